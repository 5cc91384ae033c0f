#include "planner/app/benchmark_merge.h"

#include <filesystem>
#include <optional>

#include "planner/app/benchmark_results.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/output.h"
#include "planner/app/rank_job.h"
#include "planner/benchmark/campaign_database.h"
#include "planner/benchmark/campaign_merge.h"
#include "planner/benchmark/database_file.h"
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
  const std::filesystem::path folder = *a.output, file = folder / "campaign.db";
  std::error_code ignored;
  const bool made = makeReportFolder(folder, campaign),
             had = std::filesystem::exists(file, ignored);
  const auto removeAll = [&] {
    if (!had) removeDatabase(file);
    if (made) std::filesystem::remove(folder, ignored);
  };
  CampaignResult result;
  result.start = std::chrono::system_clock::now();
  std::optional<CampaignDatabase> database;
  try {
    if (had) {  // throws if the file has runs, or is no database of a campaign
      std::vector<CampaignCell> cells = cellsOf(campaign);
      CampaignDatabase(file, CampaignDatabase::Mode::fresh, campaign, cells);
    }
    mergeInto(merge, file);
    result.cells = cellsOf(campaign);
    database.emplace(file, CampaignDatabase::Mode::resume, campaign, result.cells);
  } catch (...) {
    database.reset();
    removeAll();
    throw;
  }
  if (interrupted) {
    database.reset();
    removeDatabase(file);
    removeAll();
    return interruptedStatus();
  }
  std::uint64_t runs = 0;
  for (const CampaignCell& cell : result.cells) runs += cell.runs.size();
  const std::uint64_t all = result.cells.size() * campaign.runs;
  if (runs < all) {
    campaign.notes.push_back(counted(all - runs, "run") + " of " + grouped(all) +
                             " are missing; benchmark CAMPAIGN --resume makes them");
    warn(campaign.notes.back());
  }
  giveResults(campaign, result, {folder, &*database, a.json});
  return kDone;
}

}  // namespace corridor::app
