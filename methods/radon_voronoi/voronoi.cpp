#include "methods/radon_voronoi/voronoi.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace gridmerge::voronoi {
namespace {

/// The neighbours of a cell in eighths of a turn from +x, as (column, row).
constexpr std::array<std::array<int, 2>, 8> kRound = {
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

using Mask = std::vector<std::uint8_t>;

std::array<std::ptrdiff_t, 8> steps_round(int width) {
  std::array<std::ptrdiff_t, 8> steps{};
  for (std::size_t k = 0; k < 8; ++k) {
    steps[k] = kRound[k][0] + static_cast<std::ptrdiff_t>(kRound[k][1]) * width;
  }
  return steps;
}

std::uint8_t neighbours_of(const Mask& mask, std::size_t at, const std::array<std::ptrdiff_t, 8>& steps) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    bits |= static_cast<unsigned>(mask[at + static_cast<std::size_t>(steps[k])] != 0) << k;
  }
  return static_cast<std::uint8_t>(bits);
}

/// How often, going round, background turns into foreground: the branches that leave a cell of a thin line.
int branches(std::uint8_t neighbours) {
  const unsigned bits = neighbours;
  const unsigned turned = ((bits << 1) | (bits >> 7)) & 0xFFU;
  return std::popcount(bits & ~turned & 0xFFU);
}

/// Yokoi's number of connectivity for an 8-connected foreground: over the four direct neighbours, how many background
/// gaps lie apart. 1: simple.
constexpr bool simple_by_yokoi(unsigned bits) {
  const auto background = [bits](unsigned k) { return ((bits >> (k & 7U)) & 1U) == 0; };
  int number = 0;
  for (unsigned k = 0; k < 8; k += 2) {
    number += background(k) && !(background(k + 1) && background(k + 2)) ? 1 : 0;
  }
  return number == 1;
}

constexpr std::array<bool, 256> kSimple = [] {
  std::array<bool, 256> simple{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    simple[bits] = simple_by_yokoi(bits);
  }
  return simple;
}();

/// The lower envelope of parabolas along one row (Felzenszwalb, Huttenlocher 2012).
class Envelope {
 public:
  explicit Envelope(int width) : at_(static_cast<std::size_t>(width)), from_(static_cast<std::size_t>(width) + 1) {}

  void clear() { count_ = 0; }
  /// Columns in rising order; `square` is the height of its parabola.
  void add(int column, float square, const std::vector<float>& squares) {
    float from = -std::numeric_limits<float>::infinity();
    while (count_ > 0) {
      const int last = at_[count_ - 1];
      from = (square + static_cast<float>(column) * static_cast<float>(column) -
              squares[static_cast<std::size_t>(last)] - static_cast<float>(last) * static_cast<float>(last)) /
             static_cast<float>(2 * (column - last));
      if (from > from_[count_ - 1]) {
        break;
      }
      --count_;
      from = -std::numeric_limits<float>::infinity();
    }
    at_[count_] = column;
    from_[count_] = from;
    ++count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] int column(std::size_t k) const { return at_[k]; }
  /// Up to where the k-th parabola is the lowest.
  [[nodiscard]] float until(std::size_t k) const {
    return k + 1 < count_ ? from_[k + 1] : std::numeric_limits<float>::infinity();
  }

 private:
  std::vector<int> at_;
  std::vector<float> from_;
  std::size_t count_ = 0;
};

/// Rows of the nearest marked cell above or below in every column; -1: none.
std::vector<std::int32_t> nearest_rows(const Mask& marked, int width) {
  const auto w = static_cast<std::size_t>(width);
  std::vector<std::int32_t> nearest(marked.size(), -1);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    nearest[i] = marked[i] != 0 ? static_cast<std::int32_t>(i / w) : (i >= w ? nearest[i - w] : -1);
  }
  for (std::size_t i = marked.size() - std::min(marked.size(), w); i-- > 0;) {
    const std::int32_t row = static_cast<std::int32_t>(i / w);
    const std::int32_t below = nearest[i];
    const std::int32_t above = nearest[i + w];
    if (above > row && (below < 0 || above - row < row - below)) {
      nearest[i] = above;
    }
  }
  return nearest;
}

