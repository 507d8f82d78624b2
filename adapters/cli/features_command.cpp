#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/json.hpp"
#include "cli/program.hpp"
#include "cli/read_maps.hpp"
#include "cli/text.hpp"
#include "cli/usage_error.hpp"
#include "gridmerge/select/scene_features.hpp"

namespace gridmerge::cli {
namespace {

struct FeaturesArguments {
  std::vector<std::string> files;
  ConfigurationChoice choice;
  bool json = false;
};

SceneFeatures features_of(const OccupancyGrid& map, const Configuration& configuration) {
  const PrepareOptions& options = configuration.pipeline().prepare;
  return scene_features(PreparedMap(map, common_resolution_m(map, map, options), options, configuration.threads()));
}

std::string features_text(const std::string& file, const SceneFeatures& features) {
  std::string text = file + "\n";
  const std::vector<FeatureText> texts = scene_feature_texts();
  const auto values = features.named();
  std::size_t widest = 0;
  for (const FeatureText& one : texts) {
    widest = std::max(widest, one.name.size());
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i].second;
    const std::string number = fixed(value, value == std::floor(value) ? 0 : 3);
    const std::string unit = texts[i].unit.empty() ? "" : " " + texts[i].unit;
    text += "  " + texts[i].name + std::string(widest + 2 - texts[i].name.size(), ' ') + number + unit +
            std::string(number.size() + unit.size() < 14 ? 14 - number.size() - unit.size() : 1, ' ') +
            texts[i].meaning + "\n";
  }
  return text;
}

int run_features(const FeaturesArguments& arguments, const MethodRegistry& methods, std::ostream& out) {
  const Configuration configuration(methods, arguments.choice);
  const std::vector<OccupancyGrid> maps = read_maps(arguments.files, configuration.threads());
  Json all = Json::array();
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const SceneFeatures features = features_of(maps[i], configuration);
    if (!arguments.json) {
      out << (i == 0 ? "" : "\n") << features_text(arguments.files[i], features);
      continue;
    }
    Json one = {{"map", arguments.files[i]}};
    for (const auto& [name, value] : features.named()) {
      one[name] = value;
    }
    all.push_back(std::move(one));
  }
  if (arguments.json) {
    out << json_text(all);
  }
  return kDone;
}

}  // namespace

Command features_command(const CommandContext& context) {
  const auto arguments = std::make_shared<FeaturesArguments>();
  CLI::App* command =
      context.app.add_subcommand("features", "What maps look like, in the numbers that --method auto chooses by");
  command->add_option("MAPS", arguments->files, "Maps (map_server YAML)")->required();
  add_configuration_arguments(*command, arguments->choice);
  command->add_flag("--json", arguments->json, "A JSON array on standard output instead of words");
  command->footer("\nExit status: 0 done, 1 a file is wrong, 2 wrong usage.");
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) { return run_features(*arguments, methods, out); }};
}

}  // namespace gridmerge::cli
