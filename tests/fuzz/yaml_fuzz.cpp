// Any bytes as a YAML file: as the description of a map and as a configuration they are refused with an InputError, or
// what they say keeps every rule.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "config/config_file.hpp"
#include "gridmerge/base/error.hpp"
#include "map_server/map_files.hpp"

namespace {

using namespace gridmerge;

struct SomeOptions {
  bool flag = false;
  int count = 3;
  double rate = 0.5;
  std::string policy = "mean";

  void describe(OptionList& list) {
    list.add("flag", flag, {}).add("count", count, 1, 9, {}).add("rate", rate, 0, 1, {});
    list.add("policy", policy, {"mean", "off"}, {});
  }
};

void demand(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void try_map(std::string_view text) {
  try {
    const MapDescription map = parse_map_description(text, "map.yaml");
    const Pose2& origin = map.map_from_grid;
    demand(!map.image.empty() && std::isfinite(map.resolution_m) && map.resolution_m > 0);
    demand(std::isfinite(origin.x_m) && std::isfinite(origin.y_m) && std::isfinite(origin.theta_rad));
    demand(map.free_thresh >= 0 && map.free_thresh <= map.occupied_thresh && map.occupied_thresh <= 1);
  } catch (const InputError&) {
  }
}

void try_config(std::string_view text) {
  SomeOptions options;
  OptionList list = option_list(options);
  try {
    ConfigFile file = ConfigFile::parse(text, "config.yaml");
    (void)file.value("method");
    file.apply(ConfigFile::kTopLevel, list);
    file.apply("toy", list);
    file.reject("profile", "is not known");
    demand(list.problems().empty());
    file.check();
    std::abort();  // at least the key rejected is a problem
  } catch (const InputError&) {
  }
}

void try_word(std::string_view text) {
  const bool is_ascii = std::all_of(text.begin(), text.end(), [](char c) { return c >= 0; });
  if (is_ascii) {
    const auto entries = parse_yaml_mapping("key: " + yaml_word(std::string(text)) + "\n", "word.yaml");
    demand(entries.size() == 1 && entries.front().text == text);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try_map(text);
  try_config(text);
  try_word(text);
  return 0;
}