/// Components (8-connected) of the mask whose bounding box is shorter than `cells` on its longer side are taken out.
void drop_small(Mask& mask, int width, int cells) {
  const std::array<std::ptrdiff_t, 8> steps = steps_round(width);
  Mask seen = mask;  // 1: still to be visited
  std::vector<std::size_t> component;
  for (std::size_t start = 0; start < mask.size(); ++start) {
    if (seen[start] == 0) {
      continue;
    }
    component.assign(1, start);
    seen[start] = 0;
    int low_x = std::numeric_limits<int>::max();
    int high_x = -1;
    int low_y = low_x;
    int high_y = -1;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const std::size_t at = component[i];
      const int x = static_cast<int>(at % static_cast<std::size_t>(width));
      const int y = static_cast<int>(at / static_cast<std::size_t>(width));
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = std::max(high_y, y);
      for (const std::ptrdiff_t step : steps) {
        const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + step);
        if (next < seen.size() && seen[next] != 0) {
          seen[next] = 0;
          component.push_back(next);
        }
      }
    }
    if (std::max(high_x - low_x, high_y - low_y) + 1 < cells) {
      for (const std::size_t at : component) {
        mask[at] = 0;
      }
    }
  }
}

void clear_rim(Mask& mask, int width, int height) {
  for (int column = 0; column < width; ++column) {
    mask[static_cast<std::size_t>(column)] = 0;
    mask[mask.size() - 1 - static_cast<std::size_t>(column)] = 0;
  }
  for (int row = 0; row < height; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    mask[first] = 0;
    mask[first + static_cast<std::size_t>(width) - 1] = 0;
  }
}

/// Cells by height, a bucket for every quarter of a cell; a cell may come in again, and then counts where it is due.
class HeightQueue {
 public:
  explicit HeightQueue(float highest)
      : buckets_(static_cast<std::size_t>(highest * kPerCell) + 2), taken_(buckets_.size(), 0) {}
  void push(std::size_t cell, float height) {
    const auto bucket = static_cast<std::size_t>(height * kPerCell);
    buckets_[bucket].push_back(cell);
    lowest_ = std::min(lowest_, bucket);
  }
  /// @return false where it is empty
  bool pop(std::size_t& cell) {
    while (lowest_ < buckets_.size() && buckets_[lowest_].size() == taken_[lowest_]) {
      buckets_[lowest_].clear();
      taken_[lowest_] = 0;
      ++lowest_;
    }
    if (lowest_ == buckets_.size()) {
      return false;
    }
    cell = buckets_[lowest_][taken_[lowest_]++];
    return true;
  }

 private:
  static constexpr float kPerCell = 4;
  std::vector<std::vector<std::size_t>> buckets_;
  std::vector<std::size_t> taken_;
  std::size_t lowest_ = 0;
};

enum class Ends { kGo, kStay };

/// One pass of ordered thinning over the cells in `mask` that are also in `open_to`.
void thin(Mask& mask, const std::vector<float>& height, const Mask& open_to, Ends ends, int width) {
  const std::array<std::ptrdiff_t, 8> steps = steps_round(width);
  float highest = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    highest = mask[i] != 0 ? std::max(highest, height[i]) : highest;
  }
  HeightQueue queue(highest);
  Mask waiting(mask.size(), 0);
  const auto consider = [&](std::size_t at) {
    if (mask[at] != 0 && open_to[at] != 0 && waiting[at] == 0) {
      waiting[at] = 1;
      queue.push(at, height[at]);
    }
  };
  const auto removable = [&](std::size_t at) {
    const std::uint8_t round = neighbours_of(mask, at, steps);
    return is_simple(round) && (ends == Ends::kGo || std::popcount(static_cast<unsigned>(round)) > 1);
  };
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0 && neighbours_of(mask, i, steps) != 0xFF) {
      consider(i);
    }
  }
  for (std::size_t at = 0; queue.pop(at);) {
    waiting[at] = 0;
    if (removable(at)) {
      mask[at] = 0;
      for (const std::ptrdiff_t step : steps) {
        consider(static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + step));
      }
    }
  }
}

/// Everything about one map at one level that the diagram is made from.
struct Ground {
  int width = 0;
  int height = 0;
  Mask free;  ///< specks of anything else in it count as free
  NearestMarked wall;
  NearestMarked unseen;
};

