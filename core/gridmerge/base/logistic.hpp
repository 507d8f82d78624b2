#pragma once
/// Chances and their log odds.
#include <algorithm>
#include <cmath>

namespace gridmerge {

/// The chance of these log odds, 0..1.
[[nodiscard]] inline double logistic(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

/// The odds of these log odds, of which no more than 12 count.
[[nodiscard]] inline double odds(double log_odds) {
  constexpr double kMost = 12;
  return std::exp(std::min(log_odds, kMost));
}

/// ln(p / (1 - p)), for chances of 0.0001 to 0.9999: what is surer counts as that.
[[nodiscard]] inline double log_odds(double chance) {
  constexpr double kSure = 1e-4;
  const double p = std::clamp(chance, kSure, 1 - kSure);
  return std::log(p / (1 - p));
}

}  // namespace gridmerge
