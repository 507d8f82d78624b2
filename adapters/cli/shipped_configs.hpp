#pragma once
/// The configuration files that the repository ships: the built-in defaults, written out.
#include <string>
#include <vector>

#include "gridmerge/align/registry.hpp"

namespace gridmerge::cli {

struct ShippedConfig {
  std::string name;  ///< of the file in configs/
  std::string text;
};

/// One for every profile of every method, and one for what stands around them.
[[nodiscard]] std::vector<ShippedConfig> shipped_configs(const MethodRegistry& methods);

}  // namespace gridmerge::cli