Ground ground_of(const MapLevel& level, double speck_m) {
  Ground ground{.width = level.width, .height = level.height, .free = {}, .wall = {}, .unseen = {}};
  const std::size_t count = level.state.size();
  Mask wall(count);
  Mask other(count);
  for (std::size_t i = 0; i < count; ++i) {
    wall[i] = level.state[i] == CellState::kWall ? 1 : 0;
    other[i] = level.state[i] == CellState::kOpen ? 0 : 1;
  }
  const int speck = static_cast<int>(std::lround(speck_m / level.resolution_m));
  drop_small(wall, level.width, speck + 1);
  drop_small(other, level.width, 2 * speck + 1);
  ground.free.resize(count);
  Mask unseen(count);
  for (std::size_t i = 0; i < count; ++i) {
    ground.free[i] = other[i] == 0 && wall[i] == 0 ? 1 : 0;
    unseen[i] = ground.free[i] == 0 && wall[i] == 0 ? 1 : 0;
  }
  clear_rim(ground.free, level.width, level.height);
  ground.wall = nearest_marked(wall, level.width, level.height);
  ground.unseen = nearest_marked(unseen, level.width, level.height);
  return ground;
}

struct Cell {
  int column;
  int row;
};

Cell cell_of(std::size_t index, int width) {
  const auto w = static_cast<std::size_t>(width);
  return {static_cast<int>(index % w), static_cast<int>(index / w)};
}

/// Cells with two walls nearest, far enough apart as seen from there: the integer medial axis (Hesselink, Roerdink
/// 2008), without the branches that the roughness of a wall would make.
Mask medial_axis(const Ground& ground, const DiagramOptions& options, double cell_m) {
  Mask axis(ground.free.size(), 0);
  const double detail = options.detail_m / cell_m;
  const double per_clearance = 2 * std::sin(0.5 * radians(options.opening_deg));
  const std::array<std::ptrdiff_t, 2> steps = {1, ground.width};
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (ground.free[i] == 0 || ground.wall.index[i] < 0) {
      continue;
    }
    for (const std::ptrdiff_t step : steps) {
      const std::size_t k = i + static_cast<std::size_t>(step);
      if (ground.free[k] == 0 || ground.wall.index[k] == ground.wall.index[i]) {
        continue;
      }
      const Cell a = cell_of(static_cast<std::size_t>(ground.wall.index[i]), ground.width);
      const Cell b = cell_of(static_cast<std::size_t>(ground.wall.index[k]), ground.width);
      const double apart = std::hypot(a.column - b.column, a.row - b.row);
      const double clearance = static_cast<double>(ground.wall.distance_cells[i]);
      if (apart >= std::max(detail, per_clearance * clearance)) {
        axis[ground.wall.distance_cells[i] >= ground.wall.distance_cells[k] ? i : k] = 1;
      }
    }
  }
  return axis;
}

/// Groups of touching cells with three branches, each as its cell nearest to the middle.
std::vector<std::size_t> junctions(const Mask& skeleton, int width) {
  const std::array<std::ptrdiff_t, 8> steps = steps_round(width);
  Mask fork(skeleton.size(), 0);
  std::vector<std::size_t> forks;
  for (std::size_t i = 0; i < skeleton.size(); ++i) {
    if (skeleton[i] != 0 && branches(neighbours_of(skeleton, i, steps)) >= 3) {
      fork[i] = 1;
      forks.push_back(i);
    }
  }
  std::vector<std::size_t> found;
  std::vector<std::size_t> group;
  for (const std::size_t start : forks) {
    if (fork[start] == 0) {
      continue;
    }
    group.assign(1, start);
    fork[start] = 0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const std::ptrdiff_t step : steps) {
        const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(group[i]) + step);
        if (fork[next] != 0) {
          fork[next] = 0;
          group.push_back(next);
        }
      }
    }
    found.push_back(group[group.size() / 2]);
  }
  return found;
}

/// The skeleton with a disc taken out at every vertex, and its pieces numbered.
struct Cut {
  std::vector<std::int32_t> edge;  ///< for every cell; -1: none
  struct Piece {
    std::vector<std::size_t> cells;
    int ends_at_vertices = 0;
  };
  std::vector<Piece> pieces;
};

