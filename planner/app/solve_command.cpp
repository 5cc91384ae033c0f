#include <algorithm>
#include <atomic>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/app/problem_list.h"
#include "planner/app/rank_job.h"
#include "planner/app/solve_many.h"
#include "planner/app/solve_one.h"
#include "planner/problem/keys.h"
#include "planner/view/path_picture.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

/// Solves one problem, and prints the report on it. @returns the exit status.
int solveSingle(const std::string& file, const SolveArguments& a,
                const std::atomic<bool>& interrupted) {
  Solved solved = solveOne(file, a, interrupted);
  if (const auto& cache = solved.problem.model.cache)
    for (const std::string& note : cache->takeNotes())
      solved.problem.source.notes.push_back({note, NoteWeight::detail});
  if (a.jsonLines && !a.quiet)
    std::cout << jsonText(jsonOf(solved, file), -1) << '\n';
  else if (a.json && !a.quiet)
    std::cout << jsonText(reportJson(ordered_json::array({jsonOf(solved, file)}))) << '\n';
  else if (!a.json && !a.jsonLines)
    print(solved, file, a);
  saveCache(solved.problem.model.cache.get(), a.quiet);
  if (interrupted) return interruptedStatus();
  const bool done = solved.report.outcome == SolveOutcome::solved &&
                    (!solved.report.trajectory || solved.report.trajectory->proved());
  return done ? kDone : kNegativeResult;
}

/// Returns the names of all problems. Ranks compare them, to test that all have the same problems.
std::string namesOf(const ProblemList& list) {
  std::string all;
  for (const ListedProblem& problem : list.problems)
    all += problem.name + ' ' + problem.file + '\n';
  return all;
}

/// @throws InputError if an option for trajectories is given without --trajectory.
void requireTrajectory(const SolveArguments& a) {
  const auto need = [&](const auto& value, const char* option) {
    if (value && !a.trajectory)
      throw InputError(Fault{option, 0, "needs --trajectory, which is not given"});
  };
  need(a.smooth, "--smooth");
  need(a.rate, "--rate");
  need(a.deviation, "--deviation");
  need(a.cornerDeviation, "--corner-deviation");
}

/// @throws InputError if an output file for a single problem can't be written, is of the wrong
/// kind, or is named twice.
void requireFiles(const SolveArguments& a) {
  const auto requireExtension = [](const char* option, const std::optional<std::string>& file,
                                   std::initializer_list<std::string_view> known,
                                   const std::string& advice) {
    const std::string extension =
        file ? lowered(std::filesystem::path(*file).extension().string()) : "";
    if (!extension.empty() && std::find(known.begin(), known.end(), extension) == known.end())
      throw InputError(Fault{option, 0, *file + ": " + advice});
  };
  requireExtension("--output", a.output, {".yaml", ".yml"},
                   "solutions are written as YAML, so a name that ends in .yaml is needed; "
                   "--trajectory writes CSV");
  requireExtension("--picture", a.picture, {".svg", ".png"},
                   "pictures are SVG or PNG, so a name that ends in .svg or .png is needed");
  if (a.output != "-") requireWritable(a.output, "--output");
  if (a.picture != "-") requireWritable(a.picture, "--picture");
  if (a.trajectory) {
    trajectoryKindOf(*a.trajectory);
    requireWritable(a.trajectory, "--trajectory");
  }
  if ((a.json || a.jsonLines) && printsFile(a))
    throw InputError(Fault{a.output == "-" ? "--output" : "--picture", 0,
                           "the standard output has the report of --json already; name a file"});
  if (a.output == "-" && a.picture == "-")
    throw InputError(Fault{"--picture", 0, "the standard output has the solution already"});
  std::map<std::filesystem::path, std::string> files;  // their options
  for (const auto& [option, file] :
       {std::pair("--output", &a.output), std::pair("--picture", &a.picture),
        std::pair("--trajectory", &a.trajectory)}) {
    if (!*file || **file == "-") continue;
    std::error_code failure;  // for links to pipes, such as /dev/stdout
    const auto place =
        std::filesystem::weakly_canonical(std::filesystem::absolute(**file), failure);
    const auto [other, isNew] = files.try_emplace(failure ? **file : place.string(), option);
    if (!isNew)
      throw InputError(Fault{option, 0, "is the file of " + other->second + "; name another one"});
  }
}

