#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/problem/digest.h"
#include "planner/problem/keys.h"
#include "planner/problem/problem.h"
#include "planner/solve/solution.h"
#include "planner/solve/solve.h"
#include "planner/solve/whole_file.h"
#include "planner/view/svg_picture.h"

namespace corridor::app {
namespace {

struct SolveArguments {
  std::vector<std::string> problems;
  std::optional<std::string> planner, sampler, stop, edges, simplify;
  std::optional<double> time, resolution;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;  ///< key=value
  std::optional<std::string> output, picture, from;
  bool json = false, quiet = false, noSimplify = false;
};

using nlohmann::ordered_json;

/// Replaces settings of the problem by those of the command line.
/// @returns the keys that were set, each with its option. @throws InputError
std::map<std::string, std::string> applyArguments(const SolveArguments& a, Problem& problem) {
  std::map<std::string, std::string> set;
  if (a.planner && *a.planner != problem.settings.planner.name) {
    problem.settings.planner.name = *a.planner;
    problem.settings.planner.params.clear();  // they belong to the problem's planner
    set["planner.name"] = "--planner";
  }
  if (a.sampler) {
    const auto sampler = choiceNamed<ValidSampler>(*a.sampler);
    if (!sampler)
      throw InputError(Fault{"--sampler", 0, notOneOf(*a.sampler, wordsFor<ValidSampler>())});
    problem.settings.sampler = *sampler;
  }
  for (const std::string& assignment : a.set) {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(Fault{"--set", 0, "key=value is needed, not " + quotedWord(assignment)});
    const std::string key = assignment.substr(0, equals);
    if (set.count("planner.params." + key))
      throw InputError(Fault{"--set", 0, quotedWord(key) + " is set twice"});
    problem.settings.planner.params[key] = assignment.substr(equals + 1);
    set["planner.params." + key] = "--set";
  }
  if (a.time) problem.settings.planner.time = *a.time;
  if (a.stop) problem.settings.planner.stopAtFirst = *a.stop == "first";
  if (a.seed) problem.settings.seed = *a.seed;
  if (a.edges) problem.settings.checker.edges = choiceNamed<EdgeCheck>(*a.edges).value();
  if (const auto wrong = invalidNameIn(problem.settings.checker))
    throw InputError(
        Fault{"--edges", 0, "the problem's checker." + wrong->key + ": " + wrong->text});
  if (a.resolution) {
    if (problem.settings.checker.edges != EdgeCheck::discrete)
      throw InputError(
          Fault{"--resolution", 0,
                "needs --edges discrete, and edges are " + wordOf(problem.settings.checker.edges)});
    problem.settings.checker.resolution = *a.resolution;
  }
  if (a.simplify) problem.settings.simplify = choiceNamed<Simplifier>(*a.simplify).value();
  if (a.noSimplify) problem.settings.simplify = Simplifier::none;
  return set;
}

const char* nameOf(SolveOutcome outcome) {
  switch (outcome) {
    case SolveOutcome::solved:
      return "solved";
    case SolveOutcome::notFound:
      return "not found";
    case SolveOutcome::approximate:
      return "approximate only";
    case SolveOutcome::interrupted:
      return "interrupted";
  }
  return "";
}

/// Returns whether the solution or the picture is written to the standard output. Then no report is
/// printed there.
bool printsFile(const SolveArguments& a) {
  return a.output == "-" || a.picture == "-";
}

struct Solved {
  Problem problem;
  SolveReport report;
  double readingTime = 0;  ///< seconds to read the problem's files
};

/// A phase of `solve`: its key in JSON, its name, and its seconds.
struct Phase {
  const char* key;
  const char* name;
  double seconds;
};

/// Returns the phases in their order. The first one is not part of `SolveReport::time`.
std::vector<Phase> phasesOf(const Solved& solved) {
  const SolveReport& r = solved.report;
  const bool finished = r.outcome == SolveOutcome::solved;
  return {{"read_s", "reading", solved.readingTime},
          {"set_up_s", "set-up", r.setUpTime},
          {"search_s", "search", r.planningTime - r.setUpTime},
          {"simplify_s", "simplification",
           finished ? r.time - r.planningTime - r.certificationTime : 0},
          {"certify_s", "certification", r.certificationTime}};
}

std::string durationText(double seconds) {
  return seconds < 1 ? rounded(1e3 * seconds) + " ms" : rounded(seconds) + " s";
}

void print(const Solved& result, const std::string& problem, const SolveArguments& a) {
  const auto& [p, r, readingTime] = result;
  const bool solved = r.outcome == SolveOutcome::solved;
  if (printsFile(a)) {
    if (!solved) warn(std::string(nameOf(r.outcome)) + ": " + r.why);
    for (const std::string& note : condensed(textsOf(p.source.notes)))
      std::cerr << "note: " << note << '\n';
  }
  const ResultPrinter out(a.quiet || printsFile(a));
  out.line("problem", problem);
  out.line("result", nameOf(r.outcome), solved ? Tone::good : Tone::bad);
  if (!solved) out.line("why", r.why);
  for (const std::string& note : condensed(textsOf(p.source.notes))) out.line("note", note);
  out.line("planner", r.planner);
  out.line("seed", std::to_string(r.seed));
  std::string phases;
  for (const Phase& phase : phasesOf(result))
    phases +=
        (phases.empty() ? "" : ", ") + std::string(phase.name) + " " + durationText(phase.seconds);
  out.line("time", phases);
  if (r.restarts > 0) out.line("restarts of the search", grouped(r.restarts));
  out.line("states checked", grouped(r.counters.states));
  out.line("edges checked", grouped(r.counters.edges));
  out.line("undecided", grouped(r.counters.undecided));
  out.line("box tests N_v", grouped(r.counters.boxTests));
  out.line("triangle tests N_p", grouped(r.counters.triangleTests));
  if (!solved) return;
  out.line("path length", lengthText(p.model.space, r.length.metres, r.length.radians));
  out.line("path states", grouped(r.path.size()));
  out.line("certified", r.certified ? "yes" : "no (" + r.checker + ")",
           r.certified ? Tone::good : Tone::bad);
  if (a.output) out.line("solution", *a.output);
  if (a.picture) out.line("picture", *a.picture);
}

ordered_json jsonOf(const Solved& result, const std::string& problem) {
  const auto& [p, r, readingTime] = result;
  ordered_json phases;
  for (const Phase& phase : phasesOf(result)) phases[phase.key] = phase.seconds;
  ordered_json j = {{"problem", problem},
                    {"result", nameOf(r.outcome)},
                    {"planner", r.planner},
                    {"seed", r.seed},
                    {"restarts", r.restarts},
                    {"repeats", r.repeats},
                    {"time_s", r.time},
                    {"planning_time_s", r.planningTime},
                    {"phases", phases},
                    {"states_checked", r.counters.states},
                    {"edges_checked", r.counters.edges},
                    {"undecided", r.counters.undecided},
                    {"box_tests", r.counters.boxTests},
                    {"triangle_tests", r.counters.triangleTests},
                    {"checker", r.checker},
                    {"certified", r.certified},
                    {"tolerance_m", r.proofOptions.tolerance},
                    {"margin_m", r.proofOptions.margin},
                    {"tube", tubeJson(p.model.space, p.task.tube)}};
  if (!p.source.notes.empty()) j["notes"] = textsOf(p.source.notes);
  if (!r.warnings.empty()) {
    j["warnings"] = ordered_json::array();
    for (const Fault& fault : r.warnings) j["warnings"].push_back(fault.text);
  }
  if (r.outcome == SolveOutcome::solved) {
    ordered_json rows = ordered_json::array();
    for (const Configuration& q : r.path) rows.push_back(numbersJson(q));
    j["numbers"] = p.model.space.numberNames();
    j["path"] = {{"states", r.path.size()},
                 {"length_m", r.length.metres},
                 {"rotation_rad", r.length.radians},
                 {"raw_states", r.rawStates},
                 {"version", r.version},
                 {"rows", rows}};
  } else {
    j["why"] = r.why;
  }
  return j;
}

Solved solveOne(const std::string& file, const SolveArguments& a,
                const std::atomic<bool>& interrupted) {
  const auto before = std::chrono::steady_clock::now();
  Problem problem = readProblemOf(file);
  const std::chrono::duration<double> reading = std::chrono::steady_clock::now() - before;
  // Computed before planning, because the files may change while the planner runs.
  const std::string digest = a.output ? digestOf(problem) : "";
  requireNotAnInput(a.output, "--output", problem.source.files, "the problem");
  requireNotAnInput(a.picture, "--picture", problem.source.files, "the problem");
  SolveOptions options;
  options.valueOrigins = applyArguments(a, problem);
  options.interrupted = &interrupted;
  options.noteStillPairs = true;
  const bool show = !a.quiet && ::isatty(STDERR_FILENO) != 0;
  if (show) {
    options.progress = [&](const SolveProgress& p) {
      std::fprintf(stderr, "\r%s: %s, %.1f of %g s, %s\033[K", problem.source.name.c_str(),
                   problem.settings.planner.name.c_str(), p.seconds, problem.settings.planner.time,
                   counted(p.edges, "edge").c_str());
    };
  }
  std::optional<ViewDirection> from;
  if (a.from) from = viewDirection(*a.from, "--from");
  SolveReport report = solveProblem(problem, options);
  if (show) std::fputs("\r\033[K", stderr);
  for (const Fault& fault : report.warnings) warn(fault.str());
  addFirst(report.notes, problem.source.notes);
  if (report.outcome == SolveOutcome::solved) {
    if (a.output == "-")
      std::cout << solutionText(makeSolution(problem, report, digest));
    else if (a.output)
      writeSolution(makeSolution(problem, report, digest), *a.output);
    if (a.picture == "-")
      std::cout << svgPicture(problem, report.path, from);
    else if (a.picture)
      writeWhole(*a.picture, svgPicture(problem, report.path, from));
  }
  return {std::move(problem), std::move(report), reading.count()};
}

int solveCommand(const SolveArguments& a) {
  if (a.problems.size() > 1 && (a.output || a.picture))
    throw InputError(
        Fault{a.output ? "--output" : "--picture", 0,
              "names one file, but there are " + counted(a.problems.size(), "problem")});
  if (a.from && !a.picture)
    throw InputError(Fault{"--from", 0, "needs --picture, which is not given"});
  if (a.from) viewDirection(*a.from, "--from");
  if (a.output && lowered(std::filesystem::path(*a.output).extension().string()) == ".path")
    throw InputError(Fault{"--output", 0,
                           "solutions are written as YAML, and .path is a format of OMPL: a name "
                           "that ends in .yaml is needed"});
  if (a.output != "-") requireWritable(a.output, "--output");
  if (a.picture && lowered(std::filesystem::path(*a.picture).extension().string()) == ".png")
    throw InputError(Fault{"--picture", 0,
                           "pictures are SVG: a name that ends in .svg is needed; corridor view "
                           "--image draws PNG"});
  if (a.picture != "-") requireWritable(a.picture, "--picture");
  if (a.json && printsFile(a))
    throw InputError(Fault{a.output == "-" ? "--output" : "--picture", 0,
                           "the standard output has the report of --json already; name a file"});
  if (a.output == "-" && a.picture == "-")
    throw InputError(Fault{"--picture", 0, "the standard output has the solution already"});
  const auto whole = [](const std::string& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file));
  };
  if (a.output && a.picture && *a.output != "-" && whole(*a.output) == whole(*a.picture))
    throw InputError(Fault{"--picture", 0, "is the file of --output; name another one"});
  const std::atomic<bool>& interrupted = listenForInterrupts();
  int status = kDone;
  ordered_json results = ordered_json::array();
  for (const std::string& file : a.problems) {
    try {
      const Solved solved = solveOne(file, a, interrupted);
      if (a.json) {
        results.push_back(jsonOf(solved, file));
      } else {
        if (&file != &a.problems.front()) ResultPrinter(a.quiet).blank();
        print(solved, file, a);
      }
      if (solved.report.outcome != SolveOutcome::solved)
        status = std::max(status, int{kNegativeResult});
    } catch (const InputError& error) {
      if (a.problems.size() == 1) throw;
      printFaults(error);  // the other problems are still solved
      if (a.json)
        results.push_back({{"problem", file}, {"result", "bad input"}, {"why", error.what()}});
      status = kBadInput;
    }
    if (interrupted) {
      status = interruptedStatus();
      break;
    }
  }
  if (a.json && !a.quiet)
    std::cout << ordered_json{{"format", "corridor-solve-report-1"}, {"problems", results}}.dump(2)
              << '\n';
  return status;
}

}  // namespace

void addSolve(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<SolveArguments>();  // the callback keeps it
  SolveArguments& a = *arguments;
  CLI::App* command = program.add_subcommand("solve", "Find a path and prove it");
  command
      ->add_option("PROBLEM", a.problems,
                   "a problem.yaml, a folder that contains one, an OMPL.app .cfg file, or "
                   "SET.json#INDEX: one problem of a set of MotionBenchMaker")
      ->required();
  const char* planning = "Planning (replaces settings of the problem)";
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
  const char* checking = "Checking";
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
                   "report)")
      ->group(results);
  command
      ->add_option("--picture", a.picture,
                   "write an SVG of the scene and the path to this file (-: standard output)")
      ->group(results);
  addFrom(*command, a.from, results);
  addJson(*command, a.json, results);
  addQuiet(*command, a.quiet, results);
  command->footer(
      std::string(
          "Example: corridor solve problems/piano -o piano.solution.yaml --picture piano.svg\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = solveCommand(*arguments); });
}

}  // namespace corridor::app
