#include "report/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gridmerge {
namespace {

struct MapColours {
  Colour wall;
  Colour free;
};
// After Okabe, Ito: "Color universal design" (2008).
constexpr std::array<MapColours, 6> kMaps{{{{0x00, 0x72, 0xB2}, {0xDD, 0xEB, 0xF7}},
                                           {{0xE6, 0x9F, 0x00}, {0xFB, 0xEE, 0xD0}},
                                           {{0x00, 0x9E, 0x73}, {0xD8, 0xF0, 0xE6}},
                                           {{0x56, 0xB4, 0xE9}, {0xE4, 0xF4, 0xFD}},
                                           {{0x94, 0x67, 0xBD}, {0xEC, 0xE4, 0xF4}},
                                           {{0x8C, 0x56, 0x4B}, {0xF0, 0xE4, 0xE1}}}};

constexpr std::array<Colour, 6> kShapes{{{0xC8, 0x10, 0x2E},
                                         {0x5B, 0x2A, 0x86},
                                         {0x00, 0x6B, 0x54},
                                         {0x14, 0x18, 0x1C},
                                         {0xB0, 0x30, 0x90},
                                         {0x7A, 0x4A, 0x10}}};

constexpr std::size_t kHeatSteps = 256;

std::uint8_t srgb(double linear) {
  const double light = std::clamp(linear, 0.0, 1.0);
  const double shown = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * shown));
}

/// CIE LCh (D65) to sRGB.
Colour from_lch(double lightness, double chroma, double hue_deg) {
  const auto inverse_f = [](double t) {
    return t > 6.0 / 29 ? t * t * t : 3 * (6.0 / 29) * (6.0 / 29) * (t - 4.0 / 29);
  };
  const double hue = hue_deg * std::numbers::pi / 180;
  const double f = (lightness + 16) / 116;
  const double x = 0.95047 * inverse_f(f + chroma * std::cos(hue) / 500);
  const double y = inverse_f(f);
  const double z = 1.08883 * inverse_f(f - chroma * std::sin(hue) / 200);
  return {srgb(3.2406 * x - 1.5372 * y - 0.4986 * z), srgb(-0.9689 * x + 1.8758 * y + 0.0415 * z),
          srgb(0.0557 * x - 0.2040 * y + 1.0570 * z)};
}

/// Lightness rises evenly; the chroma follows what a screen can show along the way.
std::array<Colour, kHeatSteps> make_heat() {
  std::array<Colour, kHeatSteps> heat;
  for (std::size_t i = 0; i < kHeatSteps; ++i) {
    const double t = static_cast<double>(i) / (kHeatSteps - 1);
    heat[i] = from_lch(14 + 78 * t, 40 - 60 * t + 75 * t * t, 308 - 240 * t + 40 * t * t);
  }
  return heat;
}

}  // namespace

Colour wall_colour(std::size_t map) { return kMaps[map % kMaps.size()].wall; }
Colour free_colour(std::size_t map) { return kMaps[map % kMaps.size()].free; }
Colour shape_colour(std::size_t shape) { return kShapes[shape % kShapes.size()]; }

Colour faded(Colour colour) {
  const auto lighter = [](std::uint8_t value) { return static_cast<std::uint8_t>((value + 255) / 2); };
  return {lighter(colour.red), lighter(colour.green), lighter(colour.blue)};
}

Colour heat_colour(double share) {
  static const std::array<Colour, kHeatSteps> heat = make_heat();
  const double held = share > 0 ? std::min(share, 1.0) : 0.0;
  return heat[static_cast<std::size_t>(std::lround(held * (kHeatSteps - 1)))];
}

}  // namespace gridmerge
