#include "cli/inspection.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>

#include "report/html.hpp"
#include "report/overlay.hpp"
#include "report/view_picture.hpp"

namespace gridmerge::cli {
namespace {

constexpr std::string_view kPageHead =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<style>\n"
    "body { max-width: 76rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 sans-serif; color: #303438; }\n"
    "h1 { font-size: 1.4rem; }\nh2 { font-size: 1.1rem; margin: 2.5rem 0 0.5rem; }\n"
    "img { max-width: 100%; height: auto; }\n</style>\n";

bool is_snake_case(std::string_view name) {
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' && std::all_of(name.begin(), name.end(), fits);
}

/// "propose/evolve" as "propose_evolve".
std::string as_name(std::string text) {
  for (char& c : text) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool plain = upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    c = plain ? static_cast<char>(upper ? c - 'A' + 'a' : c) : '_';
  }
  return text;
}

Picture best_pose(const AlignInput& input, const Alignment& alignment, int num_threads) {
  const Pose2& pose = alignment.hypotheses.front().target_from_source.pose;
  const Overlay overlay =
      draw_overlay({{{&input.target, {}}, "target"}, {{&input.source, pose}, "source"}}, {}, num_threads);
  return {"overlay.png", "Both maps, the source in the best pose that was found", encode_png(overlay.image)};
}

std::string list_html(const std::vector<std::string>& items) {
  std::string html = "<ul>\n";
  for (const std::string& item : items) {
    html += "<li>" + html_escaped(item) + "</li>\n";
  }
  return html + "</ul>\n";
}

}  // namespace

void ViewRecorder::on_iteration(const IterationRecord& record) {
  auto stage = std::find_if(scores_.begin(), scores_.end(), [&](const Scores& s) { return s.stage == record.stage; });
  if (stage == scores_.end()) {
    stage = scores_.insert(scores_.end(), {record.stage, {}, {}});
  }
  stage->best.push_back(record.best_score);
  stage->mean.push_back(record.mean_score);
}

std::vector<View> ViewRecorder::views() const {
  std::vector<View> all = views_;
  for (const Scores& stage : scores_) {
    std::vector<double> iterations(stage.best.size());
    std::iota(iterations.begin(), iterations.end(), 1.0);
    all.push_back({.name = scores_.size() == 1 ? "scores" : "scores_" + as_name(stage.stage),
                   .title = "The method's own score over the iterations of " + stage.stage,
                   .content = CurvesView{.curves = {{"best", iterations, stage.best}, {"mean", iterations, stage.mean}},
                                         .x_label = "iteration",
                                         .y_label = "score",
                                         .marks = {}}});
  }
  return all;
}

std::vector<Picture> pictures_of(const std::vector<View>& views, const AlignInput& input, const Alignment& alignment,
                                 const PrepareOptions& prepare, int num_threads) {
  std::vector<Picture> pictures;
  if (!alignment.hypotheses.empty()) {
    pictures.push_back(best_pose(input, alignment, num_threads));
  }
  const double resolution_m = common_resolution_m(input.target, input.source, prepare);
  const PreparedMap target(input.target, resolution_m, prepare, num_threads);
  const PreparedMap source(input.source, resolution_m, prepare, num_threads);
  std::set<std::string> names = {"overlay"};
  for (const View& view : views) {
    if (!is_snake_case(view.name)) {
      throw std::invalid_argument("view '" + view.name + "': its name must be a word of a-z, 0-9 and _");
    }
    if (!names.insert(view.name).second) {
      throw std::invalid_argument("view '" + view.name + "': another one has this name");
    }
    pictures.push_back(
        {view.name + ".png", view.title, encode_png(draw_view(view, {target, source}, num_threads).image)});
  }
  return pictures;
}

std::string page_html(const PageText& text, const std::vector<Picture>& pictures) {
  std::string html = std::string(kPageHead) + "<title>" + html_escaped(text.title) + "</title>\n</head>\n<body>\n<h1>" +
                     html_escaped(text.title) + "</h1>\n<p>" + html_escaped(text.verdict) + "</p>\n" +
                     list_html(text.reasons) + "<p>";
  for (const std::string& fact : text.facts) {
    html += html_escaped(fact) + "<br>\n";
  }
  html += "</p>\n";
  for (const Picture& picture : pictures) {
    html += "<h2>" + html_escaped(picture.title) + "</h2>\n<img src=\"" + html_escaped(picture.file) + "\" alt=\"" +
            html_escaped(picture.title) + "\">\n";
  }
  return html + "</body>\n</html>\n";
}

}  // namespace gridmerge::cli
