#pragma once
/// Where an axis is marked, in numbers that a person likes to read.
#include <string>
#include <vector>

namespace gridmerge {

/// Marks along an axis, from low to high.
struct Ticks {
  std::vector<double> at;
  std::vector<std::string> text;  ///< as many as `at`
  std::string factor;             ///< "1e6": what the texts are multiplied by; empty: by one
};

/// Every 1, 2 or 5 times a power of ten; of degrees, also every 15, 30, 45, 90 or 180. Large and small numbers share a
/// factor of a thousand, a million, ...
/// @param low, high  finite, low < high
/// @param at_most  >= 2; there may be fewer, and no more
[[nodiscard]] Ticks round_ticks(double low, double high, int at_most, bool are_degrees = false);

/// The longest of 1, 2, 5 times a power of ten that is not longer. @param length  > 0
[[nodiscard]] double round_length(double length);

/// What stands in the last brackets of an axis' label: "deg" of "angle [deg]"; empty if there are none.
[[nodiscard]] std::string unit_of(const std::string& label);

}  // namespace gridmerge
