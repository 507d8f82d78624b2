#include "manifest/manifest.hpp"

#include "gridmerge/base/error.hpp"
#include "manifest/csv_table.hpp"

namespace gridmerge {

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
                         .scenario = tags.substr(0, tags.find(' '))};
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

}  // namespace gridmerge
