#include "methods/som/translation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace gridmerge::som {
namespace {

/// A turned source, by direction faced.
struct Turned {
  float x = 0;
  float y = 0;
  float weight = 0;
};

struct Rotor {
  float c;
  float s;

  explicit Rotor(double angle_rad)
      : c(static_cast<float>(std::cos(angle_rad))), s(static_cast<float>(std::sin(angle_rad))) {}
  [[nodiscard]] Point2f operator()(Point2f p) const { return {c * p.x_m - s * p.y_m, s * p.x_m + c * p.y_m}; }
};

float dot(Point2f a, Point2f b) { return a.x_m * b.x_m + a.y_m * b.y_m; }

bool has_direction(Point2f v) { return v.x_m != 0 || v.y_m != 0; }

struct Box {
  float low_x = std::numeric_limits<float>::max();
  float low_y = std::numeric_limits<float>::max();
  float high_x = -std::numeric_limits<float>::max();
  float high_y = -std::numeric_limits<float>::max();

  void take_in(Point2f p) {
    low_x = std::min(low_x, p.x_m);
    low_y = std::min(low_y, p.y_m);
    high_x = std::max(high_x, p.x_m);
    high_y = std::max(high_y, p.y_m);
  }
};

/// Directions are told apart in so many sectors before they are compared exactly.
constexpr int kSectors = 64;

constexpr int kNoSector = kSectors;

int sector_of(Point2f normal) {
  if (!has_direction(normal)) {
    return kNoSector;
  }
  const double turn = std::atan2(static_cast<double>(normal.y_m), static_cast<double>(normal.x_m)) / (2 * kPi);
  return static_cast<int>(std::lround(turn * kSectors)) & (kSectors - 1);
}

int opposite(int sector) { return (sector + kSectors / 2) % kSectors; }

/// With margins of two cells: one for votes between cells, one for the blur.
VoteSurface empty_surface(const Box& target, const Box& source, double angle_rad, double cell_m) {
  VoteSurface surface;
  surface.cell_m = cell_m;
  surface.angle_rad = angle_rad;
  surface.lower_left = {static_cast<double>(target.low_x - source.high_x) - 2 * cell_m,
                        static_cast<double>(target.low_y - source.high_y) - 2 * cell_m};
  const auto cells = [&](float extent) { return static_cast<int>(static_cast<double>(extent) / cell_m) + 5; };
  surface.width = cells(target.high_x - target.low_x + source.high_x - source.low_x);
  surface.height = cells(target.high_y - target.low_y + source.high_y - source.low_y);
  surface.votes.assign(static_cast<std::size_t>(surface.width) * static_cast<std::size_t>(surface.height), 0);
  return surface;
}

/// Whether two clusters may be one piece of wall, by where they face; those without a direction match their like.
bool face_alike(Point2f a, bool a_sided, Point2f b, bool b_sided, float least_cosine) {
  if (!has_direction(a) || !has_direction(b)) {
    return !has_direction(a) && !has_direction(b);
  }
  const float cosine = dot(a, b);
  return (a_sided && b_sided ? cosine : std::abs(cosine)) >= least_cosine;
}

/// A blur over three by three cells, 1-2-1 each way: a vote is no surer than that.
void blur(VoteSurface& surface) {
  std::vector<float> rows(surface.votes.size(), 0);
  for (int row = 0; row < surface.height; ++row) {
    for (int column = 1; column + 1 < surface.width; ++column) {
      const std::size_t at = surface.offset(column, row);
      rows[at] = 0.25F * (surface.votes[at - 1] + 2 * surface.votes[at] + surface.votes[at + 1]);
    }
  }
  const auto width = static_cast<std::size_t>(surface.width);
  for (int row = 1; row + 1 < surface.height; ++row) {
    for (int column = 0; column < surface.width; ++column) {
      const std::size_t at = surface.offset(column, row);
      surface.votes[at] = 0.25F * (rows[at - width] + 2 * rows[at] + rows[at + width]);
    }
  }
}

}  // namespace

