#pragma once

#include <filesystem>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Databases of one campaign that are to be merged, such as those of its shards, or those of two
/// laboratories that ran different seeds.
struct CampaignMerge {
  std::vector<std::filesystem::path> files;  ///< the databases
  /// The campaign as the first file records it, but with the seeds of all files. It can't be run.
  Campaign campaign;
};

/// Reads the campaign of the databases, and tests that it is the same in all of them.
/// @param sources files, or folders with a campaign.db.
/// @throws InputError, with the name of the file, in these cases. There is no such file, or it is
/// in use. It is no campaign database, is damaged, or was written by a version that did not record
/// the campaign. Its cells, or their settings, are not those of the first file.
CampaignMerge readCampaigns(const std::vector<std::filesystem::path>& sources);

/// Writes all runs to a new database. Rows are copied within SQLite, so the memory does not depend
/// on their number. @param file is created, whole or not at all; it replaces an existing one.
/// @throws InputError if two files have a run of the same cell and seed, or for a fault of a file
/// as in readCampaigns.
void mergeInto(const CampaignMerge& merge, const std::filesystem::path& file);

}  // namespace corridor
