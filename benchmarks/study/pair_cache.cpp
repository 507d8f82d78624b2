#include "study/pair_cache.hpp"

#include <numeric>

namespace gridmerge::study {

std::shared_ptr<const DrawnPair> PairCache::get(std::size_t pair) {
  std::promise<Drawn> promise;
  std::unique_lock lock(mutex_);
  if (const auto found = drawn_.find(pair); found != drawn_.end()) {
    const std::shared_future<Drawn> future = found->second;
    if (bytes_.contains(pair)) {
      by_use_.remove(pair);
      by_use_.push_back(pair);
    }
    lock.unlock();
    return future.get();
  }
  const std::shared_future<Drawn> future = promise.get_future().share();
  drawn_.emplace(pair, future);
  lock.unlock();
  try {
    auto made = std::make_shared<const DrawnPair>(draw(pairs_[pair], keep_prepared_));
    const std::size_t bytes = made->bytes;
    promise.set_value(std::move(made));
    lock.lock();
    bytes_[pair] = bytes;
    by_use_.push_back(pair);
    forget_the_oldest();
  } catch (...) {
    promise.set_exception(std::current_exception());
  }
  return future.get();
}

void PairCache::forget_the_oldest() {
  std::size_t sum = std::accumulate(bytes_.begin(), bytes_.end(), std::size_t{0},
                                    [](std::size_t total, const auto& one) { return total + one.second; });
  while (sum > budget_bytes_ && by_use_.size() > 1) {
    const std::size_t oldest = by_use_.front();
    by_use_.pop_front();
    sum -= bytes_[oldest];
    bytes_.erase(oldest);
    drawn_.erase(oldest);
  }
}

}  // namespace gridmerge::study
