#include "study/machine.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "study_commit.hpp"

namespace gridmerge::study {
namespace {

/// A table of 1 MiB, about a distance field, and points to look up in it.
struct Yardstick {
  static constexpr std::uint32_t kSide = 512;
  std::vector<float> table;
  std::vector<std::pair<float, float>> points;

  Yardstick() : table(kSide * kSide), points(4000) {
    RandomStream random(1, "yardstick");
    std::generate(table.begin(), table.end(), [&] { return static_cast<float>(random.uniform()); });
    for (auto& [x, y] : points) {
      x = static_cast<float>(random.uniform(-160, 160));
      y = static_cast<float>(random.uniform(-160, 160));
    }
  }

  /// What most methods do most of the time: points turned, moved, and looked up.
  [[nodiscard]] float work() const {
    float sum = 0;
    for (int pose = 0; pose < 200; ++pose) {
      const auto angle = static_cast<float>(pose) * 0.031F;
      const float c = std::cos(angle);
      const float s = std::sin(angle);
      for (const auto& [x, y] : points) {
        const auto column = static_cast<std::uint32_t>(256 + c * x - s * y);
        const auto row = static_cast<std::uint32_t>(256 + s * x + c * y);
        sum += table[row * kSide + column];
      }
    }
    return sum;
  }
};

double clock_s(clockid_t clock) {
  timespec now = {};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

std::string version() { return GRIDMERGE_VERSION; }

std::string commit() { return GRIDMERGE_COMMIT; }

std::string compiler() {
#if defined(__clang__)
  return "clang++ " + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__) + "." +
         std::to_string(__clang_patchlevel__);
#elif defined(__GNUC__)
  return "g++ " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
         std::to_string(__GNUC_PATCHLEVEL__);
#else
  return "";
#endif
}

std::string cpu() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "";
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc = {};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc)};
}

double time_yardstick() {
  static const Yardstick yardstick;
  std::array<double, 5> seconds{};
  for (double& one : seconds) {
    const double start = clock_s(CLOCK_THREAD_CPUTIME_ID);
    const volatile float result = yardstick.work();  // volatile: the work must be done
    (void)result;
    one = clock_s(CLOCK_THREAD_CPUTIME_ID) - start;
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

ProcessorShare::ProcessorShare() : wall_s_(clock_s(CLOCK_MONOTONIC)), processor_s_(clock_s(CLOCK_THREAD_CPUTIME_ID)) {}

double ProcessorShare::share() const {
  const double wall_s = clock_s(CLOCK_MONOTONIC) - wall_s_;
  const double processor_s = clock_s(CLOCK_THREAD_CPUTIME_ID) - processor_s_;
  return wall_s > 0 ? std::clamp(processor_s / wall_s, 0.01, 1.0) : 1.0;
}

}  // namespace gridmerge::study
