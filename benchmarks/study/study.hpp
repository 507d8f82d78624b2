#pragma once
/// A study as its YAML file says it, with every list and range unfolded: what is to be run, and nothing of how.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gridmerge/align/registry.hpp"
#include "manifest/manifest.hpp"
#include "worlds/scene.hpp"

namespace gridmerge::study {

/// A method with the options that it runs with.
struct MethodChoice {
  std::string method;
  std::string profile;
  std::vector<std::string> set;  ///< what differs from the profile: "section.key=value"
};

/// Where a method may look.
struct WindowChoice {
  enum class Around {
    kAnywhere,  ///< no window
    kStart,     ///< the map frames are one: both robots started on one spot, with one heading, at the frames' origins
    kMiddle,    ///< the same, started at the middle cell of each grid, as HectorSLAM does, whatever the origin says
    kTruth,     ///< the truth, moved and turned by chance within the window
  };
  std::string name = "none";
  Around around = Around::kAnywhere;
  double share = 0;  ///< > 0: the radius is this share of half the target grid's side, the angle that of 180 degrees
  double least_deg = 0;  ///< with a share: the angle is no less
  double radius_m = 0;   ///< without a share
  double angle_deg = 0;
};

struct SceneMaps {
  worlds::SceneOptions scene;
};
struct SwarmMaps {
  worlds::SceneOptions scene;
  int robots = 2;
};
struct FileMaps {
  std::filesystem::path target_yaml;
  std::filesystem::path source_yaml;
  std::string truth;               ///< same, different, unknown
  std::optional<KnownPose> known;  ///< where same
};

/// Two maps, or those of a swarm, to be merged.
struct PairChoice {
  std::string set;
  std::string name;  ///< within the set
  std::variant<SceneMaps, SwarmMaps, FileMaps> maps;
  double tolerance_m = 0;  ///< of an answer's error, to be right
  double tolerance_deg = 0;
  std::vector<std::size_t> windows;  ///< into Study::windows, ascending; a swarm has none: it runs without a window

  [[nodiscard]] bool is_swarm() const { return std::holds_alternative<SwarmMaps>(maps); }
};

struct Study {
  std::string name;
  std::string about;
  std::vector<std::uint64_t> seeds;
  std::vector<MethodChoice> methods;
  std::vector<PairChoice> pairs;
  std::vector<WindowChoice> windows;
  std::vector<std::filesystem::path> plugins;
  bool curves = false;  ///< every iteration is kept
  int threads = 1;      ///< of each run
  std::string text;     ///< the YAML
};

/// Paths in it are relative to the file. Everything is checked: names, ranges, options that do not go together.
/// @throws InputError with a line "file:line: problem" for every problem
[[nodiscard]] Study read_study(const std::filesystem::path& yaml);
/// The same from memory. `name` stands for the file in messages; `folder` is where its paths begin.
[[nodiscard]] Study parse_study(std::string_view text, const std::string& name, const std::filesystem::path& folder);

/// The methods that a study can choose from: those of the house and those of its plugins.
[[nodiscard]] MethodRegistry methods_of(const std::vector<std::filesystem::path>& plugins);

}  // namespace gridmerge::study
