#pragma once
/// A map in a few points: a self-organising map learns where the walls are, and its neurons stand for them.
///
/// This is the down-scaling for very large maps: what a method does with every wall point it can do with at most
/// `at_most` cluster points, however large the map is. Each keeps the direction its walls face and how many metres of
/// wall it stands for. After Saeedi, Paull, Trentini, Li 2011 (seed 2.5), with batch learning in place of the on-line
/// rule: that needs no chance and no order of presentation.
///
/// Error: `ClusterPoints` says how far walls lie from their point. Along a wall that is about a quarter of the spacing
/// in the mean; across it, what matters to a match, a fraction of a cell, for a point lies on the mean of its walls.
/// Cost: linear in walls times epochs. methods/som/README.md shows how to score poses on cluster points.
#include <cstdint>
#include <span>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/base/stop_token.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// What is learnt: the walls in one cell of level 1. A thick wall then counts hardly more than a thin one.
struct WallSample {
  Point2f at;          ///< their mean
  Point2f normal;      ///< unit vector or zero, as ClusterPoint's
  bool sided = false;  ///< as ClusterPoint's
  float weight = 0;    ///< metres of wall
};

/// A neuron: some walls that lie close together and face one way.
struct ClusterPoint {
  Point2f at;          ///< their mean, local frame
  Point2f normal;      ///< unit vector across the wall; zero for a blob
  bool sided = false;  ///< the normal points to the free space the walls were seen from; else its sign says nothing
  float weight = 0;    ///< metres of wall it stands for
};

struct ClusterOptions {
  double spacing_m = 0.4;
  int at_most = 4000;
  int epochs = 5;

  void describe(OptionList& list);
};

struct ClusterPoints {
  std::vector<ClusterPoint> points;  ///< none of them without a wall; in row-major order of where they began
  double spacing_m = 0;              ///< as asked for, or wider where `at_most` demands it
  double mean_error_m = 0;           ///< of the distances from the walls to their point, by weight
  double rms_across_m = 0;           ///< of those distances' parts along the normal, where there is one
  double max_error_m = 0;
};

[[nodiscard]] std::vector<WallSample> wall_samples(const PreparedMap& map);

/// Learns at most `at_most` cluster points. The same at any number of threads; stopped early, what it has learnt so
/// far. A map without walls has none.
/// @throws std::invalid_argument listing every option out of range
[[nodiscard]] ClusterPoints cluster_points(const PreparedMap& map, const ClusterOptions& options, int num_threads = 1,
                                           const StopToken& stop = {});

/// Cluster points from samples that were grouped by another rule.
/// @param owner  for each sample, the group (0 .. groups-1) it belongs to; groups without samples are left out
[[nodiscard]] ClusterPoints summarised(std::span<const WallSample> samples, std::span<const std::uint32_t> owner,
                                       std::size_t groups);

}  // namespace gridmerge
