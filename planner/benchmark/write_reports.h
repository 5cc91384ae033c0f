#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Creates the folder for results; its parent must exist. Checks that files can be written to it
/// and to its folder `plots`, and that no folder has the name of a file that `writeReports` or
/// `writeReport` (report.h) will write. In `plots`, no folder's name may end in .csv or .svg.
/// Existing files stay as they are.
/// @returns whether the folder was created. @throws InputError with everything that prevents it.
bool makeReportFolder(const std::filesystem::path& folder, const Campaign& campaign);

/// Writes `runs.csv`, `summary.csv`, and OMPL's log `PROBLEM.VARIANT.log` for each problem and
/// variant that has runs. Existing files of these names are replaced. Each file is written whole or
/// not at all. @param runs the runs of the result's cells, with all texts and records, which a
/// `RunTrimmer` may have removed from the cells; they are read several times, one by one. @returns
/// the files. @throws InputError if one can't be written.
std::vector<std::filesystem::path> writeReports(const Campaign& campaign,
                                                const CampaignResult& result, const RunSource& runs,
                                                const std::filesystem::path& folder);
std::vector<std::filesystem::path> writeReports(const Campaign& campaign,
                                                const CampaignResult& result,
                                                const std::filesystem::path& folder);

/// Returns a text as a file name that every system accepts: "thin_plate.discrete-0.01".
std::string fileName(std::string text);

}  // namespace corridor
