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
/// OMPL's properties, and every number and every yes or no of `runRow` under the same name. Its
/// verdict becomes three properties, `proved`, `refuted` and `undecided`, each 0 or 1. A failed run
/// has the status "Crash". @param runs the runs of the result's cells, with all of their data. Each
/// run is read twice, or three times if its planner reports progress.
void writeOmplLog(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
                  std::size_t problem, std::size_t variant, std::ostream& out);
std::string omplLog(const Campaign& campaign, const CampaignResult& result, std::size_t problem,
                    std::size_t variant);

// Parts of the log, which the database (campaign_database.h) also stores.

/// Returns a run's properties, such as "time REAL" → "0.1". A key is the name in words, followed by
/// the SQL type.
std::map<std::string, std::string> omplProperties(const Campaign& campaign,
                                                  const CampaignCell& cell,
                                                  const BenchmarkRun& run);
/// Returns the name of an experiment: a problem with a variant.
std::string omplExperimentName(const Campaign& campaign, const CampaignCell& cell);
/// Returns the parameters of an experiment, such as "resolution REAL" → "0.01".
std::map<std::string, std::string> omplParameters(const Campaign& campaign,
                                                  const CampaignCell& cell);
/// Returns the planner's label if it differs from its name, else the name that OMPL recorded, such
/// as "geometric_RRTConnect".
std::string omplPlannerName(const CampaignCell& cell, const OmplRecord& record);
/// Splits a run's setup text into its part on the problem (first) and its part on the planner
/// (second, may be empty).
std::pair<std::string, std::string> omplSetup(const std::string& setup);
/// Returns OMPL's names of the ways in which a run can end. A run's property `status` is an index
/// into this list.
std::vector<std::string> omplStatusNames();
/// "1.5.2"
std::string versionOfOmpl();
/// Replaces whitespace by underscores: OMPL's readers take only the last word of a line.
std::string oneWord(std::string text);

}  // namespace corridor
