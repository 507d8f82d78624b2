#include "methods/radon_voronoi/radon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "gridmerge/base/fourier.hpp"
#include "gridmerge/grid/wall_cells.hpp"

namespace gridmerge::radon {
namespace {

/// What the wall cells of one cell of a level add up to.
struct PieceSum {
  Point2f at;
  Point2f free_normal;
  float cos_2_normal = 0;  ///< a surface normal has either sign: twice its angle has not
  float sin_2_normal = 0;
  float count = 0;

  void add(const WallPoint& wall) {
    const Point2f n = wall.surface_normal;
    at.x_m += wall.at.x_m;
    at.y_m += wall.at.y_m;
    free_normal.x_m += wall.free_normal.x_m;
    free_normal.y_m += wall.free_normal.y_m;
    cos_2_normal += n.x_m * n.x_m - n.y_m * n.y_m;
    sin_2_normal += 2 * n.x_m * n.y_m;
    count += 1;
  }
};

WallPiece piece_of(const PieceSum& sum, float cells_across) {
  WallPiece piece{.at = {sum.at.x_m / sum.count, sum.at.y_m / sum.count},
                  .weight = std::min(1.0F, sum.count / cells_across)};
  if (std::hypot(sum.free_normal.x_m, sum.free_normal.y_m) > 0.5F * sum.count) {
    piece.normal_rad = std::atan2(sum.free_normal.y_m, sum.free_normal.x_m);
    piece.has_normal = true;
    piece.one_sided = true;
  } else if (std::hypot(sum.cos_2_normal, sum.sin_2_normal) > 0.5F * sum.count) {
    piece.normal_rad = 0.5F * std::atan2(sum.sin_2_normal, sum.cos_2_normal);
    piece.has_normal = true;
  }
  return piece;
}

/// How much a wall counts in a projection along a direction at `turn_rad` from its normal.
float directed_weight(const WallPiece& piece, float turn_cos) {
  if (!piece.has_normal) {
    return 0;
  }
  const float facing = piece.one_sided ? std::max(0.0F, turn_cos) : std::abs(turn_cos);
  const float squared = facing * facing;
  return piece.weight * squared * squared * (piece.one_sided ? 1.0F : 0.5F);
}

/// The magnitudes of the spectrum of every projection, each projection scaled as the whole sinogram: row-major by
/// angle.
struct Magnitudes {
  int frequencies = 0;
  std::vector<float> value;
};

/// Frequencies above this wavelength only: finer than that, two visits' walls do not repeat.
constexpr double kShortestWave_m = 0.8;

Magnitudes magnitudes(const Sinogram& sinogram) {
  const int length = fast_size(sinogram.offsets);
  const RealTransform transform(length);
  const auto real = real_array(transform.real_size());
  const auto spectrum = spectrum_array(transform.spectrum_size());
  const int highest = static_cast<int>(length * sinogram.offset_step_m / kShortestWave_m);
  Magnitudes result{.frequencies = std::clamp(highest, 1, length / 2), .value = {}};
  result.value.reserve(static_cast<std::size_t>(sinogram.angles) * static_cast<std::size_t>(result.frequencies));
  for (int angle = 0; angle < sinogram.angles; ++angle) {
    std::fill_n(real.get(), transform.real_size(), 0.0F);
    std::copy_n(sinogram.column(angle), sinogram.offsets, real.get());
    transform.forward(real.get(), spectrum.get());
    for (int f = 0; f < result.frequencies; ++f) {
      result.value.push_back(std::abs(spectrum[static_cast<std::size_t>(f)]));
    }
  }
  return result;
}

void require_alike(const Sinogram& a, const Sinogram& b) {
  if (a.angles != b.angles || a.offsets != b.offsets || a.offset_step_m != b.offset_step_m) {
    throw std::invalid_argument("radon: two sinograms of one size are needed");
  }
}

/// Correlation of b with a for every shift of a; 1 where both are the same.
void scale_to_one(std::vector<double>& correlation, double square_a, double square_b) {
  const double scale = square_a > 0 && square_b > 0 ? 1 / std::sqrt(square_a * square_b) : 0;
  for (double& c : correlation) {
    c *= scale;
  }
}

/// One frequency of all angles, mean taken off.
void copy_ring(const Magnitudes& m, int frequency, std::size_t angles, float* ring) {
  float mean = 0;
  for (std::size_t i = 0; i < angles; ++i) {
    ring[i] = m.value[i * static_cast<std::size_t>(m.frequencies) + static_cast<std::size_t>(frequency)];
    mean += ring[i] / static_cast<float>(angles);
  }
  for (std::size_t i = 0; i < angles; ++i) {
    ring[i] -= mean;
  }
}

double sum_of_squares(std::span<const float> values) {
  double sum = 0;
  for (const float v : values) {
    sum += static_cast<double>(v) * static_cast<double>(v);
  }
  return sum;
}

std::vector<float> energies(const Sinogram& sinogram) {
  std::vector<float> energy;
  double mean = 0;
  for (int angle = 0; angle < sinogram.angles; ++angle) {
    const float* column = sinogram.column(angle);
    double sum = 0;
    for (int i = 0; i < sinogram.offsets; ++i) {
      sum += static_cast<double>(column[i]) * static_cast<double>(column[i]);
    }
    energy.push_back(static_cast<float>(sum));
    mean += sum / sinogram.angles;
  }
  for (float& e : energy) {
    e -= static_cast<float>(mean);
  }
  return energy;
}

/// The standard deviation of the Gaussian with the peak's height and curvature.
double sigma_of(double left, double top, double right, double base, double step_rad) {
  const double curvature = (2 * top - left - right) / (step_rad * step_rad);
  const double height = top - base;
  const double sigma = curvature > 0 && height > 0 ? std::sqrt(height / curvature) : step_rad;
  return std::clamp(sigma, 0.25 * step_rad, radians(8));
}

}  // namespace

std::vector<WallPiece> wall_pieces(const PreparedMap& map, const MapLevel& level) {
  const float cells_across = static_cast<float>(level.resolution_m / map.resolution_m());
  std::vector<WallPiece> pieces;
  const std::vector<PieceSum> sums = summed_by_cell<PieceSum>(map, level);
  pieces.reserve(sums.size());
  for (const PieceSum& sum : sums) {
    pieces.push_back(piece_of(sum, cells_across));
  }
  return pieces;
}

std::vector<WallPiece> wall_cells(const PreparedMap& map) {
  std::vector<WallPiece> cells;
  cells.reserve(map.walls().size());
  for (const WallPoint& wall : map.walls()) {
    cells.push_back({.at = wall.at, .weight = 1});
  }
  return cells;
}

Sinogram sinogram(const std::vector<WallPiece>& pieces, Projection projection, int angles, double offset_step_m,
                  double radius_m) {
  const int each_way = static_cast<int>(std::ceil(radius_m / offset_step_m)) + 1;
  Sinogram result{.angles = angles, .offsets = 2 * each_way + 1, .offset_step_m = offset_step_m, .value = {}};
  result.value.assign(static_cast<std::size_t>(angles) * static_cast<std::size_t>(result.offsets), 0.0F);
  struct Direction {
    float x, y;
  };
  std::vector<Direction> directions;
  for (const WallPiece& piece : pieces) {
    directions.push_back({std::cos(piece.normal_rad), std::sin(piece.normal_rad)});
  }
  const float per_step = static_cast<float>(1 / offset_step_m);
  for (int k = 0; k < angles; ++k) {
    const float c = static_cast<float>(std::cos(2 * kPi * k / angles));
    const float s = static_cast<float>(std::sin(2 * kPi * k / angles));
    float* column = &result.value[static_cast<std::size_t>(k) * static_cast<std::size_t>(result.offsets)];
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const WallPiece& piece = pieces[i];
      const float weight = projection == Projection::kPlain
                               ? piece.weight
                               : directed_weight(piece, c * directions[i].x + s * directions[i].y);
      if (weight > 0) {
        // Shared by the two nearest offsets, so that nothing jumps.
        const float at = (c * piece.at.x_m + s * piece.at.y_m) * per_step + static_cast<float>(each_way);
        const auto low = static_cast<std::size_t>(at);
        const float share = at - static_cast<float>(low);
        column[low] += (1 - share) * weight;
        column[low + 1] += share * weight;
      }
    }
  }
  return result;
}

