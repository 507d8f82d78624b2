#include "page/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/base/error.hpp"
#include "map_server/raster_image.hpp"
#include "page/failures.hpp"
#include "page/scene_picture.hpp"
#include "report/colours.hpp"
#include "worlds/scene.hpp"

namespace gridmerge::page {
namespace {

using nlohmann::json;
using study::CurvePoint;
using study::Row;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// The JSON that the page's script reads.
json element(const std::string& html, const std::string& id) {
  const std::string opening = "id=\"" + id + "\">";
  const std::size_t from = html.find(opening) + opening.size();
  return json::parse(html.substr(from, html.find("</script>", from) - from));
}
json data_of(const PageInput& input) { return element(report_page(input), "study-data"); }
json data_of(const std::vector<Row>& rows) { return data_of({.name = "s", .about = "", .rows = rows}); }

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

Row run(std::int64_t number, const std::string& result = "right") {
  Row row;
  row.run = number;
  row.result = result;
  row.method = "genetic";
  row.set = "office";
  row.pair = "office-" + std::to_string(number);
  row.truth = result == "false" || result == "refused" ? "different" : "same";
  return row;
}

/// The texts of a column, row by row.
std::vector<std::string> texts(const json& column) {
  std::vector<std::string> all;
  for (const std::size_t word : column.at("at")) {
    all.push_back(column.at("words").at(word));
  }
  return all;
}

TEST(ReportPage, HoldsEveryFieldOfEveryRow) {
  std::vector<Row> rows = {run(7), run(8, "missed")};
  rows[0].error_m = 0.125;
  rows[0].target_walls = 123456789012;
  rows[0].pose_right = true;
  const json data = data_of(rows);
  EXPECT_EQ(data.at("count"), 2);
  const json& columns = data.at("columns");
  EXPECT_EQ(columns.at("run"), json({7, 8}));
  EXPECT_EQ(columns.at("error_m"), json({0.125, 0.0}));
  EXPECT_EQ(columns.at("target_walls"), json({123456789012, 0}));
  EXPECT_EQ(columns.at("pose_right"), json({1, 0}));
  EXPECT_THAT(texts(columns.at("result")), ElementsAre("right", "missed"));
  EXPECT_THAT(texts(columns.at("set")), ElementsAre("office", "office"));
  EXPECT_THAT(columns.at("set").at("words"), SizeIs(1));
}

TEST(ReportPage, TellsSeedsToTheLastDigit) {
  std::vector<Row> rows = {run(0)};
  rows[0].seed = std::numeric_limits<std::uint64_t>::max();
  EXPECT_THAT(texts(data_of(rows).at("columns").at("seed")), ElementsAre("18446744073709551615"));
}

TEST(ReportPage, TellsWhatIsNotKnownAsNull) {
  std::vector<Row> rows = {run(0), run(1)};
  rows[0].error_m = kNotKnown;
  rows[0].align_s = std::numeric_limits<double>::infinity();
  rows[1].figures = {{"evidence_m", 1.5}};
  const json data = data_of(rows);
  EXPECT_TRUE(data.at("columns").at("error_m")[0].is_null());
  EXPECT_TRUE(data.at("columns").at("align_s")[0].is_null());
  EXPECT_EQ(data.at("figures"), json::parse(R"([{"name": "evidence_m", "values": [null, 1.5]}])"));
}

TEST(ReportPage, IsWholeWithoutAnyRun) {
  const json data = data_of(std::vector<Row>());
  EXPECT_EQ(data.at("count"), 0);
  EXPECT_EQ(data.at("columns").at("run"), json::array());
  EXPECT_THAT(texts(data.at("columns").at("set")), IsEmpty());
  EXPECT_EQ(data.at("curves").at("drawn"), json::array());
}

TEST(ReportPage, KeepsTextsFromEndingAnElement) {
  const std::string evil = "</script><script>alert(1)</script><!-- \"'& {{data}} \\ \xE2\x80\xA8";
  std::vector<Row> rows = {run(0)};
  rows[0].set = evil;
  rows[0].reason = evil;
  rows[0].figures = {{evil, 1}};
  const std::vector<FailurePicture> failures = {{.run = 0, .found = {}, .truth = {}, .scene = {}, .note = evil}};
  const PageInput input{
      .name = evil, .about = evil, .rows = rows, .curves = {}, .failures = failures, .command_of = [&](const Row&) {
        return evil;
      }};
  const std::string html = report_page(input);
  const std::vector<Row> tame_rows = {run(0)};
  const std::string tame = report_page({.name = "tame", .about = "", .rows = tame_rows});
  EXPECT_EQ(occurrences(html, "<script"), occurrences(tame, "<script"));
  EXPECT_EQ(occurrences(html, "</script"), occurrences(tame, "</script"));
  const json data = element(html, "study-data");
  EXPECT_EQ(data.at("name"), evil);
  EXPECT_EQ(data.at("failures")[0].at("note"), evil);
  EXPECT_THAT(texts(data.at("columns").at("set")), ElementsAre(evil));
  EXPECT_THAT(texts(data.at("commands")), ElementsAre(evil));
  EXPECT_THAT(html, HasSubstr("<h1>&lt;/script&gt;"));
}

TEST(ReportPage, RepairsWhatIsNotUtf8) {
  std::vector<Row> rows = {run(0)};
  rows[0].pair = "map\xFF.yaml";
  const std::string html = report_page({.name = "a\xC3", .about = "\x80", .rows = rows});
  EXPECT_THAT(texts(element(html, "study-data").at("columns").at("pair")), ElementsAre("map\xEF\xBF\xBD.yaml"));
  EXPECT_EQ(html.find('\xFF'), html.npos);
  EXPECT_THAT(html, HasSubstr("<h1>a\xEF\xBF\xBD</h1>"));
}

TEST(ReportPage, AsksNoNetwork) {
  const std::string html = report_page({.name = "s", .about = ""});
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, HasSubstr("Chart.js v3."));
  for (const std::string loads : {"src=\"http", "href=\"http", "@import", "url(http", "<link"}) {
    EXPECT_EQ(html.find(loads), html.npos) << loads;
  }
}

TEST(ReportPage, LeavesNoPlaceholder) {
  const std::string html = report_page({.name = "s", .about = ""});
  for (const std::string name : {"title", "css", "data", "pictures", "chart_library", "script"}) {
    EXPECT_EQ(html.find("{{" + name + "}}"), html.npos) << name;
  }
}

/// A run whose fitness rises by one an iteration to `last`, and whose errors are given.
std::vector<CurvePoint> rising(std::int64_t number, int last, const std::vector<double>& errors_m) {
  std::vector<CurvePoint> points;
  for (int i = 0; i <= last; ++i) {
    const double error = errors_m.empty() ? kNotKnown : errors_m[std::min<std::size_t>(i, errors_m.size() - 1)];
    points.push_back({number, i, static_cast<double>(i), 0.9, error, 0});
  }
  return points;
}

json curves_of(const std::vector<Row>& rows, const std::vector<CurvePoint>& curves, int most = 1500) {
  return data_of({.name = "s",
                  .about = "",
                  .rows = rows,
                  .curves = curves,
                  .failures = {},
                  .command_of = {},
                  .max_curve_runs = most})
      .at("curves");
}

TEST(ReportPage, SaysWhenARunGotHowFar) {
  std::vector<Row> rows = {run(4)};
  rows[0].tolerance_m = 0.3;
  // Within the tolerance at 1, again beyond it at 2, and for good from 3 on.
  const json curves = curves_of(rows, rising(4, 20, {5, 0.2, 0.4, 0.3, 0.1}));
  EXPECT_EQ(curves.at("milestones"), json({{4, 10, 18, 3}}));
}

TEST(ReportPage, KnowsRunsThatNeverSettle) {
  const std::vector<Row> rows = {run(0), run(1), run(2)};
  std::vector<CurvePoint> points = rising(0, 4, {5});
  const std::vector<CurvePoint> without_truth = rising(1, 4, {});
  points.insert(points.end(), without_truth.begin(), without_truth.end());
  points.push_back({2, 0, -3, 0, kNotKnown, kNotKnown});
  EXPECT_EQ(curves_of(rows, points).at("milestones"), json::parse("[[0,2,4,null],[1,2,4,null],[2,null,null,null]]"));
}

TEST(ReportPage, TakesCurvePointsInAnyOrder) {
  const std::vector<Row> rows = {run(0), run(1)};
  std::vector<CurvePoint> points = rising(1, 30, {5, 1});
  const std::vector<CurvePoint> others = rising(0, 10, {5, 1});
  points.insert(points.end(), others.begin(), others.end());
  const json sorted = curves_of(rows, points);
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(curves_of(rows, points), sorted);
  EXPECT_THAT(sorted.at("drawn"), SizeIs(2));
}

TEST(ReportPage, DrawsASampleOfManyCurvesAndCountsAll) {
  std::vector<Row> rows;
  std::vector<CurvePoint> points;
  for (int i = 0; i < 100; ++i) {
    rows.push_back(run(i));
    const std::vector<CurvePoint> own = rising(i, 1000, {1});
    points.insert(points.end(), own.begin(), own.end());
  }
  points.push_back({12345, 0, 1, 1, 1, 1});  // of no row
  const json curves = curves_of(rows, points, 10);
  EXPECT_THAT(curves.at("milestones"), SizeIs(100));
  ASSERT_THAT(curves.at("drawn"), SizeIs(10));
  EXPECT_EQ(curves.at("drawn")[9].at("run"), 90);
  const json& iterations = curves.at("drawn")[0].at("iteration");
  EXPECT_LE(iterations.size(), 241U);
  EXPECT_EQ(iterations.front(), 0);
  EXPECT_EQ(iterations.back(), 1000);
}

std::vector<std::string> results_of(const std::vector<Row>& rows, const std::vector<std::size_t>& chosen) {
  std::vector<std::string> results;
  for (const std::size_t i : chosen) {
    results.push_back(rows[i].result);
  }
  return results;
}

TEST(ChooseFailures, PutsTheGravestFirst) {
  const std::vector<Row> rows = {run(0, "missed"),  run(1, "right"), run(2, "wrong"),
                                 run(3, "refused"), run(4, "false"), run(5, "unknown")};
  EXPECT_THAT(results_of(rows, choose_failures(rows, 40)), ElementsAre("false", "wrong", "missed"));
  EXPECT_THAT(results_of(rows, choose_failures(rows, 2)), ElementsAre("false", "wrong"));
  EXPECT_THAT(choose_failures(rows, 0), IsEmpty());
  EXPECT_THAT(choose_failures({}, 40), IsEmpty());
}

TEST(ChooseFailures, TakesTurnsBetweenSetsAndMethods) {
  std::vector<Row> rows;
  for (int i = 0; i < 60; ++i) {
    rows.push_back(run(i, i % 2 == 0 ? "wrong" : "false"));
    rows.back().set = i < 54 ? "office" : "maze";
    rows.back().method = i % 4 < 2 ? "genetic" : "som";
  }
  std::set<std::string> seen;
  for (const std::size_t i : choose_failures(rows, 8)) {
    seen.insert(rows[i].result + rows[i].set + rows[i].method);
  }
  EXPECT_THAT(seen, SizeIs(8));
}

TEST(ChooseFailures, TakesAnotherPairBeforeTheSameAgainAndTheConfidentFirst) {
  std::vector<Row> rows = {run(0, "wrong"), run(1, "wrong"), run(2, "wrong"), run(3, "wrong")};
  rows[0].pair = rows[1].pair = rows[2].pair = "a";
  rows[0].confidence = 0.7;
  rows[1].confidence = 0.9;
  rows[2].confidence = kNotKnown;
  rows[3].confidence = 0.1;
  EXPECT_THAT(choose_failures(rows, 40), ElementsAre(1, 3, 0, 2));
}

TEST(ChooseFailures, PassesManyRobotsOver) {
  std::vector<Row> rows = {run(0, "wrong")};
  rows[0].robots = 3;
  EXPECT_THAT(choose_failures(rows, 40), IsEmpty());
}

worlds::SceneOptions small_scene(const std::string& relation = "overlap") {
  worlds::SceneOptions options;
  options.kind = "flat";
  options.relation = relation;
  options.resolution_m = 0.1;
  return options;
}

PairMaps small_pair(const Row&) {
  worlds::MapPair pair = make_scene(small_scene());
  return {std::move(pair.target), std::move(pair.source), tracks_of(small_scene())};
}

FailureOptions drawn_by(std::function<PairMaps(const Row&)> maps_of, int num_threads = 1) {
  return {.num_threads = num_threads, .maps_of = std::move(maps_of)};
}

Row wrong_run() {
  Row row = run(5, "wrong");
  row.figures = {{"evidence_m", 1}};
  row.x_m = 1;
  row.truth_x_m = 2;
  return row;
}

TEST(DrawFailures, ShowsThePoseFoundTheTruthAndTheScene) {
  const std::vector<Row> rows = {run(0), wrong_run()};
  const std::vector<FailurePicture> pictures = draw_failures(rows, drawn_by(small_pair));
  ASSERT_THAT(pictures, SizeIs(1));
  EXPECT_EQ(pictures[0].run, 5);
  EXPECT_NE(pictures[0].found, pictures[0].truth);
  for (const std::string& png : {pictures[0].found, pictures[0].truth, pictures[0].scene}) {
    const RasterImage image = decode_image(png, "picture");
    EXPECT_LE(std::max(image.width, image.height), 700);
    EXPECT_GE(image.width, 300);
  }
}

TEST(DrawFailures, LeavesOutWhatThereIsNotToShow) {
  Row without_pose = run(0, "missed");
  Row without_truth = wrong_run();
  without_truth.result = "false";
  without_truth.truth = "different";
  const std::vector<Row> rows = {without_pose, without_truth};
  const std::vector<FailurePicture> pictures = draw_failures(rows, drawn_by([](const Row& row) {
                                                               PairMaps maps = small_pair(row);
                                                               maps.tracks.reset();
                                                               return maps;
                                                             }));
  ASSERT_THAT(pictures, SizeIs(2));
  EXPECT_NE(pictures[0].found, "");
  EXPECT_EQ(pictures[0].truth, "");
  EXPECT_EQ(pictures[1].found, "");
  EXPECT_NE(pictures[1].truth, "");
  EXPECT_EQ(pictures[1].scene, "");
}

TEST(DrawFailures, DrawTheSameAtAnyNumberOfThreads) {
  const std::vector<Row> rows = {wrong_run(), run(6, "missed"), run(7, "missed")};
  const auto drawn = [&](int threads) {
    std::string all;
    for (const FailurePicture& picture : draw_failures(rows, drawn_by(small_pair, threads))) {
      all += picture.found + picture.truth + picture.scene;
    }
    return all;
  };
  EXPECT_EQ(drawn(1), drawn(4));
}

TEST(DrawFailures, SayWhyThereIsNoPicture) {
  const std::vector<Row> rows = {wrong_run()};
  const std::vector<FailurePicture> pictures =
      draw_failures(rows, drawn_by([](const Row&) -> PairMaps { throw InputError("gone.yaml", "no such file"); }));
  ASSERT_THAT(pictures, SizeIs(1));
  EXPECT_EQ(pictures[0].note, "gone.yaml: no such file");
  EXPECT_EQ(pictures[0].found, "");
}

TEST(DrawFailures, GoIntoThePageAsTheyAre) {
  const std::vector<Row> rows = {run(0, "wrong")};
  const std::vector<FailurePicture> failures = {
      {.run = 0, .found = "any bytes\xFF", .truth = "ab", .scene = {}, .note = {}}};
  const json pictures = element(
      report_page({.name = "s", .about = "", .rows = rows, .curves = {}, .failures = failures}), "picture-data");
  EXPECT_EQ(pictures, json::parse(R"([{"found": "data:image/png;base64,YW55IGJ5dGVz/w==",
                                       "truth": "data:image/png;base64,YWI=", "scene": null}])"));
}

