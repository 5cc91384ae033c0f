#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <iostream>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "collision/core/error.h"
#include "collision/core/floating_point.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/query_batch.h"
#include "planner/app/standard_streams.h"
#include "planner/problem/keys.h"
#include "planner/problem/yaml_reader.h"

namespace {

using namespace corridor::app;
using corridor::VolumeKind;
using corridor::volumeKinds;

constexpr const char* kExitStatus =
    "Exit status: 0 done; 1 no (nothing found, not proved, or not valid); 2 bad input, or a result "
    "can't be written; 3 internal error; 128 + N stopped by signal N (130: Ctrl-C).";

/// Accepts numbers from `low` to `high`; `needed` describes them in the error. (CLI11's own ranges
/// accept NaN, and print 309 digits.)
template <class Number>
CLI::Validator from(Number low, Number high, const std::string& needed) {
  const auto complaint = [=](std::string& text) -> std::string {
    Number value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool isNumber = error == std::errc{} && stop == text.data() + text.size();
    if (isNumber && low <= value && value <= high) return "";
    return needed + " is needed, not " + corridor::quotedWord(text);
  };
  return {complaint, ""};
}

// Validators and options that several commands share.

CLI::Validator isSeconds() {
  return from(std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
              "a number of seconds above 0");
}

CLI::Validator isSeed() {
  return from<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max(),
                             "a whole number from 0 to 2^64 - 1");
}

/// The rule of `checker: {resolution: …}`, in the same words.
CLI::Validator isResolution() {
  return {[](std::string& text) {
            double value = 0;
            return corridor::parseNumber(text, corridor::Range::Resolution, value);
          },
          ""};
}

constexpr const char* kOptions = "Options";  // CLI11's group of options without another group

void addJson(CLI::App& command, bool& json, const char* group = kOptions) {
  command.add_flag("--json", json, "results as JSON")->group(group);
}

void addQuiet(CLI::App& command, bool& quiet, const char* group = kOptions) {
  command.add_flag("--quiet", quiet, "no results on stdout")->group(group);
}

void addIgnoreDigest(CLI::App& command, bool& ignore) {
  command.add_flag(
      "--ignore-digest", ignore,
      "verify the solution even if its digest differs, because the problem's files have "
      "changed since it was made (without this the verdict is: other problem)");
}

void addSolve(CLI::App& program, SolveArguments& a, int& status) {
  CLI::App* command = program.add_subcommand("solve", "Find a path and prove it");
  command
      ->add_option("PROBLEM", a.problems,
                   "problem.yaml, a folder that holds one, an OMPL.app .cfg, or SET.json#INDEX")
      ->required();
  const char* planning = "Planning (replaces settings of the problem)";
  command
      ->add_option("--planner", a.planner, "OMPL's name of the planner; an unknown name lists all")
      ->group(planning);
  command
      ->add_option("--set", a.set,
                   "key=value: sets a parameter of the planner, by OMPL's name; repeatable")
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
      ->check(CLI::IsMember({"first", "time"}))
      ->group(planning);
  command
      ->add_option("--seed", a.seed,
                   "random seed; with most planners the same seed gives the same path")
      ->check(isSeed())
      ->group(planning);
  command
      ->add_flag("--no-simplify", a.noSimplify, "return the planner's path without simplifying it")
      ->group(planning);
  const char* checking = "Checking";
  command
      ->add_option("--edges", a.edges,
                   "how edges are checked: certified (default); adaptive or advancement: proved by "
                   "distances, for comparison; discrete: tested at samples only, as a baseline")
      ->check(CLI::IsMember(corridor::problemChoices().at("checker.edges")))
      ->group(checking);
  command
      ->add_option("--resolution", a.resolution,
                   "with --edges discrete: OMPL's longest_valid_segment_fraction, from 1e-9 to "
                   "below 1")
      ->check(isResolution())
      ->group(checking);
  const char* results = "Results";
  command->add_option("-o,--output", a.output, "write the solution to this file (YAML)")
      ->group(results);
  command->add_option("--picture", a.picture, "write an SVG of the scene and the path to this file")
      ->group(results);
  addJson(*command, a.json, results);
  addQuiet(*command, a.quiet, results);
  command->footer(
      std::string(
          "Example: corridor solve problems/piano -o piano.solution.yaml --picture piano.svg\n") +
      kExitStatus);
  command->callback([&] { status = solveCommand(a); });
}

