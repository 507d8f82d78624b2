#pragma once
/// What the pictures of this folder share: text, and the strip of signs under a picture. Only for its .cpp files.
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "map_server/raster_image.hpp"
#include "report/colours.hpp"

namespace gridmerge::drawing {

[[nodiscard]] inline cv::Vec3b pixel(Colour colour) { return {colour.red, colour.green, colour.blue}; }
[[nodiscard]] inline cv::Scalar scalar(Colour colour) {
  return {double(colour.red), double(colour.green), double(colour.blue)};
}

/// An RGB image of paper, and the same as a matrix that borrows its samples.
[[nodiscard]] RasterImage blank_image(int width_px, int height_px);
[[nodiscard]] cv::Mat matrix_of(RasterImage& image);
[[nodiscard]] Colour colour_at(const RasterImage& image, cv::Point at);

void fill(cv::Mat& image, const cv::Rect& box, Colour colour);

/// The text cut to `longest` characters in its middle; what is not printable ASCII is shown as '?'.
[[nodiscard]] std::string printable(std::string text, std::size_t longest = 40);
/// "0.25 m"
[[nodiscard]] std::string metres(double length_m);

/// How a line of text is set. Heights are those of a capital letter.
struct TextStyle {
  double height_px = 11;
  Colour colour = kInkColour;
  bool outlined = false;  ///< with a rim of paper, for text on a picture
  bool upwards = false;   ///< turned by a quarter, to be read from the right
};

[[nodiscard]] int text_width(const std::string& text, const TextStyle& style);

/// Writes one line with the middle of its capitals at `at.y` (turned: at.x), and in the other direction so that `share`
/// of it lies before `at`: 0 begins there, 0.5 is centred, 1 ends there. What reaches beyond the image is cut off.
void write(cv::Mat& image, const std::string& text, cv::Point at, double share, const TextStyle& style);

/// One item of a legend: a sign and its text.
struct LegendEntry {
  enum class Sign { kPatch, kLine, kPoint, kRuler };  ///< a ruler is `ruler_px` long, in ink
  std::string text;
  Sign sign = Sign::kPatch;
  Colour colour = {};
  Colour second = {};  ///< of a patch: its right half
  double ruler_px = 0;
};

/// The strip under a picture, set in lines as a text is.
class Legend {
 public:
  Legend(std::vector<LegendEntry> entries, double scale) : entries_(std::move(entries)), scale_(scale) {}

  /// Height of the strip, if it is that wide.
  [[nodiscard]] int height(int width_px) const;
  void draw(cv::Mat& image, cv::Point corner, int width_px) const;

 private:
  /// Upper left corners of the items in a strip that begins at the origin.
  [[nodiscard]] std::vector<cv::Point> places(int width_px) const;
  [[nodiscard]] int px(int at_scale_one) const;
  [[nodiscard]] int sign_px(const LegendEntry& entry) const;
  void draw_sign(cv::Mat& image, const LegendEntry& entry, cv::Point left) const;

  std::vector<LegendEntry> entries_;
  double scale_;
};

}  // namespace gridmerge::drawing
