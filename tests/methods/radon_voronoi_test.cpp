#include "methods/radon_voronoi/radon_voronoi.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "gridmerge/base/random.hpp"
#include "methods/radon_voronoi/edge_matrices.hpp"
#include "methods/radon_voronoi/edge_votes.hpp"
#include "methods/radon_voronoi/paper_radon_voronoi.hpp"
#include "methods/radon_voronoi/radon.hpp"
#include "methods/radon_voronoi/voronoi.hpp"
#include "support/flat_pair.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using voronoi::Diagram;
using voronoi::EdgeMatrix;

bool near_truth(const FlatPair& flat, const Candidate& candidate, double distance_m, double angle_deg) {
  const PoseDifference error = pose_error(flat.pair, candidate.target_from_source);
  return error.distance_m < distance_m && degrees(error.angle_rad) < angle_deg;
}

/// A room of width x height cells with walls round it, free inside, unknown outside.
OccupancyGrid room(int width, int height, double resolution_m) {
  OccupancyGrid grid =
      unknown_grid({.width = width + 4, .height = height + 4, .resolution_m = resolution_m, .map_from_grid = {}});
  for (int row = 1; row < height + 3; ++row) {
    for (int column = 1; column < width + 3; ++column) {
      const bool inner = row > 1 && row < height + 2 && column > 1 && column < width + 2;
      grid.cells[grid.geometry.offset({column, row})] = inner ? kFree : kOccupied;
    }
  }
  return grid;
}

/// How many 8-connected pieces of ones, or 4-connected pieces of zeros, a mask has.
int pieces(const std::vector<std::uint8_t>& mask, int width, std::uint8_t value) {
  const int height = static_cast<int>(mask.size()) / width;
  std::vector<std::uint8_t> open(mask.size());
  std::transform(mask.begin(), mask.end(), open.begin(),
                 [&](std::uint8_t m) { return static_cast<std::uint8_t>(m == value ? 1 : 0); });
  int count = 0;
  std::vector<int> stack;
  for (int start = 0; start < width * height; ++start) {
    if (open[static_cast<std::size_t>(start)] == 0) {
      continue;
    }
    ++count;
    stack.assign(1, start);
    open[static_cast<std::size_t>(start)] = 0;
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int x = at % width + dx;
          const int y = at / width + dy;
          const bool diagonal = dx != 0 && dy != 0;
          if (x < 0 || y < 0 || x >= width || y >= height || (value == 0 && diagonal)) {
            continue;
          }
          std::uint8_t& cell = open[static_cast<std::size_t>(y * width + x)];
          if (cell != 0) {
            cell = 0;
            stack.push_back(y * width + x);
          }
        }
      }
    }
  }
  return count;
}

/// Blobs and holes at random, with a background rim.
std::vector<std::uint8_t> random_mask(int width, int height, std::uint64_t seed) {
  RandomStream random(seed, "mask");
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(width * height), 0);
  for (int blob = 0; blob < 24; ++blob) {
    const double x = random.uniform(4, width - 4);
    const double y = random.uniform(4, height - 4);
    const double radius = random.uniform(1, 9);
    const std::uint8_t value = blob % 3 == 2 ? 0 : 1;
    for (int row = 1; row + 1 < height; ++row) {
      for (int column = 1; column + 1 < width; ++column) {
        if (std::hypot(column - x, row - y) < radius) {
          mask[static_cast<std::size_t>(row * width + column)] = value;
        }
      }
    }
  }
  return mask;
}

std::vector<float> distances_to_background(const std::vector<std::uint8_t>& mask, int width) {
  std::vector<std::uint8_t> background(mask.size());
  std::transform(mask.begin(), mask.end(), background.begin(),
                 [](std::uint8_t m) { return static_cast<std::uint8_t>(m == 0 ? 1 : 0); });
  return voronoi::nearest_marked(background, width, static_cast<int>(mask.size()) / width).distance_cells;
}

