#pragma once
/// What is expected of each method on a pair of maps: learned from the rows of a study, kept in a YAML file.
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/select/scene_features.hpp"

namespace gridmerge {

/// Inputs by name.
using NamedValues = std::vector<std::pair<std::string, double>>;

/// What a bid is computed from: of a pair of maps, and of what is known beforehand.
class BidInputs {
 public:
  BidInputs(const SceneFeatures& target, const SceneFeatures& source, const std::optional<PosePrior>& prior);

  /// Name and value of each; stable names, as in the selector's YAML. The first is `bias`, always 1.
  [[nodiscard]] const NamedValues& named() const { return named_; }
  /// The names alone, with what each means.
  [[nodiscard]] static std::vector<FeatureText> texts();
  [[nodiscard]] static std::vector<std::string> names();

 private:
  NamedValues named_;
};

/// A weighted sum of inputs. What has no weight counts nothing.
struct WeightedSum {
  NamedValues weights;  ///< by name of the input

  [[nodiscard]] double of(const NamedValues& inputs) const;
};

/// What the book knows of one method.
struct BidModel {
  std::string method;
  WeightedSum success;      ///< log odds that its answer is merged rightly, where the maps overlap
  WeightedSum log_seconds;  ///< natural logarithm of the time of the whole alignment [s], on one thread
};

/// All that is learned.
struct BidBook {
  std::vector<BidModel> methods;
  /// Log odds that another method merges rightly what the first did not merge, from what the first one's verdict was:
  /// inputs `bias`, `log_odds` (of its confidence), `above_half` (the same where it is above a half, else 0: a near
  /// miss, for where a gate is broken the confidence is at most a half) and `ambiguous` (1 or 0).
  WeightedSum second_chance;
};

/// What `second_chance` weighs, of the verdict that did not merge. The first is `bias`, always 1.
[[nodiscard]] NamedValues second_chance_inputs(double confidence, bool is_ambiguous);
/// The names alone.
[[nodiscard]] std::vector<std::string> second_chance_names();

/// The book's bid; none where it does not know the method.
[[nodiscard]] std::optional<Bid> bid_of(const BidBook& book, std::string_view method, const BidInputs& inputs);

}  // namespace gridmerge