Cut cut_at(const std::vector<std::size_t>& vertices, const Mask& skeleton, const Ground& ground, int mask_cells) {
  const int width = ground.width;
  const std::array<std::ptrdiff_t, 8> steps = steps_round(width);
  Mask masked(skeleton.size(), 0);
  for (const std::size_t vertex : vertices) {
    const Cell centre = cell_of(vertex, width);
    for (int dy = -mask_cells; dy <= mask_cells; ++dy) {
      for (int dx = -mask_cells; dx <= mask_cells; ++dx) {
        const int column = centre.column + dx;
        const int row = centre.row + dy;
        if (dx * dx + dy * dy <= mask_cells * mask_cells && column >= 0 && row >= 0 && column < width &&
            row < ground.height) {
          masked[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)] =
              1;
        }
      }
    }
  }
  Cut cut{.edge = std::vector<std::int32_t>(skeleton.size(), -1), .pieces = {}};
  for (std::size_t start = 0; start < skeleton.size(); ++start) {
    if (skeleton[start] == 0 || masked[start] != 0 || cut.edge[start] >= 0) {
      continue;
    }
    const auto number = static_cast<std::int32_t>(cut.pieces.size());
    Cut::Piece piece{.cells = {start}, .ends_at_vertices = 0};
    cut.edge[start] = number;
    for (std::size_t i = 0; i < piece.cells.size(); ++i) {
      bool at_vertex = false;
      for (const std::ptrdiff_t step : steps) {
        const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(piece.cells[i]) + step);
        at_vertex = at_vertex || (skeleton[next] != 0 && masked[next] != 0);
        if (skeleton[next] != 0 && masked[next] == 0 && cut.edge[next] < 0) {
          cut.edge[next] = number;
          piece.cells.push_back(next);
        }
      }
      piece.ends_at_vertices += at_vertex ? 1 : 0;
    }
    cut.pieces.push_back(std::move(piece));
  }
  return cut;
}

/// Takes dead ends shorter than `shortest` cells away; what they hung on may then no longer be a vertex.
void prune(Mask& skeleton, const Ground& ground, int mask_cells, int shortest) {
  const std::vector<std::size_t> vertices = junctions(skeleton, ground.width);
  const Cut cut = cut_at(vertices, skeleton, ground, mask_cells);
  for (const Cut::Piece& piece : cut.pieces) {
    if (piece.ends_at_vertices == 1 && static_cast<int>(piece.cells.size()) + mask_cells < shortest) {
      for (const std::size_t cell : piece.cells) {
        skeleton[cell] = 0;
      }
    }
  }
  // The stumps within the masks: ends that are not anchored to anything shrink back to the junction.
  const std::array<std::ptrdiff_t, 8> steps = steps_round(ground.width);
  std::vector<std::size_t> ends;
  for (const Cut::Piece& piece : cut.pieces) {
    if (skeleton[piece.cells.front()] != 0) {
      continue;
    }
    for (const std::size_t cell : piece.cells) {
      for (const std::ptrdiff_t step : steps) {
        const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell) + step);
        if (skeleton[next] != 0) {
          ends.push_back(next);
        }
      }
    }
  }
  while (!ends.empty()) {
    const std::size_t end = ends.back();
    ends.pop_back();
    if (skeleton[end] != 0 && std::popcount(static_cast<unsigned>(neighbours_of(skeleton, end, steps))) == 1) {
      skeleton[end] = 0;
      for (const std::ptrdiff_t step : steps) {
        const auto next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(end) + step);
        if (skeleton[next] != 0) {
          ends.push_back(next);
        }
      }
    }
  }
}

/// Direction of the line through the skeleton's cells within `reach` of a cell, in [0, pi).
float direction_along(const Mask& skeleton, const Ground& ground, Cell centre, int reach) {
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int column = centre.column + dx;
      const int row = centre.row + dy;
      if (column >= 0 && row >= 0 && column < ground.width && row < ground.height &&
          skeleton[static_cast<std::size_t>(row) * static_cast<std::size_t>(ground.width) +
                   static_cast<std::size_t>(column)] != 0) {
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
      }
    }
  }
  const double along = 0.5 * std::atan2(2 * xy, xx - yy);
  return static_cast<float>(along < 0 ? along + kPi : along);
}