bool has_block_of_four(const std::vector<std::uint8_t>& mask, int width) {
  const auto w = static_cast<std::size_t>(width);
  for (std::size_t i = 0; i + w + 1 < mask.size(); ++i) {
    if (mask[i] + mask[i + 1] + mask[i + w] + mask[i + w + 1] == 4) {
      return true;
    }
  }
  return false;
}

// Thinning and distances.

TEST(NearestMarked, IsExactEverywhere) {
  constexpr int kWidth = 23;
  constexpr int kHeight = 17;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    RandomStream random(seed, "marks");
    std::vector<std::uint8_t> marked(kWidth * kHeight, 0);
    for (std::uint64_t i = 0; i < 2 * seed; ++i) {
      marked[random.below(kWidth * kHeight)] = 1;
    }
    const voronoi::NearestMarked nearest = voronoi::nearest_marked(marked, kWidth, kHeight);
    for (int i = 0; i < kWidth * kHeight; ++i) {
      double best = 1e9;
      for (int k = 0; k < kWidth * kHeight; ++k) {
        if (marked[static_cast<std::size_t>(k)] != 0) {
          best = std::min(best, std::hypot(i % kWidth - k % kWidth, i / kWidth - k / kWidth));
        }
      }
      const auto at = static_cast<std::size_t>(i);
      ASSERT_NEAR(static_cast<double>(nearest.distance_cells[at]), best, 1e-4) << "cell " << i;
      const int found = nearest.index[at];
      ASSERT_EQ(marked[static_cast<std::size_t>(found)], 1);
      ASSERT_NEAR(std::hypot(i % kWidth - found % kWidth, i / kWidth - found / kWidth), best, 1e-4);
    }
  }
}

TEST(NearestMarked, IsFarWhereNothingIsMarked) {
  const voronoi::NearestMarked nearest = voronoi::nearest_marked(std::vector<std::uint8_t>(12, 0), 4, 3);
  EXPECT_THAT(nearest.distance_cells, testing::Each(kFarFromWalls));
  EXPECT_THAT(nearest.index, testing::Each(-1));
  EXPECT_THAT(voronoi::nearest_marked({}, 0, 0).index, IsEmpty());
}

TEST(Thinning, CallsACellSimpleExactlyWhenNothingIsCutOrFilledByTakingIt) {
  constexpr std::array<std::array<int, 2>, 8> kRound = {
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  for (unsigned bits = 0; bits < 256; ++bits) {
    std::vector<std::uint8_t> mask(25, 0);
    for (std::size_t k = 0; k < 8; ++k) {
      mask[static_cast<std::size_t>((2 + kRound[k][1]) * 5 + 2 + kRound[k][0])] = (bits >> k) & 1U;
    }
    mask[12] = 1;
    const int ones = pieces(mask, 5, 1);
    const int zeros = pieces(mask, 5, 0);
    mask[12] = 0;
    const bool harmless = pieces(mask, 5, 1) == ones && pieces(mask, 5, 0) == zeros;
    EXPECT_EQ(voronoi::is_simple(static_cast<std::uint8_t>(bits)), harmless) << std::bitset<8>(bits);
  }
}

TEST(Thinning, KeepsEveryPieceAndEveryHole) {
  constexpr int kWidth = 60;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<std::uint8_t> mask = random_mask(kWidth, 45, seed);
    const std::vector<std::uint8_t> none(mask.size(), 0);
    const std::vector<std::uint8_t> thin = voronoi::thinned(mask, distances_to_background(mask, kWidth), none, kWidth);
    EXPECT_EQ(pieces(thin, kWidth, 1), pieces(mask, kWidth, 1)) << "seed " << seed;
    EXPECT_EQ(pieces(thin, kWidth, 0), pieces(mask, kWidth, 0)) << "seed " << seed;
    const std::vector<std::uint8_t> layers = voronoi::morphologically_thinned(mask, kWidth);
    EXPECT_EQ(pieces(layers, kWidth, 1), pieces(mask, kWidth, 1)) << "seed " << seed;
    EXPECT_EQ(pieces(layers, kWidth, 0), pieces(mask, kWidth, 0)) << "seed " << seed;
    EXPECT_LT(std::accumulate(layers.begin(), layers.end(), 0), std::accumulate(mask.begin(), mask.end(), 0) / 3);
  }
}