/// Solves the problems that rank 0 hands out to this rank. @returns the exit status.
int serveProblems(const SolveArguments& a, RankJob& job) {
  ProblemList list;
  return job.serve([&](const std::string& names) {
    list = listProblems(a.problems);
    if (namesOf(list) != names)
      throw std::runtime_error(
          "its problems are not the first rank's; all machines need the same files");
    return std::make_unique<LocalExecutor>(a.jobs, solveStarter(list.problems, a),
                                           Killable::untilItSends);
  });
}

int solveCommand(const SolveArguments& a) {
  RankJob job(a.jobs);  // also without MPI: it listens for Ctrl-C
  if (job.serves()) return serveProblems(a, job);
  if (a.from && !a.picture)
    throw InputError(Fault{"--from", 0, "needs --picture, which is not given"});
  if (a.from) viewDirection(*a.from, "--from");
  if (a.keep == "clearest" && a.tries == 1)
    throw InputError(Fault{"--keep", 0, "needs --tries, which is not given"});
  const ProblemList list = listProblems(a.problems);
  requireTrajectory(a);
  if (list.several) {
    LocalExecutor local(a.jobs, solveStarter(list.problems, a), Killable::untilItSends);
    const std::atomic<bool>& interrupted = job.listen();
    if (job.executor()) job.executor()->begin(namesOf(list), interrupted);
    Executor& executor = job.executor() ? static_cast<Executor&>(*job.executor()) : local;
    return solveMany(list.problems, a, executor, interrupted);
  }
  requireFiles(a);
  return solveSingle(list.problems.front().file, a, job.listen());
}

}  // namespace

