#include "methods/radon_voronoi/edge_votes.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::voronoi {
namespace {

template <typename Place>
Place turned(Place place, const Pose2& turn) {
  const Point2 at = turn * Point2{static_cast<double>(place.at.x_m), static_cast<double>(place.at.y_m)};
  place.at = {static_cast<float>(at.x_m), static_cast<float>(at.y_m)};
  return place;
}

/// The Gaussian of `x`, by its variance.
float bell(float x, float sigma) { return std::exp(-0.5F * x * x / (sigma * sigma)); }

class Ballot {
 public:
  explicit Ballot(VoteSurface& surface)
      : votes_(surface.votes.data()),
        width_(static_cast<std::uint32_t>(surface.width)),
        height_(static_cast<std::uint32_t>(surface.height)),
        low_x_(static_cast<float>(surface.lower_left.x_m)),
        low_y_(static_cast<float>(surface.lower_left.y_m)),
        per_bin_(static_cast<float>(1 / surface.bin_m)) {}

  /// Into the nearest bin: the blur that follows is wider than a bin.
  void cast(float x_m, float y_m, float weight) {
    const auto column = static_cast<std::uint32_t>(static_cast<std::int32_t>((x_m - low_x_) * per_bin_));
    const auto row = static_cast<std::uint32_t>(static_cast<std::int32_t>((y_m - low_y_) * per_bin_));
    if (column < width_ && row < height_) {
      votes_[row * width_ + column] += weight;
    }
  }

 private:
  float* votes_;
  std::uint32_t width_;
  std::uint32_t height_;
  float low_x_;
  float low_y_;
  float per_bin_;
};

struct Extent {
  double low_x = 0, low_y = 0, high_x = 0, high_y = 0;
};

Extent extent_of(const Diagram& diagram, const Pose2& turn) {
  Extent e{1e9, 1e9, -1e9, -1e9};
  for (const RidgePoint& one : diagram.ridge) {
    const Point2 at = turn * Point2{static_cast<double>(one.at.x_m), static_cast<double>(one.at.y_m)};
    e = {std::min(e.low_x, at.x_m), std::min(e.low_y, at.y_m), std::max(e.high_x, at.x_m), std::max(e.high_y, at.y_m)};
  }
  return e;
}

/// Directions of a line in this many steps over pi.
constexpr unsigned kDirections = 64;

unsigned direction_step(float along_rad) {
  return static_cast<unsigned>(std::lround(along_rad / static_cast<float>(kPi) * static_cast<float>(kDirections))) &
         (kDirections - 1);
}

/// What two directions that lie so many steps apart are worth; 0 beyond twice the tolerance.
std::vector<float> direction_table(float sigma_rad) {
  std::vector<float> table;
  for (unsigned k = 0; k < kDirections; ++k) {
    const float off =
        static_cast<float>(kPi) * static_cast<float>(std::min(k, kDirections - k)) / static_cast<float>(kDirections);
    table.push_back(off < 2 * sigma_rad ? bell(off, sigma_rad) : 0.0F);
  }
  return table;
}

/// A ridge's cells as the votes need them.
struct Voter {
  float x_m, y_m;
  float clearance_m;
  float weight;
  unsigned direction;
};

/// By rising clearance.
std::vector<Voter> voters(const std::vector<RidgePoint>& ridge, const Pose2& turn, int max) {
  std::vector<Voter> result;
  const std::size_t step = 1 + ridge.size() / static_cast<std::size_t>(max);
  for (std::size_t i = 0; i < ridge.size(); i += step) {
    const RidgePoint one = turned(ridge[i], turn);
    result.push_back({one.at.x_m, one.at.y_m, one.clearance_m, one.weight,
                      direction_step(one.along_rad + static_cast<float>(turn.theta_rad))});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Voter& a, const Voter& b) { return a.clearance_m < b.clearance_m; });
  return result;
}

