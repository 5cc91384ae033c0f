#pragma once

#include <filesystem>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Databases of one campaign that are to be merged, such as those of its shards, or those of two
/// laboratories that ran different seeds.
struct CampaignMerge {
  std::vector<std::filesystem::path> files;  ///< the databases
  /// The campaign as the first file records it, but with the seeds of all files and without a
  /// shard. It can't be run.
  Campaign campaign;
};

/// Reads the campaign of the databases, and tests that all of them have the same campaign. @param
/// sources files, or folders with a campaign.db.
/// @throws InputError, with the name of a file, in these cases:
/// - There is no such file, or it is in use.
/// - It is no campaign database, is damaged, or was written by a version that did not record the
/// campaign.
/// - Its cells, or their settings, are not those of the first file.
/// - Between the first and the last seed of all files, there are seeds that no file has.
CampaignMerge readCampaigns(const std::vector<std::filesystem::path>& sources);

/// Writes all runs to a new database. Rows are copied within SQLite, so the memory does not depend
/// on their number. @param file the new database. It is created, whole or not at all, and replaces
/// an existing file.
/// @throws InputError if two files have a run of the same cell and seed, if a file has one of the
/// faults that readCampaigns reports, or if `file` can't be written.
void mergeInto(const CampaignMerge& merge, const std::filesystem::path& file);

}  // namespace corridor
