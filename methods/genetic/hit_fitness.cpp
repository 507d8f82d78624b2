#include "methods/genetic/hit_fitness.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace gridmerge {
namespace {

/// Cells that are looked up together: enough for the compiler to compute their addresses with vector instructions.
constexpr std::size_t kBlock = 16;

/// Cells of rim round the table. It is never occupied, so whatever falls outside is clamped onto it and counts 0.
constexpr std::uint32_t kRim = 1;

/// The table is kept in upright strips eight cells wide, so that eight by eight cells share a cache line: a wall then
/// costs as few lines upright as lying down (benchmarks/micro).
std::uint32_t strip_offset(std::uint32_t column, std::uint32_t row, std::uint32_t height) {
  return (column & ~7U) * height + row * 8 + (column & 7U);
}

}  // namespace

HitFitness::HitFitness(const PreparedMap& target, const PreparedMap& source)
    : target_local_from_map_(inverse(target.map_from_local())),
      source_map_from_local_(source.map_from_local()),
      cells_per_m_(1 / target.resolution_m()),
      lower_left_(target.level(0).lower_left - Point2{kRim * target.resolution_m(), kRim * target.resolution_m()}),
      width_(static_cast<std::uint32_t>(target.level(0).width) + 2 * kRim),
      height_(static_cast<std::uint32_t>(target.level(0).height) + 2 * kRim),
      cell_count_(source.walls().size()) {
  const MapLevel& level = target.level(0);
  table_.assign(static_cast<std::size_t>((width_ + 7) / 8 * 8) * height_, 0);
  for (std::uint32_t row = 0; row + 2 * kRim < height_; ++row) {
    for (std::uint32_t column = 0; column + 2 * kRim < width_; ++column) {
      const std::size_t at = level.offset(static_cast<int>(column), static_cast<int>(row));
      if (level.state[at] == CellState::kWall) {
        table_[strip_offset(column + kRim, row + kRim, height_)] = static_cast<std::uint8_t>(target.occupancy()[at]);
      }
    }
  }
  // Not a number fills the last block: no comparison holds for it, so it is clamped onto the rim at every pose.
  const std::size_t filled = (cell_count_ + kBlock - 1) / kBlock * kBlock;
  x_cells_.assign(filled, std::numeric_limits<float>::quiet_NaN());
  y_cells_.assign(filled, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < cell_count_; ++i) {
    const Point2f& at = source.walls()[i].at;
    x_cells_[i] = static_cast<float>(at.x_m * cells_per_m_);
    y_cells_[i] = static_cast<float>(at.y_m * cells_per_m_);
  }
}

std::int64_t HitFitness::operator()(const Pose2& target_from_source) const {
  const Pose2 local = target_local_from_map_ * target_from_source * source_map_from_local_;
  const auto c = static_cast<float>(std::cos(local.theta_rad));
  const auto s = static_cast<float>(std::sin(local.theta_rad));
  const auto x0 = static_cast<float>((local.x_m - lower_left_.x_m) * cells_per_m_);
  const auto y0 = static_cast<float>((local.y_m - lower_left_.y_m) * cells_per_m_);
  const auto last_column = static_cast<float>(width_ - 1);
  const auto last_row = static_cast<float>(height_ - 1);
  const std::uint8_t* const table = table_.data();

  std::int64_t sum = 0;
  for (std::size_t block = 0; block < x_cells_.size(); block += kBlock) {
    const float* const px = &x_cells_[block];
    const float* const py = &y_cells_[block];
    std::array<std::uint32_t, kBlock> offset;
    for (std::size_t i = 0; i < kBlock; ++i) {
      float x = c * px[i] - s * py[i] + x0;  // Eq. 3.2
      float y = s * px[i] + c * py[i] + y0;
      x = x > 0 ? x : 0;
      y = y > 0 ? y : 0;
      x = x < last_column ? x : last_column;
      y = y < last_row ? y : last_row;
      offset[i] = strip_offset(static_cast<std::uint32_t>(static_cast<std::int32_t>(x)),
                               static_cast<std::uint32_t>(static_cast<std::int32_t>(y)), height_);
    }
    std::uint32_t hits = 0;
    for (std::size_t i = 0; i < kBlock; ++i) {
      hits += table[offset[i]];  // Eq. 3.6
    }
    sum += hits;
  }
  return sum;  // Eq. 3.5
}

}  // namespace gridmerge