/// Directions of the skeleton's branches where they cross a ring round a vertex.
std::vector<float> branch_directions(const Mask& skeleton, const Ground& ground, Cell centre, int radius) {
  std::vector<float> directions;
  constexpr int kSteps = 72;
  std::array<std::uint8_t, kSteps> on{};
  for (int k = 0; k < kSteps; ++k) {
    const double angle = 2 * kPi * k / kSteps;
    const int column = centre.column + static_cast<int>(std::lround(radius * std::cos(angle)));
    const int row = centre.row + static_cast<int>(std::lround(radius * std::sin(angle)));
    on[static_cast<std::size_t>(k)] =
        column >= 0 && row >= 0 && column < ground.width && row < ground.height
            ? skeleton[static_cast<std::size_t>(row) * static_cast<std::size_t>(ground.width) +
                       static_cast<std::size_t>(column)]
            : std::uint8_t{0};
  }
  for (int k = 0; k < kSteps; ++k) {
    const bool begins =
        on[static_cast<std::size_t>(k)] != 0 && on[static_cast<std::size_t>((k + kSteps - 1) % kSteps)] == 0;
    if (begins) {
      int length = 1;
      while (length < kSteps && on[static_cast<std::size_t>((k + length) % kSteps)] != 0) {
        ++length;
      }
      directions.push_back(static_cast<float>(wrap_angle(2 * kPi * (k + 0.5 * (length - 1)) / kSteps)));
    }
  }
  return directions;
}

/// How sure it is that each cell of a level is free: of its cells of level 0, one minus the mean occupancy; a cell that
/// nothing is known of counts half.
float free_probability(const PreparedMap& map, const MapLevel& level, Cell cell) {
  const MapLevel& fine = map.level(0);
  const int across = static_cast<int>(std::lround(level.resolution_m / fine.resolution_m));
  float sum = 0;
  int count = 0;
  for (int dy = 0; dy < across; ++dy) {
    for (int dx = 0; dx < across; ++dx) {
      const int column = cell.column * across + dx;
      const int row = cell.row * across + dy;
      if (fine.contains(column, row)) {
        const int percent = map.occupancy()[fine.offset(column, row)];
        sum += percent < 0 ? 0.5F : 1 - static_cast<float>(percent) / 100;
        ++count;
      }
    }
  }
  return count > 0 ? sum / static_cast<float>(count) : 0;
}

/// The coarsest level with cells of at most `cell_m`; the finest where none is.
int level_for(const PreparedMap& map, double cell_m) {
  int level = 0;
  while (level + 1 < PreparedMap::kLevels && map.level(level + 1).resolution_m <= cell_m * 1.01) {
    ++level;
  }
  return level;
}

int mask_of(double mask_m, const MapLevel& level) {
  return std::max(1, static_cast<int>(std::lround(mask_m / level.resolution_m)));
}

/// The skeleton as points, with its vertices and edges.
/// @param shown  of the skeleton's cells only these are told; the others hold it together
template <typename Weight>
Diagram described(const Mask& skeleton, const Mask& shown, const Ground& ground, const MapLevel& level, int mask_cells,
                  const Weight& weight) {
  const std::vector<std::size_t> vertices = junctions(skeleton, ground.width);
  const Cut cut = cut_at(vertices, skeleton, ground, mask_cells);
  const auto place = [&](Cell cell) {
    return Point2f{static_cast<float>(level.lower_left.x_m + (cell.column + 0.5) * level.resolution_m),
                   static_cast<float>(level.lower_left.y_m + (cell.row + 0.5) * level.resolution_m)};
  };
  const auto clearance = [&](std::size_t i) {
    return std::min(kFarFromWalls, ground.wall.distance_cells[i] * static_cast<float>(level.resolution_m));
  };
  Diagram result{
      .ridge = {}, .vertices = {}, .edges = static_cast<int>(cut.pieces.size()), .cell_m = level.resolution_m};
  for (std::size_t i = 0; i < skeleton.size(); ++i) {
    if (skeleton[i] != 0 && shown[i] != 0) {
      const Cell cell = cell_of(i, ground.width);
      result.ridge.push_back({.at = place(cell),
                              .clearance_m = clearance(i),
                              .along_rad = direction_along(skeleton, ground, cell, 3),
                              .weight = weight(i),
                              .edge = cut.edge[i]});
    }
  }
  for (const std::size_t i : vertices) {
    const Cell cell = cell_of(i, ground.width);
    result.vertices.push_back({.at = place(cell),
                               .clearance_m = clearance(i),
                               .weight = weight(i),
                               .branch_rad = branch_directions(skeleton, ground, cell, mask_cells + 2)});
  }
  return result;
}

