#pragma once
/// Who proposes poses, and who next where that was not enough.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/judge/verdict.hpp"

namespace gridmerge {

/// A method that was tried, and what the verdict was then, over its poses and those of all before it.
struct Attempt {
  std::string method;
  std::string why;  ///< it was chosen, in words; empty where there was no choice
  Outcome outcome = Outcome::kDeclined;
  double confidence = 0;
  double seconds = 0;  ///< wall clock
};

struct MethodPick {
  const Merger* method = nullptr;  ///< not owned, never null
  std::string name;
  std::string why;
};

/// One alignment's way through the methods.
class Choice {
 public:
  virtual ~Choice() = default;
  /// @param tried  so far, none of them merged
  /// @return none: that was enough, or there is no other
  [[nodiscard]] virtual std::optional<MethodPick> next(const std::vector<Attempt>& tried) = 0;
  /// How it came to that, in words; empty where there was no choice.
  [[nodiscard]] virtual std::vector<std::string> story() const { return {}; }
};

class Chooser {
 public:
  virtual ~Chooser() = default;
  /// Everything that the Choice borrows outlives it.
  [[nodiscard]] virtual std::unique_ptr<Choice> begin(const AlignRequest& request, const RunContext& context) const = 0;
};

/// No choice: this one method, once.
class OneMethod final : public Chooser {
 public:
  OneMethod(const Merger& method, std::string name) : method_(method), name_(std::move(name)) {}
  [[nodiscard]] std::unique_ptr<Choice> begin(const AlignRequest& request, const RunContext& context) const override;

 private:
  const Merger& method_;
  std::string name_;
};

}  // namespace gridmerge
