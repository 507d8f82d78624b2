#include "gridmerge/select/selector.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "gridmerge/base/logistic.hpp"
#include "gridmerge/base/number_text.hpp"
#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

std::string in_words(const Bid& bid) {
  return percent(bid.success) + " to merge rightly, " + fixed(bid.seconds, 2) + " s on one thread";
}

std::string in_words(const std::string& which, const SceneFeatures& f) {
  return which + ": straightness " + fixed(f.straightness, 2) + ", " + std::to_string(f.directions) +
         " directions, clutter " + fixed(f.clutter, 2) + ", self-similarity " + fixed(f.self_similarity, 2) + ", " +
         fixed(f.occupied_cells, 0) + " occupied cells, " + fixed(f.known_area_m2, 0) + " m2 known" +
         (f.ternary ? "" : ", probabilistic");
}

std::string in_words(const std::optional<PosePrior>& prior) {
  if (!prior) {
    return "prior: none";
  }
  if (!prior->radius_m || !prior->angle_rad) {
    return "prior: a start without a fence";
  }
  return "prior: within " + fixed(*prior->radius_m, 1) + " m and " + fixed(degrees(*prior->angle_rad), 0) + " deg";
}

/// One alignment's way down the standings.
class Bidding final : public Choice {
 public:
  Bidding(const Selector& selector, const AlignRequest& request, const RunContext& context)
      : selector_(selector), stop_(context.stop) {
    std::array<SceneFeatures, 2> scene;
    const std::array<const PreparedMap*, 2> maps = {&request.target, &request.source};
    parallel_for(scene.size(), context.num_threads,
                 [&](std::size_t i, std::size_t) { scene[i] = scene_features(*maps[i]); });
    standings_ = selector.standings(request, BidInputs(scene[0], scene[1], request.prior));
    const std::optional<double> left_s = stop_.seconds_left();
    story_ = {in_words("target", scene[0]), in_words("source", scene[1]), in_words(request.prior),
              left_s ? "time: " + fixed(*left_s, 2) + " s left" : "time: no limit"};
    for (const Standing& one : standings_) {
      story_.push_back(one.method + (one.objection ? " objects: " + *one.objection
                                     : one.bid     ? " bids " + in_words(*one.bid)
                                                   : " makes no bid: nothing is known of it"));
    }
  }

  [[nodiscard]] std::optional<MethodPick> next(const std::vector<Attempt>& tried) override {
    if (static_cast<int>(tried.size()) >= selector_.options().at_most) {
      return enough(tried.back(), std::to_string(tried.size()) + " methods were tried, the most that may be");
    }
    const double chance = tried.empty() ? 1 : second_chance(tried.back());
    const Standing* best = best_within_time(tried);
    if (best == nullptr) {
      return tried.empty() ? nothing("no method bids") : enough(tried.back(), "no other method bids");
    }
    if (tried.empty()) {
      return pick(*best, "the fastest of those whose chance is within " + percent(selector_.options().success_slack) +
                             " of the best");
    }
    const double gain = chance * best->bid->success;
    const std::string told = "another method has a chance of " + percent(gain) + " to merge it rightly";
    if (gain < selector_.options().least_gain) {
      return enough(tried.back(), told + ", less than " + percent(selector_.options().least_gain));
    }
    if (const std::optional<double> left_s = stop_.seconds_left(); left_s && best->bid->seconds > *left_s) {
      return enough(tried.back(), told + ", but " + fixed(*left_s, 2) + " s are left");
    }
    return pick(*best, after(tried.back()) + ": " + told);
  }

  [[nodiscard]] std::vector<std::string> story() const override { return story_; }

 private:
  static std::string after(const Attempt& last) {
    return "after " + last.method + " (" + to_string(last.outcome) + ", confidence " + fixed(last.confidence, 2) + ")";
  }

  /// The first of the standings that has a bid, is not tried yet and fits into the time; where none fits, the fastest.
  [[nodiscard]] const Standing* best_within_time(const std::vector<Attempt>& tried) const {
    const std::optional<double> left_s = stop_.seconds_left();
    const Standing* fastest = nullptr;
    for (const Standing& one : standings_) {
      const bool done =
          std::any_of(tried.begin(), tried.end(), [&](const Attempt& a) { return a.method == one.method; });
      if (!one.bid || done) {
        continue;
      }
      if (!left_s || one.bid->seconds <= *left_s) {
        return &one;
      }
      if (fastest == nullptr || one.bid->seconds < fastest->bid->seconds) {
        fastest = &one;
      }
    }
    return fastest;
  }

