#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Writes a log as OMPL's own Benchmark (OMPL 1.5) writes it, for the runs of a problem with a
/// variant and all planners. `ompl_benchmark_statistics` and Planner Arena can read it. A run has
/// OMPL's properties, and every count and measure of `runRow` under the same name. A failed run has
/// the status "Crash". @param runs the runs of the result's cells, whole; each is read three times.
void writeOmplLog(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
                  std::size_t problem, std::size_t variant, std::ostream& out);
std::string omplLog(const Campaign& campaign, const CampaignResult& result, std::size_t problem,
                    std::size_t variant);

// Parts of the log, which the database (campaign_database.h) also stores.

/// Returns a run's properties: "time REAL" → "0.1". A key is a name in words and an SQL type.
std::map<std::string, std::string> omplProperties(const Campaign& campaign,
                                                  const CampaignCell& cell,
                                                  const BenchmarkRun& run);
/// Returns the name of an experiment: a problem with a variant.
std::string omplExperimentName(const Campaign& campaign, const CampaignCell& cell);
/// Returns the parameters of an experiment: "resolution REAL" → "0.01".
std::map<std::string, std::string> omplParameters(const Campaign& campaign,
                                                  const CampaignCell& cell);
/// Returns the planner's label if it differs from its name, else the name that OMPL recorded, such
/// as "geometric_RRTConnect".
std::string omplPlannerName(const CampaignCell& cell, const OmplRecord& record);
/// Splits a run's setup text into its part on the problem and its part on the planner.
std::pair<std::string, std::string> omplSetup(const std::string& setup);
/// Returns OMPL's names of how a run can end; a run's `status` is an index into them.
std::vector<std::string> omplStatusNames();
/// "1.5.2"
std::string versionOfOmpl();
/// Replaces whitespace by underscores: OMPL's readers take only the last word of a line.
std::string oneWord(std::string text);

}  // namespace corridor
