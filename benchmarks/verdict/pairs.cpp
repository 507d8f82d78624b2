#include "verdict/pairs.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/parallel.hpp"
#include "gridmerge/base/random.hpp"
#include "map_server/map_files.hpp"
#include "verdict/derived.hpp"
#include "verdict/drawn_scenes.hpp"

namespace gridmerge::verdict_study {
namespace {

constexpr double kErasedReach = 1;        // [m]
constexpr double kLeastErasedArea = 60;   // [m2]
constexpr double kLeastErasedWalls = 40;  // [m]
constexpr double kLeastSplitArea = 180;   // [m2]
constexpr double kLeastHalfArea = 60;     // [m2]
constexpr double kSplitGap = 1;           // [m]
constexpr double kLeastOverlap = 0.01;    // of a drawn pair that is to overlap
constexpr double kDrawnTolerance = 0.5;   // [m]
constexpr double kDrawnToleranceDeg = 3;

/// A map that a manifest names.
struct NamedMap {
  std::string set;
  std::string name;
  std::filesystem::path yaml;
  bool of_its_place = false;  ///< some pair of the set says so; other maps may show any building
  std::size_t fingerprint = 0;
  double area_m2 = 0;
};

std::vector<NamedMap> maps_of(const std::vector<ManifestPair>& pairs, int threads) {
  std::vector<NamedMap> maps;
  const auto add = [&](const ManifestPair& pair, const std::string& name, const std::filesystem::path& yaml) {
    auto found = std::find_if(maps.begin(), maps.end(), [&](const NamedMap& map) { return map.yaml == yaml; });
    if (found == maps.end()) {
      found = maps.insert(found, {.set = pair.set, .name = name, .yaml = yaml});
    }
    found->of_its_place = found->of_its_place || pair.truth.has_value();
  };
  for (const ManifestPair& pair : pairs) {
    add(pair, pair.target_name, pair.target_yaml);
    add(pair, pair.source_name, pair.source_yaml);
  }
  parallel_for(maps.size(), threads, [&](std::size_t i, std::size_t) {
    const KnownCells known = known_cells(read_map(maps[i].yaml));
    maps[i].fingerprint = known.fingerprint;
    maps[i].area_m2 = known.area_m2;
  });
  return maps;
}

/// Sets of one building bear one name: that of the first.
class Places {
 public:
  Places(const std::vector<ManifestPair>& pairs, const std::vector<std::vector<std::string>>& same_building) {
    for (const ManifestPair& pair : pairs) {
      places_[pair.set] = pair.set;
    }
    for (const std::vector<std::string>& group : same_building) {
      for (const std::string& set : group) {
        if (!places_.contains(set)) {
          throw InputError("--same-building", "there is no set " + set + " in the manifests");
        }
        places_[set] = group.front();
      }
    }
  }
  [[nodiscard]] const std::string& of(const std::string& set) const { return places_.at(set); }

