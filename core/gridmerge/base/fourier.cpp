#include "gridmerge/base/fourier.hpp"

#include <fftw3.h>

#include <algorithm>
#include <mutex>
#include <new>
#include <stdexcept>

namespace gridmerge {
namespace {

/// FFTW's planner is the one part of it that is not thread safe.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

fftwf_complex* raw(std::complex<float>* spectrum) { return reinterpret_cast<fftwf_complex*>(spectrum); }

template <typename T>
FourierArray<T> zeros(std::size_t count) {
  auto* p = static_cast<T*>(fftwf_malloc(sizeof(T) * count));
  if (p == nullptr) {
    throw std::bad_alloc();
  }
  std::fill(p, p + count, T{});
  return FourierArray<T>(p);
}

/// `n` (>= 1) divided by the factor as often as it goes.
int without(int factor, int n) {
  while (n % factor == 0) {
    n /= factor;
  }
  return n;
}

}  // namespace

void FourierFree::operator()(void* memory) const { fftwf_free(memory); }

FourierArray<float> real_array(std::size_t count) { return zeros<float>(count); }
FourierArray<std::complex<float>> spectrum_array(std::size_t count) { return zeros<std::complex<float>>(count); }

int fast_size(int at_least) {
  for (int n = at_least + at_least % 2;; n += 2) {
    if (without(5, without(3, without(2, n))) == 1) {
      return n;
    }
  }
}

int fast_square_size(int at_least) {
  for (int n = (at_least + 15) / 16 * 16;; n += 16) {
    const int odd = without(2, n);
    if (odd <= 25 && without(5, without(3, odd)) == 1) {
      return n;
    }
  }
}

RealTransform::RealTransform(int width, int height) : width_(width), height_(height) {
  if (width < 1 || height < 1) {
    throw std::invalid_argument("RealTransform: width and height must be positive");
  }
  const auto real = real_array(real_size());
  const auto spectrum = spectrum_array(spectrum_size());
  const std::scoped_lock lock(planner_mutex());
  forward_ = fftwf_plan_dft_r2c_2d(height, width, real.get(), raw(spectrum.get()), FFTW_ESTIMATE);
  backward_ = fftwf_plan_dft_c2r_2d(height, width, raw(spectrum.get()), real.get(), FFTW_ESTIMATE);
}

RealTransform::~RealTransform() {
  const std::scoped_lock lock(planner_mutex());
  fftwf_destroy_plan(static_cast<fftwf_plan>(forward_));
  fftwf_destroy_plan(static_cast<fftwf_plan>(backward_));
}

std::size_t RealTransform::real_size() const {
  return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
}

std::size_t RealTransform::spectrum_size() const {
  return static_cast<std::size_t>(width_ / 2 + 1) * static_cast<std::size_t>(height_);
}

void RealTransform::forward(float* real, std::complex<float>* spectrum) const {
  fftwf_execute_dft_r2c(static_cast<fftwf_plan>(forward_), real, raw(spectrum));
}

void RealTransform::backward(std::complex<float>* spectrum, float* real) const {
  fftwf_execute_dft_c2r(static_cast<fftwf_plan>(backward_), raw(spectrum), real);
}

std::vector<float> circular_correlation(std::span<const float> a, std::span<const float> b) {
  if (a.empty() || a.size() != b.size()) {
    throw std::invalid_argument("circular_correlation: two sequences of one length are needed");
  }
  const RealTransform transform(static_cast<int>(a.size()));
  const auto real = real_array(transform.real_size());
  const auto of_a = spectrum_array(transform.spectrum_size());
  const auto of_b = spectrum_array(transform.spectrum_size());
  std::copy(a.begin(), a.end(), real.get());
  transform.forward(real.get(), of_a.get());
  std::copy(b.begin(), b.end(), real.get());
  transform.forward(real.get(), of_b.get());
  for (std::size_t i = 0; i < transform.spectrum_size(); ++i) {
    of_b[i] *= std::conj(of_a[i]);
  }
  transform.backward(of_b.get(), real.get());
  std::vector<float> c(a.size());
  std::transform(real.get(), real.get() + a.size(), c.begin(),
                 [&](float v) { return v / static_cast<float>(a.size()); });
  return c;
}

}  // namespace gridmerge
