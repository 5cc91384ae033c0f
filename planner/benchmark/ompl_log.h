#pragma once

#include <string>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// The runs of a problem with a variant, of all planners, as the log that OMPL's own Benchmark
/// writes (of OMPL 1.5): `ompl_benchmark_statistics` and Planner Arena read it. OMPL's properties
/// of a run, and every count and measure of `runRow` under its name there. A run that failed is a
/// row of status "Crash".
std::string omplLog(const Campaign& campaign, const CampaignResult& result, std::size_t problem,
                    std::size_t variant);

}  // namespace corridor