std::vector<double> angle_correlation(const Sinogram& target, const Sinogram& source) {
  require_alike(target, source);
  const Magnitudes of_target = magnitudes(target);
  const Magnitudes of_source = magnitudes(source);
  const auto angles = static_cast<std::size_t>(target.angles);
  const RealTransform transform(target.angles);
  const auto ring = real_array(transform.real_size());
  const auto target_spectrum = spectrum_array(transform.spectrum_size());
  const auto source_spectrum = spectrum_array(transform.spectrum_size());
  const auto product = spectrum_array(transform.spectrum_size());
  double target_square = 0;
  double source_square = 0;
  for (int f = 0; f < of_target.frequencies; ++f) {
    copy_ring(of_target, f, angles, ring.get());
    target_square += sum_of_squares({ring.get(), angles});
    transform.forward(ring.get(), target_spectrum.get());
    copy_ring(of_source, f, angles, ring.get());
    source_square += sum_of_squares({ring.get(), angles});
    transform.forward(ring.get(), source_spectrum.get());
    for (std::size_t i = 0; i < transform.spectrum_size(); ++i) {
      product[i] += target_spectrum[i] * std::conj(source_spectrum[i]);
    }
  }
  transform.backward(product.get(), ring.get());
  std::vector<double> correlation(angles);
  std::transform(ring.get(), ring.get() + angles, correlation.begin(),
                 [&](float v) { return static_cast<double>(v) / static_cast<double>(angles); });
  scale_to_one(correlation, target_square, source_square);
  return correlation;
}

