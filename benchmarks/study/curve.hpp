#pragma once
/// The iterations of a run, heard while it works and measured when it is over.
#include <optional>
#include <vector>

#include "gridmerge/base/trace.hpp"
#include "study/drawn_pair.hpp"
#include "study/row.hpp"

namespace gridmerge::study {

/// Keeps the best pose and its score after each iteration; iterations count on through the stages.
class CurveRecorder : public TraceSink {
 public:
  void on_iteration(const IterationRecord& record) override {
    best_.push_back({record.best_target_from_source, record.best_score});
  }

  /// @param pair  with target and source
  [[nodiscard]] std::vector<CurvePoint> curve(std::int64_t run, const DrawnPair& pair) const;

 private:
  struct Best {
    Pose2 target_from_source;
    double score = 0;
  };
  std::vector<Best> best_;
};

/// ai, Eq. 2.8 [birk2006]: agreeing cells of those known in both; the source's cells read on the target's nearest.
/// 0 where nothing overlaps. Equal to Figures::acceptance_index, without the other figures.
[[nodiscard]] double acceptance_index(const PreparedMap& target, const PreparedMap& source,
                                      const Pose2& target_from_source);

}  // namespace gridmerge::study