TEST(Thinning, KeepsAnchorsToTheirEnds) {
  constexpr int kWidth = 45;
  std::vector<std::uint8_t> bar(kWidth * 15, 0);
  std::vector<std::uint8_t> anchor(bar.size(), 0);
  for (int row = 2; row < 13; ++row) {
    for (int column = 2; column < 43; ++column) {
      bar[static_cast<std::size_t>(row * kWidth + column)] = 1;
      anchor[static_cast<std::size_t>(row * kWidth + column)] = row == 7 ? 1 : 0;
    }
  }
  const std::vector<std::uint8_t> thin = voronoi::thinned(bar, distances_to_background(bar, kWidth), anchor, kWidth);
  EXPECT_EQ(thin, anchor);
}

TEST(Thinning, ThinsThickAnchors) {
  constexpr int kWidth = 45;
  std::vector<std::uint8_t> band(kWidth * 8, 0);
  for (int row = 3; row < 5; ++row) {
    for (int column = 2; column < 43; ++column) {
      band[static_cast<std::size_t>(row * kWidth + column)] = 1;
    }
  }
  const std::vector<std::uint8_t> thin = voronoi::thinned(band, distances_to_background(band, kWidth), band, kWidth);
  EXPECT_FALSE(has_block_of_four(thin, kWidth));
  EXPECT_EQ(pieces(thin, kWidth, 1), 1);
  EXPECT_GE(std::accumulate(thin.begin(), thin.end(), 0), 38);
}

// The diagram.

TEST(VoronoiDiagram, OfABareRoomIsTheFigureGeometrySays) {
  // 6 m x 4 m: a ridge 2 m long in the middle, 2 m from the walls; a branch into each corner.
  const OccupancyGrid grid = room(60, 40, 0.1);
  const PreparedMap map(grid, 0.1);
  const Diagram diagram = voronoi::diagram(map, {});
  ASSERT_THAT(diagram.vertices, SizeIs(2));
  for (const voronoi::Vertex& vertex : diagram.vertices) {
    EXPECT_NEAR(static_cast<double>(vertex.at.y_m), 0, 0.2);
    EXPECT_NEAR(std::abs(static_cast<double>(vertex.at.x_m)), 1, 0.3);
    EXPECT_NEAR(static_cast<double>(vertex.clearance_m), 2, 0.2);
    EXPECT_THAT(vertex.branch_rad, SizeIs(3));
  }
  EXPECT_EQ(diagram.edges, 5);
  for (const voronoi::RidgePoint& one : diagram.ridge) {
    const double to_wall =
        std::min(3 - std::abs(static_cast<double>(one.at.x_m)), 2 - std::abs(static_cast<double>(one.at.y_m)));
    EXPECT_NEAR(static_cast<double>(one.clearance_m), to_wall, 0.15);
    EXPECT_NEAR(static_cast<double>(one.weight), 1, 0.01);
  }
}

TEST(VoronoiDiagram, ASpeckInARoomChangesNothing) {
  OccupancyGrid grid = room(60, 40, 0.1);
  const Diagram bare = voronoi::diagram(PreparedMap(grid, 0.1), {});
  const Diagram bare_as_published = voronoi::morphological_diagram(PreparedMap(grid, 0.1), 0.1, 0.3);
  grid.cells[grid.geometry.offset({32, 15})] = kOccupied;
  grid.cells[grid.geometry.offset({33, 15})] = kOccupied;
  grid.cells[grid.geometry.offset({20, 30})] = kUnknown;
  const Diagram specked = voronoi::diagram(PreparedMap(grid, 0.1), {});
  EXPECT_EQ(specked.ridge.size(), bare.ridge.size());
  EXPECT_EQ(specked.vertices.size(), bare.vertices.size());
  // The published thinning runs a loop round each speck.
  EXPECT_GT(voronoi::morphological_diagram(PreparedMap(grid, 0.1), 0.1, 0.3).ridge.size(),
            bare_as_published.ridge.size());
}

