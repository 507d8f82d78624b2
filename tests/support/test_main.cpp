/// The main program of every test: as those of the house begin.
#include <gmock/gmock.h>

#include "gridmerge/base/library_threads.hpp"

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  gridmerge::keep_opencv_on_the_calling_thread();
  return RUN_ALL_TESTS();
}
