#include "gridmerge/align/registry.hpp"

#include <algorithm>
#include <stdexcept>

namespace gridmerge {
namespace {

/// The element of that name, or an exception that lists the names there are.
template <typename Named>
const Named& find_named(const std::vector<Named>& all, std::string_view name, const std::string& kind) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  if (found != all.end()) {
    return *found;
  }
  std::string known;
  for (const Named& one : all) {
    known += (known.empty() ? "" : ", ") + one.name;
  }
  throw std::invalid_argument("unknown " + kind + " '" + std::string(name) + "'; known: " + known);
}

}  // namespace

const MethodProfile& MethodEntry::profile(std::string_view profile_name) const {
  return find_named(profiles, profile_name, "profile of method " + name);
}

void MethodRegistry::add(MethodEntry entry) {
  if (entry.profiles.empty()) {
    throw std::invalid_argument("method " + entry.name + " has no profile");
  }
  if (std::any_of(entries_.begin(), entries_.end(), [&](const MethodEntry& e) { return e.name == entry.name; })) {
    throw std::invalid_argument("method " + entry.name + " is registered twice");
  }
  entries_.push_back(std::move(entry));
}

const MethodEntry& MethodRegistry::method(std::string_view name) const { return find_named(entries_, name, "method"); }

}  // namespace gridmerge