void addVerify(CLI::App& program, VerifyArguments& a, int& status) {
  CLI::App* command = program.add_subcommand(
      "verify", "Prove or refute a path, independently of the checker that planned it");
  command->add_option("PROBLEM", a.problem, "the problem, as for solve")->required();
  command
      ->add_option("SOLUTION", a.solution,
                   "a solution file, or an OMPL.app .path file with one state per line")
      ->required();
  addIgnoreDigest(*command, a.ignoreDigest);
  addJson(*command, a.json);
  addQuiet(*command, a.quiet);
  command->footer(std::string("Example: corridor verify problems/piano piano.solution.yaml\n") +
                  kExitStatus);
  command->callback([&] { status = verifyCommand(a); });
}

void addView(CLI::App& program, ViewArguments& a, int& status) {
  CLI::App* command = program.add_subcommand(
      "view", "Show a problem and a path in 3D, as a page for any browser or as a picture");
  command->add_option("PROBLEM", a.problem, "the problem, as for solve")->required();
  command->add_option("SOLUTION", a.solution,
                      "a solution file, or an OMPL.app .path file; without it, only start and goal "
                      "are shown");
  addIgnoreDigest(*command, a.ignoreDigest);
  const char* results = "Results";
  command
      ->add_option("-o,--output", a.output,
                   "write the page to this file: HTML that loads no other file (default without "
                   "--image: the problem's name with .html)")
      ->group(results);
  command
      ->add_option("--image", a.image,
                   "write a PNG of the scene, the path's poses and the verdict of verify to this "
                   "file; needs Chromium, but no display")
      ->group(results);
  command
      ->add_option("--size", a.size, "size of the image: WIDTHxHEIGHT, pixels (default 1366x768)")
      ->group(results);
  addQuiet(*command, a.quiet, results);
  command->footer(
      std::string(
          "Example: corridor solve problems/two_arms -o arms.yaml && corridor view "
          "problems/two_arms arms.yaml -o arms.html\n"
          "The page plays the path. It can show the OBB trees, the closest pair of bodies with its "
          "distance along the path, the pairs that are never tested and why, and the contact where "
          "`corridor verify` refutes the path. The path is verified again for the page; the "
          "verdict does not change the exit status.\n") +
      kExitStatus);
  command->callback([&] { status = viewCommand(a); });
}

