#pragma once
/// The maps that are in use or may be soon: drawn once, by whoever needs them first.
#include <future>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "study/drawn_pair.hpp"

namespace gridmerge::study {

/// Thread safe. Pairs that were not asked for the longest are forgotten when the others take more than the budget.
class PairCache {
 public:
  /// @param pairs  borrowed
  PairCache(const std::vector<PairChoice>& pairs, bool keep_prepared, std::size_t budget_bytes)
      : pairs_(pairs), keep_prepared_(keep_prepared), budget_bytes_(budget_bytes) {}

  /// Whoever asks for a pair that another thread is drawing waits for it.
  /// @throws what draw throws, for everybody who asks for this pair
  [[nodiscard]] std::shared_ptr<const DrawnPair> get(std::size_t pair);

 private:
  using Drawn = std::shared_ptr<const DrawnPair>;
  void forget_the_oldest();

  const std::vector<PairChoice>& pairs_;
  bool keep_prepared_;
  std::size_t budget_bytes_;
  std::mutex mutex_;
  std::map<std::size_t, std::shared_future<Drawn>> drawn_;
  std::map<std::size_t, std::size_t> bytes_;  ///< of those that are done
  std::list<std::size_t> by_use_;             ///< of those, the longest unused first
};

}  // namespace gridmerge::study
