#pragma once
/// What a wall meets that is laid on a cell, in a byte.
#include <cstdint>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// A byte with three bits or more is WallSide::octants_seen_from of the walls near by. Less than that no side has:
namespace meets {
inline constexpr std::uint8_t kNothing = 0;  ///< unknown, or neither near a wall nor clear of it
inline constexpr std::uint8_t kFree = 1;
inline constexpr std::uint8_t kFarFree = 2;
}  // namespace meets

/// One row of such bytes, as far as no wall is near.
/// @param clear_m  free cells farther than that from any wall are kFree ...
/// @param far_m    ... and kFarFree beyond that, which is no less
void mark_free(const MapLevel& level, int row, float clear_m, float far_m, std::uint8_t* cells);

}  // namespace gridmerge
