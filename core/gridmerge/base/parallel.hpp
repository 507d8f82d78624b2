#pragma once
/// Loops over independent items. What an item computes depends on its index alone, and whoever sums does so in index
/// order: so an answer is the same at any number of threads.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace gridmerge {

/// As many threads as the machine runs at a time; at least 1.
[[nodiscard]] inline int available_threads() {
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// Calls `body(index, worker)` for every index in 0..count-1 on up to `num_threads` threads, the caller's among them.
/// `worker` (0..num_threads-1) names scratch memory that is not shared; it must not influence a result.
/// The first exception that a body throws is thrown again here, after all threads have come to rest.
template <typename Body>
void parallel_for(std::size_t count, int num_threads, Body&& body) {
  const std::size_t workers = std::min(count, static_cast<std::size_t>(std::max(1, num_threads)));
  if (workers <= 1) {
    for (std::size_t index = 0; index < count; ++index) {
      body(index, std::size_t{0});
    }
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&](std::size_t worker) {
    try {
      for (std::size_t index = next++; index < count; index = next++) {
        body(index, worker);
      }
    } catch (...) {
      const std::scoped_lock lock(failure_mutex);
      if (!failure) {
        failure = std::current_exception();
      }
      next = count;
    }
  };
  {
    std::vector<std::jthread> threads;
    threads.reserve(workers - 1);
    for (std::size_t worker = 1; worker < workers; ++worker) {
      threads.emplace_back(work, worker);
    }
    work(0);
  }
  if (failure) {
    std::rethrow_exception(failure);
  }
}

/// Calls every one of the functions, each once, on up to `num_threads` threads. What one writes no other may touch.
/// Exceptions as in parallel_for.
template <typename... Functions>
void parallel_invoke(int num_threads, Functions&&... functions) {
  const std::array<std::function<void()>, sizeof...(functions)> all = {std::forward<Functions>(functions)...};
  parallel_for(all.size(), num_threads, [&](std::size_t index, std::size_t) { all[index](); });
}

}  // namespace gridmerge