void vote_by_edges(const Diagram& target, const Diagram& source, const Pose2& turn, const VoteOptions& o,
                   VoteSurface& surface) {
  const std::vector<Voter> of_target = voters(target.ridge, {}, o.max_ridge);
  const std::vector<Voter> of_source = voters(source.ridge, turn, o.max_ridge);
  const auto clearance = static_cast<float>(o.clearance_m);
  const std::vector<float> alike = direction_table(static_cast<float>(radians(o.direction_deg)));
  Ballot ballot(surface);
  std::size_t low = 0;
  for (const Voter& s : of_source) {
    while (low < of_target.size() && of_target[low].clearance_m < s.clearance_m - 2 * clearance) {
      ++low;
    }
    for (std::size_t i = low; i < of_target.size() && of_target[i].clearance_m <= s.clearance_m + 2 * clearance; ++i) {
      const Voter& t = of_target[i];
      const float direction = alike[(t.direction - s.direction) & (kDirections - 1)];
      if (direction > 0) {
        const float wider = (t.clearance_m - s.clearance_m) / (2 * clearance);
        const float hill = 1 - wider * wider;  // (1 - x^2)^2 is near the Gaussian, and cheap
        ballot.cast(t.x_m - s.x_m, t.y_m - s.y_m, s.weight * t.weight * direction * hill * hill);
      }
    }
  }
}

/// How many of the branches of one vertex leave the other in the same direction, as a share of all.
float branch_likeness(const Vertex& target, const Vertex& source, float turn_rad, float narrow) {
  float common = 0;
  for (const float s : source.branch_rad) {
    float best = 0;
    for (const float t : target.branch_rad) {
      const float off = static_cast<float>(std::remainder(t - s - turn_rad, static_cast<float>(2 * kPi)));
      best = std::max(best, bell(off, narrow));
    }
    common += best;
  }
  const std::size_t most = std::max({std::size_t{1}, source.branch_rad.size(), target.branch_rad.size()});
  return common / static_cast<float>(most);
}

/// The vertices with most room round them, at most `max`: they are the rarest, and the same in both maps. By rising
/// clearance.
std::vector<Vertex> roomiest(const std::vector<Vertex>& vertices, const Pose2& turn, int max) {
  std::vector<Vertex> some = vertices;
  std::stable_sort(some.begin(), some.end(),
                   [](const Vertex& a, const Vertex& b) { return a.clearance_m < b.clearance_m; });
  const std::size_t surplus = some.size() - std::min(some.size(), static_cast<std::size_t>(max));
  some.erase(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(surplus));
  for (Vertex& one : some) {
    one = turned(std::move(one), turn);
  }
  return some;
}

void vote_by_vertices(const Diagram& target, const Diagram& source, const Pose2& turn, const VoteOptions& o,
                      VoteSurface& surface) {
  const std::vector<Vertex> of_target = roomiest(target.vertices, {}, o.max_vertices);
  const std::vector<Vertex> of_source = roomiest(source.vertices, turn, o.max_vertices);
  const auto clearance = static_cast<float>(1.5 * o.clearance_m);
  const auto narrow = static_cast<float>(radians(o.direction_deg));
  const auto turn_rad = static_cast<float>(turn.theta_rad);
  Ballot ballot(surface);
  std::size_t low = 0;
  for (const Vertex& s : of_source) {
    while (low < of_target.size() && of_target[low].clearance_m < s.clearance_m - 2 * clearance) {
      ++low;
    }
    for (std::size_t i = low; i < of_target.size() && of_target[i].clearance_m <= s.clearance_m + 2 * clearance; ++i) {
      const Vertex& t = of_target[i];
      const float weight = static_cast<float>(o.vertex_weight) * s.weight * t.weight;
      ballot.cast(t.at.x_m - s.at.x_m, t.at.y_m - s.at.y_m,
                  weight * bell(t.clearance_m - s.clearance_m, clearance) * branch_likeness(t, s, turn_rad, narrow));
    }
  }
}

/// Separable Gaussian along rows; `stride` from one value to the next.
void blur_line(float* line, int count, std::ptrdiff_t stride, const std::vector<float>& kernel,
               std::vector<float>& scratch) {
  const int reach = static_cast<int>(kernel.size()) - 1;
  for (int i = 0; i < count; ++i) {
    scratch[static_cast<std::size_t>(i)] = line[i * stride];
  }
  for (int i = 0; i < count; ++i) {
    float sum = kernel[0] * scratch[static_cast<std::size_t>(i)];
    for (int k = 1; k <= reach; ++k) {
      sum += kernel[static_cast<std::size_t>(k)] * ((i - k >= 0 ? scratch[static_cast<std::size_t>(i - k)] : 0.0F) +
                                                    (i + k < count ? scratch[static_cast<std::size_t>(i + k)] : 0.0F));
    }
    line[i * stride] = sum;
  }
}

