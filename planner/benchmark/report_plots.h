#pragma once

#include <vector>

#include "planner/benchmark/comparison.h"
#include "planner/benchmark/plot.h"

/// The plots of a campaign's report. The index of a variant selects its colour, which is the same
/// in all plots.
namespace corridor {

/// For a problem and all planners: the share of runs that have returned a path by a time. Solid
/// lines count paths that are not refuted; dashed lines count all paths.
Plot solvedOverTime(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                    std::size_t problem);
/// For a problem, one point per planner (shown by shape) and variant (shown by colour): median time
/// against the share of returned paths that are refuted, with confidence intervals of both.
Plot timeAgainstRefuted(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                        std::size_t problem);
/// For all problems, one point per variant: time, as a multiple of the reference variant's time
/// (`VariantScore::timeRatio`), against the share of returned paths that are refuted.
Plot refutedShareOfAll(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                       const std::vector<VariantScore>& scores);
/// Performance profile (Dolan, Moré 2002) over the problems, planners and seeds that every variant
/// has run: the share of these runs for which a variant returned a path that is not refuted, within
/// x times the time of the quickest variant with such a path.
Plot profileOfAll(const Campaign& campaign, const std::vector<CampaignCell>& cells);
/// For a problem, the share of returned paths whose least distance of a tested pair is at most x.
/// Paths in contact have the distance 0. The axis is logarithmic, so a line begins, at the left end
/// of the axis, at their share.
Plot clearances(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                std::size_t problem);
/// For all problems, one point per run (or per several runs if there are more than 4000): the time
/// predicted by N_v·C_v + N_p·C_p against the time measured in checking.
Plot predictedCost(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                   const std::vector<VariantScore>& scores);

}  // namespace corridor
