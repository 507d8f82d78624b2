/// Writes a page of made-up runs, and the same rows as CSV, for the test that opens the page.
///
///     page_example PAGE.html ROWS.csv [RUNS [PICTURES]]
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/base/library_threads.hpp"
#include "map_server/whole_files.hpp"
#include "page/made_up_study.hpp"
#include "page/page.hpp"
#include "study/row_fields.hpp"
#include "worlds/scene.hpp"
#include "worlds/tracks.hpp"

namespace gridmerge {
namespace {

std::string cell(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    quoted += c == '"' ? "\"" : "";
  }
  return quoted + "\"";
}
std::string cell(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}
template <typename Whole>
std::string cell(Whole value) {
  return std::to_string(value);
}

std::string csv_of(const std::vector<study::Row>& rows) {
  std::string csv;
  const study::Row like_any;
  study::for_each_field(
      like_any, [&](std::string_view name, const auto&) { csv += (csv.empty() ? "" : ",") + std::string(name); });
  for (const study::Row& row : rows) {
    csv += '\n';
    study::for_each_field(
        row, [&](std::string_view, const auto& field) { csv += (csv.back() == '\n' ? "" : ",") + cell(field); });
  }
  return csv + "\n";
}

/// A few small scenes stand for all that a study has.
worlds::SceneOptions scene_of(const study::Row& row) {
  worlds::SceneOptions options;
  options.kind = row.set == "maze" ? "maze" : row.set == "forest" ? "forest" : "flat";
  options.seed = 1 + static_cast<int>(row.run % 3);
  options.relation = row.truth == "same" ? "overlap" : "two_worlds";
  options.resolution_m = 0.1;
  return options;
}

page::PairMaps maps_of(const study::Row& row) {
  const worlds::SceneOptions options = scene_of(row);
  worlds::MapPair pair = worlds::make_scene(options);
  return {std::move(pair.target), std::move(pair.source), worlds::tracks_of(options)};
}

/// Truth as the scenes have it, and what was found as far off as the row says.
void place(std::vector<study::Row>& rows) {
  std::map<std::pair<std::string, int>, Pose2> truths;
  for (study::Row& row : rows) {
    worlds::SceneOptions options = scene_of(row);
    const auto [truth, is_new] = truths.try_emplace({options.kind, options.seed});
    if (is_new) {
      options.relation = "overlap";
      truth->second = worlds::make_scene(options).target_from_source;
    }
    row.truth_x_m = truth->second.x_m;
    row.truth_y_m = truth->second.y_m;
    row.truth_theta_rad = truth->second.theta_rad;
    const bool knows = row.truth == "same";
    row.x_m = row.truth_x_m + (knows ? row.error_m : 3);
    row.y_m = row.truth_y_m;
    row.theta_rad = wrap_angle(row.truth_theta_rad + (knows ? row.error_deg * kPi / 180 : 1));
  }
}

void write_example(const std::string& page_file, const std::string& csv_file, int runs, int pictures) {
  MadeUpStudy made_up = made_up_study(runs);
  place(made_up.rows);
  const std::vector<page::FailurePicture> failures =
      page::draw_failures(made_up.rows, {.most = pictures, .num_threads = 2, .maps_of = maps_of});
  const std::string html = page::report_page({
      .name = "Made-up <study> & \"more\"",
      .about = "No method ran for this page: its rows are drawn from a seed, to test how they are shown.",
      .rows = made_up.rows,
      .curves = made_up.curves,
      .failures = failures,
      .command_of =
          [](const study::Row& row) {
            return "gridmerge study repeat DIR --run " + std::to_string(row.run) + " # '" + row.set + "'";
          },
  });
  write_whole_file(page_file, html);
  write_whole_file(csv_file, csv_of(made_up.rows));
}

}  // namespace
}  // namespace gridmerge

int main(int argc, char** argv) {
  gridmerge::keep_opencv_on_the_calling_thread();
  if (argc < 3 || argc > 5) {
    std::fputs("page_example PAGE.html ROWS.csv [RUNS [PICTURES]]\n", stderr);
    return 2;
  }
  try {
    gridmerge::write_example(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 600, argc > 4 ? std::atoi(argv[4]) : 12);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "page_example: %s\n", error.what());
    return 1;
  }
}
