#include "planner/app/benchmark_results.h"

#include <algorithm>
#include <array>
#include <exception>
#include <iostream>
#include <string_view>

#include "planner/app/benchmark_output.h"
#include "planner/app/output.h"
#include "planner/benchmark/report.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/trajectory_rows.h"
#include "planner/benchmark/write_reports.h"

namespace corridor::app {
namespace {

/// Returns a row per cell with the columns that fit into a terminal. The files have all columns.
std::vector<Row> terminalRows(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  static constexpr std::array<std::string_view, 16> kColumns{
      "problem",         "variant",         "planner",  "runs",        "failed", "solved",
      "refuted",         "undecided",       "time_s",   "processor_s", "states", "edges",
      "edges_undecided", "closest_found_m", "length_m", "rotation_rad"};
  std::vector<Row> rows = pathSummaryRows(campaign, cells);
  for (Row& row : rows)
    std::erase_if(row, [](const auto& column) {
      return std::find(kColumns.begin(), kColumns.end(), column.first) == kColumns.end();
    });
  return rows;
}

/// Prints a row per cell, and then, if there are trajectories, a row per variant, set of limits and
/// maker.
void printTables(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  std::cout << tableOf(terminalRows(campaign, cells));
  if (campaign.trajectories.makers.empty()) return;
  std::cout << "\nTrajectories along the paths of all problems:\n"
            << tableOf(trajectoryRows(campaign, cells));
}

}  // namespace

bool anyRun(const std::vector<CampaignCell>& cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](const CampaignCell& cell) { return !cell.runs.empty(); });
}

void giveResults(Campaign& campaign, const CampaignResult& result, const BenchmarkTarget& target) {
  const bool any = anyRun(result.cells);
  const RunSource runs = target.runs ? target.runs->runs() : runsOf(result.cells);
  const std::vector<CampaignSession> sessions =
      target.runs ? target.runs->sessions() : std::vector<CampaignSession>();
  for (const std::string& note : notesOf(campaign, result.cells, sessions)) {
    campaign.notes.push_back(note);
    warn(note);
  }
  for (const std::string& line : failuresOf(result.cells)) warn(line);
  if (result.interrupted)
    warn(!any            ? "interrupted before the first run was done; nothing is written"
         : target.folder ? "interrupted: the results cover the finished runs; --resume continues"
                         : "interrupted: the results cover the finished runs");
  // If a file can't be written (its folder may be gone), the table is still printed on stdout. The
  // error is kept, and thrown after the table.
  std::exception_ptr unwritten;
  try {
    if (target.folder && any) {
      writeReports(campaign, result, runs, *target.folder);
      std::string whyNoPlot;
      writeReport(campaign, result.cells, *target.folder, sessions, &whyNoPlot);
      if (!whyNoPlot.empty()) warn("plots are missing: " + withoutControls(whyNoPlot));
    }
  } catch (const InputError&) {
    unwritten = std::current_exception();
  }
  if (target.json)
    printJson(campaign, result, any ? runs : runsOf(result.cells), std::cout);
  else if (any)
    printTables(campaign, result.cells);
  if (unwritten) std::rethrow_exception(unwritten);
}

}  // namespace corridor::app
