#include "page/scene_picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "report/axis.hpp"
#include "report/drawing.hpp"

namespace gridmerge::page {
namespace {

using drawing::Legend;
using drawing::LegendEntry;
using worlds::Track;
using worlds::Tracks;
using worlds::World;

constexpr int kMargin_px = 16;
constexpr Colour kTrunkColour{0x78, 0x7C, 0x80};

/// A robot's way in the colour that its map has in the overlay.
struct Way {
  const Track* track = nullptr;
  Colour colour;
};

/// One world and who is in it.
struct Panel {
  const World* world = nullptr;
  std::vector<Way> ways;
  Point2 low;
  Point2 high;

  [[nodiscard]] double width_m() const { return high.x_m - low.x_m; }
  [[nodiscard]] double height_m() const { return high.y_m - low.y_m; }
};

bool same_world(const World& a, const World& b) {
  const auto same_wall = [](const worlds::Segment& p, const worlds::Segment& q) {
    return p.from == q.from && p.to == q.to;
  };
  const auto same_disc = [](const worlds::Disc& p, const worlds::Disc& q) {
    return p.centre == q.centre && p.radius_m == q.radius_m;
  };
  return a.length_m == b.length_m && a.depth_m == b.depth_m &&
         std::equal(a.walls.begin(), a.walls.end(), b.walls.begin(), b.walls.end(), same_wall) &&
         std::equal(a.discs.begin(), a.discs.end(), b.discs.begin(), b.discs.end(), same_disc);
}

/// The box round all that is drawn.
void bound(Panel& panel) {
  panel.low = {0, 0};
  panel.high = {std::max(1.0, panel.world->length_m), std::max(1.0, panel.world->depth_m)};
  const auto take = [&](Point2 at) {
    panel.low = {std::min(panel.low.x_m, at.x_m), std::min(panel.low.y_m, at.y_m)};
    panel.high = {std::max(panel.high.x_m, at.x_m), std::max(panel.high.y_m, at.y_m)};
  };
  for (const worlds::Segment& wall : panel.world->walls) {
    take(wall.from);
    take(wall.to);
  }
  for (const Way& way : panel.ways) {
    for (const Pose2& pose : way.track->world_from_robot) {
      take(pose.translation());
    }
  }
}

std::vector<Panel> panels_of(const Tracks& tracks) {
  const Way target{&tracks.target, wall_colour(0)};
  const Way source{&tracks.source, wall_colour(1)};
  std::vector<Panel> panels = {{.world = &tracks.target.world, .ways = {target}, .low = {}, .high = {}}};
  if (same_world(tracks.target.world, tracks.source.world)) {
    panels.front().ways.push_back(source);
  } else {
    panels.push_back({.world = &tracks.source.world, .ways = {source}, .low = {}, .high = {}});
  }
  for (Panel& panel : panels) {
    bound(panel);
  }
  return panels;
}

/// Draws in metres; y points up.
class Pen {
 public:
  Pen(cv::Mat& image, cv::Point upper_left, double px_a_metre, const Panel& panel)
      : image_(image), upper_left_(upper_left), px_a_metre_(px_a_metre), low_(panel.low), high_(panel.high) {}

  void line(Point2 from, Point2 to, Colour colour, int thickness_px) {
    cv::line(image_, fine(from), fine(to), drawing::scalar(colour), thickness_px, cv::LINE_AA, kShift);
  }
  void disc(Point2 centre, double radius_px, Colour colour, int thickness_px = cv::FILLED) {
    cv::circle(image_, fine(centre), static_cast<int>(std::lround(radius_px * (1 << kShift))), drawing::scalar(colour),
               thickness_px, cv::LINE_AA, kShift);
  }
  [[nodiscard]] double px_a_metre() const { return px_a_metre_; }

 private:
  static constexpr int kShift = 4;  // bits behind the point of a pixel

  [[nodiscard]] cv::Point fine(Point2 at) const {
    const auto whole = [](double px) { return static_cast<int>(std::lround(px * (1 << kShift))); };
    return {whole(upper_left_.x + (at.x_m - low_.x_m) * px_a_metre_),
            whole(upper_left_.y + (high_.y_m - at.y_m) * px_a_metre_)};
  }