void addSolve(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<SolveArguments>();  // the callback keeps it
  SolveArguments& a = *arguments;
  CLI::App* command = program.add_subcommand("solve", "Find a path and prove it");
  command
      ->add_option("PROBLEM", a.problems,
                   "a problem.yaml, a folder that contains one, an OMPL.app .cfg file, or "
                   "SET.json#INDEX: one problem of a set of MotionBenchMaker; several problems: "
                   "SET.json#1-50, or a folder of folders with problems")
      ->required();
  const char* planning = "Planning (these options replace settings of the problem)";
  command
      ->add_option("--planner", a.planner,
                   "OMPL's name of the planner; the error for an unknown name lists all names")
      ->group(planning);
  command
      ->add_option("--set", a.set,
                   "key=value: set a parameter of the planner, by OMPL's name; may be repeated")
      ->group(planning)
      ->allow_extra_args(false);
  command
      ->add_option("--sampler", a.sampler,
                   "sampler of valid states: uniform, gaussian, obstacle_based, bridge_test or "
                   "max_clearance")
      ->group(planning);
  command->add_option("--time", a.time, "time limit, seconds")->check(isSeconds())->group(planning);
  command
      ->add_option("--stop", a.stop,
                   "first: stop at the first solution; time: use all the time (default: time for "
                   "planners that optimise, first for all others)")
      ->check(isOneOf({"first", "time"}))
      ->group(planning);
  command
      ->add_option("--seed", a.seed,
                   "random seed; with most planners the same seed gives the same path")
      ->check(isSeed())
      ->group(planning);
  CLI::Option* const simplify =
      command
          ->add_option("--simplify", a.simplify,
                       "how the path is shortened: true (default), false, or ompl: by OMPL's "
                       "simplifier, for comparison")
          ->check(isOneOf(wordsFor<Simplifier>()))
          ->group(planning);
  command->add_flag("--no-simplify", a.noSimplify, "the same as --simplify false")
      ->excludes(simplify)
      ->group(planning);
  const char* many = "Several problems, several tries";
  command
      ->add_option("--jobs", a.jobs,
                   "problems solved at a time, by as many processes (default 1); under mpirun, "
                   "this many on each rank except the first")
      ->check(isWithin<std::uint64_t>(1, 1024, "a whole number from 1 to 1024"))
      ->group(many);
  command
      ->add_option(
          "--tries", a.tries,
          "solve each problem this many times and keep the best path (default 1); the seeds "
          "are S, S + 1, …, where S is --seed or the problem's seed")
      ->check(isWithin<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000"))
      ->group(many);
  command
      ->add_option("--keep", a.keep,
                   "with --tries: keep the shortest path in the planner's distance (default), or "
                   "the clearest: the one with "
                   "the largest proved clearance")
      ->check(isOneOf({"shortest", "clearest"}))
      ->group(many);
  const char* checking = "Checking";
  command
      ->add_option("--margin", a.margin,
                   "metres that all tested pairs must keep apart, in place of the problem's margin")
      ->check(isMetres())
      ->group(checking);
  command
      ->add_option(
          "--clearance", a.clearance,
          "metres that the pairs should keep apart where the path can, in place of the "
          "problem's prefer.clearance (default: 0.005 for robots with joints and no margin, "
          "otherwise 0)")
      ->check(isMetres())
      ->group(checking);
  command
      ->add_option("--edges", a.edges,
                   "how edges are checked: certified (default); adaptive or advancement: proved by "
                   "distances, for comparison; discrete: tested at samples only, as a baseline")
      ->check(isOneOf(problemChoices().at("checker.edges")))
      ->group(checking);
  command
      ->add_option("--resolution", a.resolution,
                   "with --edges discrete: OMPL's longest_valid_segment_fraction, from 1e-9 to "
                   "below 1")
      ->check(isResolution())
      ->group(checking);
  const char* results = "Results";
  command
      ->add_option("-o,--output", a.output,
                   "write the solution to this file (YAML; -: standard output, without the "
                   "report); for several problems, the solutions to this folder")
      ->group(results);
  command
      ->add_option("--picture", a.picture,
                   "write a picture of the scene and the path to this file: .svg, or .png without "
                   "a caption (-: SVG to standard output); for several problems, SVGs to this "
                   "folder")
      ->group(results);
  addFrom(*command, a.from, results);
  const char* motion = "Trajectory";
  command
      ->add_option("--trajectory", a.trajectory,
                   "make a trajectory along the path, prove it, and write it to this file: .csv "
                   "(rows of numbers) or .yaml (a JointTrajectory of ROS 2); it keeps the "
                   "problem's limits; for several problems, .csv files to this folder")
      ->group(motion);
  command
      ->add_option("--smooth", a.smooth,
                   "how the path becomes a curve: none (a stop at each corner), corners (only "
                   "these are rounded), or as a whole with the least time (default), length or "
                   "acceleration")
      ->check(isOneOf(wordsFor<Smoothing>()))
      ->group(motion);
  command
      ->add_option("--rate", a.rate,
                   "rows per second (default: rows where the time law needs them)")
      ->check(isWithin(TrajectorySettings::kRates))
      ->group(motion);
  command
      ->add_option("--deviation", a.deviation,
                   "the largest distance of the file's curve from the smoothed path, rad or m "
                   "(default 1e-4)")
      ->check(isWithin(TrajectorySettings::kDeviations))
      ->group(motion);
  command
      ->add_option(
          "--corner-deviation", a.cornerDeviation,
          "the largest distance of the curve from the path, rad or m; then only the corners "
          "are rounded (default: as far as the curve can be proved)")
      ->check(isWithin(TrajectorySettings::kCornerDeviations))
      ->group(motion);
  CLI::Option* const json = command->add_flag("--json", a.json, "print one JSON object");
  json->group(results);
  command
      ->add_flag("--json-lines", a.jsonLines,
                 "print a JSON object on a line of its own for each problem, as it is done")
      ->excludes(json)
      ->group(results);
  addQuiet(*command, a.quiet, results);
  command->footer(
      std::string(
          "Example: corridor solve problems/piano -o piano.solution.yaml --picture piano.svg\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = solveCommand(*arguments); });
}

}  // namespace corridor::app
