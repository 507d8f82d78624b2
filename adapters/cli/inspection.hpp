#pragma once
/// What a method shows of itself, as pictures and one page that tells what they are.
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "gridmerge/base/trace.hpp"

namespace gridmerge::cli {

/// Keeps what a search shows.
class ViewRecorder final : public TraceSink {
 public:
  void on_iteration(const IterationRecord& record) override;
  [[nodiscard]] bool wants_views() const override { return true; }
  void on_view(const View& view) override { views_.push_back(view); }

  /// The method's own, in its order; then the best and the mean score over the iterations, for each stage that has any.
  [[nodiscard]] std::vector<View> views() const;

 private:
  struct Scores {
    std::string stage;
    std::vector<double> best;
    std::vector<double> mean;
  };
  std::vector<View> views_;
  std::vector<Scores> scores_;
};

/// A file of the page's folder, and what it shows.
struct Picture {
  std::string file;
  std::string title;
  std::string bytes;  ///< PNG
};

/// The pictures of all views, and before them the maps laid over each other in the best pose, if there is one.
/// @throws std::invalid_argument naming the view, if its name is no snake_case word, is taken, or it cannot be drawn
[[nodiscard]] std::vector<Picture> pictures_of(const std::vector<View>& views, const AlignInput& input,
                                               const Alignment& alignment, const PrepareOptions& prepare,
                                               int num_threads);

/// What the page says beside the pictures; plain text.
struct PageText {
  std::string title;
  std::string verdict;
  std::vector<std::string> reasons;
  std::vector<std::string> facts;  ///< the maps, the pose, how it was found
};

/// HTML that needs nothing but the pictures beside it.
[[nodiscard]] std::string page_html(const PageText& text, const std::vector<Picture>& pictures);

}  // namespace gridmerge::cli
