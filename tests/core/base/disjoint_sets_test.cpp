#include "gridmerge/base/disjoint_sets.hpp"

#include <gtest/gtest.h>

namespace gridmerge {
namespace {

TEST(DisjointSets, BeginApart) {
  DisjointSets sets(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(sets.name_of(i), i);
  }
}

TEST(DisjointSets, AreNamedByTheirSmallestMemberInWhateverOrderTheyGrow) {
  DisjointSets sets(6);
  sets.unite(5, 3);
  sets.unite(4, 2);
  sets.unite(4, 5);
  for (const std::uint32_t i : {2U, 3U, 4U, 5U}) {
    EXPECT_EQ(sets.name_of(i), 2U);
  }
  EXPECT_EQ(sets.name_of(0), 0U);
  EXPECT_EQ(sets.name_of(1), 1U);
  sets.unite(3, 0);
  EXPECT_EQ(sets.name_of(4), 0U);
}

TEST(DisjointSets, UnitingTwiceChangesNothing) {
  DisjointSets sets(2);
  sets.unite(0, 1);
  sets.unite(1, 0);
  EXPECT_EQ(sets.name_of(1), 0U);
}

}  // namespace
}  // namespace gridmerge
