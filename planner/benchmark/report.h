#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "planner/benchmark/campaign_database.h"

namespace corridor {

/// Writes a campaign's report into a folder: `report.html`, which loads nothing, and its plots as
/// `plots/NAME.svg` and their data as `plots/NAME.csv`; what is there of these names is replaced.
/// Without gnuplot there are no plots, and the page says so.
/// @param sessions as of the campaign's database, for the page to tell.
/// @returns the files, the page first. @throws InputError where one can't be written.
std::vector<std::filesystem::path> writeReport(const Campaign& campaign,
                                               const std::vector<CampaignCell>& cells,
                                               const std::filesystem::path& folder,
                                               const std::vector<CampaignSession>& sessions = {});

/// The text of a file of planner/benchmark/page/, by its name: embedded by CMakeLists.txt.
std::string_view reportFile(std::string_view name);

}  // namespace corridor