void addBenchmark(CLI::App& program, BenchmarkArguments& a, int& status) {
  CLI::App* command = program.add_subcommand(
      "benchmark", "Compare checkers and planners: run time, and how many paths are refuted");
  command->add_option("CAMPAIGN|PROBLEM", a.files, "a campaign file, or problems as for solve")
      ->required();
  const char* compared = "Comparison (with problems; a campaign names its own)";
  command
      ->add_option("--variants", a.variants,
                   "comma separated methods of checking edges, each with or without its parameter: "
                   "certified:TOLERANCE (m), adaptive:TOLERANCE, advancement:TOLERANCE, "
                   "discrete:RESOLUTION (OMPL's longest_valid_segment_fraction), fcl:RESOLUTION "
                   "(default: certified,discrete:0.01)")
      ->allow_extra_args(false)
      ->group(compared);
  command
      ->add_option("--planners", a.planners,
                   "comma separated, by OMPL's names (default: each problem's own planner)")
      ->allow_extra_args(false)
      ->group(compared);
  const char* runs = "Runs (replaces settings of the campaign or the problems)";
  command
      ->add_option("--runs", a.runs,
                   "runs of each combination of problem, variant and planner (default 10); all "
                   "combinations use the same seeds")
      ->check(from<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000"))
      ->group(runs);
  command
      ->add_option("--seed", a.seed, "seed of the first run; each further run adds 1 (default 1)")
      ->check(from<std::uint64_t>(1, std::numeric_limits<std::uint32_t>::max(),
                                  "a whole number from 1 to 2^32 - 1"))
      ->group(runs);
  command->add_option("--time", a.time, "time limit of a run, seconds")
      ->check(isSeconds())
      ->group(runs);
  command->add_option("--memory", a.memory, "memory limit of a run, MB (default 4096)")
      ->check(from(1.0, 1e9, "a number of MB from 1 to 1e9"))
      ->group(runs);
  command
      ->add_option("--jobs", a.jobs,
                   "number of runs at the same time (default 1); more than 1 makes measured times "
                   "longer")
      ->check(from<std::uint64_t>(1, 1024, "a whole number from 1 to 1024"))
      ->group(runs);
  const char* results = "Results";
  command
      ->add_option(
          "-o,--output", a.output,
          "write to this folder: report.html with its plots, campaign.db (SQLite), runs.csv, "
          "summary.csv and the logs of OMPL's Benchmark")
      ->group(results);
  command->add_flag("--resume", a.resume, "continue the campaign in the folder where it stopped")
      ->group(results);
  addJson(*command, a.json, results);
  command->footer(
      std::string(
          "Example: corridor benchmark problems/campaigns/error.yaml -o results --jobs 2\n"
          "Or without a file: corridor benchmark problems/thin_plate problems/piano --variants "
          "certified,discrete:0.01,discrete:0.001 -o results\n"
          "Each run is a separate process, under OMPL's Benchmark. The independent verifier tests "
          "each path: `refuted` counts those that collide, or violate the problem's margin, "
          "bounds, start or goal. Times and counts are medians over the solved runs.\n"
          "Columns: *_s in seconds (time_s: all except reading files; time_p95_s: its 95 % "
          "quantile; processor_s: of all threads), length_m in metres, rotation_rad in radians, "
          "checking_share: checking's share of time_s. All columns, and the keys of campaigns: "
          "planner/benchmark/README.md.\n") +
      kExitStatus);
  command->callback([&] { status = benchmarkCommand(a); });
}

void addCheck(CLI::App& program, CheckArguments& a, int& status) {
  CLI::App* command =
      program.add_subcommand("check", "Check a problem, or many states of it, without planning");
  command->add_option("PROBLEM", a.problem, "the problem, as for solve")->required();
  command->add_option("--states", a.states,
                      "a file of states (-: standard input), one per line, numbers blank or comma "
                      "separated, # starts a comment; prints a line state,valid,pairs for each");
  addJson(*command, a.json);
  command->footer(
      std::string(
          "Example: corridor check problems/arm_at_shelf --states states.txt > valid.csv\n"
          "The numbers of a state are the values of the problem's joints, in the order that "
          "`corridor inspect` prints.\n") +
      kExitStatus);
  command->callback([&] { status = checkCommand(a); });
}

void addInspect(CLI::App& program, InspectArguments& a, int& status) {
  CLI::App* command = program.add_subcommand(
      "inspect", "Report on a mesh, a robot or a problem, and on pairs that are never tested");
  command
      ->add_option("FILE", a.file,
                   "a mesh file, a URDF or robot.yaml, a problem, or a folder that holds a problem "
                   "or a robot")
      ->required();
  command->add_option("--unit", a.unit, "for a mesh file: its unit, m, cm, mm or in")
      ->check(CLI::IsMember({"m", "cm", "mm", "in"}));
  command->add_option("--up", a.up, "for a mesh file: its up-axis, which is turned to z")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command->add_flag(
      "--self-intersections", a.selfIntersections,
      "for a mesh file: count the pairs of its triangles that intersect, except in the "
      "corners and edges that they share (seconds for a million triangles; each pair "
      "of coincident triangles counts)");
  command->add_flag("--pairs", a.pairs,
                    "for a problem: list every pair of bodies, and why it is not tested");
  const char* cost = "Cost of queries of two meshes";
  command
      ->add_option(
          "--against", a.against,
          "a second mesh file; reports, for every bounding volume, the tests of an interference "
          "query (N_v, N_p), the cost of a test (C_v, C_p), and how well "
          "T = N_v C_v + N_p C_p predicts the time")
      ->group(cost);
  command
      ->add_option("--poses", a.poses,
                   "with --against: poses of the second mesh, as for corridor query (default: a "
                   "grid over the bounds of both)")
      ->group(cost);
  addJson(*command, a.json);
  command->footer(
      std::string("Example: corridor inspect robots/piano/piano.obj\n"
                  "         corridor inspect a.obj --against b.obj --poses poses.txt\n") +
      kExitStatus);
  command->callback([&] { status = inspectCommand(a); });
}

void addQuery(CLI::App& program, QueryArguments& a, int& status) {
  CLI::App* command = program.add_subcommand(
      "query",
      "Query two meshes at many poses, or along many motions: CSV on stdout, times on stderr");
  command->add_option("A", a.meshA, "a mesh file, in metres; it does not move")->required();
  command->add_option("B", a.meshB, "a mesh file, in metres; it takes the poses")->required();
  const char* poses = "Poses of B";
  command
      ->add_option("--poses", a.poses,
                   "a file of poses (-: standard input), one per line: r00 r01 r02 r10 r11 r12 r20 "
                   "r21 r22 tx ty tz; a point b of B is at R b + t; # starts a comment")
      ->group(poses);
  command
      ->add_option("--grid", a.grid,
                   "NXxNYxNZ: put the centre of B's bounds on every point of a lattice, x changing "
                   "first")
      ->group(poses);
  command
      ->add_option("--lower", a.lower,
                   "x,y,z in metres: the lattice's first point (default: A's bounds grown by half "
                   "the diagonal of B's)")
      ->group(poses);
  command->add_option("--upper", a.upper, "x,y,z in metres: the lattice's last point")
      ->group(poses);
  command
      ->add_option("--rotations", a.rotations,
                   "repeat the lattice this many times, each with B in another random orientation; "
                   "the first is the identity (default 1)")
      ->check(from<std::uint64_t>(1, 10'000'000, "a whole number from 1 to 10000000"))
      ->group(poses);
  command->add_option("--seed", a.seed, "random seed of the orientations (default 1)")
      ->check(isSeed())
      ->group(poses);
  command
      ->add_option("--save-poses", a.savePoses,
                   "write the grid's poses to this file, as --poses reads them")
      ->group(poses);
  command
      ->add_option("--motions", a.motions,
                   "instead of poses: a file of B's motions (-: standard input), one per line: the "
                   "first and the last pose, 12 numbers each, as for --poses. B moves straight and "
                   "rotates the shorter way (slerp; a half turn is undecided). Reports the first "
                   "contact of each motion")
      ->group("Motions of B");
  command
      ->add_option("--edges", a.edges,
                   "the method that proves motions; the first is the default: " +
                       corridor::joined(corridor::edgeMethodNames()))
      ->group("Motions of B");
  const char* asked = "Query (motions take all of these except --query)";
  const auto named = [](const auto& kinds) {
    std::vector<std::string> names;
    for (const auto& kind : kinds) names.push_back(kind.name);
    return corridor::joined(names);
  };
  const auto variants = [](std::vector<std::string> VolumeKind::*of) {
    std::string text = "the first is the default";
    for (const VolumeKind& kind : volumeKinds())
      text += "; with " + kind.name + ": " + corridor::joined(kind.*of);
    return text;
  };
  command
      ->add_option("--query", a.query,
                   "the query; the first is the default: " + named(queryKinds()))
      ->group(asked);
  command
      ->add_option("--volume", a.volume,
                   "the bounding volume; the first is the default: " + named(volumeKinds()))
      ->group(asked);
  command->add_option("--fit", a.fit, "what volumes are fitted to; " + variants(&VolumeKind::fits))
      ->group(asked);
  command
      ->add_option("--overlap", a.overlap,
                   "the overlap test of two volumes, for queries that use one; " +
                       variants(&VolumeKind::overlaps))
      ->group(asked);
  command
      ->add_option(
          "--tolerance", a.tolerance,
          "metres. With --query tolerance: report whether A and B are at most this far apart. With "
          "--motions: above 0; a clearance below twice this may be undecided (default: 1e-7 of the "
          "smaller one's radius, or what the rounding of poses needs if that is more)")
      ->check(from(0.0, std::numeric_limits<double>::max(), "a number of metres, 0 or more,"))
      ->group(asked);
  command
      ->add_option("--repeat", a.repeat,
                   "number of passes over all poses or motions; the time of each is the median of "
                   "its passes (default 1)")
      ->check(from<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000"))
      ->group(asked);
  command->footer(
      std::string(
          "Example: corridor query a.obj b.obj --poses poses.txt --repeat 5 > hits.csv\n"
          "         corridor query a.obj b.obj --grid 20x20x20 --rotations 10 --query contacts\n"
          "         corridor query a.obj b.obj --motions motions.txt > first_contacts.csv\n"
          "CSV on stdout; poses, motions and triangles count from 0:\n"
          "  interference: pose,hit,bv_tests,triangle_tests\n"
          "  contacts: pose,a,b,px,py,pz,qx,qy,qz, a line per pair of triangles with the segment "
          "that they share\n"
          "  distance: pose,distance,ax,ay,az,bx,by,bz, with a closest point of each mesh\n"
          "  tolerance: pose,closer\n"
          "  motions: motion,verdict,t0,t1,gap,triangle_a,triangle_b,bv_tests,triangle_tests,"
          "splits\n"
          "Verdicts of motions: free; contact: none before t0, one at t1, at most 1/1024 of the "
          "motion later unless the meshes graze; undecided: no contact before t0, and at t1 the "
          "two triangles are gap metres apart. t is 0 at the start of a motion and 1 at its end; "
          "-1 means none.\n"
          "Touching is contact; meshes are surfaces. Times are those of one query on one core, "
          "without reading and printing. A query shorter than 5 µs is repeated, and the mean "
          "counts.\n") +
      kExitStatus);
  command->callback([&] { status = queryCommand(a); });
}

/// Refuses empty names and values. They come from unset shell variables, and a later message could
/// not name them.
void refuseEmptyValues(CLI::App& program) {
  for (CLI::App* command : program.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0)
        option->check(CLI::Validator(
            [](std::string& text) { return text.empty() ? std::string("is empty") : ""; }, ""));
}

/// Returns which word or option a command does not take, with the nearest name, or "". (CLI11's own
/// message lists the words in reverse, and suggests nothing.) Words before the command, or after a
/// --, are among `program.remaining()`.
std::string unknownWord(const CLI::App& program, const CLI::App& command) {
  std::vector<std::string> words = command.remaining();
  if (words.empty()) words = program.remaining();
  if (words.empty()) return "";
  const auto option = std::find_if(words.begin(), words.end(),
                                   [](const std::string& word) { return word.starts_with('-'); });
  if (option == words.end()) return "unexpected word " + corridor::quotedWord(words.back());
  const std::string name = option->substr(0, option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : command.get_options())
    for (const std::string& longName : known->get_lnames()) names.push_back("--" + longName);
  return "unknown option " + corridor::quotedWord(name) + corridor::didYouMean(name, names);
}

/// Returns which option is given more often than the command takes it, or "".
std::string repeatedOption(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_items_expected_max() == 1 && option->count() > 1)
      return option->get_name() + " is given " + std::to_string(option->count()) +
             " times; once is enough";
  return "";
}

/// Returns what is wrong with the command line, in one line.
std::string usageFault(const CLI::App& program, const CLI::ParseError& error,
                       const std::string& firstWord) {
  const auto given = program.get_subcommands();
  if (!given.empty()) {
    std::string fault;
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) fault = unknownWord(program, *given[0]);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) fault = repeatedOption(*given[0]);
    if (fault.empty()) fault = error.what();
    return fault + "; see corridor " + given[0]->get_name() + " --help";
  }
  if (firstWord.empty() || firstWord[0] == '-')
    return error.what() + std::string("; see corridor --help");
  const std::vector<std::string> commands{"solve", "verify",  "view", "benchmark",
                                          "check", "inspect", "query"};
  return "unknown command " + corridor::quotedWord(firstWord) +
         corridor::didYouMean(firstWord, commands) + "; there are: " + corridor::joined(commands);
}

}  // namespace