 private:
  std::map<std::string, std::string> places_;
};

PairPlan plan_of(const ManifestPair& pair, const char* kind, const Places& places) {
  return {.kind = kind,
          .set = pair.set,
          .places = places.of(pair.set),
          .target_name = pair.target_name,
          .source_name = pair.source_name,
          .target_yaml = pair.target_yaml,
          .source_yaml = pair.source_yaml,
          .truth = pair.truth,
          .scene = {}};
}

PairPlan plan_of(const NamedMap& target, const NamedMap& source, const char* kind, const Places& places) {
  const std::string& first = places.of(target.set);
  const std::string& second = places.of(source.set);
  return {.kind = kind,
          .set = target.set,
          .places = first == second ? first : first + "+" + second,
          .target_name = target.name,
          .source_name = source.name,
          .target_yaml = target.yaml,
          .source_yaml = source.yaml,
          .truth = {},
          .scene = {}};
}

std::vector<PairPlan> cross_plans(const std::vector<NamedMap>& maps, const Places& places, const PairOptions& options) {
  std::vector<const NamedMap*> usable;
  std::set<std::pair<std::string, std::size_t>> shown;  // set, fingerprint
  for (const NamedMap& map : maps) {
    shown.emplace(map.set, map.fingerprint);
    if (map.of_its_place) {
      usable.push_back(&map);
    }
  }
  std::set<std::pair<const NamedMap*, const NamedMap*>> taken;
  RandomStream chance(options.seed, "verdict/cross");
  const auto any = [&]() { return usable[chance.below(static_cast<std::uint32_t>(usable.size()))]; };
  const auto wanted = static_cast<std::size_t>(options.cross);
  for (std::size_t tries = 100 * wanted; tries > 0 && taken.size() < wanted && !usable.empty(); --tries) {
    const NamedMap* target = any();
    const NamedMap* source = any();
    if (places.of(target->set) != places.of(source->set) && !shown.contains({target->set, source->fingerprint}) &&
        !shown.contains({source->set, target->fingerprint})) {
      taken.emplace(target, source);
    }
  }
  std::vector<PairPlan> plans;
  for (const auto& [target, source] : taken) {  // in the order of the manifests
    plans.push_back(plan_of(*target, *source, "cross", places));
  }
  return plans;
}

std::vector<PairPlan> split_plans(const std::vector<NamedMap>& maps, const Places& places) {
  std::vector<PairPlan> plans;
  std::set<std::size_t> seen;
  for (const NamedMap& map : maps) {
    if (map.area_m2 > kLeastSplitArea && seen.insert(map.fingerprint).second) {
      plans.push_back(plan_of(map, map, "split", places));
    }
  }
  return plans;
}

PairPlan drawn_plan(std::uint64_t seed, std::uint64_t index) {
  DrawnScene scene = drawn_scene(seed, index);
  return {.kind = scene.kind,
          .set = scene.options.kind,
          .places = scene.options.kind,
          .target_name = "drawn_" + std::to_string(index) + "_a",
          .source_name = "drawn_" + std::to_string(index) + "_b",
          .target_yaml = {},
          .source_yaml = {},
          .truth = {},
          .scene = std::move(scene.options)};
}

StudyPair drawn_pair(const PairPlan& plan) {
  worlds::MapPair drawn = worlds::make_scene(plan.scene);
  StudyPair pair = {.target = std::move(drawn.target),
                    .source = std::move(drawn.source),
                    .truth = "different",
                    .pose = {},
                    .overlap = drawn.overlap};
  if (plan.kind == "ambiguous") {
    pair.truth = "ambiguous";
  } else if (drawn.truth_is_same && drawn.overlap >= kLeastOverlap) {
    pair.truth = "same";
    pair.pose = {drawn.met_target_from_source, kDrawnTolerance, radians(kDrawnToleranceDeg)};
    pair.met_residual_m = drawn.met_residual_m;
  }
  return pair;
}

}  // namespace

std::vector<PairPlan> plan_pairs(const PairOptions& options) {
  std::vector<ManifestPair> known;
  for (const std::filesystem::path& manifest : options.manifests) {
    const std::vector<ManifestPair> pairs = read_manifest(manifest);
    known.insert(known.end(), pairs.begin(), pairs.end());
  }
  const Places places(known, options.same_building);
  const std::vector<NamedMap> maps = maps_of(known, options.threads);

  std::vector<PairPlan> plans;
  for (const char* kind : {"pair", "erased", "cut", "cut", "cut", "cut", "cut", "flipped"}) {
    for (const ManifestPair& pair : known) {
      if (pair.truth || std::string(kind) == "pair") {
        plans.push_back(plan_of(pair, kind, places));
      }
    }
  }
  for (const std::vector<PairPlan>& more : {split_plans(maps, places), cross_plans(maps, places, options)}) {
    plans.insert(plans.end(), more.begin(), more.end());
  }
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(options.scenes); ++i) {
    plans.push_back(drawn_plan(options.seed, i));
  }
  for (std::size_t i = 0; i < plans.size(); ++i) {
    plans[i].seed = options.seed;
    plans[i].index = i;
  }
  return plans;
}

std::optional<StudyPair> build_pair(const PairPlan& plan) {
  if (plan.target_yaml.empty()) {
    return drawn_pair(plan);
  }
  StudyPair pair = {
      .target = read_map(plan.target_yaml), .source = read_map(plan.source_yaml), .truth = "different", .pose = {}};
  RandomStream chance(plan.seed, "verdict/" + plan.kind, plan.index);
  if (plan.kind == "erased") {
    pair.source = erase_overlap(pair.target, std::move(pair.source), plan.truth->target_from_source, kErasedReach);
    const KnownCells left = known_cells(pair.source);
    if (left.area_m2 <= kLeastErasedArea || left.walls_m <= kLeastErasedWalls) {
      return std::nullopt;
    }
  } else if (plan.kind == "split") {
    const double heading_rad = known_cells(pair.target).principal_rad + chance.uniform(-0.5, 0.5);
    const double share = chance.uniform(0.4, 0.6);
    std::tie(pair.target, pair.source) = split_in_two(pair.source, heading_rad, share, kSplitGap);
    if (std::min(known_cells(pair.target).area_m2, known_cells(pair.source).area_m2) <= kLeastHalfArea) {
      return std::nullopt;
    }
  } else if (plan.kind == "flipped") {
    pair.source = mirrored(std::move(pair.source));
  } else if (plan.truth) {
    pair.truth = "same";
    pair.pose = plan.truth;
    if (plan.kind == "cut") {
      const double heading_rad = chance.uniform(-kPi, kPi);
      std::optional<OccupancyGrid> cut = cut_to_overlap(pair.target, pair.source, plan.truth->target_from_source,
                                                        heading_rad, chance.uniform(0.15, 0.95));
      if (!cut) {
        return std::nullopt;
      }
      pair.source = *std::move(cut);
    }
    pair.overlap = worlds::overlap_of(pair.target, pair.source, plan.truth->target_from_source);
  }
  return pair;
}

}  // namespace gridmerge::verdict_study