VoteSurface translation_votes(std::span<const ClusterPoint> target, std::span<const ClusterPoint> source,
                              double angle_rad, double facing_rad, double cell_m) {
  const Rotor turn(angle_rad);
  // A cluster without a direction votes with its like, in a sector of their own.
  std::array<std::vector<Turned>, kSectors + 1> by_sector;
  Box source_box;
  for (const ClusterPoint& one : source) {
    const Point2f at = turn(one.at);
    source_box.take_in(at);
    const int sector = sector_of(turn(one.normal));
    by_sector[static_cast<std::size_t>(sector)].push_back({at.x_m, at.y_m, one.weight});
    if (sector != kNoSector && !one.sided) {
      by_sector[static_cast<std::size_t>(opposite(sector))].push_back({at.x_m, at.y_m, one.weight});
    }
  }
  Box target_box;
  for (const ClusterPoint& one : target) {
    target_box.take_in(one.at);
  }
  VoteSurface surface = empty_surface(target_box, source_box, angle_rad, cell_m);
  const auto per_cell = static_cast<float>(1 / cell_m);
  const auto vote = [&](const ClusterPoint& one, int sector) {
    const float x0 = one.at.x_m - static_cast<float>(surface.lower_left.x_m);
    const float y0 = one.at.y_m - static_cast<float>(surface.lower_left.y_m);
    for (const Turned& other : by_sector[static_cast<std::size_t>(sector)]) {
      const auto column = static_cast<int>((x0 - other.x) * per_cell);
      const auto row = static_cast<int>((y0 - other.y) * per_cell);
      surface.votes[surface.offset(column, row)] += std::min(one.weight, other.weight);
    }
  };
  const int reach = std::min(kSectors / 2 - 1, static_cast<int>(std::lround(facing_rad / (2 * kPi) * kSectors)));
  for (const ClusterPoint& one : target) {
    const int sector = sector_of(one.normal);
    if (sector == kNoSector) {
      vote(one, kNoSector);
      continue;
    }
    for (int k = -reach; k <= reach; ++k) {
      vote(one, (sector + k + kSectors) % kSectors);
    }
  }
  blur(surface);
  return surface;
}

