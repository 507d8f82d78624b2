#include "gridmerge/base/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include "gridmerge/base/random.hpp"

namespace gridmerge {
namespace {

double sum_of_items(int num_threads) {
  std::vector<double> items(1000);
  parallel_for(items.size(), num_threads, [&](std::size_t index, std::size_t /*worker*/) {
    RandomStream random(1, "item", index);
    items[index] = std::sqrt(random.uniform());
  });
  double sum = 0;
  for (const double item : items) {
    sum += item;
  }
  return sum;
}

TEST(ParallelFor, GivesTheSameSumAtAnyNumberOfThreads) {
  const double one = sum_of_items(1);
  EXPECT_EQ(one, sum_of_items(2));
  EXPECT_EQ(one, sum_of_items(4));
  EXPECT_EQ(one, sum_of_items(33));
}

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (const int num_threads : {-1, 0, 1, 3, 8}) {
    std::vector<std::atomic<int>> visits(101);
    parallel_for(visits.size(), num_threads, [&](std::size_t index, std::size_t /*worker*/) { ++visits[index]; });
    for (const std::atomic<int>& count : visits) {
      ASSERT_EQ(count, 1) << num_threads << " threads";
    }
  }
}

TEST(ParallelFor, DoesNothingWithoutItems) {
  parallel_for(0, 4, [](std::size_t /*index*/, std::size_t /*worker*/) { FAIL(); });
}

TEST(ParallelFor, NamesEachWorkerToOneThreadAtATime) {
  constexpr int kThreads = 4;
  std::vector<std::atomic<int>> inside(kThreads);
  std::atomic<bool> shared{false};
  parallel_for(400, kThreads, [&](std::size_t /*index*/, std::size_t worker) {
    ASSERT_LT(worker, inside.size());
    shared = shared || ++inside[worker] != 1;
    std::this_thread::yield();
    --inside[worker];
  });
  EXPECT_FALSE(shared);
}

TEST(ParallelFor, ThrowsAgainWhatABodyThrows) {
  for (const int num_threads : {1, 4}) {
    const auto run = [&] {
      parallel_for(100, num_threads, [](std::size_t index, std::size_t /*worker*/) {
        if (index == 17) {
          throw std::runtime_error("item 17");
        }
      });
    };
    try {
      run();
      FAIL() << num_threads << " threads: nothing thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "item 17");
    }
  }
}

TEST(ParallelFor, StartsNoFurtherItemsAfterAThrow) {
  std::atomic<int> started{0};
  const auto run = [&] {
    parallel_for(1000000, 4, [&](std::size_t /*index*/, std::size_t /*worker*/) {
      ++started;
      throw std::runtime_error("at once");
    });
  };
  EXPECT_THROW(run(), std::runtime_error);
  EXPECT_LE(started, 4);
}

TEST(ParallelInvoke, CallsEveryFunctionOnce) {
  for (const int num_threads : {1, 2, 4}) {
    int first = 0;
    int second = 0;
    int third = 0;
    parallel_invoke(
        num_threads, [&] { ++first; }, [&] { ++second; }, [&] { ++third; });
    EXPECT_EQ(first, 1);
    EXPECT_EQ(second, 1);
    EXPECT_EQ(third, 1);
  }
}

TEST(ParallelInvoke, ThrowsAgainWhatAFunctionThrows) {
  for (const int num_threads : {1, 2}) {
    EXPECT_THROW(parallel_invoke(
                     num_threads, [] {}, [] { throw std::runtime_error("second"); }),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace gridmerge
