#include "gridmerge/align/chooser.hpp"

namespace gridmerge {
namespace {

class Once final : public Choice {
 public:
  explicit Once(MethodPick pick) : pick_(std::move(pick)) {}
  [[nodiscard]] std::optional<MethodPick> next(const std::vector<Attempt>& tried) override {
    return tried.empty() ? std::optional(pick_) : std::nullopt;
  }

 private:
  MethodPick pick_;
};

}  // namespace

std::unique_ptr<Choice> OneMethod::begin(const AlignRequest& /*request*/, const RunContext& /*context*/) const {
  return std::make_unique<Once>(MethodPick{&method_, name_, ""});
}

}  // namespace gridmerge
