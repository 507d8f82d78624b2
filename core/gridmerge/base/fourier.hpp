#pragma once
/// Discrete Fourier transforms of real data, by FFTW in single precision.
#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace gridmerge {

struct FourierFree {
  void operator()(void* memory) const;
};
/// Memory aligned as the transforms want it.
template <typename T>
using FourierArray = std::unique_ptr<T[], FourierFree>;

/// All zero. @throws std::bad_alloc
[[nodiscard]] FourierArray<float> real_array(std::size_t count);
[[nodiscard]] FourierArray<std::complex<float>> spectrum_array(std::size_t count);

/// The next size that is transformed fast: a product of 2, 3, 5 and even.
[[nodiscard]] int fast_size(int at_least);

/// The same for the side of a square: 16, 32, 48, 64, 80, 96, 128, ... Many threes and fives make an image slower to
/// transform than the next larger one that has few (270 takes 1.7 times as long as 288).
[[nodiscard]] int fast_square_size(int at_least);

/// Transforms of one size, forth and back: rows of `width` numbers, `height` of them; height 1 is the plain transform.
/// Const after construction and shared by threads. The spectrum has width/2 + 1 numbers a row.
class RealTransform {
 public:
  explicit RealTransform(int width, int height = 1);
  ~RealTransform();
  RealTransform(const RealTransform&) = delete;
  RealTransform& operator=(const RealTransform&) = delete;

  [[nodiscard]] std::size_t real_size() const;
  [[nodiscard]] std::size_t spectrum_size() const;
  /// Both arrays come from real_array and spectrum_array; the input may be overwritten.
  void forward(float* real, std::complex<float>* spectrum) const;
  /// Not scaled: forward and backward multiply by real_size().
  void backward(std::complex<float>* spectrum, float* real) const;

 private:
  int width_;
  int height_;
  void* forward_ = nullptr;
  void* backward_ = nullptr;
};

/// c[k] = sum over i of a[i] b[(i + k) mod n]: high where b, moved k places back, looks like a.
/// @throws std::invalid_argument unless both have one and the same length, at least 1
[[nodiscard]] std::vector<float> circular_correlation(std::span<const float> a, std::span<const float> b);

}  // namespace gridmerge
