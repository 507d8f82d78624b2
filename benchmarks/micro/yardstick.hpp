#pragma once
/// What the machine's memory allows at best: the measure for how good a measured time is.
#include <cstddef>

namespace gridmerge::micro {

/// Time to read one byte anywhere in a table of that many bytes, all addresses known beforehand and independent [ns].
[[nodiscard]] double random_byte_ns(std::size_t table_bytes, std::size_t reads);

/// Time to read eight bytes, the coordinates of one cell, one after the other from that many [ns].
[[nodiscard]] double stream_cell_ns(std::size_t cells);

}  // namespace gridmerge::micro
