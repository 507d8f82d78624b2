#pragma once
/// What a run is made of: the built-in defaults, changed by a configuration file, changed by the command line.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "gridmerge/align/registry.hpp"
#include "gridmerge/fuse/fuse.hpp"
#include "gridmerge/select/selector.hpp"

namespace gridmerge {
class ConfigFile;
}

namespace gridmerge::cli {

/// What the command line says of the configuration, as given; empty where it says nothing.
struct ConfigurationChoice {
  std::string file;
  std::string method;
  std::string profile;
  std::string seed;
  std::string threads;
  std::vector<std::string> set;      ///< "section.key=value"
  std::vector<std::string> plugins;  ///< shared libraries with further methods
  std::string strictness;            ///< short for verdict.strictness
  std::string bids;                  ///< file of what the selector has learned

  friend bool operator==(const ConfigurationChoice&, const ConfigurationChoice&) = default;
};

/// The name that stands for no method, but for the choice of one.
inline constexpr const char* kAuto = "auto";

/// The options that stand outside of every section.
struct RunOptions {
  int seed = 1;
  int threads = 0;

  void describe(OptionList& list);
};

/// The effective configuration. Everything in it has been checked.
class Configuration {
 public:
  /// A part of the pipeline with its options, as in a configuration file.
  struct Section {
    std::string name;
    std::string about;  ///< one sentence
    OptionList options;
  };

  /// @throws InputError with every problem of the file, or UsageError with every problem of the rest
  /// @param built_in  the methods of the house; those of plugins come after them
  Configuration(const MethodRegistry& built_in, const ConfigurationChoice& choice);
  Configuration(const Configuration&) = delete;
  Configuration& operator=(const Configuration&) = delete;

  [[nodiscard]] const std::string& method() const { return method_; }
  [[nodiscard]] const std::string& profile() const { return profile_; }
  /// Where they lie: the file's, then the command line's.
  [[nodiscard]] const std::vector<std::filesystem::path>& plugins() const { return plugins_; }
  /// The one method, or with `auto` the selector over all.
  [[nodiscard]] const Chooser& methods() const { return *methods_; }
  [[nodiscard]] bool chooses() const { return method_ == kAuto; }
  /// Of the selector; empty: what is built in, or there is no selector.
  [[nodiscard]] const std::filesystem::path& bids() const { return bids_; }
  [[nodiscard]] const PipelineOptions& pipeline() const { return pipeline_; }
  [[nodiscard]] const FuseOptions& fuse() const { return fuse_; }
  [[nodiscard]] std::uint64_t seed() const { return static_cast<std::uint64_t>(run_.seed); }
  [[nodiscard]] int threads() const;  ///< at least 1

  /// Bound to this object, as are the sections.
  [[nodiscard]] OptionList run_options() { return option_list(run_); }
  /// The method first (with `auto` the selector, then every method), then in the order of the pipeline.
  [[nodiscard]] std::vector<Section> sections();

 private:
  void choose_methods(const MethodRegistry& registry, const ConfigurationChoice& choice, ConfigFile& file);
  void make_methods();
  [[nodiscard]] std::vector<Section> pipeline_sections();

  std::vector<std::filesystem::path> plugins_;
  std::string method_;
  std::string profile_;
  std::filesystem::path bids_;
  RunOptions run_;
  SelectorOptions selector_;
  std::vector<std::pair<std::string, std::unique_ptr<MethodConfig>>> method_configs_;  ///< by the methods' names
  std::vector<std::unique_ptr<Merger>> mergers_;
  std::unique_ptr<Chooser> methods_;
  PipelineOptions pipeline_;
  FuseOptions fuse_;
};

}  // namespace gridmerge::cli
