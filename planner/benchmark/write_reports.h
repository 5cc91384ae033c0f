#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Makes the folder (its parent has to be there) and sees that it and `plots` in it can be written
/// to, and that nothing but files is where `writeReports` and `writeReport` (report.h) will put
/// theirs; of plots only the folder is looked at. What is there stays as it is.
/// @returns whether it was not there before. @throws InputError with all that is in the way.
bool makeReportFolder(const std::filesystem::path& folder, const Campaign& campaign);

/// Writes `runs.csv`, `summary.csv`, and for each problem and variant OMPL's log,
/// `PROBLEM.VARIANT.log`, where there are runs; what is there of these names is replaced. Each file
/// appears whole or not at all. @returns the files. @throws InputError where one can't be written.
std::vector<std::filesystem::path> writeReports(const Campaign& campaign,
                                                const CampaignResult& result,
                                                const std::filesystem::path& folder);

/// A file's name that every system takes: "thin_plate.discrete-0.01".
std::string fileName(std::string text);

}  // namespace corridor