TEST(VoronoiDiagram, CountsLessWhereTheMapIsNotSure) {
  OccupancyGrid sure = room(60, 40, 0.1);
  OccupancyGrid unsure = sure;
  for (std::int8_t& cell : unsure.cells) {
    cell = cell == kFree ? std::int8_t{20} : cell;
  }
  const Diagram of_sure = voronoi::morphological_diagram(PreparedMap(sure, 0.1), 0.1, 0.3);
  const Diagram of_unsure = voronoi::morphological_diagram(PreparedMap(unsure, 0.1), 0.1, 0.3);
  ASSERT_EQ(of_sure.ridge.size(), of_unsure.ridge.size());
  for (std::size_t i = 0; i < of_sure.ridge.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(of_unsure.ridge[i].weight), 0.8 * static_cast<double>(of_sure.ridge[i].weight),
                1e-4);
  }
}

TEST(VoronoiDiagram, CountsLessWhereAnUnseenWallMayBeNearer) {
  OccupancyGrid grid = room(60, 40, 0.1);
  for (int row = 15; row < 28; ++row) {  // a part of the room that nobody saw, beside the ridge
    for (int column = 35; column < 42; ++column) {
      grid.cells[grid.geometry.offset({column, row})] = kUnknown;
    }
  }
  const Diagram diagram = voronoi::diagram(PreparedMap(grid, 0.1), {});
  const auto lowest = std::min_element(diagram.ridge.begin(), diagram.ridge.end(),
                                       [](const auto& a, const auto& b) { return a.weight < b.weight; });
  ASSERT_NE(lowest, diagram.ridge.end());
  EXPECT_LT(lowest->weight, 0.3F);
}

TEST(VoronoiDiagram, OfAMapWithoutFreeSpaceIsEmpty) {
  const PreparedMap walls(text_map({"###", "###"}, 0.1), 0.1);
  EXPECT_THAT(voronoi::diagram(walls, {}).ridge, IsEmpty());
  EXPECT_THAT(voronoi::morphological_diagram(walls, 0.1, 0.3).ridge, IsEmpty());
}

TEST(VoronoiDiagram, OfAnOpenFieldWithoutWallsIsEmpty) {
  const PreparedMap open(text_map({".....", ".....", "....."}, 0.5), 0.5);
  EXPECT_THAT(voronoi::diagram(open, {}).ridge, IsEmpty());
}

// The sinograms.

radon::WallPiece wall_at(double x_m, double y_m, double normal_deg) {
  return {.at = {static_cast<float>(x_m), static_cast<float>(y_m)},
          .weight = 1,
          .normal_rad = static_cast<float>(radians(normal_deg)),
          .has_normal = true,
          .one_sided = true};
}

/// An L-shaped place, walls seen from inside; turned and moved.
std::vector<radon::WallPiece> l_shape(const Pose2& pose) {
  std::vector<radon::WallPiece> pieces;
  const auto wall = [&](Point2 from, Point2 to, double normal_deg) {
    const int count = static_cast<int>(norm(to - from) / 0.2);
    for (int i = 0; i < count; ++i) {
      const Point2 at = pose * (from + (static_cast<double>(i) / count) * (to - from));
      pieces.push_back(wall_at(at.x_m, at.y_m, normal_deg + degrees(pose.theta_rad)));
    }
  };
  wall({-4, -3}, {4, -3}, 90);
  wall({4, -3}, {4, 0}, 180);
  wall({4, 0}, {-1, 0}, 270);
  wall({-1, 0}, {-1, 3}, 180);
  wall({-1, 3}, {-4, 3}, 270);
  wall({-4, 3}, {-4, -3}, 0);
  return pieces;
}

TEST(Sinogram, HoldsEveryWallOnceAnAngle) {
  const radon::Sinogram sinogram = radon::sinogram(l_shape({}), radon::Projection::kPlain, 90, 0.2, 6);
  const double all = static_cast<double>(l_shape({}).size());
  for (int angle = 0; angle < sinogram.angles; ++angle) {
    const float* column = sinogram.column(angle);
    EXPECT_NEAR(std::accumulate(column, column + sinogram.offsets, 0.0), all, 1e-2);
  }
}

