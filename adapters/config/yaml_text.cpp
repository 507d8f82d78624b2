#include "config/yaml_text.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <sstream>

#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

/// Deeper entries are never asked for, and leaving them out keeps a document of nested aliases small.
constexpr int kDepth = 2;

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

std::vector<YamlEntry> children_of(const YAML::Node& parent, int depth, const std::string& file);

YamlEntry entry_of(const YAML::Node& node, int depth, const std::string& file) {
  YamlEntry entry;
  entry.line = line_of(node.Mark());
  if (node.IsScalar()) {
    entry.kind = YamlEntry::Kind::kScalar;
    entry.text = node.Scalar();
  } else if (node.IsSequence() || node.IsMap()) {
    entry.kind = node.IsMap() ? YamlEntry::Kind::kMapping : YamlEntry::Kind::kSequence;
    entry.children = children_of(node, depth - 1, file);
  }
  return entry;
}

std::vector<YamlEntry> children_of(const YAML::Node& parent, int depth, const std::string& file) {
  std::vector<YamlEntry> children;
  if (depth == 0) {
    return children;
  }
  for (const auto& child : parent) {
    if (!parent.IsMap()) {
      children.push_back(entry_of(child, depth, file));
      continue;
    }
    const YAML::Node key = child.first;
    if (!key.IsScalar()) {
      throw InputError(place(file, line_of(key.Mark())), "a key must be a single word");
    }
    children.push_back(entry_of(child.second, depth, file));
    children.back().key = key.Scalar();
    children.back().line = line_of(key.Mark());
  }
  return children;
}

}  // namespace

std::vector<YamlEntry> parse_yaml_mapping(std::string_view text, const std::string& file) {
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
    return children_of(document, kDepth, file);
  } catch (const YAML::Exception& error) {
    throw InputError(place(file, line_of(error.mark)), "is not YAML: " + error.msg);
  }
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
