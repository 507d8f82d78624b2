#include "page/made_up_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "gridmerge/base/random.hpp"

namespace gridmerge {
namespace {

using study::CurvePoint;
using study::Row;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

struct Method {
  std::string name;
  std::string profile;
  std::string options;
  double skill;    // 0..1
  double seconds;  // of a run on 2000 cells
  int iterations;  // 0: none
};
const std::array<Method, 5> kMethods{{{"genetic", "default", "", 0.93, 0.4, 40},
                                      {"genetic", "paper", "", 0.55, 0.25, 60},
                                      {"hough_spectrum", "default", "", 0.8, 0.08, 0},
                                      {"correlative", "default", "correlative.step_deg=2", 0.9, 1.6, 0},
                                      {"som", "default", "", 0.05, 0.9, 25}}};

struct Set {
  std::string name;
  double ease;
};
const std::array<Set, 5> kSets{
    {{"office", 1.0}, {"maze", 0.9}, {"forest", 0.7}, {"hall </script><b>\"x\"", 0.5}, {"corridor, \xFFlong", 0.35}}};

struct Window {
  std::string name;
  double radius_m;
  double half_angle_deg;
};
const std::array<Window, 3> kWindows{{{"none", kNotKnown, 180}, {"10 %", 4.1, 18}, {"30 %", 12.3, 54}}};

double rounded(double value, double step) { return std::round(value / step) * step; }

void ask(Row& row, RandomStream& chance) {
  const Set& set = kSets[chance.below(kSets.size())];
  const std::uint32_t pair = chance.below(6);
  row.set = set.name;
  row.pair = "pair-" + std::to_string(pair);
  row.pair_spec = R"({"scene": {"kind": "office", "seed": )" + std::to_string(pair) + "}}";
  row.truth = pair == 5 ? "different" : "same";
  row.overlap = row.truth == "same" ? rounded(chance.uniform(0.08, 0.95), 0.001) : 0;
  row.drift = rounded(0.01 * chance.below(4), 0.01);
  row.noise_m = std::array{0.005, 0.012, 0.03}[chance.below(3)];
  const Window& window = kWindows[chance.below(kWindows.size())];
  row.window = window.name;
  row.window_m = window.radius_m;
  row.window_deg = window.half_angle_deg;
  row.seed = row.run == 3 ? std::numeric_limits<std::uint64_t>::max() : 1 + chance.below(7);
  row.target_walls = 1500 + chance.below(9000);
  row.source_walls = 1200 + chance.below(8000);
  row.tolerance_m = 0.3;
  row.tolerance_deg = 1.5;
}

double ease_of(const Row& row) {
  const auto set = std::find_if(kSets.begin(), kSets.end(), [&](const Set& s) { return s.name == row.set; });
  return set->ease * (0.35 + 0.75 * std::sqrt(row.overlap)) * (1 - 6 * row.drift) * (row.window == "10 %" ? 1.1 : 0.95);
}

void judge(Row& row, double skill, RandomStream& chance) {
  const double ease = row.truth == "same" ? ease_of(row) : 0;
  row.pose_right = chance.uniform() < std::pow(skill, 0.5) * ease + 0.05;
  row.pose_right = row.pose_right && row.truth == "same" && skill > 0.1;
  const double centre = row.pose_right ? 0.55 + 0.45 * skill : 0.45 - 0.3 * skill;
  row.confidence = std::clamp(centre + 0.22 * chance.normal(), 0.0, 1.0);
  const bool merged = row.confidence > 0.62;
  row.status = merged ? "merged" : row.confidence > 0.4 ? "ambiguous" : "no_overlap";
  if (row.truth == "same") {
    row.result = !merged ? "missed" : row.pose_right ? "right" : "wrong";
  } else {
    row.result = merged ? "false" : "refused";
  }
  row.error_m = row.truth != "same" ? kNotKnown
                : row.pose_right    ? 0.02 + 0.2 * chance.uniform()
                                    : 1 + 9 * chance.uniform();
  row.error_deg = row.truth != "same" ? kNotKnown : row.pose_right ? chance.uniform() : 180 * chance.uniform();
  const std::string length_m = std::to_string(10 + chance.below(90000) / 1000.0);
  row.reason = merged ? "walls agree over " + length_m + " m, and 0.3 m of them lie in free space"
                      : "another pose has " + length_m + " m as well: \"<turned by 180\xC2\xB0>\"";
}

void measure(Row& row, const Method& method, RandomStream& chance) {
  row.iterations = method.iterations;
  const double size = static_cast<double>(row.source_walls) / 2000;
  row.propose_s = method.seconds * (0.1 + 0.9 * size) * std::exp(0.15 * chance.normal());
  row.prepare_s = 0.02 * size;
  row.refine_s = 0.05;
  row.judge_s = 0.03;
  row.align_s = row.prepare_s + row.propose_s + row.refine_s + row.judge_s;
  row.yardstick_s = 0.011;
  row.figures = {{"evidence_m", 40 * row.confidence}, {"acceptance_index", 0.9 + 0.09 * row.confidence}};
  for (int i = 0; i < 28; ++i) {  // as many as a real row has
    row.figures.emplace_back("figure_" + std::to_string(i), chance.normal());
  }
}

void merge_many(Row& row, RandomStream& chance) {
  row.robots = std::array{4, 8, 16, 32}[chance.below(4)];
  row.set = "swarm";
  row.truth = "same";
  row.robots_wrong = static_cast<int>(chance.below(3) / 2);
  row.robots_right = row.robots - row.robots_wrong - static_cast<int>(chance.below(2));
  row.result = row.robots_wrong > 0 ? "wrong" : row.robots_right == row.robots ? "right" : "missed";
  row.align_s *= row.robots;
}

void add_curve(const Row& row, RandomStream& chance, std::vector<CurvePoint>& curves) {
  const double half = 3 + 12 * chance.uniform();
  for (int i = 0; i < row.iterations; ++i) {
    const double risen = 1 / (1 + std::exp(-(i - half) / 3));
    const double goal = row.pose_right ? 1800 : 600;
    const double error = row.pose_right ? 8 * (1 - risen) + 0.05 : 8 - 2 * risen;
    curves.push_back({row.run, i, 200 + goal * risen, 0.9 + (row.pose_right ? 0.09 : 0.03) * risen,
                      row.truth == "same" ? error : kNotKnown, row.truth == "same" ? 4 * error : kNotKnown});
  }
}

}  // namespace

MadeUpStudy made_up_study(int runs, std::uint64_t seed) {
  MadeUpStudy made_up;
  for (int i = 0; i < runs; ++i) {
    RandomStream chance(seed, "made up", static_cast<std::uint64_t>(i));
    const Method& method = kMethods[chance.below(kMethods.size())];
    Row row;
    row.run = i;
    row.method = method.name;
    row.profile = method.profile;
    row.options = method.options;
    ask(row, chance);
    judge(row, method.skill, chance);
    measure(row, method, chance);
    if (method.name == "genetic" && i % 12 == 0) {
      merge_many(row, chance);
    } else if (method.iterations > 0) {
      add_curve(row, chance, made_up.curves);
    }
    row.version = "0.1.0";
    row.commit = "1a2b3c4";
    row.compiler = "GNU 12.2.0";
    row.cpu = "A made-up processor";
    row.threads = 1;
    row.date = "2026-11-22T0" + std::to_string(8 + i % 2) + ":00:00Z";
    made_up.rows.push_back(row);
  }
  return made_up;
}

}  // namespace gridmerge
