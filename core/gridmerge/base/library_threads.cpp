#include "gridmerge/base/library_threads.hpp"

#include <opencv2/core/utility.hpp>

namespace gridmerge {

void keep_opencv_on_the_calling_thread() { cv::setNumThreads(1); }

}  // namespace gridmerge
