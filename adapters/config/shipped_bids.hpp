#pragma once
/// configs/learned/bids.yaml as it was when the program was built; embed_text.cmake makes the source.
#include <string>

namespace gridmerge {

[[nodiscard]] std::string shipped_bids_yaml();

}  // namespace gridmerge
