#include "cli/json.hpp"

#include "cli/text.hpp"

namespace gridmerge::cli {

Json pose_json(const Pose2& pose) { return {{"x", pose.x_m}, {"y", pose.y_m}, {"theta", pose.theta_rad}}; }

Json covariance_json(const std::optional<PoseCovariance>& covariance) {
  if (!covariance) {
    return nullptr;
  }
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    rows.push_back({(*covariance)(row, 0), (*covariance)(row, 1), (*covariance)(row, 2)});
  }
  return rows;
}

Json figures_json(const Figures& figures, const Verdict& verdict, const RandomLevel& random_level) {
  Json json = Json::object();
  for (const auto& [name, value] : figures.named()) {
    json[name] = value;
  }
  json["lead"] = verdict.lead;
  json["lead_m"] = verdict.lead_m;
  json["deviations"] = verdict.deviations;
  json["decoy"] = verdict.decoy;
  json["random_mean_m"] = random_level.mean_m;
  json["random_deviation_m"] = random_level.deviation_m;
  json["random_poses"] = random_level.poses;
  return json;
}

Json attempts_json(const std::vector<Attempt>& attempts) {
  Json json = Json::array();
  for (const Attempt& one : attempts) {
    json.push_back(
        {{"method", one.method}, {"why", one.why}, {"status", status_of(one.outcome)}, {"confidence", one.confidence}});
  }
  return json;
}

Json alignment_json(const Alignment& alignment) {
  const Hypothesis* best = alignment.hypotheses.empty() ? nullptr : &alignment.hypotheses.front();
  Json hypotheses = Json::array();
  for (const Hypothesis& one : alignment.hypotheses) {
    const Figures& f = one.figures;
    const double best_m = best->figures.evidence_m;
    hypotheses.push_back({{"transform", pose_json(one.target_from_source.pose)},
                          {"covariance", covariance_json(one.target_from_source.covariance)},
                          {"evidence_m", f.evidence_m},
                          {"evidence_share", best_m > 0 ? Json(f.evidence_m / best_m) : Json()},  // of the best
                          {"same_side_m", f.source_in_target.same_side_m + f.target_in_source.same_side_m},
                          {"in_free_m", f.source_in_target.in_free_m + f.target_in_source.in_free_m},
                          {"conflict_share", f.conflict_share},
                          {"same_side_share", f.same_side_share},
                          {"method_score", one.method_score}});
  }
  return {{"status", status_of(alignment.outcome)},
          {"transform", best == nullptr ? Json() : pose_json(best->target_from_source.pose)},
          {"covariance", best == nullptr ? Json() : covariance_json(best->target_from_source.covariance)},
          {"confidence", alignment.confidence},
          {"reasons", reasons_of(alignment)},
          {"remarks", alignment.remarks},
          {"hypotheses", hypotheses},
          {"figures",
           best == nullptr ? Json::object() : figures_json(best->figures, alignment.verdict, alignment.random_level)},
          {"attempts", attempts_json(alignment.attempts)},
          {"choice", alignment.story},
          {"iterations", alignment.iterations},
          {"stopped", alignment.stopped}};
}

Json prior_json(const std::optional<PosePrior>& prior) {
  if (!prior) {
    return nullptr;
  }
  Json json = pose_json(prior->target_from_source);
  json["radius_m"] = prior->radius_m ? Json(*prior->radius_m) : Json();
  json["angle_deg"] = prior->angle_rad ? Json(degrees(*prior->angle_rad)) : Json();
  return json;
}

Json seconds_json(double load, const StepSeconds& seconds) {
  return {{"load", load},
          {"prepare", seconds.prepare},
          {"choose", seconds.choose},
          {"propose", seconds.propose},
          {"refine", seconds.refine},
          {"judge", seconds.judge},
          {"align", seconds.align}};
}

Json configuration_json(Configuration& configuration) {
  Json options = Json::object();
  for (const Configuration::Section& section : configuration.sections()) {
    options[section.name] = options_json(section.options);
  }
  Json plugins = Json::array();
  for (const std::filesystem::path& plugin : configuration.plugins()) {
    plugins.push_back(plugin.string());
  }
  return {{"method", configuration.method()},
          {"profile", configuration.profile()},
          {"plugins", plugins},
          {"bids", configuration.bids().empty() ? Json() : Json(configuration.bids().string())},
          {"seed", configuration.seed()},
          {"threads", configuration.threads()},
          {"options", options}};
}

Json options_json(const OptionList& options) {
  Json json = Json::object();
  for (const OptionField& field : options.fields()) {
    json[field.key] = option_value_json(field);
  }
  return json;
}

Json option_value_json(const OptionField& field) {
  return std::visit([](const auto* value) { return Json(*value); }, field.value);
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace gridmerge::cli
