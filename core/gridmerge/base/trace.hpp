#pragma once
/// Watching a method at work. Watching never changes the result.
#include <string>
#include <vector>

#include "gridmerge/base/view.hpp"
#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// What a method tells of one iteration. Poses take the source's map frame into the target's.
struct IterationRecord {
  std::string stage;      ///< "propose/evolve", ..., a stable name
  int iteration = 0;      ///< from 0, within the stage
  int iterations = 0;     ///< how many there will be at the most; 0: not known
  double best_score = 0;  ///< in the method's own unit
  double mean_score = 0;
  Pose2 best_target_from_source;
  std::vector<Pose2> population;  ///< empty where the method has none
};

/// Called from the thread that asked for the alignment, between iterations; must return soon and must not throw.
class TraceSink {
 public:
  virtual ~TraceSink() = default;
  virtual void on_stage(const std::string& /*name*/) {}
  virtual void on_iteration(const IterationRecord& /*record*/) {}
  /// Whether on_view is worth a method's time. It asks before it makes a view, which may cost more than the method.
  [[nodiscard]] virtual bool wants_views() const { return false; }
  virtual void on_view(const View& /*view*/) {}
};

}  // namespace gridmerge
