#include "cli/text.hpp"

#include <cmath>

namespace gridmerge::cli {

std::string pose_text(const Pose2& pose) {
  return "x " + fixed(pose.x_m, 3) + " m, y " + fixed(pose.y_m, 3) + " m, theta " + fixed(pose.theta_rad, 4) +
         " rad (" + fixed(degrees(pose.theta_rad), 2) + " deg)";
}

std::string deviation_text(const std::optional<PoseCovariance>& covariance) {
  if (!covariance) {
    return "not known";
  }
  const auto deviation = [&](Eigen::Index i) { return std::sqrt(std::max(0.0, (*covariance)(i, i))); };
  return fixed(deviation(0), 3) + " m, " + fixed(deviation(1), 3) + " m, " + fixed(degrees(deviation(2)), 3) + " deg";
}

std::string status_of(Outcome outcome) {
  return to_string(outcome == Outcome::kStopped ? Outcome::kDeclined : outcome);
}

std::vector<std::string> reasons_of(const Alignment& alignment) {
  if (alignment.outcome == Outcome::kStopped) {
    return {"stopped before any pose was found"};
  }
  return alignment.reasons;
}

std::string verdict_text(Outcome outcome, double confidence) {
  const std::string sure = "(confidence " + fixed(confidence, 2) + ")";
  switch (outcome) {
    case Outcome::kMerged:
      return "Merged: B lies in A as below " + sure + ".";
    case Outcome::kAmbiguous:
      return "Ambiguous: B may lie in A as below, but not surely enough to merge them " + sure + ".";
    case Outcome::kNoOverlap:
      return "No overlap: no pose fits better than chance would have it " + sure + ".";
    case Outcome::kDeclined:
    case Outcome::kStopped:
      break;
  }
  return "Declined: there is no answer for these maps.";
}

std::string list_text(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) {
    text += "  - " + item + "\n";
  }
  return text;
}

std::string choice_text(const Alignment& alignment) {
  std::string text = "\nChoice of the method\n" + list_text(alignment.story) + "\nTried\n";
  for (const Attempt& one : alignment.attempts) {
    text += "  - " + one.method + ": " + status_of(one.outcome) + ", confidence " + fixed(one.confidence, 2) + ", " +
            fixed(one.seconds, 2) + " s\n";
  }
  return text;
}

std::string alignment_text(const Alignment& alignment, double load_seconds) {
  std::string text = verdict_text(alignment.outcome, alignment.confidence) + "\n";
  const std::vector<Hypothesis>& hypotheses = alignment.hypotheses;
  if (!hypotheses.empty()) {
    const PoseEstimate& best = hypotheses.front().target_from_source;
    const bool merged = alignment.outcome == Outcome::kMerged;
    text += std::string("\n") + (merged ? "Pose" : "Best pose, not to be relied on,") + " of B's map frame in A's\n  " +
            pose_text(best.pose) + "\n  standard deviation " + deviation_text(best.covariance) + "\n";
  }
  text += "\nWhy\n" + list_text(reasons_of(alignment));
  if (!alignment.remarks.empty()) {
    text += "\nOf the search\n" + list_text(alignment.remarks);
  }
  if (hypotheses.size() > 1) {
    text += "\nOther poses, best first\n";
    const double best_m = hypotheses.front().figures.evidence_m;
    for (std::size_t i = 1; i < hypotheses.size(); ++i) {
      const double evidence_m = hypotheses[i].figures.evidence_m;
      text += "  " + pose_text(hypotheses[i].target_from_source.pose) + ": " +
              (best_m > 0 ? fixed(100 * evidence_m / best_m, 0) + " % of the best" : fixed(evidence_m, 1) + " m") +
              "\n";
    }
  }
  const StepSeconds& s = alignment.seconds;
  const std::string choosing = alignment.story.empty() ? "" : ", choose " + fixed(s.choose, 2);
  return text + "\nTime\n  " + fixed(s.align, 2) + " s: prepare " + fixed(s.prepare, 2) + choosing + ", propose " +
         fixed(s.propose, 2) + ", refine " + fixed(s.refine, 2) + ", judge " + fixed(s.judge, 2) + "; reading files " +
         fixed(load_seconds, 2) + "\n";
}

}  // namespace gridmerge::cli
