#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "collision/core/fault_list.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/output.h"
#include "planner/benchmark/campaign.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/write_reports.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

/// Reads problems and words; all faults at once.
Campaign campaignOf(const BenchmarkArguments& a) {
  Campaign campaign;
  FaultList faults;
  for (const std::string& word : a.variants)
    faults.collect([&] { campaign.variants.push_back(readVariant(word)); });
  for (const std::string& file : a.problems)
    faults.collect([&] { campaign.problems.push_back(readProblem(file)); });
  faults.throwIfAny();
  campaign.planners = a.planners;
  campaign.runs = a.runs;
  campaign.seed = a.seed;
  campaign.time = a.time;
  campaign.limits.memory = a.memory;
  return campaign;
}

ordered_json jsonOf(const Row& row) {
  ordered_json j;
  for (const auto& [name, value] : row)
    std::visit(
        [&j, &key = name](const auto& held) {
          if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
            j[key] = nullptr;
          else
            j[key] = held;
        },
        value);
  return j;
}

ordered_json jsonOf(const Campaign& campaign, const CampaignResult& result) {
  ordered_json j = {{"format", "corridor-benchmark-report-1"},
                    {"seed", campaign.seed},
                    {"runs", campaign.runs},
                    {"interrupted", result.interrupted},
                    {"results", ordered_json::array()}};
  for (const CampaignCell& cell : result.cells) {
    ordered_json of = jsonOf(summaryRow(campaign, result, cell));
    of["rows"] = ordered_json::array();
    for (const BenchmarkRun& run : cell.runs)
      of["rows"].push_back(jsonOf(runRow(campaign, result, cell, run)));
    j["results"].push_back(std::move(of));
  }
  return j;
}

}  // namespace

int benchmarkCommand(const BenchmarkArguments& a) {
  const Campaign campaign = campaignOf(a);
  checkCampaign(campaign);
  const bool made = a.output && makeReportFolder(*a.output);
  CampaignOptions options;
  options.interrupted = &listenForInterrupts();
  const bool show = ::isatty(STDERR_FILENO) != 0;
  if (show) {
    options.progress = [](const CampaignProgress& p) {
      std::fprintf(stderr, "\r%s of %s: %s, %s, %s, seed %s\033[K", grouped(p.done + 1).c_str(),
                   counted(p.total, "run").c_str(), p.problem.c_str(), p.variant.c_str(),
                   p.planner.c_str(), std::to_string(p.seed).c_str());
    };
  }
  const CampaignResult result = runCampaign(campaign, options);
  if (show) std::fputs("\r\033[K", stderr);
  const bool any = std::any_of(result.cells.begin(), result.cells.end(),
                               [](const CampaignCell& cell) { return !cell.runs.empty(); });
  if (result.interrupted)
    warn(any ? "interrupted: what follows is of the runs that were done"
             : "interrupted before the first run was done; nothing is written");
  // Neither the files nor the table are lost where the other can't be written: a folder that is
  // gone, a pipe that is closed.
  std::exception_ptr unwritten;
  try {
    if (a.output && any) writeReports(campaign, result, *a.output);
  } catch (const InputError&) {
    unwritten = std::current_exception();
  }
  std::error_code notEmpty;
  if (made && !any) std::filesystem::remove(*a.output, notEmpty);
  if (a.json)
    std::cout << jsonOf(campaign, result).dump(2) << '\n';
  else if (any)
    std::cout << tableOf(summaryRows(campaign, result));
  if (unwritten) std::rethrow_exception(unwritten);
  return result.interrupted ? kInterrupted : kDone;
}

}  // namespace corridor::app
