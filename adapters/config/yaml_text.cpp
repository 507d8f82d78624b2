#include "config/yaml_text.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>

#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

std::string place(const std::string& file, int line) { return line > 0 ? file + ":" + std::to_string(line) : file; }

int line_of(const YAML::Mark& mark) { return mark.is_null() ? 0 : mark.line + 1; }

/// Hears a document and keeps nothing of it.
class DeafHandler : public YAML::EventHandler {
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// Not by YAML::LoadAll, which never returns for some malformed text (", x").
bool holds_another_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DeafHandler handler;
  return parser.HandleNextDocument(handler) && parser.HandleNextDocument(handler);
}

/// How much of a document is kept: nested aliases make a small file unfold to a huge tree.
struct Limits {
  int depth = 0;
  int entries = 0;
  bool refuse_deeper = false;  ///< otherwise what lies deeper is left out
};
/// Of a configuration, deeper entries are never asked for.
constexpr Limits kMappingLimits = {.depth = 2, .entries = std::numeric_limits<int>::max(), .refuse_deeper = false};
constexpr Limits kTreeLimits = {.depth = 16, .entries = 200000, .refuse_deeper = true};

class TreeReader {
 public:
  TreeReader(const std::string& file, const Limits& limits) : file_(file), limits_(limits) {}

  /// @param depth  of the children, from 1
  std::vector<YamlEntry> children_of(const YAML::Node& parent, int depth) {
    std::vector<YamlEntry> children;
    if (depth > limits_.depth && !limits_.refuse_deeper) {
      return children;
    }
    for (const auto& child : parent) {
      if (!parent.IsMap()) {
        children.push_back(entry_of(child, depth));
        continue;
      }
      const YAML::Node key = child.first;
      if (!key.IsScalar()) {
        throw InputError(place(file_, line_of(key.Mark())), "a key must be a single word");
      }
      children.push_back(entry_of(child.second, depth));
      children.back().key = key.Scalar();
      children.back().line = line_of(key.Mark());
    }
    return children;
  }

 private:
  YamlEntry entry_of(const YAML::Node& node, int depth) {
    YamlEntry entry;
    entry.line = line_of(node.Mark());
    if (++entries_ > limits_.entries || depth > limits_.depth) {
      throw InputError(place(file_, entry.line), "holds too much, or nests too deep");
    }
    if (node.IsScalar()) {
      entry.kind = YamlEntry::Kind::kScalar;
      entry.text = node.Scalar();
    } else if (node.IsSequence() || node.IsMap()) {
      entry.kind = node.IsMap() ? YamlEntry::Kind::kMapping : YamlEntry::Kind::kSequence;
      entry.children = children_of(node, depth + 1);
    }
    return entry;
  }

  const std::string& file_;
  Limits limits_;
  int entries_ = 0;
};

std::vector<YamlEntry> parse(std::string_view text, const std::string& file, const Limits& limits) {
  try {
    const YAML::Node document = YAML::Load(std::string(text));
    if (holds_another_document(std::string(text))) {
      throw InputError(file, "holds more than one YAML document");
    }
    if (document.IsNull()) {
      return {};
    }
    if (!document.IsMap()) {
      throw InputError(file, "is not a YAML mapping (lines of 'key: value')");
    }
    return TreeReader(file, limits).children_of(document, 1);
  } catch (const YAML::Exception& error) {
    throw InputError(place(file, line_of(error.mark)), "is not YAML: " + error.msg);
  }
}

}  // namespace

std::vector<YamlEntry> parse_yaml_mapping(std::string_view text, const std::string& file) {
  return parse(text, file, kMappingLimits);
}

std::vector<YamlEntry> parse_yaml_tree(std::string_view text, const std::string& file) {
  return parse(text, file, kTreeLimits);
}

const YamlEntry* find_entry(const std::vector<YamlEntry>& entries, std::string_view key) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const YamlEntry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::string yaml_word(const std::string& text) {
  static const std::set<std::string> reserved = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"};
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto is_plain = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; };
  if (!text.empty() && is_letter(text.front()) && std::all_of(text.begin(), text.end(), is_plain) &&
      !reserved.contains(lower_case(text))) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char escaped[5];
      std::snprintf(escaped, sizeof escaped, "\\x%02X", static_cast<unsigned>(c));
      quoted += escaped;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

void FileProblems::add_repeated_keys(const std::vector<YamlEntry>& entries) {
  std::map<std::string_view, int> first_line;
  for (const YamlEntry& entry : entries) {
    const auto [first, is_new] = first_line.emplace(entry.key, entry.line);
    if (!is_new) {
      add(entry.line, "repeated key '" + entry.key + "', first given on line " + std::to_string(first->second));
    }
  }
}

void FileProblems::add_unknown_key(const YamlEntry& entry, const std::vector<std::string>& known) {
  std::string list;
  for (const std::string& key : known) {
    list += list.empty() ? "" : ", ";
    list += key;
  }
  add(entry.line, "unknown key '" + entry.key + "'; known keys: " + list);
}

void FileProblems::throw_if_any() const {
  if (problems_.empty()) {
    return;
  }
  std::string rest = problems_.begin()->second;
  for (auto problem = std::next(problems_.begin()); problem != problems_.end(); ++problem) {
    rest += '\n';
    rest += place(file_, problem->first) + ": " + problem->second;
  }
  throw InputError(place(file_, problems_.begin()->first), rest);
}

}  // namespace gridmerge
