#include "report/axis.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/base/number_text.hpp"

namespace gridmerge {
namespace {

/// Multiples of the step within the axis, the first hundred at most; a little beyond its ends, for what rounding takes.
std::vector<double> multiples(double low, double high, double step) {
  std::vector<double> at;
  const double slack = 1e-9 * (high - low);
  const double first = std::ceil((low - slack) / step);
  for (int i = 0; i < 100 && (first + i) * step <= high + slack; ++i) {
    at.push_back((first + i) * step);
  }
  return at;
}

/// The smallest step that needs no more marks than that.
double round_step(double low, double high, int at_most, bool are_degrees) {
  if (are_degrees) {
    for (const double step : {5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0}) {
      if ((high - low) / step > 2 && multiples(low, high, step).size() <= static_cast<std::size_t>(at_most)) {
        return step;
      }
    }
  }
  double power = std::pow(10.0, std::floor(std::log10((high - low) / at_most)));
  for (;; power *= 10) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double step = digit * power;
      if ((high - low) / step <= at_most + 1 &&
          multiples(low, high, step).size() <= static_cast<std::size_t>(at_most)) {
        return step;
      }
    }
  }
}

/// The power of a thousand that brings the largest number of the axis near one; none for what reads well as it is.
int shared_exponent(double low, double high) {
  const double largest = std::max(std::abs(low), std::abs(high));
  const bool reads_well = largest < 1e5 && largest >= 1e-2;
  return reads_well ? 0 : 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

}  // namespace

Ticks round_ticks(double low, double high, int at_most, bool are_degrees) {
  const double step = round_step(low, high, std::max(2, at_most), are_degrees);
  const int exponent = shared_exponent(low, high);
  const double factor = std::pow(10.0, exponent);
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step / factor) - 1e-9)), 0, 9);
  Ticks ticks;
  ticks.at = multiples(low, high, step);
  for (double& at : ticks.at) {
    at = at == 0 ? 0 : at;  // never -0
    ticks.text.push_back(fixed(at / factor, digits));
  }
  ticks.factor = exponent == 0 ? "" : "1e" + std::to_string(exponent);
  return ticks;
}

double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double digits = length / power;
  return (digits >= 5 ? 5 : digits >= 2 ? 2 : 1) * power;
}

std::string unit_of(const std::string& label) {
  const std::size_t open = label.rfind('[');
  const std::size_t close = label.rfind(']');
  const bool has_unit = open != std::string::npos && close != std::string::npos && open < close;
  return has_unit ? label.substr(open + 1, close - open - 1) : "";
}

}  // namespace gridmerge
