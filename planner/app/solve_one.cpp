#include "planner/app/solve_one.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <unistd.h>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/core/whole_file.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/problem/digest.h"
#include "planner/problem/user_cache.h"
#include "planner/solve/keep_clearance.h"
#include "planner/solve/solution.h"
#include "planner/trajectory/trajectory_text.h"
#include "planner/view/path_picture.h"

namespace corridor::app {
namespace {

bool isPng(const std::string& file) {
  return lowered(std::filesystem::path(file).extension().string()) == ".png";
}

/// Returns whether solution `a` is better than solution `b`.
bool isBetter(const ConfigurationSpace& space, const SolveReport& a, const SolveReport& b,
              bool clearest) {
  if (clearest && a.clearance && b.clearance) {
    if (a.clearance->proved != b.clearance->proved)
      return a.clearance->proved > b.clearance->proved;
    if (a.clearance->shareOnTarget != b.clearance->shareOnTarget)
      return a.clearance->shareOnTarget > b.clearance->shareOnTarget;
  }
  return distanceAlong(space, a.path) < distanceAlong(space, b.path);
}

/// Solves the problem as often as the arguments say, each time with another seed. Returns the
/// report with the best solution. If there is no solution, returns the report on the first try, or
/// on the try that was interrupted. An interrupt ends the tries. Sets the problem's seed to that of
/// the returned report.
/// @param tries gets the number of tries. An interrupted try is not counted, unless it is the
/// first.
SolveReport bestOf(const SolveArguments& a, Problem& problem, const SolveOptions& options,
                   std::uint64_t& tries) {
  SolveReport best = solveProblem(problem, options);
  // OMPL takes a seed of 0 as 1.
  const std::uint64_t first = std::max<std::uint64_t>(problem.settings.seed, 1);
  for (tries = 1; tries < a.tries && best.outcome != SolveOutcome::interrupted; ++tries) {
    problem.settings.seed = first + tries;  // wraps around beyond 2^64 - 1
    SolveReport report = solveProblem(problem, options);
    if (report.outcome == SolveOutcome::interrupted) {
      if (best.outcome != SolveOutcome::solved) best = std::move(report);
      break;
    }
    if (report.outcome == SolveOutcome::solved &&
        (best.outcome != SolveOutcome::solved ||
         isBetter(problem.model.space, report, best, a.keep == "clearest")))
      best = std::move(report);
  }
  problem.settings.seed = best.seed;
  if (a.tries > 1 && best.outcome == SolveOutcome::solved && !best.repeatable)
    best.notes.push_back(
        {"the planner does not repeat, or its time ran out: the seed of the path "
         "that is kept may give another path",
         NoteWeight::motion});
  return best;
}

/// Tests what can be tested before planning. @throws InputError if the arguments name an input file
/// as an output file, a trajectory file that can't hold the trajectory, or a choice of paths that
/// the problem can't make. Call this with the problem that `applyArguments` has changed.
void requirePossible(const SolveArguments& a, const Problem& problem) {
  requireNotAnInput(a.output, "--output", problem.source.files, "the problem");
  requireNotAnInput(a.picture, "--picture", problem.source.files, "the problem");
  requireNotAnInput(a.trajectory, "--trajectory", problem.source.files, "the problem");
  if (a.trajectory && trajectoryKindOf(*a.trajectory) == TrajectoryFileKind::message &&
      hasRotation(problem.model.space))
    throw InputError(Fault{"--trajectory", 0,
                           "a JointTrajectory can't hold the rotation of a floating base; a name "
                           "that ends in .csv is needed"});
  if (a.trajectory && trajectoryKindOf(*a.trajectory) == TrajectoryFileKind::csv)
    for (const std::string& name : problem.model.space.numberNames())
      if (name.find_first_of("\r\n") != name.npos)
        throw InputError(Fault{"--trajectory", 0,
                               "the name of joint " + quotedWord(name) +
                                   " has a line end, which CSV can't hold; a name that ends in "
                                   ".yaml is needed"});
  if (a.keep == "clearest" && preferredClearance(problem) == 0)
    throw InputError(
        Fault{"--keep", 0,
              "the clearest path needs a preferred clearance" +
                  std::string(problem.task.margin > 0
                                  ? ", which can't be used with a margin: --margin 0 --clearance " +
                                        shortest(problem.task.margin) + " replaces it"
                                  : ", such as --clearance 0.005")});
}

/// Returns the function that shows the progress of the search on the terminal.
auto progressOn(const Problem& problem) {
  return [&problem](const SolveProgress& p) {
    std::fprintf(stderr, "\r%s: %s, %.1f of %g s, %s\033[K", problem.source.name.c_str(),
                 problem.settings.planner.name.c_str(), p.seconds, problem.settings.planner.time,
                 counted(p.edges, "edge").c_str());
  };
}

/// Writes the files that the arguments name. The problem is solved.
void writeFiles(const SolveArguments& a, const Problem& problem, const SolveReport& report,
                const std::string& digest, const std::optional<ViewDirection>& from) {
  if (a.output == "-")
    std::cout << solutionText(makeSolution(problem, report, digest));
  else if (a.output)
    writeSolution(makeSolution(problem, report, digest), *a.output);
  std::optional<double> seconds;
  if (report.trajectory && report.trajectory->proved()) {
    writeWhole(*a.trajectory, report.trajectory->text);
    seconds = report.trajectory->duration;
  }
  if (a.picture == "-")
    std::cout << svgPicture(problem, report.path, from, seconds);
  else if (a.picture)
    writeWhole(*a.picture, isPng(*a.picture) ? pngPicture(problem, report.path, from)
                                             : svgPicture(problem, report.path, from, seconds));
}

}  // namespace

TrajectoryFileKind trajectoryKindOf(const std::string& file) {
  const std::string extension = lowered(std::filesystem::path(file).extension().string());
  if (extension == ".csv") return TrajectoryFileKind::csv;
  if (extension == ".yaml" || extension == ".yml") return TrajectoryFileKind::message;
  throw InputError(Fault{"--trajectory", 0, "a name that ends in .csv or .yaml is needed"});
}

Solved solveOne(const std::string& file, const SolveArguments& a,
                const std::atomic<bool>& interrupted, const std::function<void()>& beforeWriting) {
  const auto before = std::chrono::steady_clock::now();
  Problem problem = readProblemOf(file, userCache());
  const std::chrono::duration<double> reading = std::chrono::steady_clock::now() - before;
  // Computed before planning, because the files may change while the planner runs.
  const std::string digest = a.output ? digestOf(problem) : "";
  SolveOptions options;
  options.valueOrigins = applyArguments(a, problem);
  requirePossible(a, problem);
  options.interrupted = &interrupted;
  options.noteLeftOut = true;
  if (a.trajectory) options.trajectory = trajectoryKindOf(*a.trajectory);
  const bool show = !a.quiet && ::isatty(STDERR_FILENO) != 0;
  if (show) options.progress = progressOn(problem);
  std::optional<ViewDirection> from;
  if (a.from) from = viewDirection(*a.from, "--from");
  std::uint64_t tries = 1;
  SolveReport report = bestOf(a, problem, options, tries);
  if (show) std::fputs("\r\033[K", stderr);
  for (const Fault& fault : report.warnings) warn(fault.str());
  addFirst(report.notes, problem.source.notes);
  if (beforeWriting) beforeWriting();
  if (report.outcome == SolveOutcome::solved) writeFiles(a, problem, report, digest, from);
  return {std::move(problem), std::move(report), reading.count(), tries};
}

}  // namespace corridor::app