  [[nodiscard]] double second_chance(const Attempt& last) const {
    return logistic(
        selector_.book().second_chance.of(second_chance_inputs(last.confidence, last.outcome == Outcome::kAmbiguous)));
  }

  [[nodiscard]] std::optional<MethodPick> pick(const Standing& standing, std::string why) {
    story_.push_back(standing.method + " runs: " + why);
    return MethodPick{&selector_.method(standing.method), standing.method, std::move(why)};
  }
  [[nodiscard]] std::optional<MethodPick> enough(const Attempt& last, const std::string& why) {
    story_.push_back("no other runs " + after(last) + ": " + why);
    return std::nullopt;
  }
  [[nodiscard]] std::optional<MethodPick> nothing(const std::string& why) {
    story_.push_back(why);
    return std::nullopt;
  }

  const Selector& selector_;
  StopToken stop_;
  std::vector<Standing> standings_;
  std::vector<std::string> story_;
};

void check_names(const WeightedSum& sum, const std::vector<std::string>& known, const std::string& where) {
  for (const auto& [name, weight] : sum.weights) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      std::string names;
      for (const std::string& one : known) {
        names += (names.empty() ? "" : ", ") + one;
      }
      throw std::invalid_argument("selector: " + where + " weighs " + name + ", which is no input; inputs: " + names);
    }
  }
}

}  // namespace

void SelectorOptions::describe(OptionList& list) {
  list.add("success_slack", success_slack, 0, 1,
           {"", "Of the methods whose expected success is within this of the best one's, the fastest runs first.",
            "0: the most successful one, whatever it costs."})
      .add("least_gain", least_gain, 0, 1,
           {"", "Another method is tried where its chance to merge rightly what was not merged is at least this.",
            "Lower it to try more methods on what looks hopeless; time grows."})
      .add("at_most", at_most, 1, 100, {"methods", "How many methods are tried at the most.", ""});
}

Selector::Selector(std::vector<NamedMethod> methods, BidBook book, SelectorOptions options)
    : methods_(std::move(methods)), book_(std::move(book)), options_(options) {
  require_valid(options_, "selector");
  const std::vector<std::string> inputs = BidInputs::names();
  for (const BidModel& model : book_.methods) {
    check_names(model.success, inputs, model.method + ".success");
    check_names(model.log_seconds, inputs, model.method + ".log_seconds");
  }
  check_names(book_.second_chance, second_chance_names(), "second_chance");
}

std::unique_ptr<Choice> Selector::begin(const AlignRequest& request, const RunContext& context) const {
  announce(context, "choose");
  return std::make_unique<Bidding>(*this, request, context);
}

std::vector<Standing> Selector::standings(const AlignRequest& request, const BidInputs& inputs) const {
  std::vector<Standing> all;
  double most = 0;
  for (const NamedMethod& one : methods_) {
    Standing standing{.method = one.name, .objection = one.method->objection(request), .bid = {}};
    if (!standing.objection) {
      standing.bid = one.method->bid(request);
      standing.bid = standing.bid ? standing.bid : bid_of(book_, one.name, inputs);
    }
    most = std::max(most, standing.bid ? standing.bid->success : 0);
    all.push_back(std::move(standing));
  }
  const double bar = most - options_.success_slack;
  std::stable_sort(all.begin(), all.end(), [&](const Standing& a, const Standing& b) {
    if (!a.bid || !b.bid) {
      return a.bid && !b.bid;
    }
    const bool a_competes = a.bid->success >= bar;
    const bool b_competes = b.bid->success >= bar;
    if (a_competes != b_competes) {
      return a_competes;
    }
    return a_competes ? a.bid->seconds < b.bid->seconds : a.bid->success > b.bid->success;
  });
  return all;
}

const Merger& Selector::method(const std::string& name) const {
  const auto found =
      std::find_if(methods_.begin(), methods_.end(), [&](const NamedMethod& one) { return one.name == name; });
  if (found == methods_.end()) {
    throw std::invalid_argument("the selector has no method " + name);
  }
  return *found->method;
}

}  // namespace gridmerge
