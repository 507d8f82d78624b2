#pragma once
/// Chooses the method from what the scene looks like (seed 5.1): methods object or bid, the best bid within the time
/// runs, and where its answer is not merged the next one may.
#include <memory>
#include <string>
#include <vector>

#include "gridmerge/align/chooser.hpp"
#include "gridmerge/base/options.hpp"
#include "gridmerge/select/bids.hpp"

namespace gridmerge {

struct SelectorOptions {
  double success_slack = 0.1;
  double least_gain = 0.05;
  int at_most = 3;

  void describe(OptionList& list);
};

struct NamedMethod {
  std::string name;
  const Merger* method = nullptr;  ///< not owned, never null
};

/// How one method stands before anything is tried.
struct Standing {
  std::string method;
  std::optional<std::string> objection;  ///< it does not take these maps
  std::optional<Bid> bid;                ///< none: it objects, or nothing is known of it
};

/// Const and thread safe; the same request gives the same order, unless a deadline is set.
class Selector final : public Chooser {
 public:
  /// @throws std::invalid_argument for options out of range, or a book with a weight for what is no input
  Selector(std::vector<NamedMethod> methods, BidBook book, SelectorOptions options);

  [[nodiscard]] std::unique_ptr<Choice> begin(const AlignRequest& request, const RunContext& context) const override;

  /// All methods, in the order in which they would be tried if time did not matter: of those whose expected success is
  /// within success_slack of the best, the fastest first; then the others, most success first; then those without a
  /// bid.
  [[nodiscard]] std::vector<Standing> standings(const AlignRequest& request, const BidInputs& inputs) const;

  [[nodiscard]] const BidBook& book() const { return book_; }
  [[nodiscard]] const SelectorOptions& options() const { return options_; }
  /// @throws std::invalid_argument for an unknown name
  [[nodiscard]] const Merger& method(const std::string& name) const;

 private:
  std::vector<NamedMethod> methods_;
  BidBook book_;
  SelectorOptions options_;
};

}  // namespace gridmerge
