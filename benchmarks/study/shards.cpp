#include "study/shards.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gridmerge/base/error.hpp"
#include "study/journal.hpp"
#include "study/rows_csv.hpp"

namespace gridmerge::study {
namespace {

/// Which shard a file is of, by its name: "rows-2-of-4.sqlite".
std::optional<Shard> shard_of(const std::filesystem::path& file) {
  Shard shard;
  const std::string name = file.filename().string();
  const bool reads = std::sscanf(name.c_str(), "rows-%6d-of-%6d.sqlite", &shard.index, &shard.of) == 2;
  const bool is_name = reads && shard.of > 1 && name == journal_name(shard);
  return is_name ? std::optional(shard) : std::nullopt;
}

std::string in_words(const Shard& shard) { return std::to_string(shard.index) + " of " + std::to_string(shard.of); }

/// All shards of the folder, the first one first.
std::vector<std::filesystem::path> files_of_all_shards(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(folder.string(), "is no folder");
  }
  std::map<int, std::filesystem::path> files;
  std::set<int> numbers;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (const std::optional<Shard> shard = shard_of(entry.path())) {
      files[shard->index] = entry.path();
      numbers.insert(shard->of);
    }
  }
  if (files.empty()) {
    throw InputError(folder.string(), "holds no shard (no file like rows-1-of-4.sqlite)");
  }
  if (numbers.size() > 1) {
    throw InputError(folder.string(), "holds shards of a study cut in " + std::to_string(*numbers.begin()) +
                                          " and of one cut in " + std::to_string(*numbers.rbegin()) +
                                          "; remove those that do not belong");
  }
  std::string missing;
  std::vector<std::filesystem::path> all;
  for (int index = 1; index <= *numbers.begin(); ++index) {
    if (files.contains(index)) {
      all.push_back(files[index]);
    } else {
      missing += (missing.empty() ? "" : "\n") + (folder / journal_name({index, *numbers.begin()})).string() +
                 ": is missing; run shard " + in_words({index, *numbers.begin()});
    }
  }
  if (!missing.empty()) {
    throw InputError(folder.string(), "not all shards are there\n" + missing);
  }
  return all;
}

/// What is wrong with the shards together, a line each.
std::string problems_of(const std::vector<std::filesystem::path>& files, const std::vector<JournalContent>& shards) {
  std::string problems;
  const auto note = [&](std::size_t shard, const std::string& problem) {
    problems += (problems.empty() ? "" : "\n") + files[shard].filename().string() + ": " + problem;
  };
  std::map<std::int64_t, std::size_t> shard_with;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    if (shards[i].study.parts != shards[0].study.parts) {
      note(i, "is of another study, or of another version, than " + files[0].filename().string());
      continue;
    }
    for (const Row& row : shards[i].rows) {
      const auto [there, is_new] = shard_with.emplace(row.run, i);
      if (!is_new) {
        note(i, "holds run " + std::to_string(row.run) + ", as does " + files[there->second].filename().string());
        break;
      }
    }
  }
  return problems;
}

/// Shards that have runs left, a line each.
std::string left_over(const std::vector<std::filesystem::path>& files, const std::vector<JournalContent>& shards) {
  std::string problems;
  for (std::size_t i = 0; i < shards.size(); ++i) {
    const auto left = shards[i].study.runs_of_shard - static_cast<std::int64_t>(shards[i].rows.size());
    if (left != 0) {
      problems += (problems.empty() ? "" : "\n") + files[i].filename().string() + ": " + std::to_string(left) + " of " +
                  std::to_string(shards[i].study.runs_of_shard) + " runs are left; run shard " +
                  in_words(shards[i].study.shard) + " once more";
    }
  }
  return problems;
}

}  // namespace

void merge_shards(const std::filesystem::path& folder) {
  const std::vector<std::filesystem::path> files = files_of_all_shards(folder);
  std::vector<JournalContent> shards;
  for (const std::filesystem::path& file : files) {
    shards.push_back(read_journal_file(file));
  }
  for (const std::string& problems : {problems_of(files, shards), left_over(files, shards)}) {
    if (!problems.empty()) {
      throw InputError(folder.string(), "the shards cannot be merged\n" + problems);
    }
  }
  StudyRecord whole = shards[0].study;
  whole.shard = {};
  whole.runs_of_shard = whole.runs;
  JournalContent merged = {.study = whole, .rows = {}, .curves = {}};
  for (JournalContent& shard : shards) {
    std::move(shard.rows.begin(), shard.rows.end(), std::back_inserter(merged.rows));
    std::move(shard.curves.begin(), shard.curves.end(), std::back_inserter(merged.curves));
  }
  std::sort(merged.rows.begin(), merged.rows.end(), [](const Row& a, const Row& b) { return a.run < b.run; });
  write_journal(folder / journal_name({}), merged);
  write_rows_csv(folder, merged.rows);
}

}  // namespace gridmerge::study
