#pragma once
/// Configuration files: options from YAML, and options as YAML.
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml_text.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

/// One configuration file. Values stand at the top level, options in the section named for the part they belong to:
///
///     method: genetic
///     genetic: {population: 300}
///     evaluator:
///       min_overlap_m2: 4
///
/// Whoever understands keys asks for them, with `value` or `apply`; then `check` tells every problem at once. A key
/// that nobody asked for is a problem, so ask for everything that a file may hold before `check`.
class ConfigFile {
 public:
  /// @throws InputError naming the file, if it cannot be read or is not one YAML mapping. (An empty file is: of none.)
  [[nodiscard]] static ConfigFile read(const std::filesystem::path& file);
  /// The same from memory; `name` stands for the file in messages.
  [[nodiscard]] static ConfigFile parse(std::string_view text, const std::string& name);

  [[nodiscard]] const std::string& name() const { return problems_.file(); }
  /// Top-level keys that hold a mapping, in the order written.
  [[nodiscard]] std::vector<std::string> sections() const;

  /// The text at a top-level key; none if it is not given.
  [[nodiscard]] std::optional<std::string> value(const std::string& key);

  /// The texts of a top-level sequence, or of a single value; none if it is not given.
  [[nodiscard]] std::vector<std::string> values(const std::string& key);

  /// Sets every option that the section gives; the others keep their values, and so does one with a problem.
  /// A section of several lists is applied once for each. kTopLevel applies the keys outside of all sections.
  void apply(const std::string& section, OptionList& options);
  static constexpr const char* kTopLevel = "";

  /// Adds a problem that only the caller can see, at a top-level key: `rule` says what is wrong with its value.
  void reject(const std::string& key, const std::string& rule);

  /// @throws InputError with a line "file:line: problem" for each: values refused (key, value, rule), keys unknown
  /// (with the known ones) or repeated.
  void check() const;

 private:
  ConfigFile(std::vector<YamlEntry> entries, std::string name);

  std::vector<YamlEntry> entries_;
  std::map<std::string, std::vector<std::string>> known_keys_;  ///< asked for so far, by section
  FileProblems problems_;
};

/// The options with the values they have now, as a section that `apply` reads back; kTopLevel writes them bare.
[[nodiscard]] std::string to_yaml(const std::string& section, const OptionList& options);

}  // namespace gridmerge
