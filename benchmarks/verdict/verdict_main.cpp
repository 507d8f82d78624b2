/// gridmerge_verdict: judges the verdict on pairs with known truth, and fits its weights.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "config/config_file.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/parallel.hpp"
#include "map_server/whole_files.hpp"
#include "methods/register_all.hpp"
#include "verdict/fit.hpp"
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

/// "KIND=W" each; kinds that are not named count once.
std::vector<double> importance_of(const std::vector<Row>& rows, const std::vector<std::string>& arguments) {
  std::map<std::string, double> of_kind;
  for (const Row& row : rows) {
    of_kind[row.kind] = 1;
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

/// The weights alone, as the section `verdict` of a configuration.
std::string weights_yaml(VerdictOptions options) {
  OptionList weights;
  const OptionList all = option_list(options);
  for (const Weight& weight : kWeights) {
    for (const OptionField& field : all.fields()) {
      if (field.key == weight.key) {
        weights.add(field.key, options.*weight.value, field.low, field.high, field.text);
      }
    }
  }
  return to_yaml("verdict", weights);
}

void run_fit(const std::vector<Row>& rows, const std::vector<std::string>& weights, std::uint64_t seed,
             const std::filesystem::path& output) {
  const std::vector<double> importance = importance_of(rows, weights);
  const VerdictOptions fitted = fit_weights(rows, importance);
  const auto judgement = [&](const std::string& name, std::vector<double> confidence) {
    const double loss = log_loss(rows, importance, confidence);
    return Judgement{.name = name, .confidence = std::move(confidence), .log_loss = loss};
  };
  const auto by = [&](const VerdictOptions& options) {
    std::vector<double> confidence;
    for (const Row& row : rows) {
      confidence.push_back(confidence_of(row, options));
    }
    return confidence;
  };
  const std::vector<std::string> folds = chance_keys(rows, kFolds, seed);
  const std::vector<std::string> places = place_keys(rows);
  const WeightsByKey by_fold = fit_without(rows, importance, folds, std::equal_to<>());
  const WeightsByKey by_place = fit_without(rows, importance, places, share_a_place);
  const std::vector<Judgement> judgements = {
      judgement("built in", by({})), judgement("fitted", by(fitted)),
      judgement("fitted, in " + std::to_string(kFolds) + " folds", confidence_of(rows, folds, by_fold)),
      judgement("fitted, place by place", confidence_of(rows, places, by_place))};
  const auto counted = std::count_if(rows.begin(), rows.end(), is_fitted);
  const std::string yaml = weights_yaml(fitted);
  if (output.empty()) {
    std::cout << "```yaml\n" << yaml << "```\n\n";
  } else {
    write_whole_file(output, yaml);
  }
  std::cout << "Fitted to " << counted << " of " << rows.size() << " rows.\n\n"
            << weight_table({}, fitted, by_place) << "\nAnswers that pass a threshold: right + **wrong**.\n\n"
            << summary_table(rows, judgements);
  for (const std::size_t shown : {std::size_t{1}, std::size_t{3}}) {
    std::cout << "\n### " << judgements[shown].name << "\n\n" << threshold_table(rows, judgements[shown]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Judges the verdict on pairs of maps with known truth, and fits the weights of its confidence.");
  app.require_subcommand(1);
  const auto cores = available_threads();
  PairOptions options = {.manifests = {}, .same_building = {}, .threads = cores};
  std::vector<std::string> groups;
  std::vector<std::string> weights;
  std::filesystem::path output;
  std::filesystem::path input;
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
      run_fit(read_rows(input), weights, fold_seed, output);
    } else {
      std::cout << outcome_table(read_rows(input));
    }
  } catch (const std::exception& error) {
    std::cerr << "gridmerge_verdict: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
