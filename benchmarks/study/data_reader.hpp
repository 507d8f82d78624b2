#pragma once
/// The part `data` of a study's YAML: scenes, swarms, manifests and folders, unfolded into pairs.
#include <filesystem>
#include <vector>

#include "config/yaml_text.hpp"
#include "study/study.hpp"

namespace gridmerge::study {

struct Tolerance {
  double m = 0.5;
  double deg = 3;

  void describe(OptionList& list);
  /// Sets what the entry gives; problems are noted.
  void read(const YamlEntry& entry, FileProblems& problems);
};

/// What the data's entries refer to.
struct DataContext {
  std::filesystem::path folder;  ///< where relative paths begin
  Tolerance tolerance;           ///< where neither the entry nor a manifest says another
  const std::vector<WindowChoice>& windows;
};

/// The pairs of all entries, in the order written. Problems are noted.
[[nodiscard]] std::vector<PairChoice> read_data(const YamlEntry& data, const DataContext& context,
                                                FileProblems& problems);

}  // namespace gridmerge::study
