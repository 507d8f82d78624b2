#include "gridmerge/base/fourier.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "gridmerge/base/random.hpp"

namespace gridmerge {
namespace {

std::vector<float> random_numbers(std::size_t count, std::uint64_t seed) {
  RandomStream random(seed, "fourier_test");
  std::vector<float> numbers(count);
  std::generate(numbers.begin(), numbers.end(), [&] { return static_cast<float>(random.normal()); });
  return numbers;
}

/// Random numbers and their spectrum.
struct Transformed {
  RealTransform transform;
  std::vector<float> numbers;
  FourierArray<float> real;
  FourierArray<std::complex<float>> spectrum;

  Transformed(int width, int height)
      : transform(width, height),
        numbers(random_numbers(transform.real_size(), 1)),
        real(real_array(transform.real_size())),
        spectrum(spectrum_array(transform.spectrum_size())) {
    std::copy(numbers.begin(), numbers.end(), real.get());
    transform.forward(real.get(), spectrum.get());
  }
};

TEST(RealTransform, ForwardAndBackGivesTheInputTimesItsSize) {
  for (const auto& [width, height] : {std::pair{8, 6}, {7, 5}, {12, 1}, {1, 1}}) {
    const Transformed of(width, height);
    const auto& [transform, numbers, real, spectrum] = of;
    transform.backward(spectrum.get(), real.get());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      EXPECT_NEAR(real[i] / static_cast<float>(numbers.size()), numbers[i], 1e-5) << width << " x " << height;
    }
  }
}

TEST(RealTransform, IsTheSumOfItsDefinition) {
  for (const auto& [width, height] : {std::pair{8, 6}, {7, 5}, {12, 1}, {1, 4}}) {
    const Transformed of(width, height);
    const int columns = width / 2 + 1;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < columns; ++u) {
        std::complex<double> sum = 0;
        for (int y = 0; y < height; ++y) {
          for (int x = 0; x < width; ++x) {
            const double turns = static_cast<double>(u * x) / width + static_cast<double>(v * y) / height;
            sum += std::polar(static_cast<double>(of.numbers[static_cast<std::size_t>(y * width + x)]),
                              -2 * std::numbers::pi * turns);
          }
        }
        const std::complex<float> got = of.spectrum[static_cast<std::size_t>(v * columns + u)];
        EXPECT_NEAR(got.real(), sum.real(), 1e-4) << width << " x " << height << ": " << u << ", " << v;
        EXPECT_NEAR(got.imag(), sum.imag(), 1e-4) << width << " x " << height << ": " << u << ", " << v;
      }
    }
  }
}

TEST(RealTransform, RefusesSizesThatAreNone) {
  EXPECT_THROW(RealTransform(0, 4), std::invalid_argument);
  EXPECT_THROW(RealTransform(4, -1), std::invalid_argument);
}

TEST(FastSize, IsEvenAndNoSmaller) {
  for (int n = 1; n < 600; ++n) {
    EXPECT_GE(fast_size(n), n);
    EXPECT_EQ(fast_size(n) % 2, 0);
  }
  EXPECT_EQ(fast_size(7), 8);
  EXPECT_EQ(fast_size(14), 16);
}

TEST(Fourier, SquaresHaveFewThreesAndFives) {
  for (int n = 1; n < 3000; n += 7) {
    EXPECT_GE(fast_square_size(n), n);
    EXPECT_LE(fast_square_size(n), std::max(16.0, 1.5 * n));
    EXPECT_EQ(fast_square_size(n) % 16, 0);
  }
  EXPECT_EQ(fast_square_size(1), 16);
  EXPECT_EQ(fast_square_size(256), 256);
  EXPECT_EQ(fast_square_size(257), 288);
  EXPECT_EQ(fast_square_size(541), 576);
}

TEST(CircularCorrelation, IsTheSumOfItsDefinition) {
  for (const std::size_t n : {1U, 2U, 7U, 360U}) {
    const std::vector<float> a = random_numbers(n, 1);
    const std::vector<float> b = random_numbers(n, 2);
    const std::vector<float> c = circular_correlation(a, b);
    ASSERT_EQ(c.size(), n);
    for (std::size_t k = 0; k < n; ++k) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        sum += static_cast<double>(a[i]) * static_cast<double>(b[(i + k) % n]);
      }
      EXPECT_NEAR(static_cast<double>(c[k]), sum, 1e-3 * std::sqrt(static_cast<double>(n)));
    }
  }
}

TEST(CircularCorrelation, PeaksWhereTheSecondIsTheFirstMoved) {
  const std::vector<float> a = random_numbers(90, 3);
  std::vector<float> b = a;
  std::rotate(b.rbegin(), b.rbegin() + 17, b.rend());  // b[i + 17] = a[i]
  const std::vector<float> c = circular_correlation(a, b);
  EXPECT_EQ(std::max_element(c.begin(), c.end()) - c.begin(), 17);
}

TEST(CircularCorrelation, RefusesSequencesOfUnequalLength) {
  EXPECT_THROW((void)circular_correlation({}, {}), std::invalid_argument);
  EXPECT_THROW((void)circular_correlation(random_numbers(3, 1), random_numbers(4, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
