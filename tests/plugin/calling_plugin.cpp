/// A method whose score tells whether core's functions, called from a plugin, are the program's own.
#include "gridmerge/base/fourier.hpp"
#include "gridmerge/base/random.hpp"
#include "gridmerge/judge/verdict.hpp"
#include "plugin/method_plugin.hpp"

namespace {

class CallingMerger final : public gridmerge::Merger {
 public:
  [[nodiscard]] gridmerge::MergerTraits traits() const override { return {}; }
  [[nodiscard]] gridmerge::Proposal propose(const gridmerge::AlignRequest& /*request*/,
                                            const gridmerge::RunContext& /*context*/) const override {
    gridmerge::Proposal proposal;
    const std::vector<float> pulse = {0, 1, 0, 0};
    const std::vector<float> later = {0, 0, 0, 1};
    proposal.candidates = {{{}, gridmerge::circular_correlation(pulse, later)[2]}};
    return proposal;
  }
};

class CallingConfig final : public gridmerge::MethodConfig {
 public:
  [[nodiscard]] gridmerge::OptionList options() override { return gridmerge::option_list(verdict_); }
  [[nodiscard]] std::unique_ptr<gridmerge::Merger> make() const override { return std::make_unique<CallingMerger>(); }

 private:
  gridmerge::VerdictOptions verdict_;
};

/// The program's copy of a function, as this library sees it.
extern "C" void* gridmerge_test_correlation() { return reinterpret_cast<void*>(&gridmerge::circular_correlation); }

void add_methods(gridmerge::MethodRegistry& methods) {
  methods.add({"calling", "calls core", "none, 2000", {{"default", "a profile", [] {
                                                          return std::make_unique<CallingConfig>();
                                                        }}}});
}

}  // namespace

GRIDMERGE_METHOD_PLUGIN(add_methods)
