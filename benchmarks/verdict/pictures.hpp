#pragma once
/// Reliability and ROC as pictures.
#include <filesystem>
#include <string>
#include <vector>

#include "verdict/fit.hpp"

namespace gridmerge::verdict_study {

/// Rows and what they were told.
struct Told {
  std::string name;  ///< of the curve
  std::vector<Row> rows;
  std::vector<double> confidence;
};

/// Writes DIR/reliability.png (share right over confidence, bin by bin, with the diagonal) and DIR/roc.png (right
/// merges over wrong ones, as shares of what could be merged rightly and of what must not be; wrong ones up to 5 %).
/// @throws InputError if a file cannot be written
void write_pictures(const std::vector<Told>& told, const std::filesystem::path& folder);

}  // namespace gridmerge::verdict_study
