#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Makes the folder (its parent has to be there) and sees that it can be written to.
/// @returns whether it was not there before. @throws InputError where it can't be written to.
bool makeReportFolder(const std::filesystem::path& folder);

/// Writes `runs.csv`, `summary.csv`, and for each problem and variant OMPL's log,
/// `PROBLEM.VARIANT.log`, where there are runs; what is there of these names is replaced. Each file
/// appears whole or not at all. @returns the files. @throws InputError where one can't be written.
std::vector<std::filesystem::path> writeReports(const Campaign& campaign,
                                                const CampaignResult& result,
                                                const std::filesystem::path& folder);

/// A file's name that every system takes: "thin_plate.discrete-0.01".
std::string fileName(std::string text);

}  // namespace corridor
