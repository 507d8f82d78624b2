#pragma once
/// The single steps of the genetic method as published, each a pure function. The paper is [li2013] Li and Nashashibi
/// 2013 (journal form: Li, Tsukada, Nashashibi, Parent, "Multi-Vehicle Cooperative Local Mapping: A Methodology Based
/// on Occupancy Grid Map Merging", IEEE Trans. Intelligent Transportation Systems 15(5), 2014), in the form that the
/// thesis gave it; equation numbers are the thesis's.
#include <cstddef>
#include <cstdint>
#include <span>

#include "gridmerge/base/random.hpp"
#include "gridmerge/grid/pose2.hpp"

/// All poses lie between the map frames, source to target.
namespace gridmerge::paper {

struct Individual {
  Pose2 target_from_source;
  std::int64_t fitness = 0;  ///< HitFitness
};

/// Eq. 3.7: where the source's map lies, from each robot's pose in its own map (local) and in a common frame (global).
[[nodiscard]] Pose2 initial_pose(const Pose2& target_local, const Pose2& target_global, const Pose2& source_local,
                                 const Pose2& source_global);

/// The error range round the initial pose p_i.
struct Window {
  Pose2 start;   ///< p_i
  Point2 pivot;  ///< the point of the source frame that stays within the radius; as published, its origin
  double radius_m = 0;
  double angle_rad = 0;  ///< to either side
};

/// Initialisation and reinitialisation: a pose drawn uniformly from the window.
[[nodiscard]] Pose2 random_pose(const Window& window, RandomStream& stream);

/// Standard deviations of one mutation.
struct MutationSpread {
  double position_m = 0;  ///< of x and of y
  double angle_rad = 0;
};

[[nodiscard]] Pose2 mutation(const Pose2& pose, const MutationSpread& spread, RandomStream& stream);

/// Eq. 3.12: position of the first, orientation of the second.
[[nodiscard]] Pose2 crossover_1(const Pose2& first, const Pose2& second);

/// Eq. 3.13: lambda first + (1 - lambda) second, the angle along the shorter arc.
[[nodiscard]] Pose2 crossover_2(const Pose2& first, const Pose2& second, double lambda);

/// Eq. 3.9-3.11: how many individuals have at least the mean fitness. They are the first ones; at least one.
/// @param best_first  sorted by falling fitness, not empty
[[nodiscard]] std::size_t superior_count(std::span<const Individual> best_first);

/// Eq. 3.14: how often the thesis's variant tries to mutate a superior individual, 1 .. most.
/// @param worst, best  fitness of the worst and the best of the superior group
[[nodiscard]] int mutation_attempts(std::int64_t fitness, std::int64_t worst, std::int64_t best, int most);

}  // namespace gridmerge::paper
