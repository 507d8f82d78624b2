#pragma once
/// The list of methods: one row makes a method known to the command line, the docs, the contract tests and the
/// benchmarks.
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

/// A method's options with the way to build it from them.
class MethodConfig {
 public:
  virtual ~MethodConfig() = default;
  /// Bound to this object.
  [[nodiscard]] virtual OptionList options() = 0;
  /// @throws std::invalid_argument listing every option out of range
  [[nodiscard]] virtual std::unique_ptr<Merger> make() const = 0;
};

/// A method whose class is constructed from its struct of options.
template <typename Options, typename Method>
class TypedMethodConfig final : public MethodConfig {
 public:
  explicit TypedMethodConfig(Options options) : options_(std::move(options)) {}
  [[nodiscard]] OptionList options() override { return option_list(options_); }
  [[nodiscard]] std::unique_ptr<Merger> make() const override { return std::make_unique<Method>(options_); }

 private:
  Options options_;
};

/// A named set of option values: `default` is the best we can make it, `paper` runs the method as published.
struct MethodProfile {
  std::string name;
  std::string summary;
  std::function<std::unique_ptr<MethodConfig>()> config;
};

struct MethodEntry {
  std::string name;                     ///< snake_case, as on the command line
  std::string summary;                  ///< one sentence
  std::string paper;                    ///< authors, title, year
  std::vector<MethodProfile> profiles;  ///< the first is the default

  /// @throws std::invalid_argument naming the known profiles
  [[nodiscard]] const MethodProfile& profile(std::string_view profile_name) const;
};

/// Methods in the order they were added; the first is the default.
class MethodRegistry {
 public:
  /// @throws std::invalid_argument if the name is taken or there is no profile
  void add(MethodEntry entry);
  [[nodiscard]] const std::vector<MethodEntry>& entries() const { return entries_; }
  /// @throws std::invalid_argument naming the known methods
  [[nodiscard]] const MethodEntry& method(std::string_view name) const;

 private:
  std::vector<MethodEntry> entries_;
};

}  // namespace gridmerge
