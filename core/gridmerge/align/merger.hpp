#pragma once
/// The contract between the pipeline and a method: a method proposes poses, and does nothing else.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/base/stop_token.hpp"
#include "gridmerge/base/trace.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// What is known of the answer beforehand.
struct PosePrior {
  Pose2 target_from_source;  ///< between the map frames
  /// How far off the centre of the source's known cells may be, and the heading. None: a start, not a fence.
  std::optional<double> radius_m;
  std::optional<double> angle_rad;
};

/// A set of poses that a method carries from one epoch to the next: a value, not hidden state.
struct Population {
  std::vector<Pose2> target_from_source;  ///< between the map frames
};

/// Borrowed by the method for the time of one call; not modified.
struct AlignRequest {
  const PreparedMap& target;            ///< the answer is in its frame
  const PreparedMap& source;            ///< the map that moves; same resolution as the target
  std::optional<PosePrior> prior;       ///< none: anywhere, any angle
  const Population* carried = nullptr;  ///< what the last epoch's Proposal left, where the method has the trait
};

/// Same request and same seed: same answer, at any number of threads.
struct RunContext {
  std::uint64_t seed = 1;
  int num_threads = 1;
  StopToken stop = {};
  TraceSink* trace = nullptr;  ///< optional, not owned
};

/// Tells whoever watches which stage begins.
inline void announce(const RunContext& context, const std::string& stage) {
  if (context.trace != nullptr) {
    context.trace->on_stage(stage);
  }
}

/// Whether views are worth a method's time.
[[nodiscard]] inline bool wants_views(const RunContext& context) {
  return context.trace != nullptr && context.trace->wants_views();
}

struct Candidate {
  Pose2 target_from_source;  ///< between the map frames
  double method_score = 0;   ///< higher is better, in the method's own unit: never compared with another method's
};

struct Proposal {
  std::vector<Candidate> candidates;  ///< best first; empty: nothing found
  Population carry;                   ///< for the next epoch; empty where the method has none
  int iterations = 0;
  bool stopped = false;  ///< the stop token ended it early; the candidates are the best so far
  /// The candidates hold the best distinct poses of all there are (or of the prior's fence), not of one basin only.
  /// Where they do not, the pipeline seeks rivals itself: a lead over nobody is worth nothing.
  bool surveyed = false;
  std::vector<std::string> remarks = {};  ///< what is worth knowing of the search, in words: a bound, a proof
};

struct MergerTraits {
  bool stochastic = false;   ///< another seed may give another answer
  bool uses_prior = false;   ///< a prior speeds it up or narrows it
  bool needs_prior = false;  ///< without one it objects
  bool anytime = false;      ///< stopped early, it still gives its best so far
  bool warm_start = false;   ///< takes up AlignRequest::carried
};

/// What is expected of a method on a pair of maps.
struct Bid {
  double success = 0;  ///< chance that its answer is merged, and rightly, where the maps overlap: 0..1
  double seconds = 0;  ///< of the whole alignment, on one thread
};

/// A method. Const and reentrant: no state between calls, no printing, no files.
class Merger {
 public:
  virtual ~Merger() = default;
  [[nodiscard]] virtual MergerTraits traits() const = 0;
  /// Why this method cannot work on these maps, in one sentence; none: it can.
  [[nodiscard]] virtual std::optional<std::string> objection(const AlignRequest& /*request*/) const { return {}; }
  /// What to expect of it on these maps, where the method knows better than what was learned of it (BidBook). Soon.
  [[nodiscard]] virtual std::optional<Bid> bid(const AlignRequest& /*request*/) const { return {}; }
  /// Ranked poses. Both maps hold at least one occupied cell, and `objection` has found nothing.
  [[nodiscard]] virtual Proposal propose(const AlignRequest& request, const RunContext& context) const = 0;
};

}  // namespace gridmerge
