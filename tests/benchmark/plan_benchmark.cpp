/// `corridor benchmark` with competitors: `plan_benchmark --problem FILE… [--variant NAME[:KNOB]…]
/// [--planner NAME…] [--runs N] [--seed N] [--time S] [--out FOLDER]`, each option may be given any
/// number of times.
///
/// Variants are those of the program, and:
/// * `fcl:RESOLUTION`, if FCL is installed: states are tested by FCL (Debian's; BVHModel<OBBRSS>
///   and FCL's own primitives, all meshes as surfaces, no margin), and edges are sampled by OMPL's
///   rule;
/// * `replay[:TOLERANCE]`: a certified run that is repeated with its recorded verdicts, so that
///   verdicts cost nothing.
///
/// Prints the same table as the program, the failures, and the ratio of the time of `certified` to
/// that of its replay.
#include <algorithm>
#include <iostream>
#include <vector>

#include "collision/core/quantiles.h"
#include "planner/benchmark/competitors.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/benchmark/statistics.h"
#include "planner/benchmark/write_reports.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/replay.h"

namespace corridor::bench {
namespace {

std::vector<BenchmarkCompetitor> peers() {
  std::vector<BenchmarkCompetitor> peers = availableCompetitors();
  peers.insert(peers.begin(), replayPeer());
  return peers;
}

/// Compares `certified` with its replay, for each seed with which both runs were solved.
void compareWithReplay(const Campaign& campaign, const CampaignResult& result) {
  const auto specOf = [&](const CampaignCell& cell) {
    CheckerSettings checker = campaign.problems[cell.problem].settings.checker;
    campaign.variants[cell.variant].apply(checker);
    return checker;
  };
  const auto is = [&](const CampaignCell& cell, EdgeMethod edges, bool replay) {
    const Variant& variant = campaign.variants[cell.variant];
    return specOf(cell).edges == edges &&
           (variant.competitor && variant.competitor->name == "replay") == replay;
  };
  for (const CampaignCell& real : result.cells)
    for (const CampaignCell& replay : result.cells) {
      if (!is(real, EdgeMethod::certified, false) || !is(replay, EdgeMethod::certified, true) ||
          real.problem != replay.problem || real.planner.label != replay.planner.label ||
          specOf(real).tolerance != specOf(replay).tolerance)
        continue;
      std::vector<double> ratios;
      for (std::size_t i = 0; i < std::min(real.runs.size(), replay.runs.size()); ++i)
        if (real.runs[i].solved && replay.runs[i].solved)
          ratios.push_back(real.runs[i].searchProcessorTime / replay.runs[i].searchProcessorTime);
      if (ratios.empty()) continue;
      const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
      std::cout << campaign.problemNames[real.problem] << ", " << real.planner.label
                << ": certified takes " << medianOf(ratios)
                << " times as long as its replay (processor time of planner "
                << "and simplifier; " << *least << " to " << *most << ", " << ratios.size()
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
    for (const BenchmarkCompetitor& peer : peers())
      variants.push_back(peer.edges == "discrete" ? peer.name + ":0.01" : peer.name);
  }
  for (const std::string& variant : variants)
    campaign.variants.push_back(readVariant(variant, peers()));
  for (const std::string& name : arguments.texts("--planner"))
    campaign.planners.push_back({name, name, {}});
  identifyProblems(campaign);
  campaign.runs = static_cast<std::uint64_t>(arguments.number("--runs", 10));
  campaign.seed = static_cast<std::uint64_t>(arguments.number("--seed", 1));
  if (arguments.has("--time")) campaign.time = arguments.number("--time", 20);
  checkCampaign(campaign);
  const std::string folder = arguments.text("--out");
  if (!folder.empty()) makeReportFolder(folder, campaign);
  const CampaignResult result = runCampaign(campaign);
  if (!folder.empty()) writeReports(campaign, result, folder);
  std::cout << tableOf(summaryRows(campaign, result.cells));
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
