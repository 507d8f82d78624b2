#pragma once
/// What a map looks like, in a few numbers: what the selector chooses a method by (seed 5.1).
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// Of one map. Turning or moving the map changes them little: as much as its cells change.
struct SceneFeatures {
  /// Concentration of the Hough spectrum (Eq. 2.9 [carpin2008]): 1 - mean / maximum over all directions. 0: walls of
  /// every direction, or none; an office comes to 0.7 and more, a forest to 0.3 and less.
  double straightness = 0;
  /// Dominant directions of walls, modulo half a turn: maxima of the smoothed spectrum above 0.3 of the way from its
  /// mean to its maximum.
  int directions = 0;
  double occupied_cells = 0;  ///< at the prepared resolution
  double known_area_m2 = 0;
  /// Share of the occupied cells that lie in pieces less than a metre wide each way: trunks, chair legs, specks.
  double clutter = 0;
  /// Second peak of the autocorrelation, as a share of the first, 0..1: how well the map fits on itself elsewhere, by
  /// the smooth fitness (walls on walls, walls in free space cost), over all translations and quarter turns. Within
  /// 1.5 m of the first peak nothing counts.
  double self_similarity = 0;
  bool ternary = true;  ///< no cell says anything but free, occupied or unknown

  /// Name and value of each, in the order above; stable names, as in JSON, CSV and the selector's YAML.
  [[nodiscard]] std::vector<std::pair<std::string, double>> named() const;
};

/// Visits name and field of each, in the order above.
template <typename AnyFeatures, typename Visit>
void for_each_feature(AnyFeatures& features, Visit&& visit) {
  visit("straightness", features.straightness);
  visit("directions", features.directions);
  visit("occupied_cells", features.occupied_cells);
  visit("known_area_m2", features.known_area_m2);
  visit("clutter", features.clutter);
  visit("self_similarity", features.self_similarity);
  visit("ternary", features.ternary);
}

/// What a feature is, for people: its unit and one sentence.
struct FeatureText {
  std::string name;
  std::string unit;
  std::string meaning;
};
/// One for each of SceneFeatures::named, in its order.
[[nodiscard]] std::vector<FeatureText> scene_feature_texts();

/// Zeros where the map holds no occupied cell. Some milliseconds.
[[nodiscard]] SceneFeatures scene_features(const PreparedMap& map);

}  // namespace gridmerge
