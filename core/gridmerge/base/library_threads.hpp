#pragma once
/// Threads that libraries start by themselves.

namespace gridmerge {

/// From here on OpenCV works on the thread that calls it, in the whole process: what runs side by side is then what
/// `num_threads` says, a measured time is that of one thread, and no split of OpenCV's own can colour an answer.
/// A program calls it once, first thing; it must not be called while another thread is inside of OpenCV.
/// The library does not do so by itself, since the setting is the process's, and others may live there.
void keep_opencv_on_the_calling_thread();

}  // namespace gridmerge
