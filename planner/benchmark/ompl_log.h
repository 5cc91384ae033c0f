#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// The runs of a problem with a variant, of all planners, as the log that OMPL's own Benchmark
/// writes (of OMPL 1.5): `ompl_benchmark_statistics` and Planner Arena read it. OMPL's properties
/// of a run, and every count and measure of `runRow` under its name there. A run that failed is a
/// row of status "Crash".
std::string omplLog(const Campaign& campaign, const CampaignResult& result, std::size_t problem,
                    std::size_t variant);

// Its parts, as the database has them, too (campaign_database.h).

/// Of a run: "time REAL" → "0.1"; a name in words, and a type of SQL's.
std::map<std::string, std::string> omplProperties(const Campaign& campaign,
                                                  const CampaignCell& cell,
                                                  const BenchmarkRun& run);
/// What an experiment, a problem with a variant, is called, and what is said of it:
/// "resolution REAL" → "0.01".
std::string omplExperimentName(const Campaign& campaign, const CampaignCell& cell);
std::map<std::string, std::string> omplParameters(const Campaign& campaign,
                                                  const CampaignCell& cell);
/// The planner's, and its runs' own where there are any: "geometric_RRTConnect".
std::string omplPlannerName(const CampaignCell& cell, const OmplRecord& record);
/// Of a run's setup: what speaks of the problem, and what of the planner.
std::pair<std::string, std::string> omplSetup(const std::string& setup);
/// OMPL's names of how runs end; a run's `status` is an index.
std::vector<std::string> omplStatusNames();
/// "1.5.2"
std::string versionOfOmpl();
/// Whitespace made underscores: OMPL's readers take the last word of a line.
std::string oneWord(std::string text);

}  // namespace corridor
