#include "methods/hough_spectrum/hough_views.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gridmerge/base/fourier.hpp"

namespace gridmerge::hough {
namespace {

Curve curve(const std::string& label, std::span<const float> values, double first_x, double step_x) {
  Curve curve{.label = label, .x = std::vector<double>(values.size()), .y = {values.begin(), values.end()}};
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    curve.x[i] = first_x + step_x * static_cast<double>(i);
  }
  return curve;
}

/// Scaled so that its highest value is 1: spectra of maps of different size are compared by their shape.
std::vector<float> normalised(std::span<const float> values) {
  const float high = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  std::vector<float> scaled(values.begin(), values.end());
  for (float& value : scaled) {
    value = high > 0 ? value / high : value;
  }
  return scaled;
}

}  // namespace

View transform_view(const std::string& name, const std::string& whose, const HoughTransform& transform) {
  SurfaceView surface{.width = transform.angles,
                      .height = transform.rhos,
                      .values = std::vector<float>(transform.votes.size()),
                      .x_low = -180.0 / transform.angles,
                      .x_high = 360 - 180.0 / transform.angles,
                      .y_low = transform.rho_low_m - 0.5 * transform.rho_step_m,
                      .y_high = -transform.rho_low_m + 0.5 * transform.rho_step_m,
                      .x_label = "angle [deg]",
                      .y_label = "rho [m]",
                      .value_label = "votes",
                      .marks = {}};
  const auto angles = static_cast<std::size_t>(transform.angles);
  for (std::size_t k = 0; k < angles; ++k) {
    const std::span<const float> row = transform.row(static_cast<int>(k));
    for (std::size_t i = 0; i < row.size(); ++i) {
      surface.values[i * angles + k] = row[i];
    }
  }
  return {name, "Hough transform of the " + whose + ": votes of its walls for lines", std::move(surface)};
}

std::vector<View> spectrum_views(std::span<const float> target, std::span<const float> source,
                                 std::span<const float> correlation, std::span<const double> rotations_rad) {
  const double step_deg = 360.0 / static_cast<double>(target.size());
  CurvesView spectra{
      .curves = {curve("target", normalised(target), 0, step_deg), curve("source", normalised(source), 0, step_deg)},
      .x_label = "angle [deg]",
      .y_label = "Hough spectrum [of its highest]",
      .marks = {}};
  CurvesView turned{.curves = {curve("cross-correlation", normalised(correlation), 0, step_deg)},
                    .x_label = "rotation of the source [deg]",
                    .y_label = "correlation [of its highest]",
                    .marks = {}};
  for (const double rotation : rotations_rad) {
    turned.marks.push_back(degrees(rotation < 0 ? rotation + 2 * kPi : rotation));
  }
  return {{"hough_spectra", "Hough spectra: how much wall lies across each direction", std::move(spectra)},
          {"spectrum_correlation", "Circular cross-correlation of the Hough spectra, and the rotations tried",
           std::move(turned)}};
}

std::vector<View> axis_views(const std::string& axis, std::span<const float> target, std::span<const float> source,
                             double step_m, double chosen_m) {
  const double first_m = -static_cast<double>(target.size() / 2) * step_m;
  CurvesView spectra{.curves = {curve("target", target, first_m, step_m), curve("source", source, first_m, step_m)},
                     .x_label = "offset along " + axis + " [m]",
                     .y_label = "votes",
                     .marks = {}};
  std::vector<float> correlation = circular_correlation(source, target);
  // From a shift of 0..n-1 to one about 0.
  const auto half = static_cast<std::ptrdiff_t>(correlation.size() / 2);
  std::rotate(correlation.begin(), correlation.end() - half, correlation.end());
  CurvesView shifted{
      .curves = {curve("cross-correlation", normalised(correlation), -static_cast<double>(half) * step_m, step_m)},
      .x_label = "translation along " + axis + " [m]",
      .y_label = "correlation [of its highest]",
      .marks = {chosen_m}};
  const std::string at_best = " at the best rotation";
  return {{axis + "_spectra", "Walls across " + axis + " by their offset," + at_best, std::move(spectra)},
          {axis + "_correlation", "Cross-correlation of the spectra along " + axis + at_best, std::move(shifted)}};
}

View agreement_view(const Agreement& agreement, std::span<const Translation> best) {
  const double edge_m = (agreement.side + 0.5) * agreement.step_m;
  SurfaceView surface{.width = agreement.columns(),
                      .height = agreement.columns(),
                      .values = agreement.value,
                      .x_low = -edge_m,
                      .x_high = edge_m,
                      .y_low = -edge_m,
                      .y_high = edge_m,
                      .x_label = "translation along x [m]",
                      .y_label = "translation along y [m]",
                      .value_label = "agreement of X- and Y-spectra, by stretch",
                      .marks = {}};
  const Pose2 lattice_from_target{0, 0, -agreement.axis_rad};
  for (const Translation& one : best) {
    surface.marks.push_back(lattice_from_target * one.at);
  }
  return {"agreement", "Agreement of all translations at the best rotation, with the peaks that are tried",
          std::move(surface)};
}

View hypotheses_view(const std::vector<Candidate>& candidates, const AlignRequest& request) {
  MapView map{.map = MapView::Map::kBoth, .local_target_from_source = {}, .shapes = {}};
  Shape centres{.kind = Shape::Kind::kPoints, .label = "where the others put the source's centre", .points = {}};
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Pose2 pose = to_local(candidates[i].target_from_source, request.target, request.source);
    if (i == 0) {
      map.local_target_from_source = pose;
    } else {
      centres.points.push_back(pose.translation());
    }
  }
  map.shapes.push_back(std::move(centres));
  return {"hypotheses", "The best hypothesis and the others", std::move(map)};
}

}  // namespace gridmerge::hough