TEST(Sinogram, OfAPlainProjectionHasPeriodPi) {
  const radon::Sinogram sinogram = radon::sinogram(l_shape({}), radon::Projection::kPlain, 90, 0.2, 6);
  for (int i = 0; i < sinogram.offsets; ++i) {
    EXPECT_NEAR(sinogram.column(10)[i], sinogram.column(55)[sinogram.offsets - 1 - i], 1e-3);
  }
}

TEST(Sinogram, TellsTheTurnWhateverTheShift) {
  const radon::Sinogram target = radon::sinogram(l_shape({}), radon::Projection::kDirected, 360, 0.2, 12);
  for (const double turn_deg : {0.0, 37.3, 90.0, 180.0, -128.0}) {
    const Pose2 source_from_target = inverse(Pose2{2.5, -1.7, radians(turn_deg)});
    const radon::Sinogram source =
        radon::sinogram(l_shape(source_from_target), radon::Projection::kDirected, 360, 0.2, 12);
    const radon::Rotation best = radon::rotations(radon::angle_correlation(target, source), {}, 4).front();
    EXPECT_LT(std::abs(degrees(wrap_angle(best.angle_rad - radians(turn_deg)))), 0.6) << turn_deg;
    EXPECT_GT(best.score, 0.9);
    EXPECT_GT(best.sigma_rad, 0);
  }
}

TEST(Sinogram, OfThePlainTransformLeavesTheTurnOpenByHalfATurn) {
  const radon::Sinogram target = radon::sinogram(l_shape({}), radon::Projection::kPlain, 360, 0.2, 12);
  const radon::Sinogram source =
      radon::sinogram(l_shape({1, 1, radians(-40)}), radon::Projection::kPlain, 360, 0.2, 12);
  const std::vector<double> correlation = radon::energy_correlation(target, source);
  for (std::size_t i = 0; i < 180; ++i) {
    EXPECT_NEAR(correlation[i], correlation[i + 180], 1e-3);
  }
  const std::vector<radon::Rotation> best = radon::rotations(correlation, {}, 2);
  ASSERT_THAT(best, SizeIs(2));
  EXPECT_LT(std::abs(degrees(std::remainder(best.front().angle_rad - radians(40), kPi))), 1);
}

TEST(Sinogram, CorrelatesOnlyWithOneOfItsSize) {
  const radon::Sinogram one = radon::sinogram(l_shape({}), radon::Projection::kPlain, 90, 0.2, 6);
  const radon::Sinogram other = radon::sinogram(l_shape({}), radon::Projection::kPlain, 180, 0.2, 6);
  EXPECT_THROW((void)radon::angle_correlation(one, other), std::invalid_argument);
  EXPECT_THROW((void)radon::energy_correlation(one, other), std::invalid_argument);
}

TEST(Rotations, KeepToTheFence) {
  const radon::Sinogram map = radon::sinogram(l_shape({}), radon::Projection::kDirected, 360, 0.2, 12);
  const std::vector<double> correlation = radon::angle_correlation(map, map);
  const PoseWindow fence{.centre = {0, 0, radians(45)}, .radius_m = 1, .angle_rad = radians(20)};
  for (const radon::Rotation& one : radon::rotations(correlation, fence, 10)) {
    EXPECT_LE(std::abs(degrees(wrap_angle(one.angle_rad)) - 45), 20 + 1e-6);
  }
  const PoseWindow slit{.centre = {0, 0, radians(45.4)}, .radius_m = 1, .angle_rad = radians(0.1)};
  const std::vector<radon::Rotation> only = radon::rotations(correlation, slit, 10);
  ASSERT_THAT(only, SizeIs(1));
  EXPECT_NEAR(degrees(only.front().angle_rad), 45.4, 1e-6);
}

// Votes and matrices.

