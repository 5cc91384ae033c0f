/// `corridor benchmark` with peers: `plan_benchmark --problem FILE… [--variant NAME[:KNOB]…]
/// [--planner NAME…] [--runs N] [--seed N] [--time S] [--out FOLDER]`, each option any number of
/// times. Variants are those of the program; where FCL is installed `fcl:RESOLUTION`: states tested
/// by FCL (Debian's; BVHModel<OBBRSS> and FCL's own primitives, all meshes as surfaces, no margin),
/// edges sampled by OMPL's rule; and `replay[:TOLERANCE]`: the certified run again with its
/// recorded verdicts, at no cost. Prints the same table, what failed, and how many times as long as
/// its replay certified takes.
#include <algorithm>
#include <iostream>
#include <memory>
#include <mutex>
#include <vector>

#include <ompl/base/StateValidityChecker.h>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/write_reports.h"
#include "planner/checker/problem_state_space.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/fcl_scene.h"
#include "tests/benchmark/replay.h"

namespace corridor::bench {
namespace {

#ifdef CORRIDOR_WITH_FCL
class FclStateValidityChecker final : public ompl::base::StateValidityChecker {
 public:
  FclStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : StateValidityChecker(si), checker_(checker), scene_(checker) {}
  bool isValid(const ompl::base::State* state) const override {
    const Configuration q = configurationOf(*si_, state);
    if (!checker_.inBounds(q)) return false;
    const std::lock_guard lock(mutex_);  // some planners have threads
    return !scene_.touches(framePoses(checker_.problem().tree, q));
  }

 private:
  const Checker& checker_;
  mutable std::mutex mutex_;
  mutable FclScene scene_;
};
#endif

std::vector<BenchmarkPeer> peers() {
  return {replayPeer(),
#ifdef CORRIDOR_WITH_FCL
          {"fcl",
           [](const auto& si, const Checker& checker) {
             return std::make_shared<FclStateValidityChecker>(si, checker);
           }}
#endif
  };
}

/// By seed, where both were solved.
void compareWithReplay(const Campaign& campaign, const CampaignResult& result) {
  const auto is = [&](const CampaignCell& cell, const char* edges, bool replay) {
    const Variant& variant = campaign.variants[cell.variant];
    return variant.edges == edges && (variant.peer && variant.peer->name == "replay") == replay;
  };
  for (const CampaignCell& real : result.cells)
    for (const CampaignCell& replay : result.cells) {
      if (!is(real, "certified", false) || !is(replay, "certified", true) ||
          real.problem != replay.problem || real.planner != replay.planner ||
          campaign.variants[real.variant].knob != campaign.variants[replay.variant].knob)
        continue;
      std::vector<double> ratios;
      for (std::size_t i = 0; i < std::min(real.runs.size(), replay.runs.size()); ++i)
        if (real.runs[i].solved && replay.runs[i].solved)
          ratios.push_back(real.runs[i].searchProcessorTime / replay.runs[i].searchProcessorTime);
      if (ratios.empty()) continue;
      const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
      std::cout << result.names[real.problem] << ", " << real.planner << ": certified takes "
                << medianOf(ratios) << " times as long as its replay (processor, planner and "
                << "simplifier; " << *least << " to " << *most << ", " << ratios.size()
                << " seeds)\n";
    }
}

void run(const Arguments& arguments) {
  Campaign campaign;
  for (const std::string& file : arguments.texts("--problem"))
    campaign.problems.push_back(readProblem(file));
  auto variants = arguments.texts("--variant");
  if (variants.empty()) {
    variants = {"certified", "discrete:0.01"};
    for (const BenchmarkPeer& peer : peers())
      variants.push_back(peer.edges == "discrete" ? peer.name + ":0.01" : peer.name);
  }
  for (const std::string& variant : variants)
    campaign.variants.push_back(readVariant(variant, peers()));
  campaign.planners = arguments.texts("--planner");
  campaign.runs = static_cast<std::uint64_t>(arguments.number("--runs", 10));
  campaign.seed = static_cast<std::uint64_t>(arguments.number("--seed", 1));
  if (arguments.has("--time")) campaign.time = arguments.number("--time", 20);
  checkCampaign(campaign);
  const std::string folder = arguments.text("--out");
  if (!folder.empty()) makeReportFolder(folder);
  const CampaignResult result = runCampaign(campaign);
  if (!folder.empty()) writeReports(campaign, result, folder);
  std::cout << tableOf(summaryRows(campaign, result));
  for (const CampaignCell& cell : result.cells)
    for (const BenchmarkRun& run : cell.runs)
      if (!run.failure.empty())
        std::cout << campaign.variants[cell.variant].name << ", seed " << run.seed << ": "
                  << run.failure << '\n';
  compareWithReplay(campaign, result);
}

}  // namespace
}  // namespace corridor::bench

int main(int argc, char** argv) {
  return corridor::bench::runWith(
      argc, argv, {"--problem", "--variant", "--planner", "--runs", "--seed", "--time", "--out"},
      corridor::bench::run);
}
