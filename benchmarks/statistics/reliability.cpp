#include "statistics/reliability.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::statistics {

std::vector<ReliabilityBin> reliability(const Eigen::VectorXd& confidence, const Eigen::VectorXd& labels, int bins) {
  std::vector<ReliabilityBin> all;
  for (int bin = 0; bin < bins; ++bin) {
    all.push_back({.low = static_cast<double>(bin) / bins, .high = (bin + 1.0) / bins});
  }
  for (Eigen::Index i = 0; i < confidence.size(); ++i) {
    ReliabilityBin& bin =
        all[static_cast<std::size_t>(std::clamp(static_cast<int>(confidence(i) * bins), 0, bins - 1))];
    ++bin.rows;
    bin.mean_confidence += confidence(i);
    bin.share_right += labels(i);
  }
  for (ReliabilityBin& bin : all) {
    bin.mean_confidence /= std::max(1, bin.rows);
    bin.share_right /= std::max(1, bin.rows);
  }
  return all;
}

double expected_calibration_error(const Eigen::VectorXd& confidence, const Eigen::VectorXd& labels, int bins) {
  double off = 0;
  for (const ReliabilityBin& bin : reliability(confidence, labels, bins)) {
    off += bin.rows * std::abs(bin.mean_confidence - bin.share_right);
  }
  return confidence.size() > 0 ? off / static_cast<double>(confidence.size()) : 0;
}

}  // namespace gridmerge::statistics
