#include "micro/yardstick.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "gridmerge/base/random.hpp"

namespace gridmerge::micro {
namespace {

/// The best of many rounds, for one item: other work on the machine only ever adds.
template <typename Round>
double best_ns(std::size_t items, Round&& round) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 200; ++i) {
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(round());
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count() / static_cast<double>(items));
  }
  return best;
}

}  // namespace

double random_byte_ns(std::size_t table_bytes, std::size_t reads) {
  const std::vector<std::uint8_t> table(table_bytes, 1);
  std::vector<std::uint32_t> addresses(reads);
  RandomStream random(1, "addresses");
  std::generate(addresses.begin(), addresses.end(),
                [&] { return random.below(static_cast<std::uint32_t>(table_bytes)); });
  return best_ns(reads, [&] {
    std::uint32_t sum = 0;
    for (const std::uint32_t address : addresses) {
      sum += table[address];
    }
    return sum;
  });
}

double stream_cell_ns(std::size_t cells) {
  const std::vector<std::uint64_t> coordinates(cells, 1);
  return best_ns(cells, [&] { return std::accumulate(coordinates.begin(), coordinates.end(), std::uint64_t{0}); });
}

}  // namespace gridmerge::micro
