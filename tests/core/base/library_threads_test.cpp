#include "gridmerge/base/library_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <opencv2/core/utility.hpp>
#include <thread>

namespace gridmerge {
namespace {

TEST(LibraryThreads, OpenCvWorksOnTheCallingThread) {
  keep_opencv_on_the_calling_thread();
  const std::thread::id here = std::this_thread::get_id();
  std::atomic<int> elsewhere = 0;
  cv::parallel_for_(cv::Range(0, 10000), [&](const cv::Range& range) {
    if (std::this_thread::get_id() != here) {
      elsewhere += range.size();
    }
  });
  EXPECT_EQ(elsewhere, 0);
}

}  // namespace
}  // namespace gridmerge
