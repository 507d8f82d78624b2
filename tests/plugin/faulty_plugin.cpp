/// Built once for each FAULT_...: a plugin with that one fault.
#include <stdexcept>

#include "plugin/method_plugin.hpp"

#ifdef FAULT_ABI
#undef GRIDMERGE_PLUGIN_ABI
#define GRIDMERGE_PLUGIN_ABI "gridmerge 0.0.1, gcc 2, libstdc++ 1"
#endif

namespace {

class NoMerger final : public gridmerge::Merger {
 public:
  [[nodiscard]] gridmerge::MergerTraits traits() const override { return {}; }
  [[nodiscard]] gridmerge::Proposal propose(const gridmerge::AlignRequest& /*request*/,
                                            const gridmerge::RunContext& /*context*/) const override {
    return {};
  }
};

class NoConfig final : public gridmerge::MethodConfig {
 public:
  [[nodiscard]] gridmerge::OptionList options() override { return {}; }
  [[nodiscard]] std::unique_ptr<gridmerge::Merger> make() const override { return std::make_unique<NoMerger>(); }
};

[[maybe_unused]] void add(gridmerge::MethodRegistry& methods, const char* name) {
  methods.add(
      {name, "a summary", "a paper, 2000", {{"default", "a profile", [] { return std::make_unique<NoConfig>(); }}}});
}

void add_methods([[maybe_unused]] gridmerge::MethodRegistry& methods) {
#if defined(FAULT_TAKEN)
  add(methods, "first_of_two");
  add(methods, "taken");
#elif defined(FAULT_THROWS)
  add(methods, "half_done");
  throw std::runtime_error("no licence");
#elif defined(FAULT_THROWS_NOTHING)
  throw 7;
#elif defined(FAULT_BAD_NAME)
  add(methods, "Two Words");
#elif defined(FAULT_NO_CONFIG)
  methods.add({"hollow", "a summary", "a paper, 2000", {{"default", "a profile", {}}}});
#elif !defined(FAULT_ADDS_NOTHING)
  add(methods, "fine");
#endif
}

}  // namespace

#ifdef FAULT_LAYOUT
extern "C" const char* gridmerge_plugin_abi() { return GRIDMERGE_PLUGIN_ABI; }
extern "C" std::uint64_t gridmerge_plugin_layout() { return gridmerge::plugin_layout() + 1; }
extern "C" void gridmerge_plugin_register(gridmerge::MethodRegistry* methods) { add_methods(*methods); }
#else
GRIDMERGE_METHOD_PLUGIN(add_methods)
#endif
