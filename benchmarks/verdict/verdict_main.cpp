/// gridmerge_verdict: judges the verdict on pairs with known truth, and fits its weights.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "config/config_file.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/library_threads.hpp"
#include "gridmerge/base/parallel.hpp"
#include "map_server/whole_files.hpp"
#include "methods/register_all.hpp"
#include "verdict/fit.hpp"
#include "verdict/pictures.hpp"
#include "verdict/tables.hpp"

namespace {

using namespace gridmerge;
using namespace gridmerge::verdict_study;

constexpr int kFolds = 5;

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) {
    words.push_back(word);
  }
  return words;
}

void run_rows(const PairOptions& options, const std::filesystem::path& output) {
  WholeFiles().stage(output, "");  // better to know now than after an hour
  const std::vector<PairPlan> plans = plan_pairs(options);
  const auto method = all_methods().entries().front().profiles.front().config()->make();
  Watcher watcher;
  if (isatty(STDERR_FILENO) != 0) {
    watcher = [](std::size_t done, std::size_t of) {
      std::cerr << "\r" << done << " of " << of << " pairs" << (done == of ? "\n" : "") << std::flush;
    };
  }
  write_whole_file(output, to_csv(make_rows(plans, *method, {}, options.threads, watcher)));
}

/// "KIND=W" each. Others count once, but for the manifests' own pairs: those the verdict is judged on.
std::vector<double> importance_of(const std::vector<Row>& rows, const std::vector<std::string>& arguments) {
  std::map<std::string, double> of_kind;
  for (const Row& row : rows) {
    of_kind[row.kind] = row.kind == "pair" ? 0 : 1;
  }
  for (const std::string& argument : arguments) {
    const std::size_t equals = std::min(argument.find('='), argument.size());
    const auto kind = of_kind.find(argument.substr(0, equals));
    double value = -1;
    std::istringstream stream(argument.substr(std::min(equals + 1, argument.size())));
    if (kind == of_kind.end() || !(stream >> value) || !stream.eof() || !(value >= 0)) {
      throw InputError("--weight " + argument, "KIND=NUMBER is wanted: a kind that the rows have, and no less than 0");
    }
    kind->second = value;
  }
  std::vector<double> importance;
  for (const Row& row : rows) {
    importance.push_back(of_kind.at(row.kind));
  }
  return importance;
}

/// The weights alone, as the section `verdict` of a configuration; four digits say enough.
std::string weights_yaml(ConfidenceWeights weights) {
  const OptionList list = option_list(weights);
  for (const OptionField& field : list.fields()) {
    double& weight = *std::get<double*>(field.value);
    weight = std::round(weight * 1e4) / 1e4;
  }
  return to_yaml("verdict", list);
}

std::vector<double> told_by(const std::vector<Row>& rows, const ConfidenceWeights& weights) {
  std::vector<double> confidence;
  for (const Row& row : rows) {
    confidence.push_back(confidence_of(row, weights));
  }
  return confidence;
}

/// The rows of drawn scenes, or those of real maps and of the manifests.
std::vector<Row> part_of(const std::vector<Row>& rows, bool drawn) {
  std::vector<Row> part;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(part),
               [&](const Row& row) { return row.a.starts_with("drawn_") == drawn; });
  return part;
}

void print_judgement(const std::string& name, const std::vector<Row>& rows, const std::vector<double>& confidence) {
  std::cout << "\n## " << name << "\n\n### By strictness\n\n"
            << strictness_table(rows, confidence) << "\n### By overlap\n\n"
            << overlap_table(rows, confidence) << "\n### Reliability\n\n"
            << reliability_table(rows, confidence);
}

void run_fit(const std::vector<Row>& rows, const std::vector<std::string>& kinds, std::uint64_t seed, double ridge,
             const std::filesystem::path& output, const std::string& command) {
  const std::vector<double> importance = importance_of(rows, kinds);
  const ConfidenceWeights fitted = fit_weights(rows, importance, ridge);
  const std::vector<std::string> folds = chance_keys(rows, kFolds, seed);
  const std::vector<std::string> places = place_keys(rows);
  const WeightsByKey by_fold = fit_without(rows, importance, folds, std::equal_to<>());
  const WeightsByKey by_place = fit_without(rows, importance, places, share_a_place);
  std::size_t counted = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    counted += is_fitted(rows[i]) && importance[i] > 0 ? 1 : 0;
  }
  const std::string yaml = "# What the figures of the confidence weigh (docs/verdict.md). Fitted to " +
                           std::to_string(counted) + " rows by\n#     " + command + "\n" + weights_yaml(fitted);
  if (output.empty()) {
    std::cout << "```yaml\n" << yaml << "```\n\n";
  } else {
    write_whole_file(output, yaml);
  }
  std::cout << "Fitted to " << counted << " of " << rows.size() << " rows.\n\n"
            << weight_table(VerdictOptions::learned_weights(), fitted, by_place);
  print_judgement("Fitted, in " + std::to_string(kFolds) + " folds", rows, confidence_of(rows, folds, by_fold));
  print_judgement("Fitted, place by place", rows, confidence_of(rows, places, by_place));
}