/// Whether a cell of the outermost layer goes in one of the two turns of an iteration (Guo, Hall 1989).
bool off_by_guo_hall(std::uint8_t neighbours, bool even) {
  const auto on = [&](unsigned k) { return ((neighbours >> (k & 7U)) & 1U) != 0; };
  int crossings = 0;
  int first = 0;
  int second = 0;
  for (unsigned k = 0; k < 8; k += 2) {
    crossings += !on(k) && (on(k + 1) || on(k + 2)) ? 1 : 0;
    first += on(k) || on(k + 1) ? 1 : 0;
    second += on(k + 1) || on(k + 2) ? 1 : 0;
  }
  const int fewer = std::min(first, second);
  const bool kept_this_turn = even ? (on(2) || on(1) || !on(7)) && on(0) : (on(6) || on(5) || !on(3)) && on(4);
  return crossings == 1 && (fewer == 2 || fewer == 3) && !kept_this_turn;
}

}  // namespace

bool is_simple(std::uint8_t neighbours) { return kSimple[neighbours]; }

NearestMarked nearest_marked(const std::vector<std::uint8_t>& marked, int width, int height) {
  NearestMarked result;
  result.distance_cells.assign(marked.size(), kFarFromWalls);
  result.index.assign(marked.size(), -1);
  if (marked.empty()) {
    return result;
  }
  const std::vector<std::int32_t> nearest = nearest_rows(marked, width);
  std::vector<float> squares(static_cast<std::size_t>(width));
  Envelope envelope(width);
  for (int row = 0; row < height; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    envelope.clear();
    for (int column = 0; column < width; ++column) {
      const std::int32_t other = nearest[first + static_cast<std::size_t>(column)];
      if (other >= 0) {
        const float square = static_cast<float>((row - other) * (row - other));
        squares[static_cast<std::size_t>(column)] = square;
        envelope.add(column, square, squares);
      }
    }
    if (envelope.count() == 0) {
      continue;
    }
    std::size_t k = 0;
    for (int column = 0; column < width; ++column) {
      while (envelope.until(k) < static_cast<float>(column)) {
        ++k;
      }
      const int from = envelope.column(k);
      const float dx = static_cast<float>(column - from);
      const std::size_t at = first + static_cast<std::size_t>(column);
      result.distance_cells[at] = std::sqrt(dx * dx + squares[static_cast<std::size_t>(from)]);
      result.index[at] = nearest[first + static_cast<std::size_t>(from)] * width + from;
    }
  }
  return result;
}

std::vector<std::uint8_t> thinned(std::vector<std::uint8_t> foreground, const std::vector<float>& height,
                                  const std::vector<std::uint8_t>& anchor, int width) {
  Mask loose(foreground.size());
  std::transform(anchor.begin(), anchor.end(), loose.begin(),
                 [](std::uint8_t a) { return static_cast<std::uint8_t>(a == 0 ? 1 : 0); });
  thin(foreground, height, loose, Ends::kGo, width);
  thin(foreground, height, anchor, Ends::kStay, width);
  return foreground;
}

void DiagramOptions::describe(OptionList& list) {
  list.add("cell_m", cell_m, 0.01, 10,
           {"m", "The diagram is drawn on the coarsest level of the maps with cells of at most this.",
            "Raise it for speed; doors narrower than three cells close."})
      .add("speck_m", speck_m, 0, 10,
           {"m", "Walls shorter than this, and unseen spots shorter than twice this, count as free space.",
            "Raise it for maps with speckle, lower it where posts are landmarks."})
      .add("detail_m", detail_m, 0, 10,
           {"m", "A cell is on the diagram where its two nearest walls' points are at least so far apart.",
            "Lower it and roughness of walls grows branches."})
      .add("opening_deg", opening_deg, 0, 179,
           {"deg", "And where they are seen at least at this angle from it.",
            "Above 90 deg the branches into the corners of rooms go."})
      .add("spur_m", spur_m, 0, 100, {"m", "Dead ends shorter than this are cut off.", ""})
      .add("mask_m", mask_m, 0, 10, {"m", "Radius of the mask at each vertex that cuts the diagram into edges.", ""});
}

