#pragma once
/// The journals of a study's shards, joined into one.
#include <filesystem>

namespace gridmerge::study {

/// Joins folder/rows-1-of-n.sqlite .. rows-n-of-n.sqlite into folder/rows.sqlite and folder/rows.csv, whole or not at
/// all. The shards' files stay.
/// @throws InputError naming file and rule with a line for every problem: a shard that is missing or has runs left, two
/// ways of cutting in one folder, shards of different studies, a run that is in two of them
void merge_shards(const std::filesystem::path& folder);

}  // namespace gridmerge::study
