#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Creates the folder for results; its parent must exist. Checks that files can be written to this
/// folder and to its subfolder `plots`, and that no folder has the name of a file that
/// `writeReports` or `writeReport` (report.h) will write. In `plots`, no folder's name may end in
/// .csv or .svg. Existing files stay as they are.
/// @returns whether the folder was created; false if it existed before. @throws InputError with
/// everything that prevents writing the results.
bool makeReportFolder(const std::filesystem::path& folder, const Campaign& campaign);

/// Writes `runs.csv`, `summary.csv`, and OMPL's log `PROBLEM.VARIANT.log` for each problem and
/// variant that has runs. Existing files of these names are replaced. Each file is written whole or
/// not at all. @param runs the runs of the result's cells, with all texts and records. (The cells
/// themselves may have been trimmed by a `RunTrimmer`.) The runs are read several times, one by
/// one. @returns the files that were written. @throws InputError if a file can't be written.
std::vector<std::filesystem::path> writeReports(const Campaign& campaign,
                                                const CampaignResult& result, const RunSource& runs,
                                                const std::filesystem::path& folder);
/// Does the same with the runs in the result's cells.
std::vector<std::filesystem::path> writeReports(const Campaign& campaign,
                                                const CampaignResult& result,
                                                const std::filesystem::path& folder);

/// Returns a text as a part of a file name, such as "thin_plate.discrete-0.01": only its first 120
/// bytes, with "-" for every byte except ASCII letters, digits, ".", "_" and "-".
std::string fileName(std::string text);

}  // namespace corridor
