#include "study/option_entry.hpp"

#include <algorithm>

namespace gridmerge::study {

void set_option(OptionList& options, const YamlEntry& entry, FileProblems& problems) {
  const std::string problem = entry.kind == YamlEntry::Kind::kScalar ? options.set(entry.key, entry.text)
                                                                     : "'" + entry.key + "' must have a single value";
  if (!problem.empty()) {
    problems.add(entry.line, problem);
  }
}

void set_options(OptionList& options, const YamlEntry& mapping, FileProblems& problems,
                 const std::vector<std::string>& others) {
  std::vector<std::string> known = others;
  for (const OptionField& field : options.fields()) {
    known.push_back(field.key);
  }
  if (mapping.kind != YamlEntry::Kind::kMapping) {
    const std::string keys = known.front() + ": ..., " + known.back() + ": ...";
    const std::string name = mapping.key.empty() ? "" : mapping.key + ": ";
    problems.add(mapping.line, name + "must hold values, as in {" + keys + "}");
    return;
  }
  problems.add_repeated_keys(mapping.children);
  for (const YamlEntry& child : mapping.children) {
    if (std::find(known.begin(), known.end(), child.key) == known.end()) {
      problems.add_unknown_key(child, known);
    } else if (std::find(others.begin(), others.end(), child.key) == others.end()) {
      set_option(options, child, problems);
    }
  }
}

}  // namespace gridmerge::study
