#include "report/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace gridmerge::drawing {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapital = 21;  // height of the font's capitals at scale 1 [px]
constexpr int kFine = 4;         // text is drawn so many times larger, then made smaller: no jagged strokes

double font_scale(const TextStyle& style) { return style.height_px / kCapital; }
int stroke(const TextStyle& style) { return std::max(1, static_cast<int>(std::lround(kFine * style.height_px / 8.5))); }

/// 0 .. 255: how much of each pixel the strokes cover, when they are so much wider.
cv::Mat strokes(const std::string& text, const TextStyle& style, cv::Size size, int margin_px, int wider) {
  cv::Mat fine(kFine * size.height, kFine * size.width, CV_8U, cv::Scalar(0));
  const cv::Point base(kFine * margin_px, kFine * size.height / 2 + static_cast<int>(kFine * style.height_px / 2));
  cv::putText(fine, text, base, kFont, kFine * font_scale(style), cv::Scalar(255), stroke(style) + wider, cv::LINE_AA);
  cv::Mat coverage;
  cv::resize(fine, coverage, size, 0, 0, cv::INTER_AREA);
  return coverage;
}

void blend(cv::Mat& image, const cv::Mat& coverage, cv::Point corner, Colour colour) {
  const cv::Rect seen = cv::Rect(corner, coverage.size()) & cv::Rect({}, image.size());
  for (int y = seen.y; y < seen.br().y; ++y) {
    for (int x = seen.x; x < seen.br().x; ++x) {
      const int share = coverage.at<std::uint8_t>(y - corner.y, x - corner.x);
      auto& at = image.at<cv::Vec3b>(y, x);
      const cv::Vec3b ink = pixel(colour);
      for (int channel = 0; channel < 3; ++channel) {
        at[channel] = static_cast<std::uint8_t>((ink[channel] * share + at[channel] * (255 - share) + 127) / 255);
      }
    }
  }
}

constexpr int kLine = 26;  // pixels at scale 1
constexpr int kGap = 24;
constexpr int kPad = 8;
constexpr int kSignWidth = 30;
constexpr int kSignHeight = 15;
constexpr double kLegendText = 10;

}  // namespace

RasterImage blank_image(int width_px, int height_px) {
  RasterImage image{width_px, height_px, 3, {}};
  image.samples.assign(3 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 0xFF);
  return image;
}

cv::Mat matrix_of(RasterImage& image) { return {image.height, image.width, CV_8UC3, image.samples.data()}; }

Colour colour_at(const RasterImage& image, cv::Point at) {
  const std::size_t i =
      3 * (static_cast<std::size_t>(at.y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(at.x));
  return {image.samples[i], image.samples[i + 1], image.samples[i + 2]};
}

void fill(cv::Mat& image, const cv::Rect& box, Colour colour) {
  if (!box.empty()) {
    cv::rectangle(image, box, scalar(colour), cv::FILLED);
  }
}

std::string printable(std::string text, std::size_t longest) {
  if (text.size() > longest) {
    text = text.substr(0, longest / 2 - 2) + "..." + text.substr(text.size() - longest / 2 + 1);
  }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::string metres(double length_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g m", length_m);
  return text.data();
}

int text_width(const std::string& text, const TextStyle& style) {
  int baseline = 0;
  const int fine = cv::getTextSize(text, kFont, kFine * font_scale(style), stroke(style), &baseline).width;
  return (fine + kFine - 1) / kFine;
}

void write(cv::Mat& image, const std::string& text, cv::Point at, double share, const TextStyle& style) {
  if (text.empty()) {
    return;
  }
  const int margin_px = static_cast<int>(std::ceil(style.height_px / 2));
  const int width_px = text_width(text, style);
  const cv::Size size(width_px + 2 * margin_px, static_cast<int>(std::ceil(2.5 * style.height_px)));
  const int before = margin_px + static_cast<int>(std::lround(share * width_px));
  const auto put = [&](int wider, Colour colour) {
    cv::Mat coverage = strokes(text, style, size, margin_px, wider);
    cv::Point corner = at - cv::Point(before, size.height / 2);
    if (style.upwards) {
      cv::rotate(coverage, coverage, cv::ROTATE_90_COUNTERCLOCKWISE);
      corner = at - cv::Point(size.height / 2, size.width - before);
    }
    blend(image, coverage, corner, colour);
  };
  if (style.outlined) {
    put(kFine * 4, kPaperColour);
  }
  put(0, style.colour);
}

int Legend::px(int at_scale_one) const { return static_cast<int>(std::lround(at_scale_one * scale_)); }

int Legend::sign_px(const LegendEntry& entry) const {
  return entry.sign == LegendEntry::Sign::kRuler ? static_cast<int>(std::lround(entry.ruler_px)) : px(kSignWidth);
}

std::vector<cv::Point> Legend::places(int width_px) const {
  std::vector<cv::Point> corners;
  cv::Point at;
  for (const LegendEntry& entry : entries_) {
    const int item_px = sign_px(entry) + px(kPad) + text_width(entry.text, {.height_px = kLegendText * scale_});
    if (at.x > 0 && at.x + item_px > width_px) {
      at = {0, at.y + px(kLine)};
    }
    corners.push_back(at);
    at.x += item_px + px(kGap);
  }
  return corners;
}

int Legend::height(int width_px) const { return entries_.empty() ? 0 : places(width_px).back().y + px(kLine); }

void Legend::draw_sign(cv::Mat& image, const LegendEntry& entry, cv::Point left) const {
  const int middle = left.y + px(kLine) / 2;
  const int width = sign_px(entry);
  switch (entry.sign) {
    case LegendEntry::Sign::kPatch: {
      const cv::Rect frame({left.x, left.y + (px(kLine) - px(kSignHeight)) / 2}, cv::Size(width, px(kSignHeight)));
      fill(image, frame, entry.second);
      fill(image, {frame.tl(), cv::Size(entry.colour == entry.second ? width : width / 2, frame.height)}, entry.colour);
      cv::rectangle(image, frame, scalar(kFrameColour));
      return;
    }
    case LegendEntry::Sign::kLine:
      fill(image, {left.x, middle - px(1), width, std::max(2, px(3))}, entry.colour);
      return;
    case LegendEntry::Sign::kPoint:
      cv::circle(image, {left.x + width / 2, middle}, px(5), scalar(entry.colour), cv::FILLED, cv::LINE_AA);
      return;
    case LegendEntry::Sign::kRuler: {
      const int thick = px(4);
      fill(image, {left.x, middle - thick / 2, width, thick}, kInkColour);
      for (const int x : {left.x, left.x + width - px(2)}) {
        fill(image, {x, middle - px(6), px(2), px(12)}, kInkColour);
      }
    }
  }
}

void Legend::draw(cv::Mat& image, cv::Point corner, int width_px) const {
  const std::vector<cv::Point> corners = places(width_px);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const cv::Point left = corner + corners[i];
    draw_sign(image, entries_[i], left);
    write(image, entries_[i].text, left + cv::Point(sign_px(entries_[i]) + px(kPad), px(kLine) / 2), 0,
          {.height_px = kLegendText * scale_});
  }
}

}  // namespace gridmerge::drawing
