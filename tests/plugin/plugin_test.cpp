#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/fourier.hpp"
#include "gridmerge/grid/prepared_map.hpp"
#include "plugin/plugin_loader.hpp"

namespace gridmerge {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const fs::path kFolder = GRIDMERGE_PLUGIN_FOLDER;
const fs::path kCentroid = GRIDMERGE_CENTROID;

fs::path built(const std::string& name) { return kFolder / ("libgridmerge_" + name + ".so"); }

std::vector<std::string> names_of(const MethodRegistry& methods) {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods.entries()) {
    names.push_back(entry.name);
  }
  return names;
}

/// One method, "taken".
MethodRegistry taken() {
  MethodRegistry methods;
  methods.add({"taken", "a summary", "a paper, 2000", {{"default", "a profile", [] {
                                                          return std::unique_ptr<MethodConfig>();
                                                        }}}});
  return methods;
}

/// Expects a refusal that begins with the file's name. @return what it says
std::string refusal(const fs::path& file) {
  const MethodRegistry methods = taken();
  try {
    (void)with_plugins(methods, {file});
    ADD_FAILURE() << file << " was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith(file.string() + ": "));
    EXPECT_THAT(names_of(methods), ElementsAre("taken"));
    return error.what();
  }
  return "";
}

/// A file of the test's own; it is gone with this object.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& content)
      : path_(fs::temp_directory_path() / ("gridmerge_plugin_test_" + std::to_string(::getpid()) + ".so")) {
    std::ofstream(path_, std::ios::binary) << content;
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() { fs::remove(path_); }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

TEST(PluginLoader, AddsTheMethodsOfALibraryAfterThoseThereAre) {
  const MethodRegistry methods = with_plugins(taken(), {kCentroid});
  ASSERT_THAT(names_of(methods), ElementsAre("taken", "centroid"));
  const MethodEntry& centroid = methods.method("centroid");
  EXPECT_EQ(centroid.profiles.front().config()->options().fields().front().key, "climb");
  EXPECT_NE(centroid.profiles.front().config()->make(), nullptr);
}

TEST(PluginLoader, TakesALibraryOnceHoweverOftenItIsNamed) {
  const fs::path other_way = kCentroid.parent_path() / "." / kCentroid.filename();
  EXPECT_THAT(names_of(with_plugins({}, {kCentroid, other_way, kCentroid})), ElementsAre("centroid"));
  EXPECT_THAT(names_of(with_plugins({}, {kCentroid})), ElementsAre("centroid")) << "and again, from the start";
}

TEST(PluginLoader, TakesARelativeNameFromTheWorkingDirectory) {
  const fs::path before = fs::current_path();
  fs::current_path(kCentroid.parent_path());
  EXPECT_THAT(names_of(with_plugins({}, {kCentroid.filename()})), ElementsAre("centroid"));
  fs::current_path(before);
}

TEST(PluginLoader, GivesPluginsTheProgramsOwnCore) {
  const MethodRegistry methods = with_plugins({}, {built("calling_plugin")});
  const std::unique_ptr<MethodConfig> config = methods.method("calling").profiles.front().config();
  EXPECT_FALSE(config->options().fields().empty());
  const PreparedMap map(unknown_grid({.width = 1, .height = 1, .resolution_m = 1, .map_from_grid = {}}), 1);
  const Proposal proposal = config->make()->propose({.target = map, .source = map, .prior = {}}, {.stop = {}});
  EXPECT_NEAR(proposal.candidates.front().method_score, 1, 1e-6);

  void* const library = dlopen(built("calling_plugin").c_str(), RTLD_NOW | RTLD_NOLOAD);
  ASSERT_NE(library, nullptr) << "it must still be loaded";
  auto* const seen = reinterpret_cast<void* (*)()>(dlsym(library, "gridmerge_test_correlation"));
  ASSERT_NE(seen, nullptr);
  EXPECT_EQ(seen(), reinterpret_cast<void*>(&circular_correlation));
}

TEST(PluginLoader, RefusesWhatIsNoPlugin) {
  EXPECT_THAT(refusal(kFolder / "nowhere.so"), HasSubstr("does not exist"));
  EXPECT_THAT(refusal(kFolder), HasSubstr("is no file"));
  EXPECT_THAT(refusal(ScratchFile("these are words").path()),
              HasSubstr("is not a shared library that can be loaded: "));
  EXPECT_THAT(refusal(ScratchFile("").path()), HasSubstr("is not a shared library that can be loaded: "));
  EXPECT_THAT(refusal(built("no_plugin")),
              HasSubstr("is not a gridmerge plugin: it has no symbol gridmerge_plugin_abi"));
}

TEST(PluginLoader, RefusesALibraryOfAnotherBuild) {
  EXPECT_THAT(refusal(built("faulty_abi")),
              AllOf(HasSubstr("was built for 'gridmerge 0.0.1, gcc 2, libstdc++ 1'; this program is 'gridmerge ")));
  EXPECT_THAT(refusal(built("faulty_layout")), HasSubstr("was built with other headers"));
}

TEST(PluginLoader, RefusesAFailedRegistrationAndLeavesTheMethodsAsTheyWere) {
  EXPECT_THAT(refusal(built("faulty_taken")), HasSubstr("its registration failed: method taken is registered twice"));
  EXPECT_THAT(refusal(built("faulty_throws")), HasSubstr("its registration failed: no licence"));
  EXPECT_THAT(refusal(built("faulty_throws_nothing")), HasSubstr("does not say why"));
  EXPECT_THAT(refusal(built("faulty_adds_nothing")), HasSubstr("registers no method"));
  EXPECT_THAT(refusal(built("faulty_bad_name")), HasSubstr("method 'Two Words': a name must be"));
  EXPECT_THAT(refusal(built("faulty_no_config")), HasSubstr("method 'hollow': profile 'default' has no configuration"));
}

}  // namespace
}  // namespace gridmerge