/// Where the parabola through three equally spaced values has its top, from the middle one; within half a step.
double top_of(float left, float middle, float right) {
  const float bend = left - 2 * middle + right;
  return bend < 0 ? std::clamp(0.5 * static_cast<double>((left - right) / bend), -0.5, 0.5) : 0;
}

}  // namespace

void VoteOptions::describe(OptionList& list) {
  list.add("bin_m", bin_m, 0.01, 10, {"m", "Side of a bin of the votes over translation.", ""})
      .add("blur_m", blur_m, 0, 10,
           {"m", "Standard deviation of what a vote says about the translation.", "Raise it for bent maps."})
      .add("clearance_m", clearance_m, 0.001, 10,
           {"m", "How much the clearances of one place may differ, as a standard deviation.", ""})
      .add("direction_deg", direction_deg, 0.1, 90,
           {"deg", "How much the directions of one edge may differ, as a standard deviation.", ""})
      .add("vertex_weight", vertex_weight, 0, 10000,
           {"", "How much a pair of vertices says, where a pair of cells of two edges says 1.", ""})
      .add("max_ridge", max_ridge, 10, 1000000,
           {"", "Of each diagram at most so many cells vote.", "Time grows with its square."})
      .add("max_vertices", max_vertices, 1, 1000000,
           {"", "Of each diagram at most so many vertices vote, those with most room round them.",
            "Time grows with its square."});
}

VoteSurface empty_surface(const Diagram& target, const Diagram& source, double angle_rad,
                          const std::optional<PoseWindow>& window, double bin_m) {
  const Extent t = extent_of(target, {});
  const Extent s = extent_of(source, {0, 0, angle_rad});
  Extent e{t.low_x - s.high_x, t.low_y - s.high_y, t.high_x - s.low_x, t.high_y - s.low_y};
  if (window) {
    const double reach = window->radius_m;
    e = {std::max(e.low_x, window->centre.x_m - reach), std::max(e.low_y, window->centre.y_m - reach),
         std::min(e.high_x, window->centre.x_m + reach), std::min(e.high_y, window->centre.y_m + reach)};
  }
  if (!(e.high_x >= e.low_x && e.high_y >= e.low_y)) {
    return {};
  }
  constexpr int kRim = 4;  // bins, so that the blur and the search for peaks meet no edge
  VoteSurface surface{.width = static_cast<int>((e.high_x - e.low_x) / bin_m) + 1 + 2 * kRim,
                      .height = static_cast<int>((e.high_y - e.low_y) / bin_m) + 1 + 2 * kRim,
                      .bin_m = bin_m,
                      .lower_left = {e.low_x - kRim * bin_m, e.low_y - kRim * bin_m},
                      .votes = {}};
  surface.votes.assign(static_cast<std::size_t>(surface.width) * static_cast<std::size_t>(surface.height), 0.0F);
  return surface;
}

void cast(VoteSurface& surface, Point2 translation, double weight) {
  Ballot(surface).cast(static_cast<float>(translation.x_m), static_cast<float>(translation.y_m),
                       static_cast<float>(weight));
}

void blur(VoteSurface& surface, double sigma_m) {
  if (sigma_m <= 0 || surface.votes.empty()) {
    return;
  }
  const double sigma_bins = sigma_m / surface.bin_m;
  std::vector<float> kernel;
  float sum = 0;
  for (int k = 0; k <= static_cast<int>(std::ceil(2.5 * sigma_bins)); ++k) {
    kernel.push_back(bell(static_cast<float>(k), static_cast<float>(sigma_bins)));
    sum += (k == 0 ? 1.0F : 2.0F) * kernel.back();
  }
  for (float& k : kernel) {
    k /= sum;
  }
  std::vector<float> scratch(static_cast<std::size_t>(std::max(surface.width, surface.height)));
  for (int row = 0; row < surface.height; ++row) {
    blur_line(&surface.votes[static_cast<std::size_t>(row) * static_cast<std::size_t>(surface.width)], surface.width, 1,
              kernel, scratch);
  }
  for (int column = 0; column < surface.width; ++column) {
    blur_line(&surface.votes[static_cast<std::size_t>(column)], surface.height, surface.width, kernel, scratch);
  }
}

VoteSurface vote(const Diagram& target, const Diagram& source, const radon::Rotation& rotation,
                 const std::optional<PoseWindow>& window, const VoteOptions& options) {
  const Pose2 turn{0, 0, rotation.angle_rad};
  VoteSurface surface = empty_surface(target, source, rotation.angle_rad, window, options.bin_m);
  if (!surface.votes.empty()) {
    vote_by_edges(target, source, turn, options, surface);
    vote_by_vertices(target, source, turn, options, surface);
    blur(surface, options.blur_m);
  }
  return surface;
}

