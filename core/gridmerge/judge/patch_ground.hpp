#pragma once
/// A map as patches of another one are laid on it: at every place of a small neighbourhood at once.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"
#include "gridmerge/grid/wall_sides.hpp"

namespace gridmerge {

/// What walls meet, in half walls.
struct Met {
  int same_side = 0;
  int in_free = 0;

  [[nodiscard]] int gain() const { return same_side - in_free; }
};

/// Neighbourhoods are kSteps steps of about 0.1 m each way. Every step-th column lies beside the one before in memory,
/// so that one load looks a wall up at a whole row of places.
class PatchGround {
 public:
  static constexpr int kSteps = 4;
  static constexpr std::size_t kPlaces = 2 * kSteps + 1;  ///< in a row, and rows
  static constexpr std::size_t kLanes = 16;               ///< of them beyond kPlaces fill a register only

  /// A wall where a patch is laid.
  struct Spot {
    std::uint32_t first = 0;  ///< first_of its cell
    std::uint8_t sides = 0;   ///< bits of octants_seen_from that are its own
    std::uint8_t halves = 0;  ///< of a wall, that it counts where one of them is set; it counts two in free space
  };

  /// What the spots meet at each place, by row and column.
  struct Tally {
    template <typename T>
    using Places = std::array<std::array<T, kLanes>, kPlaces>;
    alignas(16) Places<std::uint8_t> same_side;
    alignas(16) Places<std::uint8_t> in_free;

    [[nodiscard]] Met at(std::size_t row, std::size_t column) const {
      return {same_side[row][column], in_free[row][column]};
    }
  };

  PatchGround() = default;
  /// Of level 0. @param sides  wall_sides of the map
  /// @param near_m  walls meet walls within this distance, and free space a cell farther from any
  PatchGround(const PreparedMap& map, const std::vector<WallSide>& sides, double near_m);

  [[nodiscard]] int step_cells() const { return step_; }

  /// A cell's neighbourhood holds cells of the map.
  [[nodiscard]] bool touches(int column, int row) const {
    return column >= -margin_ && row >= -margin_ && column < width_ + margin_ && row < height_ + margin_;
  }
  /// The first place in the neighbourhood of a cell that touches.
  [[nodiscard]] std::uint32_t first_of(int column, int row) const {
    return first_of_column_[static_cast<std::size_t>(column + margin_)] +
           static_cast<std::uint32_t>(row + margin_) * row_length_;
  }

  /// @param spots  127 at the most, so that no count of half walls exceeds a byte
  [[nodiscard]] Tally around(std::span<const Spot> spots) const;
  /// As they lie.
  [[nodiscard]] Met met(std::span<const Spot> spots) const;

 private:
  /// From the first place in a neighbourhood to that of the cell itself.
  [[nodiscard]] std::size_t to_centre() const { return static_cast<std::size_t>(margin_) * row_length_ + kSteps; }
  /// The place of a cell itself.
  [[nodiscard]] std::size_t centre_of(int column, int row) const { return first_of(column, row) + to_centre(); }

  int width_ = 0;  // [cells], and so are the next five
  int height_ = 0;
  int step_ = 1;
  int margin_ = 0;  // kSteps steps
  std::uint32_t row_length_ = 0;
  std::vector<std::uint32_t> first_of_column_;  // by column, from -margin_ on, of the first row
  std::vector<std::uint8_t> cells_;             // meeting_cells.hpp
};

}  // namespace gridmerge
