#pragma once

#include <filesystem>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Makes the folder (its parent has to be there) and sees that it can be written to.
/// @throws InputError where not.
void makeReportFolder(const std::filesystem::path& folder);

/// Writes `runs.csv`, `summary.csv`, and for each problem and variant OMPL's log,
/// `PROBLEM.VARIANT.log`; what is there of these names is replaced. Each file appears whole or not
/// at all. @returns the files. @throws InputError where one can't be written.
std::vector<std::filesystem::path> writeReports(const Campaign& campaign,
                                                const CampaignResult& result,
                                                const std::filesystem::path& folder);

}  // namespace corridor
