#pragma once
/// What the runs were made with: the program, the machine, and what the machine was worth just then.
#include <string>

namespace gridmerge::study {

[[nodiscard]] std::string version();   ///< of gridmerge
[[nodiscard]] std::string commit();    ///< of the sources, as git describes them; empty: not known
[[nodiscard]] std::string compiler();  ///< "g++ 12.2.0"
[[nodiscard]] std::string cpu();       ///< "Intel(R) Xeon(R) ...": of /proc/cpuinfo; empty: not known
[[nodiscard]] std::string utc_now();   ///< "2026-11-22T08:16:00Z"

/// Time that a fixed piece of work takes on this thread, undisturbed: points turned, moved and looked up, about a
/// millisecond. The middle one of five [s].
[[nodiscard]] double time_yardstick();

/// What share of a processor the calling thread had, since construction: 1 undisturbed, 0.5 where it took turns with
/// another. Of a run on several threads nothing is known by it.
class ProcessorShare {
 public:
  ProcessorShare();
  [[nodiscard]] double share() const;  ///< 0.01..1

 private:
  double wall_s_;
  double processor_s_;
};

}  // namespace gridmerge::study
