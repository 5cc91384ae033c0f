#include "planner/app/benchmark_output.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <ostream>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "collision/core/spelling.h"
#include "planner/app/output.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/trajectory_rows.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

/// Bytes that are not UTF-8, such as those of names in files, become U+FFFD in the JSON.
constexpr auto kReplace = ordered_json::error_handler_t::replace;

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

/// "1:02:03", "4:05"
std::string clockText(double seconds) {
  const auto all = static_cast<std::uint64_t>(std::lround(std::min(seconds, 1e9)));
  char text[32];
  if (all >= 3600)
    std::snprintf(text, sizeof text, "%d:%02d:%02d", static_cast<int>(all / 3600),
                  static_cast<int>(all / 60 % 60), static_cast<int>(all % 60));
  else
    std::snprintf(text, sizeof text, "%d:%02d", static_cast<int>(all / 60),
                  static_cast<int>(all % 60));
  return text;
}

/// Returns a note if a competitor plans a problem with a margin, else "". Competitors test for
/// contact only, so the verifier may refute paths of theirs that touch nothing, because these paths
/// violate the margin.
std::string marginNote(const Campaign& campaign) {
  const bool margin =
      std::any_of(campaign.problems.begin(), campaign.problems.end(),
                  [](const Problem& p) { return p.task.margin > 0 || !p.task.padding.empty(); });
  for (const Variant& variant : campaign.variants)
    if (margin && variant.competitor)
      return variant.competitor->name +
             " tests for contact without the margin, so its paths may be refuted for the margin "
             "alone; closest_found_m in runs.csv shows which of them collide";
  return "";
}

std::set<std::string> hostsOf(const std::vector<CampaignCell>& cells) {
  std::set<const OmplRecord*> records;  // runs share them
  for (const CampaignCell& cell : cells)
    for (const BenchmarkRun& run : cell.runs) records.insert(run.ompl.get());
  std::set<std::string> hosts;
  for (const OmplRecord* record : records)
    if (!record->host.empty()) hosts.insert(record->host);
  return hosts;
}

/// Returns each commit once, in the order of the sessions.
std::vector<std::string> commitsOf(const std::vector<CampaignSession>& sessions) {
  std::vector<std::string> commits;
  for (const CampaignSession& session : sessions)
    if (std::find(commits.begin(), commits.end(), session.commit) == commits.end())
      commits.push_back(session.commit);
  return commits;
}

}  // namespace

void showProgress(const Campaign& campaign, const CampaignProgress& p) {
  constexpr std::uint64_t kWidth = 20;
  const std::uint64_t full = p.done * kWidth / p.total;
  std::string bar;
  for (std::uint64_t i = 0; i < kWidth; ++i) bar += i < full ? "#" : "·";
  const std::string left = p.secondsLeft < 0 ? "" : ", " + clockText(p.secondsLeft) + " left";
  std::fprintf(stderr, "\r[%s] %s of %s%s: %s, %s, %s, seed %s\033[K", bar.c_str(),
               grouped(p.done).c_str(), counted(p.total, "run").c_str(), left.c_str(),
               campaign.problemNames[p.cell.problem].c_str(),
               campaign.variants[p.cell.variant].name.c_str(), p.cell.planner.label.c_str(),
               std::to_string(p.seed).c_str());
}

std::vector<std::string> notesOf(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                                 const std::vector<CampaignSession>& sessions) {
  std::vector<std::string> notes;
  if (const std::vector<std::string> builds = commitsOf(sessions); builds.size() > 1)
    notes.push_back("the runs are from several builds, whose times may differ: commits " +
                    joined(builds));
  if (const std::string note = marginNote(campaign); !note.empty()) notes.push_back(note);
  if (const std::set<std::string> hosts = hostsOf(cells); hosts.size() > 1)
    notes.push_back("the runs are from several machines, whose times differ: " +
                    joined(std::vector<std::string>(hosts.begin(), hosts.end())));
  return notes;
}

std::vector<std::string> failuresOf(const std::vector<CampaignCell>& cells) {
  std::map<std::string, std::size_t> counts;
  for (const CampaignCell& cell : cells)
    for (const BenchmarkRun& run : cell.runs)
      if (!run.failure.empty()) ++counts[run.failure];
  std::vector<std::pair<std::string, std::size_t>> reasons(counts.begin(), counts.end());
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> lines;
  for (const auto& [why, runs] : reasons)
    lines.push_back(std::to_string(runs) + (runs == 1 ? " run failed: " : " runs failed: ") + why);
  return lines;
}

void printJson(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
               std::ostream& out) {
  ordered_json j = {{"format", "corridor-benchmark-report-2"},
                    {"campaign", campaign.name},
                    {"seed", campaign.seed},
                    {"runs", campaign.runs},
                    {"interrupted", result.interrupted},
                    {"notes", campaign.notes}};
  // The runs may not fit into memory as JSON, so lists of them are printed row by row.
  const auto text = [](const ordered_json& of, int depth) {
    std::string lines = of.dump(2, ' ', false, kReplace);
    const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
    for (auto at = lines.find('\n'); at != std::string::npos; at = lines.find('\n', at + 1))
      lines.insert(at + 1, indent);
    return lines;
  };
  /// Prints an object except its closing brace, and one more key, so that the caller can print the
  /// value of this key.
  const auto openObject = [&](const ordered_json& of, int depth, const char* key) {
    std::string lines = text(of, depth);
    lines.erase(lines.rfind('\n'));
    out << lines << ",\n"
        << std::string(static_cast<std::size_t>(2 * depth) + 2, ' ') << '"' << key << "\": ";
  };
  /// Prints a list. Calls `each(add)`, which must call `add(print)` for each item of the list;
  /// `print()` prints the item.
  const auto list = [&](int depth, const auto& each) {
    const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
    bool any = false;
    out << '[';
    each([&](const auto& print) {
      out << (any ? ",\n  " : "\n  ") << indent;
      any = true;
      print();
    });
    out << (any ? "\n" + indent : std::string()) << ']';
  };
  openObject(j, 0, "results");
  list(1, [&](const auto& addCell) {
    for (std::size_t c = 0; c < result.cells.size(); ++c)
      addCell([&] {
        const CampaignCell& cell = result.cells[c];
        openObject(jsonOf(summaryRow(campaign, cell)), 2, "rows");
        list(3, [&](const auto& addRun) {
          runs(c, [&](const BenchmarkRun& run) {
            addRun([&] { out << text(jsonOf(runRow(campaign, cell, run)), 4); });
          });
        });
        out << "\n    }";
      });
  });
  if (!campaign.trajectories.makers.empty()) {
    ordered_json trajectories = ordered_json::array();
    for (const Row& row : trajectoryRows(campaign, result.cells))
      trajectories.push_back(jsonOf(row));
    out << ",\n  \"trajectories\": " << text(trajectories, 1);
  }
  out << "\n}\n";
}

}  // namespace corridor::app
