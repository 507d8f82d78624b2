#include "config/config_file.hpp"

#include <algorithm>
#include <utility>

#include "config/read_file.hpp"

namespace gridmerge {
namespace {

using Kind = YamlEntry::Kind;

void remember(std::vector<std::string>& keys, const std::string& key) {
  if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
    keys.push_back(key);
  }
}

bool contains(const std::vector<std::string>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

std::string no_single_value(const std::string& key) { return "'" + key + "' must have a single value"; }

}  // namespace

ConfigFile::ConfigFile(std::vector<YamlEntry> entries, std::string name)
    : entries_(std::move(entries)), problems_(std::move(name)) {
  problems_.add_repeated_keys(entries_);
  for (const YamlEntry& entry : entries_) {
    if (entry.kind == Kind::kMapping) {
      problems_.add_repeated_keys(entry.children);
    }
  }
}

ConfigFile ConfigFile::read(const std::filesystem::path& file) {
  return parse(read_file(file, kMaxYamlBytes), file.string());
}

ConfigFile ConfigFile::parse(std::string_view text, const std::string& name) {
  return {parse_yaml_mapping(text, name), name};
}

std::vector<std::string> ConfigFile::sections() const {
  std::vector<std::string> keys;
  for (const YamlEntry& entry : entries_) {
    if (entry.kind == Kind::kMapping) {
      remember(keys, entry.key);
    }
  }
  return keys;
}

std::optional<std::string> ConfigFile::value(const std::string& key) {
  remember(known_keys_[kTopLevel], key);
  for (const YamlEntry& entry : entries_) {
    if (entry.key != key) {
      continue;
    }
    if (entry.kind == Kind::kScalar) {
      return entry.text;
    }
    problems_.add(entry.line, no_single_value(key));
  }
  return std::nullopt;
}

std::vector<std::string> ConfigFile::values(const std::string& key) {
  remember(known_keys_[kTopLevel], key);
  std::vector<std::string> texts;
  for (const YamlEntry& entry : entries_) {
    if (entry.key != key) {
      continue;
    }
    const bool all_single = std::all_of(entry.children.begin(), entry.children.end(),
                                        [](const YamlEntry& child) { return child.kind == Kind::kScalar; });
    if (entry.kind == Kind::kScalar) {
      texts.push_back(entry.text);
    } else if (entry.kind == Kind::kSequence && all_single) {
      for (const YamlEntry& child : entry.children) {
        texts.push_back(child.text);
      }
    } else {
      problems_.add(entry.line, "'" + key + "' must have a single value, or a list of them");
    }
  }
  return texts;
}

void ConfigFile::apply(const std::string& section, OptionList& options) {
  std::vector<std::string>& known = known_keys_[section];
  for (const OptionField& field : options.fields()) {
    remember(known, field.key);
  }
  const auto apply_entries = [&](const std::vector<YamlEntry>& entries) {
    for (const YamlEntry& entry : entries) {
      const auto is_entry = [&](const OptionField& field) { return field.key == entry.key; };
      if (std::none_of(options.fields().begin(), options.fields().end(), is_entry)) {
        continue;
      }
      const std::string problem =
          entry.kind == Kind::kScalar ? options.set(entry.key, entry.text) : no_single_value(entry.key);
      if (!problem.empty()) {
        problems_.add(entry.line, problem);
      }
    }
  };
  if (section == kTopLevel) {
    apply_entries(entries_);
    return;
  }
  remember(known_keys_[kTopLevel], section);
  for (const YamlEntry& entry : entries_) {
    if (entry.key != section) {
      continue;
    }
    if (entry.kind == Kind::kScalar || entry.kind == Kind::kSequence) {
      problems_.add(entry.line, "'" + section + "' must hold options (lines of 'key: value', indented)");
    }
    apply_entries(entry.children);
  }
}

void ConfigFile::reject(const std::string& key, const std::string& rule) {
  for (const YamlEntry& entry : entries_) {
    if (entry.key == key) {
      problems_.add(entry.line, key + " = '" + entry.text + "' " + rule);
      return;
    }
  }
  problems_.add(0, key + " " + rule);
}

void ConfigFile::check() const {
  FileProblems problems = problems_;
  const auto known_in = [&](const std::string& section) {
    const auto found = known_keys_.find(section);
    return found == known_keys_.end() ? std::vector<std::string>{} : found->second;
  };
  for (const YamlEntry& entry : entries_) {
    if (!contains(known_in(kTopLevel), entry.key)) {
      problems.add_unknown_key(entry, known_in(kTopLevel));
      continue;
    }
    if (entry.kind != Kind::kMapping || !known_keys_.contains(entry.key)) {
      continue;
    }
    const std::vector<std::string> known = known_in(entry.key);
    for (const YamlEntry& option : entry.children) {
      if (!contains(known, option.key)) {
        problems.add_unknown_key(option, known);
      }
    }
  }
  problems.throw_if_any();
}

std::string to_yaml(const std::string& section, const OptionList& options) {
  const bool bare = section == ConfigFile::kTopLevel;
  std::string text = bare ? "" : yaml_word(section) + (options.fields().empty() ? ": {}\n" : ":\n");
  for (const OptionField& field : options.fields()) {
    const bool is_word = std::holds_alternative<std::string*>(field.value);
    text += (bare ? "" : "  ") + yaml_word(field.key) + ": " +
            (is_word ? yaml_word(field.value_text()) : field.value_text()) + "\n";
  }
  return text;
}

}  // namespace gridmerge
