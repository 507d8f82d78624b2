#include "study_rows.hpp"

#include <cstdio>
#include <type_traits>

#include "gridmerge/judge/evaluator.hpp"
#include "study/row_fields.hpp"

namespace gridmerge::study {

Row row_of_everything(std::int64_t run) {
  Row row;
  int number = 1;
  for_each_field(row, [&]<typename Field>(const char* name, Field& field) {
    ++number;
    if constexpr (std::is_same_v<Field, std::string>) {
      field = std::string(name) + " ü, \"" + std::to_string(number) + "\"";
    } else if constexpr (std::is_same_v<Field, bool>) {
      field = true;
    } else if constexpr (std::is_same_v<Field, double>) {
      field = 1.0 / number;
    } else {
      field = static_cast<Field>(number);
    }
  });
  row.run = run;
  row.figures = Figures{}.named();
  for (auto& [name, value] : row.figures) {
    value = 1.0 / ++number;
  }
  return row;
}

std::string in_words(const Row& row) {
  std::string text;
  const auto exact = [](double value) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%a", value);
    return std::string(value != value ? "not known" : digits);
  };
  for_each_field(row, [&]<typename Field>(const char* name, const Field& field) {
    text += std::string(name) + ": ";
    if constexpr (std::is_same_v<Field, std::string>) {
      text += field;
    } else if constexpr (std::is_same_v<Field, double>) {
      text += exact(field);
    } else {
      text += std::to_string(field);
    }
    text += "\n";
  });
  for (const auto& [name, value] : row.figures) {
    text += name + ": " + exact(value) + "\n";
  }
  return text;
}

Row timeless(Row row) {
  row.prepare_s = row.choose_s = row.propose_s = row.refine_s = row.judge_s = row.align_s = row.yardstick_s = 0;
  row.date.clear();
  return row;
}

}  // namespace gridmerge::study
