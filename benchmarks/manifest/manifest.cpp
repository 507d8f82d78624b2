#include "manifest/manifest.hpp"

#include <cstdlib>
#include <stdexcept>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/number_text.hpp"
#include "manifest/csv_table.hpp"
#include "map_server/whole_files.hpp"

namespace gridmerge {
namespace {

const std::vector<std::string>& columns() {
  static const std::vector<std::string> names = {"set", "a",  "b",     "truth",   "tx",      "ty",  "theta",
                                                 "cx",  "cy", "tol_m", "tol_deg", "overlap", "tags"};
  return names;
}

std::optional<Point2> centre_of(const CsvRow& row) {
  const std::optional<double> x = row.number_if_any("cx");
  const std::optional<double> y = row.number_if_any("cy");
  return x && y ? std::optional<Point2>({*x, *y}) : std::nullopt;
}

/// The shortest number of degrees that reads back as the same angle.
std::string degrees_text(double angle_rad) {
  char text[32] = "";
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, degrees(angle_rad));
    if (radians(std::strtod(text, nullptr)) == angle_rad) {
      break;
    }
  }
  return text;
}

std::string optional_text(std::optional<double> value) { return value ? exact(*value) : ""; }

std::vector<std::string> cells_of(const ManifestPair& pair) {
  if (!pair.truth_known) {
    throw std::invalid_argument("write_manifest: the truth of " + pair.target_name + ", " + pair.source_name +
                                " is not known");
  }
  if (pair.truth && !pair.source_centre) {
    throw std::invalid_argument("write_manifest: no source_centre for " + pair.target_name + ", " + pair.source_name);
  }
  std::vector<std::string> cells = {pair.set, pair.target_name, pair.source_name, pair.truth ? "same" : "different"};
  const auto add_if = [&](bool known, auto&& text) { cells.push_back(known ? text() : std::string()); };
  const bool same = pair.truth.has_value();
  const bool centred = pair.source_centre.has_value();
  add_if(same, [&] { return exact(pair.truth->target_from_source.x_m); });
  add_if(same, [&] { return exact(pair.truth->target_from_source.y_m); });
  add_if(same, [&] { return exact(pair.truth->target_from_source.theta_rad); });
  add_if(centred, [&] { return exact(pair.source_centre->x_m); });
  add_if(centred, [&] { return exact(pair.source_centre->y_m); });
  add_if(same, [&] { return exact(pair.truth->tolerance_m); });
  add_if(same, [&] { return degrees_text(pair.truth->tolerance_rad); });
  cells.push_back(optional_text(pair.overlap));
  cells.push_back(pair.tags);
  return cells;
}

}  // namespace

std::vector<ManifestPair> read_manifest(const std::filesystem::path& csv) {
  std::vector<ManifestPair> pairs;
  for (const CsvRow& row : read_csv(csv)) {
    const std::string tags = row.text("tags");
    ManifestPair pair = {.set = row.text("set"),
                         .target_name = row.text("a"),
                         .source_name = row.text("b"),
                         .target_yaml = csv.parent_path() / row.text("a"),
                         .source_yaml = csv.parent_path() / row.text("b"),
                         .truth = {},
                         .scenario = tags.substr(0, tags.find(' ')),
                         .tags = tags,
                         .source_centre = centre_of(row),
                         .overlap = row.number_if_any("overlap")};
    const std::string truth = row.text("truth");
    if (truth == "same") {
      pair.truth = {.target_from_source = {row.number("tx"), row.number("ty"), row.number("theta")},
                    .tolerance_m = row.number("tol_m"),
                    .tolerance_rad = radians(row.number("tol_deg"))};
    } else if (truth != "different") {
      throw InputError(row.where(), "truth: '" + truth + "' is neither same nor different");
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

std::string manifest_text(const std::filesystem::path& csv, const std::vector<ManifestPair>& pairs) {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(pairs.size());
  for (const ManifestPair& pair : pairs) {
    rows.push_back(cells_of(pair));
  }
  return csv_text(csv.string(), columns(), rows);
}

void write_manifest(const std::filesystem::path& csv, const std::vector<ManifestPair>& pairs) {
  write_whole_file(csv, manifest_text(csv, pairs));
}

}  // namespace gridmerge
