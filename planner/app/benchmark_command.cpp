#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "collision/core/fault_list.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/output.h"
#include "planner/benchmark/campaign_database.h"
#include "planner/benchmark/campaign_yaml.h"
#include "planner/benchmark/competitors.h"
#include "planner/benchmark/report.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/benchmark/write_reports.h"
#include "planner/problem/keys.h"
#include "planner/problem/nothing_tested.h"
#include "planner/solve/planner_factory.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

/// Bytes that are not UTF-8, such as those of names in files, become U+FFFD in the JSON.
constexpr auto kReplace = ordered_json::error_handler_t::replace;

[[noreturn]] void refuse(const std::string& option, const std::string& why) {
  throw InputError(Fault{option, 0, why});
}

/// Splits the values of an option at commas; refuses empty entries. CLI11's own delimiter drops
/// these: then "$A,certified" with an unset variable would silently run another comparison.
/// @throws InputError
std::vector<std::string> wordsOf(const std::string& option, const std::vector<std::string>& lists) {
  std::vector<std::string> words;
  for (const std::string& list : lists) {
    for (std::size_t from = 0, to = 0; to != list.npos; from = to + 1) {
      to = list.find(',', from);
      const std::string word = list.substr(from, to == list.npos ? to : to - from);
      const auto begin = word.find_first_not_of(' ');
      words.push_back(
          begin == word.npos ? "" : word.substr(begin, word.find_last_not_of(' ') + 1 - begin));
      if (words.back().empty()) refuse(option, "an entry of " + quotedWord(list) + " is empty");
    }
  }
  return words;
}

/// Returns the competitors that can take part. Their modules are opened only if a variant names a
/// competitor or something unknown. @throws InputError if a variant names one that can't take part.
std::vector<BenchmarkCompetitor> peersOf(const std::vector<std::string>& variants) {
  const std::vector<std::string>& edges = problemChoices().at("checker.edges");
  bool needed = false;
  for (const std::string& word : variants) {
    const std::string name = word.substr(0, word.find(':'));
    needed = needed || std::find(edges.begin(), edges.end(), name) == edges.end();
    if (std::find(peerNames().begin(), peerNames().end(), name) == peerNames().end()) continue;
    if (const std::string why = whyNoPeer(name); !why.empty())
      refuse("--variants", name + " can't take part: " + why);
  }
  return needed ? peersHere() : std::vector<BenchmarkCompetitor>();
}

/// Makes a campaign of problems and options. @throws InputError with all faults.
Campaign campaignOfProblems(const BenchmarkArguments& a) {
  Campaign campaign;
  FaultList faults;
  std::vector<std::string> variants = wordsOf("--variants", a.variants);
  if (variants.empty()) variants = {"certified", "discrete:0.01"};
  std::vector<BenchmarkCompetitor> peers;
  faults.collect([&] { peers = peersOf(variants); });
  faults.throwIfAny();
  for (const std::string& word : variants)
    faults.collect([&] { campaign.variants.push_back(readVariant(word, peers)); });
  for (const std::string& file : a.files) {
    faults.collect([&] {
      for (const std::string& problem : problemsOf(file))
        faults.collect([&] { campaign.problems.push_back(readProblem(problem)); });
    });
  }
  for (const std::string& name : wordsOf("--planners", a.planners)) {
    if (const auto unknown = unknownPlanner(name)) faults.add("--planners", 0, *unknown);
    campaign.planners.push_back({name, name, {}});
  }
  faults.throwIfAny();
  nameProblems(campaign);
  return campaign;
}

/// Reads the campaign's file, or makes one of problems; options override what it says.
Campaign campaignOf(const BenchmarkArguments& a) {
  const auto file = std::find_if(a.files.begin(), a.files.end(),
                                 [](const std::string& name) { return isCampaignFile(name); });
  if (file != a.files.end()) {
    if (a.files.size() > 1) refuse(*file, "is a campaign, which names its problems itself");
    if (!a.variants.empty()) refuse("--variants", "a campaign names its checkers itself");
    if (!a.planners.empty()) refuse("--planners", "a campaign names its planners itself");
  }
  Campaign campaign = file != a.files.end() ? readCampaign(*file) : campaignOfProblems(a);
  campaign.runs = a.runs.value_or(campaign.runs);
  campaign.seed = a.seed.value_or(campaign.seed);
  if (a.time) campaign.time = a.time;
  campaign.limits.memory = a.memory.value_or(campaign.limits.memory);
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
  ordered_json j = {{"format", "corridor-benchmark-report-2"},
                    {"campaign", campaign.name},
                    {"seed", campaign.seed},
                    {"runs", campaign.runs},
                    {"interrupted", result.interrupted},
                    {"notes", campaign.notes},
                    {"results", ordered_json::array()}};
  for (const CampaignCell& cell : result.cells) {
    ordered_json of = jsonOf(summaryRow(campaign, cell));
    of["rows"] = ordered_json::array();
    for (const BenchmarkRun& run : cell.runs)
      of["rows"].push_back(jsonOf(runRow(campaign, cell, run)));
    j["results"].push_back(std::move(of));
  }
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

/// Prints a line over the line before:
/// "[####······] 41 of 240, 2:10 left: piano, certified, RRT, seed 2".
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

/// Returns a note if a competitor plans a problem with a margin, else "". Competitors test for
/// contact only, so the verifier may refute their paths for the margin alone.
std::string marginNote(const Campaign& campaign) {
  const bool margin = std::any_of(campaign.problems.begin(), campaign.problems.end(),
                                  [](const Problem& p) { return p.task.margin > 0; });
  for (const Variant& variant : campaign.variants)
    if (margin && variant.peer)
      return variant.peer->name +
             " tests for contact without the margin, so its paths may be refuted for the margin "
             "alone; least_distance_m in runs.csv shows which of them collide";
  return "";
}

std::set<std::string> hostsOf(const std::vector<CampaignCell>& cells) {
  std::set<std::string> hosts;
  for (const CampaignCell& cell : cells)
    for (const BenchmarkRun& run : cell.runs)
      if (!run.ompl.host.empty()) hosts.insert(run.ompl.host);
  return hosts;
}

bool anyRun(const std::vector<CampaignCell>& cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](const CampaignCell& cell) { return !cell.runs.empty(); });
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

