#pragma once
/// The colours of the house's pictures.
#include <cstddef>
#include <cstdint>

namespace gridmerge {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  friend constexpr bool operator==(Colour, Colour) = default;
};

inline constexpr Colour kPaperColour{0xFF, 0xFF, 0xFF};
inline constexpr Colour kInkColour{0x30, 0x34, 0x38};
inline constexpr Colour kFrameColour{0xA8, 0xAC, 0xB0};

inline constexpr Colour kUnknownColour{0xDA, 0xDC, 0xDE};
inline constexpr Colour kFreeOfSeveralColour{0xFF, 0xFF, 0xFF};
inline constexpr Colour kAgreementColour{0x20, 0x20, 0x20};  ///< a wall of several maps
inline constexpr Colour kConflictColour{0xDC, 0x00, 0x32};   ///< a wall of one map in another map's free space

/// The palette holds six maps, then begins again.
[[nodiscard]] Colour wall_colour(std::size_t map);  ///< a wall of this map alone
[[nodiscard]] Colour free_colour(std::size_t map);  ///< free space of this map alone

/// Strong enough to be seen on a faded map. Six of them, then they begin again.
[[nodiscard]] Colour shape_colour(std::size_t shape);

/// Half way to the paper: a background that other things are drawn on.
[[nodiscard]] Colour faded(Colour colour);

/// Dark violet (0) over teal to yellow (1), in steps that look alike. It also reads right without colours.
/// @param share  held to 0 .. 1; NaN counts as 0
[[nodiscard]] Colour heat_colour(double share);

}  // namespace gridmerge