std::vector<ScoredPose> peaks(const VoteSurface& surface, double angle_rad, std::size_t at_most) {
  std::vector<ScoredPose> found;
  const auto w = static_cast<std::ptrdiff_t>(surface.width);
  for (int row = 1; row + 1 < surface.height; ++row) {
    for (int column = 1; column + 1 < surface.width; ++column) {
      const float* at = &surface.votes[static_cast<std::size_t>(row) * static_cast<std::size_t>(surface.width) +
                                       static_cast<std::size_t>(column)];
      const float v = *at;
      if (v > 0 && v > at[-1] && v >= at[1] && v > at[-w] && v >= at[w] && v > at[-w - 1] && v > at[-w + 1] &&
          v >= at[w - 1] && v >= at[w + 1]) {
        const double x = column + 0.5 + top_of(at[-1], v, at[1]);
        const double y = row + 0.5 + top_of(at[-w], v, at[w]);
        found.push_back({{surface.lower_left.x_m + x * surface.bin_m, surface.lower_left.y_m + y * surface.bin_m,
                          wrap_angle(angle_rad)},
                         static_cast<double>(v)});
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  found.resize(std::min(found.size(), at_most));
  return found;
}

std::vector<Point2> matched_vertices(const Diagram& target, const Diagram& source,
                                     const Pose2& local_target_from_source, double within_m) {
  std::vector<Point2> pairs;
  for (const Vertex& unmoved : source.vertices) {
    const Vertex s = turned(unmoved, local_target_from_source);
    const Vertex* nearest = nullptr;
    double distance = within_m;
    for (const Vertex& t : target.vertices) {
      const double d = std::hypot(static_cast<double>(t.at.x_m - s.at.x_m), static_cast<double>(t.at.y_m - s.at.y_m));
      if (d < distance) {
        distance = d;
        nearest = &t;
      }
    }
    if (nearest != nullptr) {
      pairs.push_back({static_cast<double>(nearest->at.x_m), static_cast<double>(nearest->at.y_m)});
      pairs.push_back({static_cast<double>(s.at.x_m), static_cast<double>(s.at.y_m)});
    }
  }
  return pairs;
}

View vote_view(const VoteSurface& surface, const std::vector<ScoredPose>& peaks) {
  SurfaceView view{.width = surface.width,
                   .height = surface.height,
                   .values = surface.votes,
                   .x_low = surface.lower_left.x_m,
                   .x_high = surface.lower_left.x_m + surface.width * surface.bin_m,
                   .y_low = surface.lower_left.y_m,
                   .y_high = surface.lower_left.y_m + surface.height * surface.bin_m,
                   .x_label = "x of the source's centre [m]",
                   .y_label = "y of the source's centre [m]",
                   .value_label = "votes",
                   .marks = {}};
  for (const ScoredPose& one : peaks) {
    view.marks.push_back(one.pose.translation());
  }
  return {"edge_votes", "What the edges and vertices of the Voronoi diagrams say of the translation", std::move(view)};
}

View match_view(const Diagram& target, const Diagram& source, const Pose2& local_target_from_source) {
  const auto place = [](Point2f at) { return Point2{static_cast<double>(at.x_m), static_cast<double>(at.y_m)}; };
  Shape of_target{.kind = Shape::Kind::kPoints, .label = "target's diagram", .points = {}};
  for (const RidgePoint& one : target.ridge) {
    of_target.points.push_back(place(one.at));
  }
  Shape of_source{.kind = Shape::Kind::kPoints, .label = "source's diagram", .points = {}};
  for (const RidgePoint& one : source.ridge) {
    of_source.points.push_back(local_target_from_source * place(one.at));
  }
  Shape matches{.kind = Shape::Kind::kSegments,
                .label = "matched vertices",
                .points = matched_vertices(target, source, local_target_from_source, 0.5)};
  return {"matched_vertices", "Both Voronoi diagrams at the best pose, with the vertices that meet",
          MapView{.map = MapView::Map::kBoth,
                  .local_target_from_source = local_target_from_source,
                  .shapes = {std::move(matches), std::move(of_target), std::move(of_source)}}};
}

}  // namespace gridmerge::voronoi
