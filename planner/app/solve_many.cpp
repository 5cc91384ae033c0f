#include "planner/app/solve_many.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "collision/core/file_cache.h"
#include "collision/core/quantiles.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/output.h"
#include "planner/app/solve_one.h"
#include "planner/solve/solution.h"

namespace corridor::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Seconds that the parent waits for a child: practically without limit, because the time limits of
/// the problems end the children.
constexpr double kPatience = 1e9;
constexpr int kPollMs = 200;

constexpr const char* kBadInputResult = "bad input";
constexpr const char* kFailedResult = "failed";
constexpr const char* kCacheNotes = "cache_notes";  // in a child's report

/// Returns the name of a problem's solution in a folder. Input files are unlikely to have this
/// name.
fs::path solutionIn(const std::string& folder, const ListedProblem& problem) {
  return fs::path(folder) / (problem.name + ".solution.yaml");
}
fs::path pictureIn(const std::string& folder, const ListedProblem& problem) {
  return fs::path(folder) / (problem.name + ".svg");
}
fs::path trajectoryIn(const std::string& folder, const ListedProblem& problem) {
  return fs::path(folder) / (problem.name + ".csv");
}

/// Makes a folder for files, unless it exists. @throws InputError if it can't be used.
void requireFolder(const std::optional<std::string>& folder, const char* option,
                   std::size_t problems) {
  if (!folder) return;
  const auto refuse = [&](const std::string& why) { throw InputError(Fault{option, 0, why}); };
  const std::string extension = lowered(fs::path(*folder).extension().string());
  std::error_code error;
  const bool isFolder = fs::is_directory(*folder, error);
  const bool isFileName = extension == ".yaml" || extension == ".yml" || extension == ".svg" ||
                          extension == ".png" || extension == ".path" || extension == ".csv";
  if (*folder == "-" || (fs::exists(*folder, error) && !isFolder) || (!isFolder && isFileName))
    refuse("names one file, but there " +
           std::string(problems == 1 ? "may be several problems"
                                     : "are " + counted(problems, "problem")) +
           "; name a folder");
  fs::create_directories(*folder, error);
  if (error) refuse("the folder " + *folder + " can't be made: " + error.message());
  if (::access(folder->c_str(), W_OK | X_OK) != 0)
    refuse("the folder " + *folder + " is not writable");
}

/// @throws InputError if a file that is not a solution would be overwritten.
void requireNoOtherFile(const std::vector<ListedProblem>& problems, const SolveArguments& a) {
  if (!a.output) return;
  for (const ListedProblem& problem : problems) {
    const fs::path file = solutionIn(*a.output, problem);
    std::error_code none;
    if (fs::exists(file, none) && !isSolutionFile(file))
      throw InputError(
          Fault{"--output", 0, file.string() + " exists, and is no solution; name another folder"});
  }
}

/// Returns the arguments in which the folders are replaced by the names of one problem's files.
SolveArguments argumentsFor(const ListedProblem& problem, const SolveArguments& a) {
  SolveArguments own = a;
  if (a.output) own.output = solutionIn(*a.output, problem).string();
  if (a.picture) own.picture = pictureIn(*a.picture, problem).string();
  if (a.trajectory) own.trajectory = trajectoryIn(*a.trajectory, problem).string();
  return own;
}

/// Solves one problem in a child process. Sends a first message before it writes a file, and then
/// the report.
void solveInChild(const ListedProblem& problem, const SolveArguments& a,
                  const ChildProcess::Send& send) {
  static const std::atomic<bool> never = false;  // the parent kills an interrupted child
  ordered_json report;
  bool isWriting = false;
  try {
    SolveArguments own = argumentsFor(problem, a);
    own.quiet = true;  // no progress
    const Solved solved = solveOne(problem.file, own, never, [&] {
      isWriting = true;
      send("writes");
    });
    report = jsonOf(solved, problem.file);
    if (const auto& cache = solved.problem.model.cache) {
      cache->save();  // now, because the parent may end this process after its last message
      for (const std::string& note : cache->takeNotes()) report[kCacheNotes].push_back(note);
    }
    for (const Note& note : solved.problem.source.notes)
      if (note.weight == NoteWeight::coverage && !a.quiet)
        std::cerr << problem.name << ": note: " << note.text << '\n';
  } catch (const InputError& error) {
    printFaults(error);
    report = {{"problem", problem.file}, {"result", kBadInputResult}, {"why", error.what()}};
  }
  if (!isWriting) send("writes");
  send(jsonText(report, -1));
}

