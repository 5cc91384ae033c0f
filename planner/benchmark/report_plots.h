#pragma once

#include <vector>

#include "planner/benchmark/comparison.h"
#include "planner/benchmark/plot.h"

/// The plots of a campaign's report. Variants have the colour of their number.
namespace corridor {

/// Runs of a problem, all planners together: the share that is solved by a time, and with that of
/// the returned paths that hold (dashed: those that were refuted count, too).
Plot solvedOverTime(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                    std::size_t problem);
/// Of a problem, a point a planner (its shape) and variant: median time against the share of
/// returned paths that are refuted, with what both are sure to.
Plot timeAgainstError(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                      std::size_t problem);
/// The same of all problems, a point a variant: time as a multiple of the reference variant's, as
/// the ranking has it.
Plot errorOfAll(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                const std::vector<VariantScore>& scores);
/// Performance profile (Dolan, Moré 2002) of the problems, planners and seeds that every variant
/// has run: the share of these of which it returned a path that is not refuted, within x times what
/// the quickest variant took for one.
Plot profileOfAll(const Campaign& campaign, const std::vector<CampaignCell>& cells);
/// Of a problem, the share of returned paths whose least distance is at most x; those in collision
/// have 0, and where the lines begin.
Plot clearances(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                std::size_t problem);
/// A point a run, of all problems: what N_v·C_v + N_p·C_p tells against what was measured.
Plot predictedCost(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                   const std::vector<VariantScore>& scores);

}  // namespace corridor
