#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Creates the folder for results; its parent must exist. Checks that files can be written to this
/// folder and to its subfolder `plots`, that no folder has the name of a file that a campaign will
/// write, and that `campaign.db` is not of an older version. In `plots`, no folder's name may end
/// in .csv or .svg. Existing files stay as they are.
/// @returns whether the folder was created; false if it existed before. @throws InputError with
/// everything that prevents writing the results.
bool makeReportFolder(const std::filesystem::path& folder);

/// Writes `runs.csv`, `summary.csv`, and the database `campaign.db` (ompl_database.h). Existing
/// files of these names are replaced. Each file is written whole or not at all. @param runs the
/// runs of the result's cells, with all texts and records. (The cells themselves may have been
/// trimmed by a `RunTrimmer`.) The runs are read twice, one by one. @throws InputError if a file
/// can't be written.
void writeReports(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
                  const std::filesystem::path& folder);
/// Does the same with the runs in the result's cells.
void writeReports(const Campaign& campaign, const CampaignResult& result,
                  const std::filesystem::path& folder);

/// Returns a text as a part of a file name, such as "thin_plate.discrete-0.01": only its first 120
/// bytes, with "-" for every byte except ASCII letters, digits, ".", "_" and "-".
std::string fileName(std::string text);

}  // namespace corridor