int benchmarkCommand(const BenchmarkArguments& a) {
  if (a.resume && !a.output) refuse("--resume", "needs -o with the folder of the campaign");
  Campaign campaign = campaignOf(a);
  for (std::size_t i = campaign.problems.size(); i-- > 0;)  // these notes come first
    if (nothingIsTested(campaign.problems[i]))
      campaign.notes.insert(campaign.notes.begin(),
                            campaign.problemNames[i] + ": " + kNothingTested);
  for (const std::string& note : campaign.notes) warn(note);
  checkCampaign(campaign);
  // From here on the command makes files, which it must finish or remove on a signal.
  const std::atomic<bool>& interrupted = listenForInterrupts();
  const bool made = a.output && makeReportFolder(*a.output, campaign);
  std::vector<CampaignCell> cells = cellsOf(campaign);
  std::optional<CampaignDatabase> database;
  const std::filesystem::path file = std::filesystem::path(a.output.value_or("")) / "campaign.db";
  if (a.output)
    database.emplace(file,
                     a.resume ? CampaignDatabase::Mode::resume : CampaignDatabase::Mode::fresh,
                     campaign, cells, a.jobs);
  CampaignOptions options;
  options.interrupted = &interrupted;
  options.jobs = a.jobs;
  if (database)
    options.done = [&](std::size_t cell, const BenchmarkRun& run) { database->add(cell, run); };
  const bool show = ::isatty(STDERR_FILENO) != 0;
  if (show) options.progress = [&](const CampaignProgress& p) { showProgress(campaign, p); };
  const CampaignResult result = runCampaign(campaign, options, std::move(cells));
  if (show) std::fputs("\r\033[K", stderr);
  const bool any = anyRun(result.cells);
  // A file that can't be written, such as in a folder that is gone, must not lose the table on
  // stdout: its error is kept, and thrown after the table.
  std::exception_ptr unwritten;
  std::vector<CampaignSession> sessions;
  try {
    if (database) sessions = database->sessions();
  } catch (const InputError&) {
    unwritten = std::current_exception();
  }
  if (const std::vector<std::string> builds = commitsOf(sessions); builds.size() > 1) {
    campaign.notes.push_back("the runs are from several builds, whose times may differ: commits " +
                             joined(builds));
    warn(campaign.notes.back());
  }
  if (const std::string note = marginNote(campaign); !note.empty()) {
    campaign.notes.push_back(note);
    warn(note);
  }
  if (const std::set<std::string> hosts = hostsOf(result.cells); hosts.size() > 1) {
    campaign.notes.push_back("the runs are from several machines, whose times differ: " +
                             joined(std::vector<std::string>(hosts.begin(), hosts.end())));
    warn(campaign.notes.back());
  }
  if (result.interrupted)
    warn(!any       ? "interrupted before the first run was done; nothing is written"
         : a.output ? "interrupted: the results cover the finished runs; --resume continues"
                    : "interrupted: the results cover the finished runs");
  try {
    if (a.output && any) {
      writeReports(campaign, result, *a.output);
      writeReport(campaign, result.cells, *a.output, sessions);
    }
  } catch (const InputError&) {
    unwritten = std::current_exception();
  }
  if (!any && !a.resume) {
    std::error_code ignored;
    database.reset();
    if (a.output) std::filesystem::remove(file, ignored);
    if (made) std::filesystem::remove(*a.output, ignored);
  }
  if (a.json)
    std::cout << jsonOf(campaign, result).dump(2, ' ', false, kReplace) << '\n';
  else if (any)
    std::cout << tableOf(summaryRows(campaign, result.cells));
  if (unwritten) std::rethrow_exception(unwritten);
  return result.interrupted ? interruptedStatus() : kDone;
}

}  // namespace corridor::app
