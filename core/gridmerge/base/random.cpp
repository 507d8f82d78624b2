#include "gridmerge/base/random.hpp"

#include <bit>
#include <cmath>

namespace gridmerge {
namespace {

std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return hash;
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name, std::uint64_t index) {
  std::uint64_t state = seed;
  state = splitmix64(state) ^ fnv1a(name);
  state = splitmix64(state) ^ index;
  for (std::uint64_t& word : state_) {
    word = splitmix64(state);
  }
}

std::uint64_t RandomStream::next() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double RandomStream::uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }

double RandomStream::normal() {
  // Box-Muller; 1 - u lies in (0, 1], so the logarithm is finite. One of the pair is thrown away: a stream then has no
  // state beyond its generator.
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(6.283185307179586 * uniform());
}

std::uint32_t RandomStream::below(std::uint32_t count) {
  const std::uint64_t limit = (std::uint64_t{1} << 32) / count * count;
  std::uint64_t draw = next() >> 32;
  while (draw >= limit) {
    draw = next() >> 32;
  }
  return static_cast<std::uint32_t>(draw % count);
}

}  // namespace gridmerge
