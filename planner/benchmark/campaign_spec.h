#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

/// The settings that must be equal in all sessions of one campaign.
namespace corridor {

/// Returns, as JSON, the settings of a cell that must be the same in all sessions: the problem's
/// digest, the variant's checker, the planner with its parameters, the limits of time and memory,
/// `simplify`, `verify`, and the makers and limits of trajectories, if there are any.
std::string specOf(const Campaign& campaign, const CampaignCell& cell);

/// Where a cell of one campaign is in another campaign.
struct CellMatch {
  std::optional<std::size_t> index;  ///< unset: the other campaign does not have the cell
  /// Why a run of this cell is no run of the other campaign: "hall, certified, RRT was measured
  /// with time 77.0, not 20.0". Empty if the settings are the same.
  std::string fault;
};
/// Returns, for each cell of `of`, the cell of `campaign` with the same names.
std::vector<CellMatch> matchCells(const Campaign& of, const Campaign& campaign);

/// Returns "problem, variant, planner", for messages.
std::string cellName(const Campaign& campaign, const CampaignCell& cell);

}  // namespace corridor
