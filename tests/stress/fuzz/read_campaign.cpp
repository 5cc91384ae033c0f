// Fuzz target: campaign files (corridor-campaign-1), in a folder with small problems that they may
// name.
#include "planner/benchmark/campaign_yaml.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const bool ready = (fuzz::writeSmallWorld(folder), true);
  const auto file = folder.write("problems/campaigns/p.yaml", fuzz::textOf(data, ready ? size : 0));
  bool sound = false;
  fuzz::readsOrRefuses([&] {
    const Campaign campaign = readCampaign(file);
    sound = true;
    if (campaign.problems.empty()) fuzz::fail("a campaign without a problem");
    cellsOf(campaign);
  });
  if (sound && !isCampaignFile(file))
    fuzz::fail("readCampaign accepts the file, but isCampaignFile does not");
  return 0;
}
