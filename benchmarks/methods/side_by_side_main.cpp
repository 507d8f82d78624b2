/// gridmerge_side_by_side: every method on the same pairs, interleaved; prints a Markdown table a set.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <memory>

#include "gridmerge/align/pipeline.hpp"
#include "gridmerge/base/library_threads.hpp"
#include "gridmerge/base/parallel.hpp"
#include "gridmerge/base/random.hpp"
#include "manifest/manifest.hpp"
#include "map_server/map_files.hpp"
#include "methods/register_all.hpp"
#include "plugin/plugin_loader.hpp"
#include "worlds/scene.hpp"

namespace {

using namespace gridmerge;

struct Arguments {
  std::vector<std::filesystem::path> manifests;
  std::vector<std::string> methods;
  std::vector<std::filesystem::path> plugins;
  std::string profile = "default";
  std::vector<double> prior;
  int repeats = 1;
  int every = 1;
  int threads = available_threads();
};

struct Pair {
  std::string set;
  OccupancyGrid target;
  OccupancyGrid source;
  KnownPose truth;
};

std::vector<Pair> drawn_pairs() {
  std::vector<Pair> pairs;
  for (const char* kind : {"office", "maze", "flat"}) {
    for (int seed = 1; seed <= 4; ++seed) {
      worlds::MapPair scene = worlds::make_scene({.kind = kind, .seed = seed});
      pairs.push_back({std::string("drawn ") + kind,
                       std::move(scene.target),
                       std::move(scene.source),
                       {scene.target_from_source, 0.3, radians(3)}});
    }
  }
  return pairs;
}

std::vector<Pair> listed_pairs(const Arguments& arguments) {
  std::vector<Pair> pairs;
  for (const std::filesystem::path& manifest : arguments.manifests) {
    int index = 0;
    for (const ManifestPair& listed : read_manifest(manifest)) {
      if (listed.truth && index++ % arguments.every == 0) {
        pairs.push_back({listed.set, read_map(listed.target_yaml), read_map(listed.source_yaml), *listed.truth});
      }
    }
  }
  return pairs;
}

/// Where errors are measured: the centre of what the source knows.
Point2 centre_of(const OccupancyGrid& grid) { return PreparedMap(grid, grid.geometry.resolution_m).centre_in_map(); }

/// The truth moved by chance, at most so far and so much.
PosePrior rough_start(const Pair& pair, const std::vector<double>& reach, std::uint64_t index) {
  RandomStream random(1, "side by side", index);
  const Point2 centre = centre_of(pair.source);
  const Pose2& truth = pair.truth.target_from_source;
  const double turn_rad = radians(random.uniform(-reach[1], reach[1]));
  const double way_rad = random.uniform(-kPi, kPi);
  const double far_m = reach[0] * std::sqrt(random.uniform());
  const Point2 at = truth * centre + Point2{far_m * std::cos(way_rad), far_m * std::sin(way_rad)};
  const Pose2 turned{0, 0, wrap_angle(truth.theta_rad + turn_rad)};
  const Point2 shift = at - turned * centre;
  return {.target_from_source = {shift.x_m, shift.y_m, turned.theta_rad},
          .radius_m = reach[0],
          .angle_rad = radians(reach[1])};
}

/// What one method did on one set.
struct Tally {
  int pairs = 0;
  int right = 0;
  int wrongly_merged = 0;
  int merged = 0;
  std::vector<double> propose_s;
  std::vector<double> align_s;
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void add(Tally& tally, const Alignment& alignment, const Pair& pair, bool first_time) {
  tally.propose_s.push_back(alignment.seconds.propose);
  tally.align_s.push_back(alignment.seconds.align);
  if (!first_time) {
    return;
  }
  bool right = false;
  if (!alignment.hypotheses.empty()) {
    const PoseDifference error = difference_at(
        centre_of(pair.source), alignment.hypotheses.front().target_from_source.pose, pair.truth.target_from_source);
    right = error.distance_m <= pair.truth.tolerance_m && error.angle_rad <= pair.truth.tolerance_rad;
  }
  const bool merged = alignment.outcome == Outcome::kMerged;
  ++tally.pairs;
  tally.right += right ? 1 : 0;
  tally.merged += merged && right ? 1 : 0;
  tally.wrongly_merged += merged && !right ? 1 : 0;
}

void print(const std::string& set, const std::map<std::string, Tally>& tallies, const std::vector<std::string>& order) {
  double fastest = 1e300;
  for (const auto& [name, tally] : tallies) {
    fastest = std::min(fastest, quantile(tally.align_s, 0.5));
  }
  std::printf(
      "\n### %s\n\n| method | first pose right | merged right | merged wrongly | propose median [s] | "
      "align median [s] | p95 [s] | times the fastest |\n|---|---|---|---|---|---|---|---|\n",
      set.c_str());
  for (const std::string& name : order) {
    const Tally& t = tallies.at(name);
    std::printf("| %s | %d/%d | %d | %d | %.3f | %.3f | %.3f | %.1f |\n", name.c_str(), t.right, t.pairs, t.merged,
                t.wrongly_merged, quantile(t.propose_s, 0.5), quantile(t.align_s, 0.5), quantile(t.align_s, 0.95),
                quantile(t.align_s, 0.5) / fastest);
  }
  std::fflush(stdout);
}

void run(const Arguments& arguments) {
  const MethodRegistry registry = with_plugins(all_methods(), arguments.plugins);
  std::vector<std::string> order;
  std::map<std::string, std::unique_ptr<Merger>> methods;
  for (const MethodEntry& entry : registry.entries()) {
    const bool wanted = arguments.methods.empty() || std::find(arguments.methods.begin(), arguments.methods.end(),
                                                               entry.name) != arguments.methods.end();
    if (wanted) {
      order.push_back(entry.name);
      methods[entry.name] = entry.profile(arguments.profile).config()->make();
    }
  }
  for (const std::string& name : arguments.methods) {
    (void)registry.method(name);  // throws for an unknown one
  }
  const std::vector<Pair> pairs = arguments.manifests.empty() ? drawn_pairs() : listed_pairs(arguments);
  std::map<std::string, std::map<std::string, Tally>> tallies;
  for (int repeat = 0; repeat < arguments.repeats; ++repeat) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Pair& pair = pairs[i];
      const std::optional<PosePrior> prior =
          arguments.prior.empty() ? std::nullopt : std::optional(rough_start(pair, arguments.prior, i));
      for (const std::string& name : order) {
        const Alignment alignment = align({.target = pair.target, .source = pair.source, .prior = prior},
                                          *methods.at(name), {}, {.num_threads = arguments.threads});
        add(tallies[pair.set][name], alignment, pair, repeat == 0);
      }
    }
  }
  for (const auto& [set, of_set] : tallies) {
    print(set, of_set, order);
  }
}

}  // namespace

int main(int argc, char** argv) {
  gridmerge::keep_opencv_on_the_calling_thread();
  CLI::App app("Runs every method on the same pairs, interleaved; prints a Markdown table a set.");
  Arguments arguments;
  app.add_option("manifests", arguments.manifests, "CSV files that list pairs; none: pairs are drawn");
  app.add_option("--methods", arguments.methods, "Only these")->delimiter(',');
  app.add_option("--plugin", arguments.plugins, "Shared libraries that bring methods along");
  app.add_option("--profile", arguments.profile, "Of every method")->capture_default_str();
  app.add_option("--prior", arguments.prior, "Give a start that is off by at most M metres and DEG degrees")
      ->delimiter(',')
      ->expected(2)
      ->type_name("M,DEG");
  app.add_option("--repeats", arguments.repeats, "Every pair so many times")->check(CLI::PositiveNumber);
  app.add_option("--every", arguments.every, "Only every n-th overlapping pair")->check(CLI::PositiveNumber);
  app.add_option("--threads", arguments.threads, "Threads of an alignment")->check(CLI::Range(1, 1024));
  CLI11_PARSE(app, argc, argv);
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "gridmerge_side_by_side: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