/// Returns the report on a problem, made from the end of its task.
/// @param cacheNotes gets the child's notes on the cache, too: they are printed once for all.
ordered_json reportOf(const ListedProblem& problem, const ChildEnd& end,
                      std::vector<std::string>& cacheNotes) {
  if (end.messages.size() != 2)
    return {{"problem", problem.file}, {"result", kFailedResult}, {"why", end.failure}};
  ordered_json report = ordered_json::parse(end.messages.back());
  if (const auto notes = report.find(kCacheNotes); notes != report.end()) {
    const ordered_json own = *notes;
    report.erase(notes);
    for (const ordered_json& note : own) {
      cacheNotes.push_back(note);
      report["notes"].push_back(note);
    }
  }
  return report;
}

/// Solves the problems until all are done, or until an interrupt.
/// @param done is called with the index of each problem and the end of its task.
template <class Done>
void solveAll(std::size_t problems, Executor& executor, const std::atomic<bool>& interrupted,
              const Done& done) {
  std::size_t next = 0;
  bool stopped = false;
  while (next < problems || executor.underWay() > 0) {
    while (!interrupted && next < problems && executor.underWay() < executor.places() &&
           executor.start(next))
      ++next;
    for (const TaskEnd& one : executor.wait(kPollMs)) done(one.task, one.end);
    // A child that writes its files is not stopped in the middle.
    if (interrupted && !std::exchange(stopped, true)) executor.stop();
    if (interrupted && executor.underWay() == 0) return;
  }
}

/// Returns whether the report has a trajectory that was not made, or is not proved.
bool lacksTrajectory(const ordered_json& report) {
  return report.contains("trajectory") && !report["trajectory"].value("proved", false);
}

int statusOf(const ordered_json& report) {
  const std::string result = report["result"];
  return result == nameOf(SolveOutcome::solved)
             ? (lacksTrajectory(report) ? kNegativeResult : kDone)
         : result == kBadInputResult ? kBadInput
         : result == kFailedResult   ? kInternal
                                     : kNegativeResult;
}

bool isSolved(const ordered_json& report) {
  return report["result"] == nameOf(SolveOutcome::solved);
}

/// Returns the line about one problem.
std::string lineOf(const ordered_json& report) {
  std::string line = report["result"];
  if (!isSolved(report)) {
    const std::string why = report.at("why");
    return line + ": " + why.substr(0, why.find('\n'));
  }
  const auto& path = report["path"];
  const double metres = path["length_m"], radians = path["rotation_rad"];
  line += ", " + (metres > 0 ? rounded(metres) + " m" : "") +
          (metres > 0 && radians > 0 ? " and " : "") +
          (radians > 0 ? rounded(radians) + " rad" : "");
  if (metres == 0 && radians == 0) line += "0 m";
  line += ", " + counted(path["states"].get<std::uint64_t>(), "state");
  if (report.contains("clearance")) {
    const auto& clearance = report["clearance"];
    line += ", clearance " + rounded(1e3 * clearance["proved_clearance_m"].get<double>()) + " mm";
    if (clearance["share_on_target"] < 1)
      line += " (targets kept on " + percent(clearance["share_on_target"]) + " of the length)";
  }
  line += report["certified"].get<bool>() ? ", certified" : ", not certified";
  if (const std::size_t pairs = report["left_out"].size();
      pairs > 0 && report["certified"].get<bool>())
    line += " except " + counted(pairs, "pair");
  if (report.contains("trajectory")) {
    const auto& made = report["trajectory"];
    line += made.contains("why_none") ? ", no trajectory: " + made["why_none"].get<std::string>()
            : lacksTrajectory(report)
                ? ", trajectory not proved"
                : ", trajectory of " + rounded(made["duration_s"].get<double>()) + " s";
  }
  return line + ", " + durationText(report["time_s"]);
}

