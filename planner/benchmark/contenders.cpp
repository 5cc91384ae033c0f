#include "planner/benchmark/contenders.h"

namespace corridor {

std::optional<Contenders> contendersOf(const Campaign& campaign,
                                       const std::vector<CampaignCell>& cells) {
  if (campaign.planners.size() < 2) return std::nullopt;
  Contenders all{campaign, cells};
  all.campaign.variants.clear();
  for (const CampaignPlanner& planner : campaign.planners)
    for (const Variant& variant : campaign.variants) {
      Variant& contender = all.campaign.variants.emplace_back(variant);
      contender.name =
          planner.label + (campaign.variants.size() > 1 ? ", " + variant.name : std::string());
    }
  // The cells of a problem are in order of planner, then variant: the order of the contenders.
  const std::size_t count = all.campaign.variants.size();
  for (std::size_t i = 0; i < all.cells.size(); ++i) all.cells[i].variant = i % count;
  return all;
}

}  // namespace corridor
