#include "gridmerge/select/scene_features.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gridmerge/base/random.hpp"
#include "support/scenes.hpp"

namespace gridmerge {
namespace {

constexpr double kCell = 0.05;  // [m]

OccupancyGrid free_field(double width_m, double height_m) {
  OccupancyGrid grid = unknown_grid({.width = static_cast<int>(std::lround(width_m / kCell)),
                                     .height = static_cast<int>(std::lround(height_m / kCell)),
                                     .resolution_m = kCell,
                                     .map_from_grid = {}});
  std::fill(grid.cells.begin(), grid.cells.end(), kFree);
  return grid;
}

/// Occupied along a straight line.
void draw_wall(OccupancyGrid& grid, Point2 from, Point2 to) {
  const int steps = static_cast<int>(norm(to - from) / (0.4 * kCell)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const CellIndex cell = grid.geometry.cell_at(from + static_cast<double>(i) / steps * (to - from));
    if (grid.geometry.contains(cell)) {
      grid.at(cell) = kOccupied;
    }
  }
}

SceneFeatures features_of(const OccupancyGrid& grid) { return scene_features(PreparedMap(grid, kCell)); }

/// A room of 12 m x 8 m with its axes turned.
OccupancyGrid room(double turn_rad) {
  OccupancyGrid grid = free_field(20, 20);
  const Pose2 placed{10, 10, turn_rad};
  const std::vector<Point2> corners = {placed * Point2{-6, -4}, placed * Point2{6, -4}, placed * Point2{6, 4},
                                       placed * Point2{-6, 4}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    draw_wall(grid, corners[i], corners[(i + 1) % corners.size()]);
  }
  return grid;
}

/// Posts of two cells, at random.
OccupancyGrid posts(int count) {
  OccupancyGrid grid = free_field(20, 20);
  RandomStream random(1, "posts");
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(1, 19);
    const double y = random.uniform(1, 19);
    draw_wall(grid, {x, y}, {x + kCell, y});
  }
  return grid;
}

TEST(SceneFeatures, ARoomIsStraightWithTwoDirections) {
  const SceneFeatures f = features_of(room(0));
  EXPECT_GT(f.straightness, 0.8);
  EXPECT_EQ(f.directions, 2);
  EXPECT_EQ(f.clutter, 0);
  EXPECT_TRUE(f.ternary);
  EXPECT_NEAR(f.known_area_m2, 400, 1e-6);
  EXPECT_NEAR(f.occupied_cells, 40 / kCell, 10);
}

TEST(SceneFeatures, TurningTheMapChangesThemLittle) {
  const SceneFeatures straight = features_of(room(0));
  const SceneFeatures turned = features_of(room(radians(29)));
  EXPECT_NEAR(turned.straightness, straight.straightness, 0.15);
  EXPECT_EQ(turned.directions, straight.directions);
  EXPECT_EQ(turned.clutter, straight.clutter);
}

TEST(SceneFeatures, PostsAreClutterWithoutADirection) {
  const SceneFeatures f = features_of(posts(250));
  EXPECT_LT(f.straightness, 0.35);
  EXPECT_EQ(f.clutter, 1);
}

TEST(SceneFeatures, FurnitureIsClutterAmongWalls) {
  OccupancyGrid grid = room(0);
  for (const double x : {6.0, 8.0, 10.0, 12.0}) {
    draw_wall(grid, {x, 10}, {x + 0.5, 10});
  }
  const SceneFeatures f = features_of(grid);
  EXPECT_GT(f.clutter, 0.03);
  EXPECT_LT(f.clutter, 0.1);
}

TEST(SceneFeatures, WhatFitsOnItselfTurnedByHalfIsSelfSimilar) {
  EXPECT_GT(features_of(room(0)).self_similarity, 0.9);  // a bare room, turned by half
  OccupancyGrid odd = room(0);
  for (const auto& [from, to] : {std::pair{Point2{5, 6}, Point2{5, 11}},
                                 {Point2{5, 11}, Point2{8, 11}},
                                 {Point2{9, 13}, Point2{12, 9}},
                                 {Point2{13, 7}, Point2{15, 8}},
                                 {Point2{7, 8}, Point2{9, 7}}}) {
    draw_wall(odd, from, to);
  }
  const SceneFeatures f = features_of(odd);
  EXPECT_LT(f.self_similarity, features_of(room(0)).self_similarity - 0.1);
  EXPECT_LT(features_of(posts(60)).self_similarity, 0.5);
}

TEST(SceneFeatures, SeeWhetherCellsSayHowLikely) {
  OccupancyGrid grid = room(0);
  grid.cells[grid.geometry.offset({10, 10})] = 20;
  EXPECT_FALSE(features_of(grid).ternary);
}

TEST(SceneFeatures, AreZeroWithoutWalls) {
  const SceneFeatures nothing =
      features_of(unknown_grid({.width = 30, .height = 20, .resolution_m = kCell, .map_from_grid = {}}));
  EXPECT_EQ(nothing.known_area_m2, 0);
  EXPECT_EQ(nothing.straightness, 0);
  const SceneFeatures open = features_of(free_field(5, 5));
  EXPECT_NEAR(open.known_area_m2, 25, 1e-6);
  EXPECT_EQ(open.directions, 0);
  EXPECT_EQ(open.self_similarity, 0);
}

TEST(SceneFeatures, HaveATextForEveryName) {
  const std::vector<FeatureText> texts = scene_feature_texts();
  const auto named = SceneFeatures{}.named();
  ASSERT_EQ(texts.size(), named.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_EQ(texts[i].name, named[i].first);
    EXPECT_FALSE(texts[i].meaning.empty());
  }
}

TEST(SceneFeatures, TellDrawnWorldsApart) {
  const auto of_kind = [](const char* kind) {
    worlds::MapPair pair = worlds::make_scene({.kind = kind, .seed = 3});
    return features_of(pair.target);
  };
  const SceneFeatures office = of_kind("office");
  const SceneFeatures forest = of_kind("forest");
  const SceneFeatures hall = of_kind("hall");
  EXPECT_GT(office.straightness, forest.straightness + 0.2);
  EXPECT_GT(forest.clutter, office.clutter + 0.5);
  EXPECT_GT(hall.self_similarity, office.self_similarity);
}

}  // namespace
}  // namespace gridmerge