  cv::Mat& image_;
  cv::Point upper_left_;
  double px_a_metre_;
  Point2 low_;
  Point2 high_;
};

/// A ring with a hand where the robot began, a dot where it came to rest.
void draw_way(Pen& pen, const Way& way) {
  const std::vector<Pose2>& poses = way.track->world_from_robot;
  if (poses.empty()) {
    return;
  }
  for (std::size_t i = 1; i < poses.size(); ++i) {
    pen.line(poses[i - 1].translation(), poses[i].translation(), way.colour, 2);
  }
  constexpr double kRing_px = 7;
  const Point2 hand = poses.front() * Point2{2 * kRing_px / pen.px_a_metre(), 0};
  pen.line(poses.front().translation(), hand, way.colour, 3);
  pen.disc(poses.front().translation(), kRing_px, kPaperColour);
  pen.disc(poses.front().translation(), kRing_px, way.colour, 3);
  pen.disc(poses.back().translation(), 5, way.colour);
}

void draw_panel(cv::Mat& image, cv::Point upper_left, double px_a_metre, const Panel& panel) {
  Pen pen(image, upper_left, px_a_metre, panel);
  for (const worlds::Disc& disc : panel.world->discs) {
    pen.disc(disc.centre, std::max(1.0, disc.radius_m * px_a_metre), kTrunkColour);
  }
  for (const worlds::Segment& wall : panel.world->walls) {
    pen.line(wall.from, wall.to, kInkColour, 2);
  }
  for (const Way& way : panel.ways) {
    draw_way(pen, way);
  }
}

std::vector<LegendEntry> legend(const std::vector<Panel>& panels, double ruler_m, double px_a_metre) {
  const auto any = [&](auto holds) { return std::any_of(panels.begin(), panels.end(), holds); };
  std::vector<LegendEntry> entries = {
      {.text = drawing::metres(ruler_m), .sign = LegendEntry::Sign::kRuler, .ruler_px = ruler_m * px_a_metre}};
  if (any([](const Panel& panel) { return !panel.world->walls.empty(); })) {
    entries.push_back({.text = "walls", .sign = LegendEntry::Sign::kLine, .colour = kInkColour});
  }
  if (any([](const Panel& panel) { return !panel.world->discs.empty(); })) {
    entries.push_back({.text = "round obstacles", .sign = LegendEntry::Sign::kPoint, .colour = kTrunkColour});
  }
  const std::string where = panels.size() > 1 ? ", in a world of its own" : "";
  entries.push_back({.text = "target's way" + where, .sign = LegendEntry::Sign::kLine, .colour = wall_colour(0)});
  entries.push_back({.text = "source's way" + where, .sign = LegendEntry::Sign::kLine, .colour = wall_colour(1)});
  entries.push_back({.text = "(ring: start, dot: end)", .sign = LegendEntry::Sign::kLine, .colour = kPaperColour});
  return entries;
}

/// Where the panels go: in a row, or in a column where that makes them larger.
struct Layout {
  bool in_a_row = true;
  double px_a_metre = 1;
  int width_px = 0;
  int height_px = 0;
};

Layout layout_of(const std::vector<Panel>& panels, bool in_a_row, int room_x_px, int room_y_px) {
  double sum = 0;
  double largest = 0;
  for (const Panel& panel : panels) {
    sum += in_a_row ? panel.width_m() : panel.height_m();
    largest = std::max(largest, in_a_row ? panel.height_m() : panel.width_m());
  }
  const int gaps_px = static_cast<int>(panels.size() - 1) * 2 * kMargin_px;
  const double along_px = (in_a_row ? room_x_px : room_y_px) - gaps_px;
  const double across_px = in_a_row ? room_y_px : room_x_px;
  const double scale = std::min(along_px / sum, across_px / largest);
  const int along = static_cast<int>(std::ceil(sum * scale)) + gaps_px;
  const int across = static_cast<int>(std::ceil(largest * scale));
  return {in_a_row, scale, in_a_row ? along : across, in_a_row ? across : along};
}

}  // namespace

RasterImage draw_scene(const Tracks& tracks, int max_side_px) {
  constexpr int kTallestLegend_px = 100;
  if (max_side_px < 400) {
    throw std::invalid_argument("scene picture: max_side_px must be >= 400");
  }
  const std::vector<Panel> panels = panels_of(tracks);
  const int room_x_px = max_side_px - 2 * kMargin_px;
  const int room_y_px = room_x_px - kMargin_px - kTallestLegend_px;
  const Layout row = layout_of(panels, true, room_x_px, room_y_px);
  const Layout column = layout_of(panels, false, room_x_px, room_y_px);
  const Layout layout = column.px_a_metre > row.px_a_metre ? column : row;

  const double ruler_m = round_length(0.2 * room_x_px / layout.px_a_metre);
  const Legend strip(legend(panels, ruler_m, layout.px_a_metre), 1);
  RasterImage image =
      drawing::blank_image(room_x_px + 2 * kMargin_px, layout.height_px + strip.height(room_x_px) + 3 * kMargin_px);
  cv::Mat picture = drawing::matrix_of(image);
  cv::Point corner(kMargin_px + (room_x_px - layout.width_px) / 2, kMargin_px);
  for (const Panel& panel : panels) {
    draw_panel(picture, corner, layout.px_a_metre, panel);
    const int step =
        static_cast<int>(std::ceil((layout.in_a_row ? panel.width_m() : panel.height_m()) * layout.px_a_metre)) +
        2 * kMargin_px;
    (layout.in_a_row ? corner.x : corner.y) += step;
  }
  strip.draw(picture, {kMargin_px, layout.height_px + 2 * kMargin_px}, room_x_px);
  return image;
}

}  // namespace gridmerge::page
