#pragma once
/// Sets that grow together: which of many things hang together, directly or through others.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace gridmerge {

/// Each of the numbers 0 .. count-1 begins as a set of its own; a set is named by its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  /// The name of the set that holds `i`.
  [[nodiscard]] std::uint32_t name_of(std::uint32_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  /// Makes one set of the two that hold `a` and `b`.
  void unite(std::uint32_t a, std::uint32_t b) {
    a = name_of(a);
    b = name_of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace gridmerge
