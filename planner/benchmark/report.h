#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "planner/benchmark/run_file.h"

namespace corridor {

/// Writes a campaign's report into a folder: `report.html`, which loads no other file, its plots as
/// `plots/NAME.svg`, and their data as `plots/NAME.csv`. Existing files of these names are
/// replaced. Without gnuplot there are no plots, and the page says so.
/// @param sessions the sessions of the campaign's database, which the page lists.
/// @param whyNoPlot if not null, receives the reason why a plot is missing; "" if none is. The page
/// states the reason at each missing plot.
/// @returns the files that were written, the page first. @throws InputError if a file can't be
/// written.
std::vector<std::filesystem::path> writeReport(const Campaign& campaign,
                                               const std::vector<CampaignCell>& cells,
                                               const std::filesystem::path& folder,
                                               const std::vector<CampaignSession>& sessions = {},
                                               std::string* whyNoPlot = nullptr);

/// Returns the text of a file of planner/benchmark/page/ by its name; CMakeLists.txt embeds these
/// files in the program.
std::string_view reportFile(std::string_view name);

}  // namespace corridor
