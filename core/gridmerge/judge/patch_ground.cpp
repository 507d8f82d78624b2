#include "gridmerge/judge/patch_ground.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

#include "gridmerge/judge/meeting_cells.hpp"

namespace gridmerge {
namespace {

constexpr double kStep_m = 0.1;

}  // namespace

PatchGround::PatchGround(const PreparedMap& map, const std::vector<WallSide>& sides, double near_m) {
  const MapLevel& level = map.level(0);
  width_ = level.width;
  height_ = level.height;
  step_ = std::max(1, static_cast<int>(std::lround(kStep_m / level.resolution_m)));
  margin_ = kSteps * step_;
  // From the first place of a cell at the left margin to the last lane of one at the right.
  const int columns = width_ + 2 * margin_;
  const auto of_a_phase = static_cast<std::uint32_t>((columns + step_ - 1) / step_ + static_cast<int>(kLanes));
  row_length_ = static_cast<std::uint32_t>(step_) * of_a_phase;
  cells_.assign(static_cast<std::size_t>(height_ + 4 * margin_) * row_length_, meets::kNothing);
  first_of_column_.resize(static_cast<std::size_t>(columns));
  for (int column = 0; column < columns; ++column) {
    first_of_column_[static_cast<std::size_t>(column)] =
        static_cast<std::uint32_t>(column % step_) * of_a_phase + static_cast<std::uint32_t>(column / step_);
  }
  const auto clear_m = static_cast<float>(near_m + level.resolution_m);
  std::vector<std::uint8_t> row_of_cells(static_cast<std::size_t>(width_));
  for (int row = 0; row < height_; ++row) {
    mark_free(level, row, clear_m, kFarFromWalls, row_of_cells.data());
    for (int phase = 0; phase < std::min(step_, width_); ++phase) {
      std::uint8_t* to = &cells_[centre_of(phase, row)];
      for (int column = phase; column < width_; column += step_) {
        *to++ = row_of_cells[static_cast<std::size_t>(column)];
      }
    }
  }
  mark_sides_within(map, sides, near_m, [&](int row, int from, int to, std::uint8_t bits) {
    for (int column = from; column <= to; ++column) {
      cells_[centre_of(column, row)] |= bits;
    }
  });
}

PatchGround::Tally PatchGround::around(std::span<const Spot> spots) const {
  constexpr std::size_t kAtOnce = 3;  // rows
  static_assert(kPlaces % kAtOnce == 0);
  Tally tally;
  const std::size_t step = static_cast<std::size_t>(step_) * row_length_;
  for (std::size_t row = 0; row < kPlaces; row += kAtOnce) {
    std::array<cv::v_uint8x16, kAtOnce> same_side;
    std::array<cv::v_uint8x16, kAtOnce> in_free;
    same_side.fill(cv::v_setzero_u8());
    in_free.fill(cv::v_setzero_u8());
    for (const Spot& spot : spots) {
      const cv::v_uint8x16 sides = cv::v_setall_u8(spot.sides);
      const cv::v_uint8x16 halves = cv::v_setall_u8(spot.halves);
      for (std::size_t i = 0; i < kAtOnce; ++i) {
        const cv::v_uint8x16 cells = cv::v_load(&cells_[spot.first + (row + i) * step]);
        const cv::v_uint8x16 free = cells == cv::v_setall_u8(meets::kFree);
        const cv::v_uint8x16 other_side = (cells & sides) == cv::v_setzero_u8();
        same_side[i] += halves & ~(other_side | free);
        in_free[i] += free & cv::v_setall_u8(2);
      }
    }
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      cv::v_store(tally.same_side[row + i].data(), same_side[i]);
      cv::v_store(tally.in_free[row + i].data(), in_free[i]);
    }
  }
  return tally;
}

Met PatchGround::met(std::span<const Spot> spots) const {
  const std::size_t centre = to_centre();
  Met met;
  for (const Spot& spot : spots) {
    // Decided without a branch: it is asked for millions of walls.
    const std::uint8_t cell = cells_[spot.first + centre];
    const bool free = cell == meets::kFree;
    met.same_side += static_cast<int>((cell & spot.sides) != 0 && !free) * spot.halves;
    met.in_free += 2 * static_cast<int>(free);
  }
  return met;
}

}  // namespace gridmerge
