#include "study/yaml_tree.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "gridmerge/base/error.hpp"

namespace gridmerge::study {
namespace {

constexpr int kMaxDepth = 16;
constexpr int kMaxEntries = 200000;

class TreeReader {
 public:
  explicit TreeReader(const std::string& file) : file_(file) {}

  std::vector<YamlEntry> children_of(const YAML::Node& parent, int depth) {
    std::vector<YamlEntry> children;
    for (const auto& child : parent) {
      if (parent.IsMap()) {
        children.push_back(entry_of(child.second, depth));
        children.back().key = word(child.first);
        children.back().line = child.first.Mark().line + 1;
      } else {
        children.push_back(entry_of(child, depth));
      }
    }
    return children;
  }

 private:
  std::string word(const YAML::Node& key) const {
    if (!key.IsScalar()) {
      throw InputError(file_ + ":" + std::to_string(key.Mark().line + 1), "a key must be a single word");
    }
    return key.Scalar();
  }

  YamlEntry entry_of(const YAML::Node& node, int depth) {
    YamlEntry entry;
    entry.line = node.Mark().is_null() ? 0 : node.Mark().line + 1;
    if (++entries_ > kMaxEntries || depth > kMaxDepth) {
      throw InputError(file_ + ":" + std::to_string(entry.line), "holds too much, or nests too deep");
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
  int entries_ = 0;
};

}  // namespace

std::vector<YamlEntry> parse_yaml_tree(std::string_view text, const std::string& file) {
  (void)parse_yaml_mapping(text, file);  // throws for whatever is not one plain mapping
  return TreeReader(file).children_of(YAML::Load(std::string(text)), 1);
}

const YamlEntry* find_entry(const std::vector<YamlEntry>& entries, std::string_view key) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const YamlEntry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

}  // namespace gridmerge::study
