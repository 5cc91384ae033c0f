#pragma once

#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// A campaign whose variants are its contenders: what the report ranks, and draws as one line each.
/// With several planners, a contender is a planner with a variant; else it is a variant.
struct Contenders {
  Campaign campaign;
  std::vector<CampaignCell> cells;
};

/// Returns the contenders: "RRTConnect", or "RRTConnect, fcl" if there are several variants. A run
/// keeps its problem and its seed, so that the runs of two contenders can be compared in pairs.
/// @param cells as `cellsOf` orders them.
Contenders contendersOf(const Campaign& campaign, const std::vector<CampaignCell>& cells);

}  // namespace corridor
