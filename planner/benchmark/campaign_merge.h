#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "planner/benchmark/run_file.h"

namespace corridor {

/// Files of runs of one campaign that are to be merged, such as those of its shards, or those of
/// two laboratories that ran different seeds.
struct CampaignMerge {
  std::vector<std::filesystem::path> files;
  /// The campaign of the first file, but with the seeds of all files and without a shard. It can't
  /// be run.
  Campaign campaign;
};

/// Reads the campaigns of the files, and tests that they are one campaign. @param sources files, or
/// folders with a runs.jsonl.
/// @throws InputError, with the name of a file, in these cases:
/// - There is no such file, it is in use, or it is no file of runs.
/// - It does not have all cells of the first file, or has other settings for them.
/// - Between the first and the last seed of all files, there are seeds that no file has.
CampaignMerge readCampaigns(const std::vector<std::filesystem::path>& sources);

/// Writes the runs of all files to a new file, one file after the other. @param file the new file.
/// It is created, whole or not at all, and replaces an existing file. @param cells the cells of
/// `merge.campaign`; they receive the runs, without their texts. @pre `merge` outlives the result.
/// @throws InputError if two files have a run of the same cell and seed, if a file is damaged, or
/// if `file` can't be written.
std::unique_ptr<RunFile> mergeInto(const CampaignMerge& merge, const std::filesystem::path& file,
                                   std::vector<CampaignCell>& cells);

}  // namespace corridor
