#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <ostream>

#include "cli/output_folder.hpp"
#include "cli/usage_error.hpp"
#include "commands/commands.hpp"
#include "commands/option_arguments.hpp"
#include "gridmerge/base/parallel.hpp"
#include "manifest/carpin.hpp"
#include "manifest/folder_conversion.hpp"
#include "manifest/halmstad.hpp"

namespace gridmerge::cli {
namespace {

struct ConvertArguments {
  std::filesystem::path path;
  std::filesystem::path folder;
  HalmstadOptions halmstad;
  CarpinOptions carpin;
  FolderPairOptions pairs;
};

using Convert = std::function<Conversion(const ConvertArguments&)>;

int run_convert(const ConvertArguments& arguments, const Convert& convert, std::ostream& out) {
  const OutputFolder output(arguments.folder);
  const Conversion conversion = convert(arguments);
  for (const std::string& what : conversion.left_out) {
    out << "left out: " << what << "\n";
  }
  out << arguments.folder.string() << ": " << conversion.maps << " maps";
  if (conversion.pairs > 0) {
    out << "; pairs.csv tells the truth of " << conversion.pairs << " pairs";
  } else {
    out << "; no truth is known of any pair, so there is no pairs.csv";
  }
  out << "\n";
  return kDone;
}

CLI::App* add_format(CLI::App& convert, const std::string& name, const std::string& about, const std::string& path,
                     ConvertArguments& arguments) {
  CLI::App* format = convert.add_subcommand(name, about);
  format->add_option("PATH", arguments.path, path)->required();
  format->add_option("-o,--output", arguments.folder, "Folder for the maps and pairs.csv")->required();
  return format;
}

}  // namespace

Command convert_command(const CommandContext& context) {
  const auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = context.app.add_subcommand(
      "convert", "Turns a public data set into maps and a list of pairs with known truth (docs/data-sets.md)");
  command->require_subcommand(1);

  CLI::App* halmstad = add_format(*command, "halmstad", "Halmstad-Robot-Maps: pictures with points marked by hand",
                                  "The repository, as cloned", *arguments);
  add_options(*halmstad, option_list(arguments->halmstad));
  CLI::App* carpin = add_format(*command, "carpin", "Carpin's text grids of 0, 127 and 255",
                                "A .txt file, or a folder of them", *arguments);
  add_options(*carpin, option_list(arguments->carpin));
  CLI::App* folder = add_format(*command, "folder", "A folder of map_server maps, with world.csv if poses are known",
                                "The folder", *arguments);
  add_options(*folder, option_list(arguments->pairs));

  return {command, [=](std::ostream& out) {
            if (halmstad->parsed()) {
              check_options(arguments->halmstad, "convert halmstad");
              return run_convert(
                  *arguments,
                  [](const auto& a) { return convert_halmstad(a.path, a.folder, a.halmstad, available_threads()); },
                  out);
            }
            if (carpin->parsed()) {
              check_options(arguments->carpin, "convert carpin");
              return run_convert(
                  *arguments, [](const auto& a) { return convert_carpin(a.path, a.folder, a.carpin); }, out);
            }
            check_options(arguments->pairs, "convert folder");
            return run_convert(
                *arguments,
                [](const auto& a) { return convert_folder(a.path, a.folder, a.pairs, available_threads()); }, out);
          }};
}

}  // namespace gridmerge::cli
