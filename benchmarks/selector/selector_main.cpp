/// gridmerge_selector: learns from the rows of a study what to expect of each method, and judges the choice.
#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "config/bid_file.hpp"
#include "map_server/whole_files.hpp"
#include "selector/learn.hpp"
#include "selector/tables.hpp"
#include "study/rows_csv.hpp"

namespace {

using namespace gridmerge;

std::vector<study::Row> read_all(const std::vector<std::filesystem::path>& files) {
  std::vector<study::Row> rows;
  for (const std::filesystem::path& file : files) {
    const std::vector<study::Row> more = study::read_rows_csv(file);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

std::string book_text(const std::vector<study::Row>& rows, const std::string& command) {
  std::size_t counted = 0;
  for (const study::Row& row : rows) {
    counted += selector_study::is_learned_from(row) ? 1 : 0;
  }
  return "# What the selector (--method auto) expects of each method; what the inputs are: docs/selector.md.\n"
         "# Learned from " +
         std::to_string(counted) + " rows by\n#     " + command +
         "\n# success: log odds that the answer is merged rightly, where the maps overlap. log_seconds: natural\n"
         "# logarithm of the time on one thread. second_chance: log odds that another method merges rightly what one\n"
         "# did not merge.\n" +
         to_yaml(selector_study::learn(rows));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Learns from the rows of a study what to expect of each method, and judges the choice.");
  app.require_subcommand(1);
  std::vector<std::filesystem::path> files;
  std::filesystem::path output;
  std::string told;
  CLI::App* fit = app.add_subcommand("fit", "Learns success and time of every method; writes the selector's YAML");
  fit->add_option("rows", files, "rows.csv of studies")->required()->check(CLI::ExistingFile);
  fit->add_option("-o,--output", output, "YAML file to write; none: to standard output");
  fit->add_option("--command", told, "How it was learned, for the file's heading (this command)");
  CLI::App* table = app.add_subcommand("table", "Prints auto beside every method and the best in hindsight");
  table->add_option("rows", files, "rows.csv of studies")->required()->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  try {
    const std::vector<study::Row> rows = read_all(files);
    if (fit->parsed()) {
      if (told.empty()) {
        told = "gridmerge_selector fit";
        for (const std::filesystem::path& file : files) {
          told += " " + file.filename().string();
        }
      }
      const std::string text = book_text(rows, told);
      if (output.empty()) {
        std::cout << text;
      } else {
        write_whole_file(output, text);
      }
    } else {
      std::cout << selector_study::comparison_table(rows) << '\n' << selector_study::choice_table(rows);
    }
  } catch (const std::exception& error) {
    std::cerr << "gridmerge_selector: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