/// What the built-in verdict did, on rows that it was not fitted to.
void run_judge(const std::vector<Row>& rows, const std::filesystem::path& pictures) {
  const ConfidenceWeights weights = VerdictOptions::learned_weights();
  std::vector<Told> told;
  for (const bool drawn : {true, false}) {
    const std::vector<Row> part = part_of(rows, drawn);
    if (part.empty()) {
      continue;
    }
    const std::string name = drawn ? "drawn scenes" : "real maps";
    const std::vector<double> confidence = told_by(part, weights);
    print_judgement(name, part, confidence);
    told.push_back({name, part, confidence});
  }
  std::vector<double> seconds;
  for (const Row& row : rows) {
    seconds.push_back(row.judge_s);
  }
  std::sort(seconds.begin(), seconds.end());
  if (!seconds.empty()) {
    std::cout << "\nTime of the verdict, on one thread: median " << 1e3 * seconds[seconds.size() / 2] << " ms, 95 % "
              << 1e3 * seconds[seconds.size() * 95 / 100] << " ms.\n";
  }
  if (!pictures.empty()) {
    write_pictures(told, pictures);
  }
}

}  // namespace

int main(int argc, char** argv) {
  gridmerge::keep_opencv_on_the_calling_thread();
  CLI::App app("Judges the verdict on pairs of maps with known truth, and fits the weights of its confidence.");
  app.require_subcommand(1);
  const auto cores = available_threads();
  PairOptions options = {.manifests = {}, .same_building = {}, .threads = cores};
  std::vector<std::string> groups;
  std::vector<std::string> weights;
  std::filesystem::path output;
  std::filesystem::path input;
  std::filesystem::path pictures;
  std::string command = "gridmerge_verdict fit";
  double ridge = 1;
  std::uint64_t fold_seed = 1;

  CLI::App* rows = app.add_subcommand("rows", "Aligns pairs and writes what was said of each");
  rows->add_option("manifests", options.manifests,
                   "CSV files that list pairs (columns set, a, b, truth, tx, ty, theta, tol_m, tol_deg, tags)")
      ->check(CLI::ExistingFile);
  rows->add_option("--same-building", groups, "Sets SET,SET,... that show one building in part; again for another")
      ->take_all();
  rows->add_option("--cross", options.cross, "Pairs of maps of different buildings")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  rows->add_option("--scenes", options.scenes, "Drawn pairs")->check(CLI::Range(0, 1000000))->capture_default_str();
  rows->add_option("--seed", options.seed, "Of all chance")->capture_default_str();
  rows->add_option("--threads", options.threads, "Threads; they change the time only")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  rows->add_option("-o,--output", output, "CSV file to write")->required();

  CLI::App* fit = app.add_subcommand("fit", "Fits the weights to rows; prints them and what they would do");
  fit->add_option("rows", input, "CSV file that `rows` wrote")->required()->check(CLI::ExistingFile);
  fit->add_option("--weight", weights, "KIND=W: how much rows of a kind count (others: 1)")->take_all();
  fit->add_option("--seed", fold_seed, "Of the folds")->capture_default_str();
  fit->add_option("-o,--output", output, "YAML file for the weights, as `gridmerge --config` takes it");

  fit->add_option("--ridge", ridge, "Pulls the weights to zero, the figures scaled to deviation 1")
      ->capture_default_str();
  fit->add_option("--command", command, "How it was fitted, for the file's heading");

  CLI::App* judge_rows = app.add_subcommand("judge", "How sure the built-in confidence is, and how often it is right");
  judge_rows->add_option("rows", input, "CSV file that `rows` wrote, of pairs that the weights were not fitted to")
      ->required()
      ->check(CLI::ExistingFile);
  judge_rows->add_option("--pictures", pictures, "Folder for reliability.png and roc.png");

  CLI::App* table = app.add_subcommand("table", "Prints what the built-in verdict did on rows");
  table->add_option("rows", input, "CSV file that `rows` wrote")->required()->check(CLI::ExistingFile);

  CLI11_PARSE(app, argc, argv);
  try {
    if (rows->parsed()) {
      for (const std::string& group : groups) {
        options.same_building.push_back(words_of(group));
      }
      run_rows(options, output);
    } else if (fit->parsed()) {
      run_fit(read_rows(input), weights, fold_seed, ridge, output, command);
    } else if (judge_rows->parsed()) {
      run_judge(read_rows(input), pictures);
    } else {
      std::cout << outcome_table(read_rows(input));
    }
  } catch (const std::exception& error) {
    std::cerr << "gridmerge_verdict: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
