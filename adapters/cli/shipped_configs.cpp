#include "cli/shipped_configs.hpp"

#include "cli/describe.hpp"

namespace gridmerge::cli {
namespace {

constexpr const char* kOrigin =
    "# The defaults, written by 'gridmerge config --write configs'. Keep the lines you change; leave out the rest.\n";

}  // namespace

std::vector<ShippedConfig> shipped_configs(const MethodRegistry& methods) {
  std::vector<ShippedConfig> files;
  for (const MethodEntry& method : methods.entries()) {
    for (const MethodProfile& profile : method.profiles) {
      ConfigurationChoice choice;
      choice.method = method.name;
      choice.profile = profile.name;
      Configuration configuration(methods, choice);
      const bool is_default = &profile == &method.profiles.front();
      files.push_back({method.name + (is_default ? "" : "_" + profile.name) + ".yaml",
                       "# " + method.name + ", profile " + profile.name + ": " + profile.summary + ".\n" + kOrigin +
                           configuration_yaml(configuration, [&](const std::string& s) { return s == method.name; })});
    }
  }
  ConfigurationChoice choice;
  choice.method = kAuto;
  Configuration automatic(methods, choice);
  files.push_back({"auto.yaml", std::string("# auto: the method is chosen by what the maps look like.\n") + kOrigin +
                                    configuration_yaml(automatic, [](const std::string& section) {
                                      return section == kAuto || section == "selector";
                                    })});
  Configuration configuration(methods, {});
  files.push_back({"pipeline.yaml", std::string("# What stands around the method, whichever it is.\n") + kOrigin +
                                        configuration_yaml(configuration, [&](const std::string& section) {
                                          return section != configuration.method();
                                        })});
  return files;
}

}  // namespace gridmerge::cli
