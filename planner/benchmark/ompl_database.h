#pragma once

#include <filesystem>
#include <string>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Writes an SQLite database with the tables that OMPL's `ompl_benchmark_statistics` 1.5 makes of
/// logs, for Planner Arena. It replaces an existing file, whole or not at all.
///
/// An experiment is a problem with a variant, and has the runs of all planners. A run has OMPL's
/// properties, and every number and every yes or no of `runRow` under the same name. Its verdict
/// becomes three columns, `proved`, `refuted` and `undecided`, each 0 or 1. A failed run has the
/// status "Crash".
/// @param runs the runs of the result's cells, with all of their data. Each run is read once.
/// @throws InputError if the file can't be written.
void writeOmplDatabase(const Campaign& campaign, const CampaignResult& result,
                       const RunSource& runs, const std::filesystem::path& file);

/// Returns why this program does not replace a file of the name `campaign.db`, or "" if it does:
/// there is none, or `writeOmplDatabase` wrote it. Databases of older versions hold the only record
/// of their runs.
std::string whyNotReplaced(const std::filesystem::path& database);

/// "1.5.2"
std::string versionOfOmpl();

}  // namespace corridor
