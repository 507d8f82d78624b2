#include "gridmerge/base/stop_token.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

namespace gridmerge {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;

TEST(StopToken, DoesNotStopByItself) {
  const StopToken token;
  EXPECT_FALSE(token.stop_requested());
  EXPECT_EQ(token.iteration_budget(), std::numeric_limits<int>::max());
}

TEST(StopToken, StopsWhenAnyCopyIsCancelled) {
  const StopToken token;
  const StopToken copy = token;
  std::jthread([copy] { copy.cancel(); }).join();
  EXPECT_TRUE(token.stop_requested());
  EXPECT_TRUE(copy.stop_requested());
}

TEST(StopToken, LeavesOthersAloneWhenCancelled) {
  const StopToken token;
  const StopToken other;
  token.cancel();
  EXPECT_FALSE(other.stop_requested());
}

TEST(StopToken, StopsWhenItsTimeIsUp) {
  EXPECT_TRUE(StopToken::after(duration<double>(0)).stop_requested());
  EXPECT_TRUE(StopToken::after(duration<double>(-1)).stop_requested());
  EXPECT_FALSE(StopToken::after(duration<double>(3600)).stop_requested());
  const StopToken soon = StopToken::after(duration<double>(0.02));
  std::this_thread::sleep_for(milliseconds(30));
  EXPECT_TRUE(soon.stop_requested());
}

TEST(StopToken, KeepsDeadlineAndCancelFlagWithABudget) {
  const StopToken token = StopToken::after(duration<double>(3600));
  const StopToken budgeted = token.with_iterations(7);
  EXPECT_EQ(budgeted.iteration_budget(), 7);
  EXPECT_FALSE(budgeted.stop_requested());
  token.cancel();
  EXPECT_TRUE(budgeted.stop_requested());
  EXPECT_TRUE(StopToken::after(duration<double>(0)).with_iterations(7).stop_requested());
}

}  // namespace
}  // namespace gridmerge
