#include "cli/inspection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "cli/watch.hpp"
#include "support/text_map.hpp"

namespace gridmerge::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// Shows a view of every kind, where somebody wants to see them.
class ShowingMethod final : public Merger {
 public:
  [[nodiscard]] MergerTraits traits() const override { return {}; }
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override {
    Proposal proposal;
    proposal.candidates = {{from_local({}, request.target, request.source), 1}};
    if (context.trace != nullptr && context.trace->wants_views()) {
      SurfaceView surface;
      surface.width = surface.height = 1;
      surface.values = {1};
      context.trace->on_view({"surface", "A surface", surface});
      context.trace->on_view({"curves", "Some curves", CurvesView{}});
      context.trace->on_view({"map", "A map", MapView{}});
    }
    return proposal;
  }
};

const OccupancyGrid& room() {
  static const OccupancyGrid room = text_map({"#####", "#...#", "#.#.#", "#####"}, 0.5);
  return room;
}

Alignment aligned(TraceSink* trace) {
  return align({room(), room(), {}}, ShowingMethod(), {}, {.stop = {}, .trace = trace});
}

std::vector<std::string> names_of(const std::vector<View>& views) {
  std::vector<std::string> names;
  for (const View& view : views) {
    names.push_back(view.name);
  }
  return names;
}

std::vector<Picture> pictures(const std::vector<View>& views) {
  return pictures_of(views, {room(), room(), {}}, {}, {}, 1);
}

IterationRecord scored(const std::string& stage, double best, double mean) {
  IterationRecord record;
  record.stage = stage;
  record.best_score = best;
  record.mean_score = mean;
  return record;
}

TEST(Inspection, DrawsWhatAMethodShows) {
  ViewRecorder recorder;
  Watch watch({&recorder});
  const Alignment alignment = aligned(&watch);
  EXPECT_THAT(names_of(recorder.views()), testing::ElementsAre("surface", "curves", "map"));
  const std::vector<Picture> drawn = pictures_of(recorder.views(), {room(), room(), {}}, alignment, {}, 1);
  ASSERT_EQ(drawn.size(), 4U);
  EXPECT_EQ(drawn[0].file, "overlay.png");
  EXPECT_EQ(drawn[1].file, "surface.png");
  EXPECT_EQ(drawn[3].title, "A map");
  for (const Picture& picture : drawn) {
    EXPECT_THAT(picture.bytes, testing::StartsWith("\x89PNG"));
  }
}

TEST(Inspection, AsksForNoViewsWhereNobodyDrawsThem) {
  Progress progress(nullptr);
  TraceFile file("");
  EXPECT_FALSE(Watch({&progress, &file}).wants_views());
  ViewRecorder recorder;
  EXPECT_TRUE(Watch({&progress, &recorder}).wants_views());
}

TEST(Inspection, ShowsTheScoresOfEveryStage) {
  ViewRecorder recorder;
  recorder.on_iteration(scored("propose/walk", 1, 0.5));
  recorder.on_iteration(scored("propose/walk", 2, 1.5));
  ASSERT_THAT(names_of(recorder.views()), testing::ElementsAre("scores"));
  const std::vector<Curve> curves = std::get<CurvesView>(recorder.views()[0].content).curves;
  EXPECT_THAT(curves[0].y, testing::ElementsAre(1, 2));
  EXPECT_THAT(curves[1].y, testing::ElementsAre(0.5, 1.5));
  recorder.on_iteration(scored("propose/Climb", 3, 3));
  EXPECT_THAT(names_of(recorder.views()), testing::ElementsAre("scores_propose_walk", "scores_propose_climb"));
}

TEST(Inspection, RefusesNamesThatAreNoFilesOfTheFolder) {
  for (const std::string name : {"", "../up", "a/b", "Upper", "_x", "two words", "dot.png"}) {
    EXPECT_THAT(
        [&] {
          (void)pictures({{name, "", CurvesView{}}});
        },
        ThrowsMessage<std::invalid_argument>(HasSubstr("'" + name + "': its name")));
  }
  EXPECT_THAT(
      [&] {
        (void)pictures({{"a", "", CurvesView{}}, {"a", "", CurvesView{}}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("'a': another one")));
  EXPECT_THAT(
      [&] {
        (void)pictures({{"overlay", "", CurvesView{}}});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("'overlay': another one")));
}

TEST(Inspection, ThePageTellsTextAsText) {
  const std::string page = page_html({.title = "<b>&", .verdict = "v", .reasons = {"1 < 2"}, .facts = {"\"x\".yaml"}},
                                     {{"a.png", "A > B", ""}});
  EXPECT_THAT(page, AllOf(HasSubstr("<h1>&lt;b&gt;&amp;</h1>"), HasSubstr("<li>1 &lt; 2</li>"),
                          HasSubstr("&quot;x&quot;.yaml"), HasSubstr("<img src=\"a.png\" alt=\"A &gt; B\">")));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace gridmerge::cli