std::vector<std::uint8_t> morphologically_thinned(std::vector<std::uint8_t> foreground, int width) {
  const std::array<std::ptrdiff_t, 8> steps = steps_round(width);
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < foreground.size(); ++i) {
    if (foreground[i] != 0) {
      cells.push_back(i);
    }
  }
  std::vector<std::size_t> layer;
  for (bool changed = true; changed;) {
    changed = false;
    for (const bool even : {true, false}) {
      layer.clear();
      for (const std::size_t at : cells) {
        if (off_by_guo_hall(neighbours_of(foreground, at, steps), even)) {
          layer.push_back(at);
        }
      }
      for (const std::size_t at : layer) {
        foreground[at] = 0;
      }
      std::erase_if(cells, [&](std::size_t at) { return foreground[at] == 0; });
      changed = changed || !layer.empty();
    }
  }
  return foreground;
}

Diagram diagram(const PreparedMap& map, const DiagramOptions& options) {
  const MapLevel& level = map.level(level_for(map, options.cell_m));
  const Ground ground = ground_of(level, options.speck_m);
  const Mask axis = medial_axis(ground, options, level.resolution_m);
  std::vector<float> height = ground.wall.distance_cells;
  // Where no wall is near, all is as far: a bound keeps the buckets few.
  const float bound = static_cast<float>(ground.width + ground.height);
  std::transform(height.begin(), height.end(), height.begin(), [&](float h) { return std::min(h, bound); });
  Mask skeleton = thinned(ground.free, height, axis, ground.width);
  const int mask_cells = mask_of(options.mask_m, level);
  const int spur_cells = static_cast<int>(std::lround(options.spur_m / level.resolution_m));
  prune(skeleton, ground, mask_cells, spur_cells);
  prune(skeleton, ground, mask_cells, spur_cells);  // what was between two spurs may have become one
  const auto weight = [&](std::size_t cell) {
    // A wall may hide where nothing was seen, if that is nearer than the nearest wall.
    const float clear = ground.wall.distance_cells[cell];
    const float sure =
        clear >= kFarFromWalls ? 0 : std::min(1.0F, (ground.unseen.distance_cells[cell] + 1) / (clear + 1));
    return sure * sure * free_probability(map, level, cell_of(cell, ground.width));
  };
  return described(skeleton, axis, ground, level, mask_cells, weight);
}

Diagram morphological_diagram(const PreparedMap& map, double cell_m, double mask_m) {
  const MapLevel& level = map.level(level_for(map, cell_m));
  const Ground ground = ground_of(level, 0);
  const Mask skeleton = morphologically_thinned(ground.free, ground.width);
  const auto weight = [&](std::size_t cell) { return free_probability(map, level, cell_of(cell, ground.width)); };
  return described(skeleton, skeleton, ground, level, mask_of(mask_m, level), weight);
}

View diagram_view(const Diagram& diagram, MapView::Map map) {
  const std::string which = map == MapView::Map::kTarget ? "target" : "source";
  Shape edges{.kind = Shape::Kind::kPoints, .label = "edges", .points = {}};
  Shape masked{.kind = Shape::Kind::kPoints, .label = "cut at the vertices", .points = {}};
  for (const RidgePoint& one : diagram.ridge) {
    (one.edge >= 0 ? edges : masked)
        .points.push_back({static_cast<double>(one.at.x_m), static_cast<double>(one.at.y_m)});
  }
  Shape vertices{.kind = Shape::Kind::kPoints, .label = "vertices", .points = {}};
  for (const Vertex& one : diagram.vertices) {
    vertices.points.push_back({static_cast<double>(one.at.x_m), static_cast<double>(one.at.y_m)});
  }
  return {"voronoi_" + which, "Voronoi diagram of the " + which + "'s free space, its vertices and edges",
          MapView{.map = map,
                  .local_target_from_source = {},
                  .shapes = {std::move(vertices), std::move(masked), std::move(edges)}}};
}

}  // namespace gridmerge::voronoi