/// Prints a table of medians over the solved problems, with one row for each set or folder of
/// problems.
void printTable(const std::vector<ordered_json>& reports, const ResultPrinter& out) {
  std::vector<std::pair<std::string, std::vector<const ordered_json*>>> groups;
  for (const ordered_json& report : reports) {
    if (report.is_null()) continue;
    const std::string file = report["problem"];
    const auto hash = file.rfind(".json#");
    const std::string set = hash == std::string::npos ? "other problems" : file.substr(0, hash + 5);
    const auto known = std::find_if(groups.begin(), groups.end(),
                                    [&](const auto& group) { return group.first == set; });
    auto& group = known == groups.end()
                      ? groups.emplace_back(set, std::vector<const ordered_json*>())
                      : *known;
    group.second.push_back(&report);
  }
  for (const auto& [set, all] : groups) {
    std::vector<const ordered_json*> solved;
    std::size_t certified = 0;
    for (const ordered_json* report : all)
      if (isSolved(*report)) {
        solved.push_back(report);
        certified += (*report)["certified"].get<bool>();
      }
    out.line(groups.size() == 1 && set == "other problems" ? "problems" : set,
             std::to_string(solved.size()) + " of " + std::to_string(all.size()) + " solved, " +
                 std::to_string(certified) + " certified");
    if (solved.empty()) continue;
    std::string times;
    for (const auto& [key, name] : kSolvePhases) {
      if (!solved.front()->at("phases").contains(key)) continue;  // without --trajectory
      std::vector<double> seconds;
      for (const ordered_json* report : solved) seconds.push_back((*report)["phases"][key]);
      times +=
          (times.empty() ? "" : ", ") + std::string(name) + " " + durationText(medianOf(seconds));
    }
    out.line("  medians", times);
    std::vector<double> proved;
    for (const ordered_json* report : solved)
      if (report->contains("clearance"))
        proved.push_back((*report)["clearance"]["proved_clearance_m"]);
    if (!proved.empty())
      out.line("  median clearance", rounded(1e3 * medianOf(proved)) + " mm proved");
  }
}

}  // namespace

TaskStarter solveStarter(const std::vector<ListedProblem>& problems, const SolveArguments& a) {
  const auto work = [&](std::uint64_t task, const ChildProcess::Send& send) {
    solveInChild(problems[task], a, send);
  };
  return [work](std::uint64_t task) {
    return ChildProcess(work, task, {{kPatience, kPatience}, 0});
  };
}

int solveMany(const std::vector<ListedProblem>& problems, const SolveArguments& a,
              Executor& executor, const std::atomic<bool>& interrupted) {
  requireFolder(a.output, "--output", problems.size());
  requireFolder(a.picture, "--picture", problems.size());
  requireFolder(a.trajectory, "--trajectory", problems.size());
  requireNoOtherFile(problems, a);
  const ResultPrinter out(a.quiet || a.json || a.jsonLines);
  const bool show = !a.quiet && ::isatty(STDERR_FILENO) != 0;
  int status = kDone;
  std::size_t done = 0;
  std::vector<ordered_json> reports(problems.size());  // a null report: the problem is not done
  std::vector<std::string> cacheNotes;
  solveAll(problems.size(), executor, interrupted, [&](std::size_t i, const ChildEnd& end) {
    const ordered_json& report = reports[i] = reportOf(problems[i], end, cacheNotes);
    ++done;
    status = std::max(status, statusOf(report));
    if (show) std::fputs("\r\033[K", stderr);
    if (a.jsonLines && !a.quiet) std::cout << jsonText(report, -1) << std::endl;
    out.line(problems[i].name, lineOf(report));
    std::cout.flush();
    if (show) std::fprintf(stderr, "\r%zu of %zu problems done\033[K", done, problems.size());
  });
  if (show) std::fputs("\r\033[K", stderr);
  if (a.json && !a.quiet) {
    ordered_json list = ordered_json::array();
    for (const ordered_json& report : reports)
      if (!report.is_null()) list.push_back(report);
    std::cout << jsonText(reportJson(list)) << '\n';
  }
  if (!a.quiet && !a.json && !a.jsonLines) {
    out.blank();
    printTable(reports, out);
  }
  if (!a.quiet) printCacheNotes(cacheNotes);
  if (interrupted && !a.quiet)
    warn("interrupted: " + std::to_string(problems.size() - done) + " of " +
         counted(problems.size(), "problem") + " were not solved");
  return interrupted ? interruptedStatus() : status;
}

}  // namespace corridor::app
