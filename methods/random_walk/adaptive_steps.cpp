#include "methods/random_walk/adaptive_steps.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

Pose2 stepped(const Pose2& pose, const PoseStep& step) {
  return {pose.x_m + step[0], pose.y_m + step[1], wrap_angle(pose.theta_rad + step[2])};
}

AdaptiveSteps::AdaptiveSteps(const StepRules& rules) : rules_(rules) { learn(); }

PoseStep AdaptiveSteps::draw(RandomStream& random) const {
  const double a = random.normal();
  const double b = random.normal();
  const double c = random.normal();
  const double m = mean_share_ * width_;
  return {m * mean_[0] + width_ * root_[0] * a, m * mean_[1] + width_ * (root_[1] * a + root_[2] * b),
          m * mean_[2] + width_ * (root_[3] * a + root_[4] * b + root_[5] * c)};
}

void AdaptiveSteps::accepted(const PoseStep& step) {
  last_.push_back({step[0] / width_, step[1] / width_, step[2] / width_});
  if (last_.size() > rules_.memory) {
    last_.pop_front();
  }
  learn();
  width_ = std::min(width_ * rules_.on_accepted, rules_.most_width);
  mean_share_ = 1;
}

void AdaptiveSteps::rejected() {
  width_ = std::max(width_ * rules_.on_rejected, rules_.least_width);
  mean_share_ *= rules_.mean_fade;
}

double AdaptiveSteps::sigma_m() const {
  return width_ * std::sqrt(0.5 * (root_[0] * root_[0] + root_[1] * root_[1] + root_[2] * root_[2]));
}

void AdaptiveSteps::learn() {
  // Where fewer than `memory` steps are known, the first covariance makes up for the missing ones.
  const auto known = static_cast<double>(last_.size());
  const auto all = static_cast<double>(rules_.memory);
  mean_ = {};
  for (const PoseStep& step : last_) {
    for (std::size_t i = 0; i < 3; ++i) {
      mean_[i] += step[i] / all;
    }
  }
  std::array<std::array<double, 3>, 3> covariance{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      for (const PoseStep& step : last_) {
        covariance[i][j] += (step[i] - mean_[i]) * (step[j] - mean_[j]) / all;
      }
    }
    const double first = rules_.first_sigma[i];
    covariance[i][i] += first * first * ((all - known) / all + rules_.floor_share * rules_.floor_share);
  }
  const auto& s = covariance;
  root_[0] = std::sqrt(s[0][0]);
  root_[1] = s[1][0] / root_[0];
  root_[2] = std::sqrt(std::max(0.0, s[1][1] - root_[1] * root_[1]));
  root_[3] = s[2][0] / root_[0];
  root_[4] = root_[2] > 0 ? (s[2][1] - root_[3] * root_[1]) / root_[2] : 0;
  root_[5] = std::sqrt(std::max(0.0, s[2][2] - root_[3] * root_[3] - root_[4] * root_[4]));
}

}  // namespace gridmerge
