#pragma once
/// The runs of a study, the order in which they are made, and how they are dealt to several machines.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "study/study.hpp"

namespace gridmerge::study {

/// One run to be made.
struct PlannedRun {
  static constexpr std::uint32_t kNoWindow = 0xffffffff;  ///< of a swarm

  std::int64_t run = 0;  ///< its number, from 0
  std::uint32_t pair = 0;
  std::uint32_t method = 0;
  std::uint32_t window = 0;
  std::uint64_t seed = 1;

  friend bool operator==(const PlannedRun&, const PlannedRun&) = default;
};

/// All runs by number: pair by pair, within it window by window, method by method, seed by seed. Where no truth is
/// known there is no window round it.
[[nodiscard]] std::vector<PlannedRun> plan_of(const Study& study);

/// A part of a study, for one machine of several.
struct Shard {
  int index = 1;  ///< 1..of
  int of = 1;

  friend bool operator==(const Shard&, const Shard&) = default;
};

/// The shard's runs in the order in which they are made: blocks of pairs by chance, and by chance within a block, so
/// that whatever else the machine does meets all methods alike, and few maps are in use at a time. All chance is fixed.
///
/// Shards have no run in common, and together all. As many whole pairs as can be are dealt evenly; what is left over is
/// dealt run by run, so that every shard has its share of each method.
/// @throws std::invalid_argument if there is no such shard
[[nodiscard]] std::vector<PlannedRun> order_of(const Study& study, const Shard& shard = {});

/// What makes a study this one and no other, by part (methods, seeds, data, ...), in words that can be told apart.
using StudyParts = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] StudyParts parts_of(const Study& study);

/// 16 hexadecimal digits of all parts.
[[nodiscard]] std::string fingerprint_of(const StudyParts& parts);

}  // namespace gridmerge::study
