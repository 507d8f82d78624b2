#pragma once
/// Random numbers that are the same on every machine and at every thread count.
#include <array>
#include <cstdint>
#include <string_view>

namespace gridmerge {

/// A stream of random numbers, told apart from all others by (seed, name, index) and by nothing else: never by thread
/// or by the order of calls elsewhere. xoshiro256++ (Blackman, Vigna 2019) seeded through splitmix64; the distributions
/// are our own, since the standard library's differ between implementations.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name, std::uint64_t index = 0);

  [[nodiscard]] std::uint64_t next();                      ///< 64 random bits
  [[nodiscard]] double uniform();                          ///< [0, 1)
  [[nodiscard]] double uniform(double low, double high);   ///< [low, high)
  [[nodiscard]] double normal();                           ///< mean 0, standard deviation 1
  [[nodiscard]] std::uint32_t below(std::uint32_t count);  ///< 0 .. count-1, unbiased; count > 0

 private:
  std::array<std::uint64_t, 4> state_;
};

}  // namespace gridmerge
