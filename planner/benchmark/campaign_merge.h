#pragma once

#include <filesystem>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Databases of one campaign, such as its shards, or those of two laboratories with different
/// seeds, which are put together.
struct CampaignMerge {
  std::vector<std::filesystem::path> files;  ///< the databases
  /// As the first file records it; its seeds are those of all files. It can't be run.
  Campaign campaign;
};

/// Reads which campaign the databases are of. @param sources files, or folders with a campaign.db.
/// @throws InputError, with the name of the file, in these cases. There is no such file, or it is
/// in use. It is no campaign database, is damaged, or was written by a version that did not record
/// the campaign. Its cells, or their settings, are not those of the first file.
CampaignMerge readCampaigns(const std::vector<std::filesystem::path>& sources);

/// Writes all runs to a new database. Rows are copied within SQLite, so the memory does not depend
/// on their number. @param file is created, whole or not at all; it replaces an existing one.
/// @throws InputError if two files have a run of the same cell and seed, or as readCampaigns.
void mergeInto(const CampaignMerge& merge, const std::filesystem::path& file);

}  // namespace corridor