std::vector<double> energy_correlation(const Sinogram& target, const Sinogram& source) {
  require_alike(target, source);
  const std::vector<float> a = energies(source);
  const std::vector<float> b = energies(target);
  const std::vector<float> c = circular_correlation(a, b);
  std::vector<double> correlation(c.begin(), c.end());
  scale_to_one(correlation, sum_of_squares(a), sum_of_squares(b));
  return correlation;
}

std::vector<Rotation> rotations(const std::vector<double>& correlation, const std::optional<PoseWindow>& window,
                                std::size_t at_most) {
  const std::size_t n = correlation.size();
  const double step_rad = 2 * kPi / static_cast<double>(n);
  const double base = *std::min_element(correlation.begin(), correlation.end());
  const auto allowed = [&](double angle_rad) {
    return !window || std::abs(wrap_angle(angle_rad - window->centre.theta_rad)) <= window->angle_rad;
  };
  std::vector<Rotation> peaks;
  std::optional<Rotation> highest;
  for (std::size_t i = 0; i < n; ++i) {
    const double left = correlation[(i + n - 1) % n];
    const double top = correlation[i];
    const double right = correlation[(i + 1) % n];
    const double angle = static_cast<double>(i) * step_rad;
    const double sigma = sigma_of(left, top, right, base, step_rad);
    if (allowed(angle) && (!highest || top > highest->score)) {
      highest = Rotation{wrap_angle(angle), sigma, top};
    }
    if (top > left && top >= right) {
      const double bend = left - 2 * top + right;
      const double shift = bend < 0 ? 0.5 * (left - right) / bend : 0;
      const double exact = wrap_angle(angle + shift * step_rad);
      if (allowed(exact)) {
        peaks.push_back({exact, sigma, top});
      }
    }
  }
  if (peaks.empty()) {
    return {highest.value_or(Rotation{window ? window->centre.theta_rad : 0, step_rad, 0})};
  }
  std::stable_sort(peaks.begin(), peaks.end(), [](const Rotation& a, const Rotation& b) { return a.score > b.score; });
  peaks.resize(std::min(peaks.size(), at_most));
  return peaks;
}

View sinogram_view(const Sinogram& sinogram, const std::string& which) {
  const double half = 0.5 * sinogram.offsets * sinogram.offset_step_m;
  SurfaceView surface{.width = sinogram.angles,
                      .height = sinogram.offsets,
                      .values = std::vector<float>(sinogram.value.size()),
                      .x_low = 0,
                      .x_high = 360,
                      .y_low = -half,
                      .y_high = half,
                      .x_label = "angle [deg]",
                      .y_label = "offset [m]",
                      .value_label = "wall on the line",
                      .marks = {}};
  for (int angle = 0; angle < sinogram.angles; ++angle) {
    for (int i = 0; i < sinogram.offsets; ++i) {
      surface.values[static_cast<std::size_t>(i) * static_cast<std::size_t>(sinogram.angles) +
                     static_cast<std::size_t>(angle)] = sinogram.column(angle)[i];
    }
  }
  return {"sinogram_" + which, "Radon transform of the " + which + "'s walls", std::move(surface)};
}

View correlation_view(const std::vector<double>& correlation, const std::vector<Rotation>& chosen) {
  CurvesView curves{.curves = {{.label = "correlation", .x = {}, .y = correlation}},
                    .x_label = "turn [deg]",
                    .y_label = "likeness",
                    .marks = {}};
  for (std::size_t i = 0; i < correlation.size(); ++i) {
    curves.curves.front().x.push_back(360.0 * static_cast<double>(i) / static_cast<double>(correlation.size()));
  }
  for (const Rotation& one : chosen) {
    const double turn = degrees(one.angle_rad);
    curves.marks.push_back(turn < 0 ? turn + 360 : turn);
  }
  return {"angle_correlation", "How alike the sinograms are when the source is turned; the rotations tried",
          std::move(curves)};
}

}  // namespace gridmerge::radon