/// How many pixels have exactly this colour.
int pixels(const RasterImage& image, Colour colour) {
  int count = 0;
  for (std::size_t i = 0; i < image.samples.size(); i += 3) {
    count += Colour{image.samples[i], image.samples[i + 1], image.samples[i + 2]} == colour ? 1 : 0;
  }
  return count;
}

TEST(ScenePicture, ShowsWallsAndBothWaysAtScale) {
  worlds::Tracks tracks;
  tracks.target.world = {
      .length_m = 20, .depth_m = 10, .walls = {{{0, 0}, {20, 0}}, {{20, 0}, {20, 10}}}, .discs = {}, .places = {}};
  tracks.source.world = tracks.target.world;
  tracks.target.world_from_robot = {{2, 2, 0}, {18, 2, 0}};
  tracks.source.world_from_robot = {{2, 8, 0}, {10, 8, 0}};
  const RasterImage image = draw_scene(tracks);
  EXPECT_EQ(image.width, 700);
  EXPECT_LT(image.height, 500);
  EXPECT_GT(pixels(image, kInkColour), 500);
  const double ratio = double(pixels(image, wall_colour(0))) / pixels(image, wall_colour(1));
  EXPECT_NEAR(ratio, 2, 0.4) << "the target's way is twice as long";
}

TEST(ScenePicture, ShowsTwoWorldsApart) {
  const RasterImage image = draw_scene(tracks_of(small_scene("two_worlds")));
  EXPECT_LE(std::max(image.width, image.height), 700);
  EXPECT_GT(pixels(image, wall_colour(0)), 100);
  EXPECT_GT(pixels(image, wall_colour(1)), 100);
}

TEST(ScenePicture, IsDrawnOfAnEmptyPlace) {
  EXPECT_GT(draw_scene({}).height, 0);
  EXPECT_THROW((void)draw_scene({}, 399), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge::page