std::vector<ScoredPose> vote_peaks(const VoteSurface& surface, const std::optional<PoseWindow>& window,
                                   std::size_t at_most) {
  std::vector<ScoredPose> peaks;
  for (int row = 1; row + 1 < surface.height; ++row) {
    for (int column = 1; column + 1 < surface.width; ++column) {
      const float* const v = &surface.votes[surface.offset(column, row)];
      const std::ptrdiff_t w = surface.width;
      if (*v <= 0 || *v < v[-1] || *v < v[1] || *v < v[-w] || *v < v[w] || *v < v[-w - 1] || *v < v[-w + 1] ||
          *v < v[w - 1] || *v < v[w + 1]) {
        continue;
      }
      const Point2 at = surface.centre_of(column, row);
      const Pose2 pose{at.x_m, at.y_m, surface.angle_rad};
      if (inside(pose, window)) {
        peaks.push_back({pose, static_cast<double>(*v)});
      }
    }
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  peaks.resize(std::min(peaks.size(), at_most));
  return peaks;
}

ClusterMatcher::ClusterMatcher(std::span<const ClusterPoint> target, double reach_m, double facing_rad,
                               double along_share)
    : target_(target),
      reach_(static_cast<float>(reach_m)),
      least_cosine_(static_cast<float>(std::cos(facing_rad))),
      along_share_(static_cast<float>(along_share)) {
  Box box;
  for (const ClusterPoint& one : target) {
    box.take_in(one.at);
  }
  low_ = {box.low_x, box.low_y};
  columns_ = static_cast<int>((box.high_x - box.low_x) / reach_) + 1;
  rows_ = static_cast<int>((box.high_y - box.low_y) / reach_) + 1;
  const auto square = [&](Point2f p) {
    return static_cast<std::size_t>((p.y_m - low_.y_m) / reach_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>((p.x_m - low_.x_m) / reach_);
  };
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const ClusterPoint& one : target) {
    ++first_[square(one.at) + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) {
    first_[i] += first_[i - 1];
  }
  members_.resize(target.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < target.size(); ++i) {
    members_[next[square(target[i].at)]++] = static_cast<std::uint32_t>(i);
  }
}

ClusterMatch ClusterMatcher::operator()(std::span<const ClusterPoint> source, const Pose2& pose) const {
  const Rotor turn(pose.theta_rad);
  const Point2f moved{static_cast<float>(pose.x_m), static_cast<float>(pose.y_m)};
  ClusterMatch match;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Point2f turned = turn(source[i].at);
    const Point2f at{turned.x_m + moved.x_m, turned.y_m + moved.y_m};
    const Point2f normal = turn(source[i].normal);
    const float across_columns = (at.x_m - low_.x_m) / reach_;
    const float across_rows = (at.y_m - low_.y_m) / reach_;
    if (across_columns < -1 || across_rows < -1 || across_columns > static_cast<float>(columns_ + 1) ||
        across_rows > static_cast<float>(rows_ + 1)) {
      continue;
    }
    const int column = static_cast<int>(std::floor(across_columns));
    const int row = static_cast<int>(std::floor(across_rows));
    float least = reach_ * reach_;
    float distance = 0;
    std::uint32_t nearest = 0;
    bool found = false;
    for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
      const auto line = static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_);
      for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
        const std::size_t square = line + static_cast<std::size_t>(c);
        for (std::uint32_t k = first_[square]; k < first_[square + 1]; ++k) {
          const ClusterPoint& other = target_[members_[k]];
          if (!face_alike(normal, source[i].sided, other.normal, other.sided, least_cosine_)) {
            continue;
          }
          const Point2f off{at.x_m - other.at.x_m, at.y_m - other.at.y_m};
          const float full2 = dot(off, off);
          const float across = dot(off, other.normal);
          const float d2 = has_direction(normal) ? across * across + along_share_ * (full2 - across * across) : full2;
          if (full2 < reach_ * reach_ && d2 < least) {
            least = d2;
            distance = std::sqrt(full2);
            nearest = members_[k];
            found = true;
          }
        }
      }
    }
    if (found) {
      match.pairs.emplace_back(nearest, static_cast<std::uint32_t>(i));
      match.distance_sum_m += static_cast<double>(distance);  // Eq. 2.13
    }
  }
  return match;
}

Pose2 ClusterMatcher::step(std::span<const ClusterPoint> source, const Pose2& pose) const {
  const ClusterMatch match = (*this)(source, pose);
  if (match.pairs.size() < 3) {
    return pose;
  }
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  const double scale2 = 0.25 * static_cast<double>(reach_) * static_cast<double>(reach_);
  for (const auto& [k, i] : match.pairs) {
    const ClusterPoint& fixed = target_[k];
    const Point2 turned = Pose2{0, 0, pose.theta_rad} *
                          Point2{static_cast<double>(source[i].at.x_m), static_cast<double>(source[i].at.y_m)};
    const Point2 off =
        turned + pose.translation() - Point2{static_cast<double>(fixed.at.x_m), static_cast<double>(fixed.at.y_m)};
    const Point2 n{static_cast<double>(fixed.normal.x_m), static_cast<double>(fixed.normal.y_m)};
    const auto pull = [&](Point2 direction, double weight) {
      const double residual = direction.x_m * off.x_m + direction.y_m * off.y_m;
      const double bounded = 1 + residual * residual / scale2;
      const Eigen::Vector3d gradient(direction.x_m, direction.y_m,
                                     direction.y_m * turned.x_m - direction.x_m * turned.y_m);
      const double w = weight * static_cast<double>(source[i].weight) / (bounded * bounded);
      normal_matrix += w * gradient * gradient.transpose();
      right_side -= w * residual * gradient;
    };
    if (has_direction(fixed.normal)) {
      pull(n, 1);
      pull({-n.y_m, n.x_m}, static_cast<double>(along_share_));
    } else {
      pull({1, 0}, 1);
      pull({0, 1}, 1);
    }
  }
  const Eigen::Vector3d move = normal_matrix.ldlt().solve(right_side);
  if (!move.allFinite()) {
    return pose;
  }
  return {pose.x_m + move.x(), pose.y_m + move.y(), wrap_angle(pose.theta_rad + move.z())};
}

}  // namespace gridmerge::som
