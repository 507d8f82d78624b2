#pragma once
/// Is a confidence right as often as it says?
#include <Eigen/Core>
#include <vector>

namespace gridmerge::statistics {

/// Rows of one bin of confidence.
struct ReliabilityBin {
  double low = 0;
  double high = 0;
  int rows = 0;
  double mean_confidence = 0;
  double share_right = 0;
};
/// In `bins` equal bins of confidence, from 0 to 1.
[[nodiscard]] std::vector<ReliabilityBin> reliability(const Eigen::VectorXd& confidence, const Eigen::VectorXd& labels,
                                                      int bins = 10);

/// Expected calibration error: the mean over rows of |mean confidence - share of right ones| in each of the bins; 0
/// without rows.
[[nodiscard]] double expected_calibration_error(const Eigen::VectorXd& confidence, const Eigen::VectorXd& labels,
                                                int bins = 10);

}  // namespace gridmerge::statistics
