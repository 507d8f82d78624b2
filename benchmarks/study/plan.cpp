#include "study/plan.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "cli/text.hpp"
#include "gridmerge/base/number_text.hpp"
#include "gridmerge/base/random.hpp"
#include "study/drawn_pair.hpp"
#include "study/machine.hpp"

namespace gridmerge::study {
namespace {

/// Maps of so many pairs are in use at a time.
constexpr std::size_t kPairsOfABlock = 16;

template <typename T>
void shuffle(std::vector<T>& items, RandomStream& random) {
  for (std::size_t left = items.size(); left > 1; --left) {
    std::swap(items[left - 1], items[random.below(static_cast<std::uint32_t>(left))]);
  }
}

std::vector<std::uint32_t> windows_of(const Study& study, const PairChoice& pair) {
  if (pair.is_swarm()) {
    return {PlannedRun::kNoWindow};
  }
  const auto* files = std::get_if<FileMaps>(&pair.maps);
  const bool unknown = files != nullptr && files->truth == "unknown";
  std::vector<std::uint32_t> windows;
  for (const std::size_t window : pair.windows) {
    if (!unknown || study.windows[window].around != WindowChoice::Around::kTruth) {
      windows.push_back(static_cast<std::uint32_t>(window));
    }
  }
  return windows;
}

/// The pairs, those of a set together, by chance within it: dealt in this order, every shard gets its share of each
/// set.
std::vector<std::uint32_t> dealing_order(const Study& study) {
  std::vector<std::uint32_t> pairs(study.pairs.size());
  std::iota(pairs.begin(), pairs.end(), 0U);
  RandomStream random(1, "study/deal");
  shuffle(pairs, random);
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return study.pairs[a].set < study.pairs[b].set; });
  return pairs;
}

std::vector<PlannedRun> runs_of(const Study& study, const Shard& shard) {
  if (shard.of < 1 || shard.index < 1 || shard.index > shard.of) {
    throw std::invalid_argument("shard " + std::to_string(shard.index) + "/" + std::to_string(shard.of) +
                                " must be 1/n .. n/n");
  }
  const auto shards = static_cast<std::size_t>(shard.of);
  const auto mine = static_cast<std::size_t>(shard.index - 1);
  const std::vector<std::uint32_t> dealt = dealing_order(study);
  const std::size_t whole = dealt.size() / shards * shards;
  std::vector<std::size_t> place(dealt.size());  // of each pair in the order of dealing
  for (std::size_t i = 0; i < dealt.size(); ++i) {
    place[dealt[i]] = i;
  }
  std::vector<PlannedRun> runs;
  std::vector<PlannedRun> left_over;
  for (const PlannedRun& run : plan_of(study)) {
    if (place[run.pair] >= whole) {
      left_over.push_back(run);
    } else if (place[run.pair] % shards == mine) {
      runs.push_back(run);
    }
  }
  std::sort(left_over.begin(), left_over.end(), [](const PlannedRun& a, const PlannedRun& b) {
    return std::tie(a.method, a.run) < std::tie(b.method, b.run);
  });
  for (std::size_t i = mine; i < left_over.size(); i += shards) {
    runs.push_back(left_over[i]);
  }
  return runs;
}

std::string in_words(const MethodChoice& choice) {
  std::string text = choice.method + " " + choice.profile;
  for (const std::string& setting : choice.set) {
    text += " " + setting;
  }
  return text;
}

std::string in_words(const WindowChoice& window) {
  static constexpr const char* kAround[] = {"anywhere", "start", "middle", "truth"};
  return window.name + " (" + kAround[static_cast<int>(window.around)] + ", " + exact(window.share) + ", " +
         exact(window.least_deg) + " deg, " + exact(window.radius_m) + " m, " + exact(window.angle_deg) + " deg)";
}

/// Without the folder in which the maps lie: a study may be moved.
std::string in_words(const PairChoice& pair) {
  std::string text =
      pair.set + "/" + pair.name + " " + exact(pair.tolerance_m) + " m " + exact(pair.tolerance_deg) + " deg ";
  const auto* files = std::get_if<FileMaps>(&pair.maps);
  if (files == nullptr) {
    text += spec_of(pair);
  } else if (files->known) {
    text += cli::pose_text(files->known->target_from_source);
  } else {
    text += files->truth;
  }
  for (const std::size_t window : pair.windows) {
    text += " " + std::to_string(window);
  }
  return text;
}

/// FNV-1a.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) {
      state_ = (state_ ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    }
    state_ = (state_ ^ 0xff) * 0x100000001b3;  // ends the text: no UTF-8 holds it
  }
  [[nodiscard]] std::string text() const {
    std::string digits;
    for (int shift = 60; shift >= 0; shift -= 4) {
      digits += "0123456789abcdef"[(state_ >> shift) & 15];
    }
    return digits;
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325;
};

template <typename Items, typename Words>
std::string listed(const Items& items, Words&& words) {
  std::string text;
  for (const auto& item : items) {
    text += (text.empty() ? "" : ", ") + words(item);
  }
  return text;
}

}  // namespace

std::vector<PlannedRun> plan_of(const Study& study) {
  std::vector<PlannedRun> runs;
  std::int64_t number = 0;
  for (std::uint32_t pair = 0; pair < study.pairs.size(); ++pair) {
    for (const std::uint32_t window : windows_of(study, study.pairs[pair])) {
      for (std::uint32_t method = 0; method < study.methods.size(); ++method) {
        for (const std::uint64_t seed : study.seeds) {
          runs.push_back({.run = number++, .pair = pair, .method = method, .window = window, .seed = seed});
        }
      }
    }
  }
  return runs;
}

std::vector<PlannedRun> order_of(const Study& study, const Shard& shard) {
  std::vector<PlannedRun> runs = runs_of(study, shard);
  std::vector<std::uint32_t> pairs(study.pairs.size());
  std::iota(pairs.begin(), pairs.end(), 0U);
  RandomStream random(1, "study/order");
  shuffle(pairs, random);
  std::vector<std::size_t> block_of(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    block_of[pairs[i]] = i / kPairsOfABlock;
  }
  shuffle(runs, random);
  std::stable_sort(runs.begin(), runs.end(),
                   [&](const PlannedRun& a, const PlannedRun& b) { return block_of[a.pair] < block_of[b.pair]; });
  return runs;
}

StudyParts parts_of(const Study& study) {
  Hash data;
  for (const PairChoice& pair : study.pairs) {
    data.add(in_words(pair));
  }
  return {{"name", study.name},
          {"methods", listed(study.methods, [](const MethodChoice& choice) { return in_words(choice); })},
          {"seeds", listed(study.seeds, [](std::uint64_t seed) { return std::to_string(seed); })},
          {"windows", listed(study.windows, [](const WindowChoice& window) { return in_words(window); })},
          {"data", std::to_string(study.pairs.size()) + " pairs, " + data.text()},
          {"curves", study.curves ? "true" : "false"},
          {"threads", std::to_string(study.threads)},
          {"version", version()}};
}

std::string fingerprint_of(const StudyParts& parts) {
  Hash hash;
  for (const auto& [key, value] : parts) {
    hash.add(key);
    hash.add(value);
  }
  return hash.text();
}

}  // namespace gridmerge::study
