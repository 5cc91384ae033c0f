#include "planner/app/benchmark_merge.h"

#include <filesystem>
#include <memory>

#include "planner/app/benchmark_results.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/output.h"
#include "planner/app/rank_job.h"
#include "planner/benchmark/campaign_merge.h"
#include "planner/benchmark/write_reports.h"

namespace corridor::app {

int mergeCampaigns(const BenchmarkArguments& a) {
  RankJob job(1);
  if (job.serves()) return job.serve({});  // until rank 0 has merged
  if (!a.output) throw InputError(Fault{"--merge", 0, "needs -o with the folder of the results"});
  CampaignMerge merge = readCampaigns({a.files.begin(), a.files.end()});
  Campaign& campaign = merge.campaign;
  for (const std::string& note : campaign.notes) warn(note);
  // From here on the command creates files. If a signal arrives, it must finish or remove them.
  const std::atomic<bool>& interrupted = job.listen();
  const std::filesystem::path folder = *a.output, file = folder / "runs.jsonl";
  std::error_code ignored;
  const bool made = makeReportFolder(folder), had = std::filesystem::exists(file, ignored);
  const auto removeAll = [&] {
    if (!had) std::filesystem::remove(file, ignored);
    if (made) std::filesystem::remove(folder, ignored);
  };
  CampaignResult result;
  result.start = std::chrono::system_clock::now();
  result.cells = cellsOf(campaign);
  std::unique_ptr<RunFile> stored;
  try {
    if (had) RunFile(file, RunFile::Mode::fresh, campaign, result.cells);  // throws if it has runs
    stored = mergeInto(merge, file, result.cells);
  } catch (...) {
    removeAll();
    throw;
  }
  if (interrupted) {
    std::filesystem::remove(file, ignored);
    removeAll();
    return interruptedStatus();
  }
  for (const std::string& note : stored->notes()) warn(note);
  std::uint64_t runs = 0;
  for (const CampaignCell& cell : result.cells) runs += cell.runs.size();
  const std::uint64_t all = result.cells.size() * campaign.runs;
  if (runs < all) {
    campaign.notes.push_back(counted(all - runs, "run") + " of " + grouped(all) +
                             " are missing; benchmark CAMPAIGN --resume makes them");
    warn(campaign.notes.back());
  }
  giveResults(campaign, result, {folder, stored.get(), a.json});
  return kDone;
}

}  // namespace corridor::app