TEST(EdgeVotes, OfADiagramWithItselfPeakAtNoShift) {
  const Diagram diagram = voronoi::diagram(flat().target, {});
  const voronoi::VoteSurface surface = vote(diagram, diagram, {}, {}, {});
  const std::vector<ScoredPose> best = peaks(surface, 0, 3);
  ASSERT_THAT(best, Not(IsEmpty()));
  EXPECT_LT(norm(best.front().pose.translation()), 0.05);
}

TEST(EdgeVotes, FindTheShiftOfTwoMapsGivenTheTurn) {
  int first = 0;
  for (int seed = 1; seed <= 6; ++seed) {
    const FlatPair scene(seed);
    const Pose2 truth = scene.local_truth();
    const radon::Rotation turn{truth.theta_rad, radians(1), 1};
    const std::vector<ScoredPose> best = peaks(
        vote(voronoi::diagram(scene.target, {}), voronoi::diagram(scene.source, {}), turn, {}, {}), truth.theta_rad, 3);
    ASSERT_THAT(best, Not(IsEmpty()));
    first += norm(best.front().pose.translation() - truth.translation()) < 0.3 ? 1 : 0;
  }
  EXPECT_GE(first, 5) << "of 6 scenes";
}

TEST(EdgeVotes, OfEmptyDiagramsAreNone) {
  const Diagram diagram = voronoi::diagram(flat().target, {});
  EXPECT_THAT(peaks(vote(diagram, {}, {}, {}, {}), 0, 3), IsEmpty());
  EXPECT_THAT(peaks(vote({}, diagram, {}, {}, {}), 0, 3), IsEmpty());
  const PoseWindow far{.centre = {500, 0, 0}, .radius_m = 1, .angle_rad = kPi};
  EXPECT_THAT(vote(diagram, diagram, {}, far, {}).votes, IsEmpty());
}

TEST(EdgeVotes, MatchVerticesThatMeet) {
  const Diagram diagram = voronoi::diagram(flat().target, {});
  const std::vector<Point2> all = matched_vertices(diagram, diagram, {}, 0.1);
  EXPECT_EQ(all.size(), 2 * diagram.vertices.size());
  EXPECT_THAT(matched_vertices(diagram, diagram, {500, 0, 0}, 0.1), IsEmpty());
}

TEST(EdgeMatrices, LieOnThemselvesWithoutAShift) {
  const Diagram diagram = voronoi::morphological_diagram(flat().target, 0.1, 0.3);
  const std::vector<EdgeMatrix> edges = edge_matrices(diagram, {}, {.cell_m = diagram.cell_m, .shortest_cells = 6});
  ASSERT_THAT(edges, Not(IsEmpty()));
  for (const EdgeMatrix& edge : edges) {
    const voronoi::EdgeMatch match = cross_correlate(edge, edge);
    EXPECT_NEAR(match.columns, 0, 0.5);
    EXPECT_NEAR(match.rows, 0, 0.5);
    EXPECT_NEAR(match.likeness, 1, 1e-4);
  }
}

TEST(EdgeMatrices, TellTheShiftBetweenThem) {
  const Diagram diagram = voronoi::morphological_diagram(flat().target, 0.1, 0.3);
  const std::vector<EdgeMatrix> edges = edge_matrices(diagram, {}, {.cell_m = diagram.cell_m, .shortest_cells = 12});
  ASSERT_THAT(edges, Not(IsEmpty()));
  EdgeMatrix moved = edges.front();
  moved.low_column += 7;
  moved.low_row -= 4;
  const voronoi::EdgeMatch match = cross_correlate(edges.front(), moved);
  EXPECT_NEAR(match.columns, -7, 0.5);
  EXPECT_NEAR(match.rows, 4, 0.5);
}

TEST(EdgeMatrices, AreBlurredMoreTheLessSureTheTurnIs) {
  const Diagram diagram = voronoi::morphological_diagram(flat().target, 0.1, 0.3);
  const voronoi::EdgeRaster raster{.cell_m = diagram.cell_m, .shortest_cells = 6, .most_blur_m = 0.5};
  const std::vector<EdgeMatrix> sharp = edge_matrices(diagram, {0, 0, 1}, raster);
  const std::vector<EdgeMatrix> blurred = edge_matrices(diagram, {0, radians(5), 1}, raster);
  ASSERT_EQ(sharp.size(), blurred.size());
  for (std::size_t i = 0; i < sharp.size(); ++i) {
    EXPECT_GE(blurred[i].width, sharp[i].width);
    EXPECT_LT(cross_correlate(sharp[i], blurred[i]).likeness, 1);
  }
}

