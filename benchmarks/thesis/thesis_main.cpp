/// gridmerge_thesis: the thesis's experiments again, as a Markdown table.
#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iostream>

#include "gridmerge/base/library_threads.hpp"
#include "gridmerge/base/number_text.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/genetic/hit_fitness.hpp"
#include "thesis/experiment.hpp"

namespace {

using namespace gridmerge;
using namespace gridmerge::thesis;

std::string count(int part, std::size_t of) { return std::to_string(part) + "/" + std::to_string(of); }

/// 0: there is none.
std::string iteration(int number) { return number > 0 ? std::to_string(number) : "-"; }

void print_pair(const ManifestPair& pair, const Setup& setup) {
  const HitFitness fitness(setup.target, setup.source);
  std::cout
      << "\n### " << pair.scenario << "\n\n"
      << "Received map: " << fitness.cell_count() << " occupied cells; fitness at the truth "
      << fixed(static_cast<double>(fitness(setup.truth)) / kOccupied, 0) << ". With both starts on one spot p_i is "
      << fixed(norm(setup.truth.translation()), 2) << " m and " << fixed(degrees(std::abs(setup.truth.theta_rad)), 1)
      << "° off the truth.\n\n"
      << "| window | truth in it | converged | within tolerance | half-way at | final fitness min/median/max | "
         "ms/iteration | thesis: converged | thesis: half-way at | thesis: median fitness | thesis: ms/iteration |\n"
      << "|---|---|---|---|---|---|---|---|---|---|---|\n";
}

void print_window(int percent, const WindowResult& result, const std::optional<PublishedResult>& thesis) {
  const std::vector<double>& fitness = result.fitness;
  std::cout << "| " << percent << " %: ±" << fixed(result.window.radius_m, 1) << " m, ±"
            << fixed(degrees(result.window.angle_rad), 0) << "° | " << (result.truth_inside ? "yes" : "no") << " | "
            << count(result.converged, fitness.size()) << " | " << count(result.exact, fitness.size()) << " | "
            << iteration(result.half_way.value_or(0)) << " | " << fixed(fitness.front(), 0) << " / "
            << fixed(fitness[fitness.size() / 2], 0) << " / " << fixed(fitness.back(), 0) << " | "
            << fixed(1000 * result.iteration_s, 1) << " | ";
  if (thesis) {
    std::cout << count(thesis->converged, static_cast<std::size_t>(thesis->runs)) << " | "
              << iteration(thesis->half_way) << " | " << thesis->median_fitness << " | "
              << fixed(1000 * thesis->iteration_s, 0) << " |" << std::endl;
  } else {
    std::cout << "- | - | - | - |" << std::endl;
  }
}

}  // namespace

int main(int argc, char** argv) {
  gridmerge::keep_opencv_on_the_calling_thread();
  CLI::App app("Runs the genetic method as published over the windows of the thesis; prints a Markdown table.");
  std::filesystem::path manifest;
  ExperimentOptions options;
  options.threads = available_threads();
  app.add_option("manifest", manifest,
                 "CSV file that lists the pairs (columns set, a, b, truth, tx, ty, "
                 "theta, tol_m, tol_deg, tags)")
      ->required();
  app.add_option("--windows", options.window_percent, "Windows [% of half the target map's side]")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seeds", options.seeds, "Runs of each window, with the seeds 1, 2, ..")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--iterations", options.iterations, "Iterations of each run")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "Threads; they change the time only")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  app.add_option("--tolerance-factor", options.tolerance_factor,
                 "A run has converged if its best pose lies within the manifest's tolerance times this")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    for (const ManifestPair& pair : read_manifest(manifest)) {
      if (!pair.truth) {
        continue;
      }
      const Setup setup = set_up(pair, options.threads);
      print_pair(pair, setup);
      for (const int percent : options.window_percent) {
        print_window(percent, run_window(pair, setup, percent, options), published(pair.scenario, percent));
      }
    }
  } catch (const std::exception& error) {
    std::cerr << "gridmerge_thesis: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
