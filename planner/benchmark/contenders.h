#pragma once

#include <optional>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// A campaign whose variants are its contenders: what the report ranks, and draws as one line each.
/// With several planners, a contender is a planner with a variant; else it is a variant.
struct Contenders {
  Campaign campaign;
  std::vector<CampaignCell> cells;
};

/// Returns the contenders of a campaign with several planners: "RRTConnect", or "RRTConnect, fcl"
/// if there are several variants. A run keeps its problem and its seed, so that the runs of two
/// contenders can be compared in pairs. Returns nullopt if there are not several planners: the
/// campaign's variants are then the contenders.
/// @param cells all of them, as `cellsOf` orders them. They are copied with their runs.
std::optional<Contenders> contendersOf(const Campaign& campaign,
                                       const std::vector<CampaignCell>& cells);

}  // namespace corridor
