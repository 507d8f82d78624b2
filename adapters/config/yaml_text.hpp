#pragma once
/// YAML as plain text with line numbers, and the problems found in it: what the readers of configuration and of map
/// descriptions share.
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmerge {

/// One entry of a mapping (with a key) or of a sequence (without). No type is guessed: `text` is what the file says.
struct YamlEntry {
  enum class Kind { kEmpty, kScalar, kSequence, kMapping };
  std::string key;
  int line = 0;  ///< from 1
  Kind kind = Kind::kEmpty;
  std::string text;                 ///< of a scalar
  std::vector<YamlEntry> children;  ///< of a sequence or mapping; parse_yaml_mapping keeps those of the top level
};

/// The entries of a document that is one mapping, in the order written, repeated keys included. An empty document has
/// none.
/// @throws InputError naming file and line, if the text is not YAML, or not one mapping with plain keys.
[[nodiscard]] std::vector<YamlEntry> parse_yaml_mapping(std::string_view text, const std::string& file);

/// The same with everything below the top level too, for files that nest deeper than a configuration.
/// @throws InputError naming file and line, also for a document that unfolds to more than a person would write
[[nodiscard]] std::vector<YamlEntry> parse_yaml_tree(std::string_view text, const std::string& file);

/// The entry of that key; null where there is none.
[[nodiscard]] const YamlEntry* find_entry(const std::vector<YamlEntry>& entries, std::string_view key);

/// The text as YAML would write it: quoted where a reader could take it for something else than this text.
[[nodiscard]] std::string yaml_word(const std::string& text);

/// The text with A .. Z made small.
[[nodiscard]] std::string lower_case(std::string text);

/// Problems of one file, collected so that all are told at once.
class FileProblems {
 public:
  explicit FileProblems(std::string file) : file_(std::move(file)) {}

  /// A problem told twice counts once. Line 0: it concerns no line in particular.
  void add(int line, std::string problem) { problems_.emplace(line, std::move(problem)); }
  void add_repeated_keys(const std::vector<YamlEntry>& entries);
  void add_unknown_key(const YamlEntry& entry, const std::vector<std::string>& known);

  [[nodiscard]] const std::string& file() const { return file_; }
  /// @throws InputError with a line "file:line: problem" for each problem, if there are any.
  void throw_if_any() const;

 private:
  std::string file_;
  std::set<std::pair<int, std::string>> problems_;  ///< by line
};

}  // namespace gridmerge
