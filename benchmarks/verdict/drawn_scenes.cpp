#include "verdict/drawn_scenes.hpp"

#include <array>
#include <cmath>

#include "gridmerge/base/random.hpp"
#include "worlds/world.hpp"

namespace gridmerge::verdict_study {
namespace {

struct Weighted {
  const char* name;
  double weight;
};

template <std::size_t kCount>
std::string pick(const std::array<Weighted, kCount>& all, RandomStream& chance) {
  double sum = 0;
  for (const Weighted& one : all) {
    sum += one.weight;
  }
  double left = chance.uniform(0, sum);
  for (const Weighted& one : all) {
    left -= one.weight;
    if (left < 0) {
      return one.name;
    }
  }
  return all.back().name;
}

constexpr std::array<Weighted, 11> kWorlds = {{{"office", 3},
                                               {"flat", 3},
                                               {"floors", 1.5},
                                               {"maze", 2},
                                               {"warehouse", 1.5},
                                               {"cave", 1.5},
                                               {"forest", 1.5},
                                               {"bush_forest", 0.5},
                                               {"spiral", 0.5},
                                               {"hall", 0.5},
                                               {"corridor", 0.5}}};
constexpr std::array<Weighted, 3> kMappings = {{{"known", 5}, {"noisy", 2}, {"slam", 3}}};
constexpr std::array<Weighted, 4> kLidars = {
    {{"custom", 6}, {"rplidar_a3", 1.5}, {"hokuyo_utm30lx", 1.5}, {"hokuyo_urg04lx", 1}}};
constexpr std::array<Weighted, 4> kResolutions = {{{"0.05", 7}, {"0.04", 1}, {"0.08", 1}, {"0.1", 1}}};
constexpr std::array<const char*, 8> kApart = {"two_ends", "two_worlds", "mirrored", "two_buildings",
                                               "two_ends", "two_worlds", "mirrored", "two_floors"};

bool chance_of(double share, RandomStream& chance) { return chance.uniform() < share; }

void choose_sight(worlds::SceneOptions& scene, RandomStream& chance) {
  scene.lidar = pick(kLidars, chance);
  const double range_m = chance.uniform(4, 25);
  const double noise_m = chance.uniform(0.005, 0.04);
  if (scene.lidar == "custom") {
    scene.range_m = range_m;
    scene.range_noise_m = noise_m;
  }
  const double roll_deg = chance.uniform(1, 4);
  scene.roll_deg = chance_of(0.1, chance) ? roll_deg : 0;
  scene.robots_seen = chance_of(0.1, chance) ? 1 : 0;
}

void choose_mapping(worlds::SceneOptions& scene, RandomStream& chance) {
  scene.mapping = pick(kMappings, chance);
  scene.drift_m = chance.uniform(0, 0.04);
  const double bent = chance.uniform();
  scene.drift_deg = 0.6 * bent * std::sqrt(bent);
  scene.pose_noise_m = chance.uniform(0.01, 0.08);
  scene.pose_noise_deg = chance.uniform(0.2, 1.2);
}

void choose_grid(worlds::SceneOptions& scene, RandomStream& chance) {
  scene.resolution_m = std::stod(pick(kResolutions, chance));
  scene.probabilistic = chance_of(0.15, chance);
  const double yaw_deg = chance.uniform(-180, 180);
  scene.origin_yaw_deg = chance_of(0.15, chance) ? yaw_deg : 0;
}

}  // namespace

DrawnScene drawn_scene(std::uint64_t seed, std::uint64_t index) {
  RandomStream chance(seed, "verdict/scene", index);
  const bool overlaps = index % 2 == 0;
  worlds::SceneOptions scene;
  scene.kind = pick(kWorlds, chance);
  scene.relation = overlaps ? "overlap" : kApart[(index / 2) % kApart.size()];
  scene.kind = scene.relation == "two_floors" ? "floors" : scene.kind;
  scene.seed = static_cast<int>(chance.below(1U << 30));
  // The source's robot visits a share of the world from the right; the target's comes as far as to know a part of that.
  scene.source_share = chance.uniform(0.3, 0.9);
  scene.target_share = std::min(1.0, 1 - scene.source_share + chance.uniform(0, 1) * scene.source_share);
  scene.rotation_deg = chance.uniform(-180, 180);
  const double larger = chance.uniform(0.8, 1.7);
  if (chance_of(0.3, chance) && worlds::world_grows(scene.kind)) {
    scene.length_m = larger * worlds::usual_length_m(scene.kind);
  }
  const double rearranged = chance.uniform(0.1, 0.8);
  const double visit = chance.uniform();
  if (overlaps && worlds::world_is_furnished(scene.kind)) {
    scene.rearranged_share = visit < 0.4 ? rearranged : 0;
    scene.cleared = visit > 0.85;  // as a plan shows it
  }
  choose_sight(scene, chance);
  choose_mapping(scene, chance);
  choose_grid(scene, chance);
  // Turned by half, or moved along, these fit themselves as well, wherever the robots were.
  const bool self_similar = scene.kind == "hall" ? scene.relation != "two_buildings"
                                                 : scene.kind == "corridor" && scene.relation != "two_buildings";
  return {.kind = self_similar ? "ambiguous" : scene.relation, .options = scene};
}

}  // namespace gridmerge::verdict_study
