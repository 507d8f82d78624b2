#include "gridmerge/base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace gridmerge {
namespace {

constexpr int kDraws = 100000;

TEST(RandomStream, GivesTheSameNumbersForEver) {
  RandomStream stream(1, "golden");
  EXPECT_EQ(stream.next(), 0x7548e5ec21659b89U);
  EXPECT_EQ(stream.next(), 0x1ac0238c96909a66U);
  EXPECT_EQ(stream.next(), 0xc1eb2ce9f9708928U);
  EXPECT_EQ(RandomStream(1, "golden", 7).next(), 0xf239ee4fca291672U);
  EXPECT_DOUBLE_EQ(RandomStream(1, "golden").uniform(), 0.45814358725455973);
  EXPECT_DOUBLE_EQ(RandomStream(1, "golden").uniform(-2, 6), -2 + 8 * 0.45814358725455973);
  EXPECT_NEAR(RandomStream(1, "golden").normal(), 0.87687426053253248, 1e-14);
  EXPECT_EQ(RandomStream(1, "golden").below(1000), 724u);
}

TEST(RandomStream, RepeatsItselfForTheSameSeedNameAndIndex) {
  RandomStream first(5, "mutate", 3);
  RandomStream second(5, "mutate", 3);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(first.next(), second.next());
  }
}

TEST(RandomStream, HangsOnSeedNameAndIndexEach) {
  const std::uint64_t reference = RandomStream(5, "mutate", 3).next();
  EXPECT_NE(reference, RandomStream(6, "mutate", 3).next());
  EXPECT_NE(reference, RandomStream(5, "select", 3).next());
  EXPECT_NE(reference, RandomStream(5, "mutate", 4).next());
  EXPECT_NE(reference, RandomStream(3, "mutate", 5).next());
}

/// Of neighbouring streams, too: an index is what tells the items of one loop apart.
TEST(RandomStream, IsNotCorrelatedWithItsNeighbours) {
  for (const std::uint64_t index : {1U, 2U, 1000U}) {
    RandomStream first(1, "stream", 0);
    RandomStream other(1, "stream", index);
    double sum = 0;
    for (int i = 0; i < kDraws; ++i) {
      sum += (first.uniform() - 0.5) * (other.uniform() - 0.5);
    }
    const double correlation = sum / kDraws * 12;
    EXPECT_LT(std::abs(correlation), 4 / std::sqrt(kDraws)) << "index " << index;
  }
}

TEST(RandomStream, FirstDrawsOfManyStreamsAreUniform) {
  std::array<int, 10> bins{};
  for (int index = 0; index < kDraws; ++index) {
    ++bins[static_cast<std::size_t>(10 * RandomStream(1, "stream", static_cast<std::uint64_t>(index)).uniform())];
  }
  for (const int count : bins) {
    EXPECT_NEAR(count, kDraws / 10, 4 * std::sqrt(kDraws * 0.09));
  }
}

TEST(RandomStream, UniformStaysInItsRange) {
  RandomStream stream(2, "uniform");
  for (int i = 0; i < kDraws; ++i) {
    const double value = stream.uniform(-3, 5);
    ASSERT_GE(value, -3);
    ASSERT_LT(value, 5);
  }
}

TEST(RandomStream, NormalHasTheMomentsOfANormalDistribution) {
  RandomStream stream(3, "normal");
  double sum = 0;
  double sum2 = 0;
  double sum4 = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = stream.normal();
    ASSERT_TRUE(std::isfinite(value));
    sum += value;
    sum2 += value * value;
    sum4 += value * value * value * value;
  }
  EXPECT_NEAR(sum / kDraws, 0, 4 / std::sqrt(kDraws));
  EXPECT_NEAR(sum2 / kDraws, 1, 4 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(sum4 / kDraws, 3, 4 * std::sqrt(96.0 / kDraws));
}

TEST(RandomStream, BelowReachesEveryNumberAlikeAndNoOther) {
  RandomStream stream(4, "below");
  std::array<int, 7> bins{};
  for (int i = 0; i < kDraws; ++i) {
    const std::uint32_t value = stream.below(7);
    ASSERT_LT(value, 7U);
    ++bins[value];
  }
  for (const int count : bins) {
    EXPECT_NEAR(count, kDraws / 7.0, 4 * std::sqrt(kDraws * 6.0 / 49));
  }
  EXPECT_EQ(stream.below(1), 0U);
}

}  // namespace
}  // namespace gridmerge