int main(int argc, char** argv) {
  openStandardStreams();
  // Without this, SIGXFSZ ends the program where a file reaches its size limit (ulimit -f). With
  // it, writing fails, and is reported as for a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  if (const auto arithmetic = corridor::floatingPoint();
      arithmetic != corridor::FloatingPoint::standard) {
    std::cerr << "corridor: nothing can be proved with these floating-point settings: "
              << corridor::described(arithmetic)
              << "; remove the library or wrapper that sets them when the program is loaded\n";
    return kInternal;
  }
  CLI::App program("Corridor plans collision-free motions and proves each one.", "corridor");
  program.set_version_flag("--version", CORRIDOR_VERSION);
  program.require_subcommand(1);
  program.footer(std::string("corridor COMMAND --help lists a command's options.\n") + kExitStatus);
  int status = kDone;
  SolveArguments solve;
  VerifyArguments verify;
  ViewArguments view;
  BenchmarkArguments benchmark;
  CheckArguments check;
  InspectArguments inspect;
  QueryArguments query;
  addSolve(program, solve, status);
  addVerify(program, verify, status);
  addView(program, view, status);
  addBenchmark(program, benchmark, status);
  addCheck(program, check, status);
  addInspect(program, inspect, status);
  addQuery(program, query, status);
  refuseEmptyValues(program);
  try {
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() != 0) {
        std::cerr << usageFault(program, error, argc > 1 ? argv[1] : "") << '\n';
        return kBadInput;
      }
      program.exit(error);  // --help, --version
    }
    requireResultsWritten();
  } catch (const corridor::InputError& error) {
    std::cerr << error.what() << '\n';
    return kBadInput;
  } catch (const std::bad_alloc&) {
    std::cerr << "corridor: out of memory: too many bodies, pairs of bodies or triangles, or too "
                 "large a parameter\n";
    return kInternal;
  } catch (const std::exception& error) {
    std::cerr << "corridor: internal error: " << error.what() << '\n';
    return kInternal;
  }
  return status;
}