// The method.

TEST(RadonVoronoi, ProposesTheTruthFirst) {
  int first = 0;
  int any = 0;
  for (int seed = 1; seed <= 6; ++seed) {
    const FlatPair scene(seed);
    const Proposal proposal = RadonVoronoiMerger({}).propose(scene.request(), {.seed = 1, .num_threads = 2});
    ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
    first += near_truth(scene, proposal.candidates.front(), 0.2, 1.5) ? 1 : 0;
    any += std::any_of(proposal.candidates.begin(), proposal.candidates.end(),
                       [&](const Candidate& one) { return near_truth(scene, one, 0.2, 1.5); })
               ? 1
               : 0;
  }
  EXPECT_GE(first, 5) << "of 6 scenes";
  EXPECT_GE(any, 5) << "of 6 scenes";
}

/// By name; a KnownPair itself would be printed as bytes.
class RadonVoronoiOnKnownPairs : public testing::TestWithParam<std::string> {};

TEST_P(RadonVoronoiOnKnownPairs, IsRightWhereTheMapsSayItAndNeverMergesWhereTheyDoNot) {
  const std::vector<KnownPair> all = known_pairs();
  const auto known = std::find_if(all.begin(), all.end(), [](const KnownPair& k) { return k.name == GetParam(); });
  ASSERT_NE(known, all.end());
  const worlds::MapPair pair = worlds::make_scene(known->options);
  const Alignment alignment = align({.target = pair.target, .source = pair.source, .prior = {}}, RadonVoronoiMerger({}),
                                    {}, {.seed = 1, .num_threads = 2});
  const std::string told = testing::PrintToString(alignment.reasons);
  if (!known->overlaps || known->ambiguous) {
    EXPECT_NE(alignment.outcome, Outcome::kMerged) << told;
  } else {
    EXPECT_EQ(alignment.outcome, Outcome::kMerged) << told;
    ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
    const PoseDifference error = pose_error(pair, alignment.hypotheses.front().target_from_source.pose);
    EXPECT_LT(error.distance_m, 1) << told;
    EXPECT_LT(degrees(error.angle_rad), 3) << told;
  }
}

std::string as_it_is(const testing::TestParamInfo<std::string>& name) { return name.param; }

std::vector<std::string> known_names() {
  std::vector<std::string> names;
  for (const KnownPair& known : known_pairs()) {
    names.push_back(known.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, RadonVoronoiOnKnownPairs, testing::ValuesIn(known_names()), as_it_is);

TEST(RadonVoronoi, ProposesDistinctPoses) {
  const RadonVoronoiOptions options;
  const Proposal proposal = RadonVoronoiMerger(options).propose(flat().request(), {});
  EXPECT_LE(proposal.candidates.size(), static_cast<std::size_t>(options.candidates));
  for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const PoseDifference apart =
          difference_at(flat().source.centre_in_map(), proposal.candidates[i].target_from_source,
                        proposal.candidates[k].target_from_source);
      EXPECT_TRUE(apart.distance_m >= options.distinct_m - 1e-6 ||
                  apart.angle_rad >= radians(options.distinct_deg) - 1e-6);
    }
  }
}

TEST(RadonVoronoi, DoesNotClaimToHaveLookedEverywhere) {
  // Rotations that the sinograms do not suggest were never tried.
  EXPECT_FALSE(RadonVoronoiMerger({}).propose(flat().request(), {}).surveyed);
  EXPECT_FALSE(PaperRadonVoronoiMerger({}).propose(flat().request(), {}).surveyed);
}

TEST(RadonVoronoi, TakesABarePriorAsOneMoreStart) {
  RadonVoronoiOptions blind;
  blind.rotations = 1;
  blind.peaks_per_rotation = 1;
  const PosePrior start{.target_from_source = flat().pair.target_from_source, .radius_m = {}, .angle_rad = {}};
  const Proposal proposal = RadonVoronoiMerger(blind).propose(flat().request(start), {});
  EXPECT_TRUE(std::any_of(proposal.candidates.begin(), proposal.candidates.end(),
                          [](const Candidate& one) { return near_truth(flat(), one, 0.2, 1.5); }));
}

TEST(RadonVoronoi, FindsTheTruthInATightFence) {
  const PosePrior fence{.target_from_source = flat().pair.target_from_source, .radius_m = 0.1, .angle_rad = radians(1)};
  const Proposal proposal = RadonVoronoiMerger({}).propose(flat().request(fence), {});
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  EXPECT_TRUE(near_truth(flat(), proposal.candidates.front(), 0.2, 1.5));
}

TEST(RadonVoronoi, PaperProfileTriesOneRotationAndItsOpposite) {
  const Proposal proposal = PaperRadonVoronoiMerger({}).propose(flat().request(), {});
  EXPECT_EQ(proposal.iterations, 2);
  std::set<double> angles;
  for (const Candidate& one : proposal.candidates) {
    angles.insert(std::round(degrees(one.target_from_source.theta_rad) * 1e3));
  }
  EXPECT_LE(angles.size(), 2U);
}

/// Collects what a method shows.
struct Viewer : TraceSink {
  std::vector<View> views;
  [[nodiscard]] bool wants_views() const override { return true; }
  void on_view(const View& view) override { views.push_back(view); }
};

void expect_whole(const View& view) {
  EXPECT_FALSE(view.title.empty()) << view.name;
  if (const auto* surface = std::get_if<SurfaceView>(&view.content)) {
    EXPECT_EQ(surface->values.size(),
              static_cast<std::size_t>(surface->width) * static_cast<std::size_t>(surface->height))
        << view.name;
    EXPECT_LT(surface->x_low, surface->x_high) << view.name;
    EXPECT_LT(surface->y_low, surface->y_high) << view.name;
  } else if (const auto* curves = std::get_if<CurvesView>(&view.content)) {
    for (const Curve& curve : curves->curves) {
      EXPECT_EQ(curve.x.size(), curve.y.size()) << view.name;
    }
  } else {
    for (const Shape& shape : std::get<MapView>(view.content).shapes) {
      EXPECT_TRUE(shape.kind != Shape::Kind::kSegments || shape.points.size() % 2 == 0) << view.name;
    }
  }
}

TEST(RadonVoronoi, ShowsWhatItSeesInside) {
  for (const bool paper : {false, true}) {
    Viewer viewer;
    const RunContext context{.seed = 1, .num_threads = 1, .stop = {}, .trace = &viewer};
    (void)(paper ? PaperRadonVoronoiMerger({}).propose(flat().request(), context)
                 : RadonVoronoiMerger({}).propose(flat().request(), context));
    std::set<std::string> names;
    for (const View& view : viewer.views) {
      EXPECT_TRUE(names.insert(view.name).second) << view.name << " is shown twice";
      expect_whole(view);
    }
    for (const char* name : {"sinogram_target", "sinogram_source", "angle_correlation", "voronoi_target",
                             "voronoi_source", "edge_votes", "matched_vertices"}) {
      EXPECT_THAT(names, Contains(name));
    }
  }
}

TEST(RadonVoronoi, RefusesOptionsOutOfRange) {
  RadonVoronoiOptions options;
  options.rotations = 0;
  EXPECT_THROW(RadonVoronoiMerger{options}, std::invalid_argument);
  options = {};
  options.votes.bin_m = 0;
  EXPECT_THROW(RadonVoronoiMerger{options}, std::invalid_argument);
  options = {};
  options.diagram.cell_m = 0;
  EXPECT_THROW(RadonVoronoiMerger{options}, std::invalid_argument);
  PaperRadonVoronoiOptions paper;
  paper.shortest_cells = 0;
  EXPECT_THROW(PaperRadonVoronoiMerger{paper}, std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
