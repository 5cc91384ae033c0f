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
#include "collision/core/nearest.h"
#include "planner/app/commands.h"
#include "planner/app/query_batch.h"
#include "planner/app/standard_streams.h"
#include "planner/problem/keys.h"

namespace {

using namespace corridor::app;
using corridor::VolumeKind;
using corridor::volumeKinds;

constexpr const char* kExitStatus =
    "Exit status: 0 done; 1 no (nothing found, not proved, or not valid); 2 bad input, or a result "
    "can't be written; 3 internal error; 128 + N stopped by signal N (130: Ctrl-C).";

/// An option's value from `low` to `high`; `needed` says so. (CLI11's own ranges take NaN, and
/// print 309 digits.)
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

// What several commands take.

CLI::Validator isSeconds() {
  return from(std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
              "a number of seconds above 0");
}

CLI::Validator isSeed() {
  return from<std::uint64_t>(0, std::numeric_limits<std::uint64_t>::max(),
                             "a whole number from 0 to 2^64 - 1");
}

constexpr const char* kOptions = "Options";  // CLI11's group of those that are in no other

void addJson(CLI::App& command, bool& json, const char* group = kOptions) {
  command.add_flag("--json", json, "results as JSON")->group(group);
}

void addQuiet(CLI::App& command, bool& quiet, const char* group = kOptions) {
  command.add_flag("--quiet", quiet, "no results on stdout")->group(group);
}

void addIgnoreDigest(CLI::App& command, bool& ignore) {
  command.add_flag("--ignore-digest", ignore,
                   "verify a solution although the problem's files have changed since it was made "
                   "(its digest differs; else the verdict is: other problem)");
}

void addSolve(CLI::App& program, SolveArguments& a, int& status) {
  CLI::App* command = program.add_subcommand("solve", "Find a path and prove it");
  command
      ->add_option("PROBLEM", a.problems,
                   "problem.yaml, a folder that holds one, an OMPL.app .cfg, or SET.json#INDEX")
      ->required();
  const char* planning = "Planning (over what the problem says)";
  command->add_option("--planner", a.planner, "by OMPL's name; a wrong one lists them all")
      ->group(planning);
  command->add_option("--set", a.set, "key=value: a parameter of the planner, by OMPL's name")
      ->group(planning)
      ->allow_extra_args(false);
  command
      ->add_option("--sampler", a.sampler,
                   "uniform, gaussian, obstacle_based, bridge_test or max_clearance")
      ->group(planning);
  command->add_option("--time", a.time, "seconds")->check(isSeconds())->group(planning);
  command
      ->add_option("--stop", a.stop,
                   "first: at the first solution; time: planners that optimise use all of it "
                   "(their default)")
      ->check(CLI::IsMember({"first", "time"}))
      ->group(planning);
  command->add_option("--seed", a.seed, "the same seed gives the same path, for most planners")
      ->check(isSeed())
      ->group(planning);
  command->add_flag("--no-simplify", a.noSimplify, "the planner's own path")->group(planning);
  const char* checking = "Checking";
  command
      ->add_option("--edges", a.edges,
                   "certified (default); adaptive or advancement: proved by distances, as "
                   "comparisons; or discrete: samples, as a yardstick")
      ->check(CLI::IsMember(corridor::problemChoices().at("checker.edges")))
      ->group(checking);
  command
      ->add_option("--resolution", a.resolution,
                   "of discrete: OMPL's longest_valid_segment_fraction")
      ->check(from(1e-9, 1.0, "a number from 1e-9 to 1"))
      ->group(checking);
  const char* results = "Results";
  command->add_option("-o,--output", a.output, "the solution file (YAML)")->group(results);
  command->add_option("--picture", a.picture, "an SVG of the scene and the path")->group(results);
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
      "verify", "Prove or refute a path, by other means than those that found it");
  command->add_option("PROBLEM", a.problem, "the problem")->required();
  command
      ->add_option("SOLUTION", a.solution, "a solution file, or an OMPL.app .path: a state a line")
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
      "view", "Show a problem and a path of it in 3D: a page for any browser, or a picture");
  command->add_option("PROBLEM", a.problem, "the problem")->required();
  command->add_option("SOLUTION", a.solution,
                      "a path: a solution file, or an OMPL.app .path; none: start and goal alone");
  addIgnoreDigest(*command, a.ignoreDigest);
  const char* results = "Results";
  command
      ->add_option("-o,--output", a.output,
                   "the page (HTML, in one piece that loads nothing; default, where there is no "
                   "--image: the problem's name and .html)")
      ->group(results);
  command
      ->add_option("--image", a.image,
                   "a PNG of the scene with the path's poses and what verify says of it; by "
                   "Chromium, without a display")
      ->group(results);
  command->add_option("--size", a.size, "of the image: WIDTHxHEIGHT in pixels (default 1366x768)")
      ->group(results);
  addQuiet(*command, a.quiet, results);
  command->footer(
      std::string(
          "Example: corridor solve problems/two_arms -o arms.yaml && corridor view "
          "problems/two_arms arms.yaml -o arms.html\n"
          "The page plays the path, and shows on demand the OBB trees, the closest pair with its "
          "distance along the path, what is skipped and why, and the contact where `corridor "
          "verify` refutes the path. Whether the path is proved is asked anew, and makes no "
          "difference to the exit status.\n") +
      kExitStatus);
  command->callback([&] { status = viewCommand(a); });
}

void addBenchmark(CLI::App& program, BenchmarkArguments& a, int& status) {
  CLI::App* command = program.add_subcommand(
      "benchmark", "Compare checkers and planners: run time, and how many paths are refuted");
  command->add_option("CAMPAIGN|PROBLEM", a.files, "a campaign's file, or problems (as of solve)")
      ->required();
  const char* compared = "What is compared, where problems are named";
  command
      ->add_option("--variants", a.variants,
                   "comma separated: what `checker: {edges: …}` takes, each with its knob or "
                   "without: certified:TOLERANCE (m), discrete:RESOLUTION (OMPL's "
                   "longest_valid_segment_fraction), fcl:RESOLUTION (default: "
                   "certified,discrete:0.01)")
      ->allow_extra_args(false)
      ->group(compared);
  command
      ->add_option("--planners", a.planners,
                   "comma separated, by OMPL's names (default: each problem's own)")
      ->allow_extra_args(false)
      ->group(compared);
  const char* runs = "Runs (over what the campaign or the problems say)";
  command
      ->add_option("--runs", a.runs,
                   "of each problem, variant and planner (default 10); the seeds are the same "
                   "for all")
      ->check(from<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000"))
      ->group(runs);
  command->add_option("--seed", a.seed, "the first; one more each run (default 1)")
      ->check(from<std::uint64_t>(1, std::numeric_limits<std::uint32_t>::max(),
                                  "a whole number from 1 to 2^32 - 1"))
      ->group(runs);
  command->add_option("--time", a.time, "limit of a run, seconds")->check(isSeconds())->group(runs);
  command->add_option("--memory", a.memory, "limit of a run, MB (default 4096)")
      ->check(from(1.0, 1e9, "a number of MB from 1 to 1e9"))
      ->group(runs);
  command
      ->add_option("--jobs", a.jobs,
                   "runs at a time (default 1); times are those of a busy machine then")
      ->check(from<std::uint64_t>(1, 1024, "a whole number from 1 to 1024"))
      ->group(runs);
  const char* results = "Results";
  command
      ->add_option("-o,--output", a.output,
                   "a folder for report.html with its plots, campaign.db (SQLite), runs.csv, "
                   "summary.csv and the logs of OMPL's Benchmark")
      ->group(results);
  command
      ->add_flag("--resume", a.resume, "goes on with the campaign in the folder, where it stopped")
      ->group(results);
  addJson(*command, a.json, results);
  command->footer(
      std::string(
          "Example: corridor benchmark problems/campaigns/error.yaml -o results --jobs 2\n"
          "Or without a file: corridor benchmark problems/thin_plate problems/piano --variants "
          "certified,discrete:0.01,discrete:0.001 -o results\n"
          "Each run is a process of its own, under OMPL's Benchmark; each path is judged by the "
          "independent verifier: `refuted` of those that were returned do collide, or break what "
          "the problem asks for. Times and counts are medians over the runs that were solved.\n"
          "Columns: *_s are seconds (time_s: all but reading files; time_p95_s: its 95 % quantile; "
          "processor_s: of all threads), length_m metres, rotation_rad radians, checking_share the "
          "part of time_s; all of them, and campaigns' keys: planner/benchmark/README.md.\n") +
      kExitStatus);
  command->callback([&] { status = benchmarkCommand(a); });
}

void addCheck(CLI::App& program, CheckArguments& a, int& status) {
  CLI::App* command =
      program.add_subcommand("check", "Check a problem, or many states of it, without planning");
  command->add_option("PROBLEM", a.problem, "the problem")->required();
  command->add_option("--states", a.states,
                      "a file of states (- is the standard input), one a line, numbers blank or "
                      "comma separated, # comments: "
                      "prints one line each, state,valid,pairs");
  addJson(*command, a.json);
  command->footer(
      std::string(
          "Example: corridor check problems/arm_at_shelf --states states.txt > valid.csv\n"
          "The numbers of a state are those of the problem's joints, in the order that `corridor "
          "inspect` prints.\n") +
      kExitStatus);
  command->callback([&] { status = checkCommand(a); });
}

void addInspect(CLI::App& program, InspectArguments& a, int& status) {
  CLI::App* command = program.add_subcommand(
      "inspect", "Tell what a mesh, robot or problem is, and what is skipped");
  command
      ->add_option("FILE", a.file,
                   "a mesh file, a URDF or robot.yaml, a problem, or a folder that holds a problem "
                   "or a robot")
      ->required();
  command->add_option("--unit", a.unit, "of a mesh file: m, cm, mm or in")
      ->check(CLI::IsMember({"m", "cm", "mm", "in"}));
  command->add_option("--up", a.up, "of a mesh file: its up-axis, to be turned to z")
      ->check(CLI::IsMember({"x", "y", "z"}));
  command->add_flag("--self-intersections", a.selfIntersections,
                    "of a mesh file: pairs of its triangles that intersect anywhere but in corners "
                    "and edges that they share (seconds for a million triangles; every pair of "
                    "coincident ones is counted)");
  command->add_flag("--pairs", a.pairs,
                    "of a problem: every pair of bodies, and why it isn't tested");
  const char* cost = "What queries of two meshes cost";
  command
      ->add_option(
          "--against", a.against,
          "a second mesh file: for every bounding volume the tests that interference "
          "takes (N_v, N_p), what one costs (C_v, C_p), and how well T = N_v C_v + N_p C_p "
          "predicts the time")
      ->group(cost);
  command
      ->add_option("--poses", a.poses,
                   "of --against: the second mesh's poses, as of corridor query (default: a grid "
                   "over the bounds of both)")
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
      "query", "Ask two meshes at many poses, or of many motions: CSV on stdout, times on stderr");
  command->add_option("A", a.meshA, "a mesh file, in metres; it stays where it is")->required();
  command->add_option("B", a.meshB, "a mesh file, in metres; it is posed")->required();
  const char* poses = "Poses of B";
  command
      ->add_option("--poses", a.poses,
                   "a file (- is the standard input), one a line: r00 r01 r02 r10 r11 r12 r20 r21 "
                   "r22 tx ty tz, a point b of B is at R b + t; # comments")
      ->group(poses);
  command
      ->add_option("--grid", a.grid,
                   "NXxNYxNZ: the centre of B's bounds on every point of a lattice, x first")
      ->group(poses);
  command
      ->add_option("--lower", a.lower,
                   "x,y,z in metres: the lattice's first point (default: A's bounds grown by half "
                   "the diagonal of B's)")
      ->group(poses);
  command->add_option("--upper", a.upper, "x,y,z in metres: its last point")->group(poses);
  command
      ->add_option("--rotations", a.rotations,
                   "all of the lattice so many times, B turned: not, then at random (default 1)")
      ->check(from<std::uint64_t>(1, 10'000'000, "a whole number from 1 to 10000000"))
      ->group(poses);
  command->add_option("--seed", a.seed, "of those rotations (default 1)")
      ->check(isSeed())
      ->group(poses);
  command->add_option("--save-poses", a.savePoses, "a file for the grid's poses, as --poses reads")
      ->group(poses);
  command
      ->add_option("--motions", a.motions,
                   "instead of poses: a file (- is the standard input) of B's motions, one a line: "
                   "the pose where it begins, 12 numbers as of --poses, and where it ends; from "
                   "one to the other B goes straight and turns "
                   "the shorter way (slerp; half a turn has none: undecided). Asked is the first "
                   "contact")
      ->group("Motions of B");
  command
      ->add_option("--edges", a.edges,
                   "how motions are proved, the first is the default: " +
                       corridor::joined(corridor::edgeMethodNames()))
      ->group("Motions of B");
  const char* asked = "What is asked (of motions all but --query)";
  const auto named = [](const auto& kinds) {
    std::vector<std::string> names;
    for (const auto& kind : kinds) names.push_back(kind.name);
    return corridor::joined(names);
  };
  const auto variants = [](std::vector<std::string> VolumeKind::*of) {
    std::string text = "the first is the default";
    for (const VolumeKind& kind : volumeKinds())
      text += "; of " + kind.name + ": " + corridor::joined(kind.*of);
    return text;
  };
  command->add_option("--query", a.query, "the first is the default: " + named(queryKinds()))
      ->group(asked);
  command
      ->add_option("--volume", a.volume,
                   "the bounding volume, the first is the default: " + named(volumeKinds()))
      ->group(asked);
  command->add_option("--fit", a.fit, variants(&VolumeKind::fits))->group(asked);
  command
      ->add_option("--overlap", a.overlap,
                   "how two volumes are tested, where it is asked whether they overlap; " +
                       variants(&VolumeKind::overlaps))
      ->group(asked);
  command
      ->add_option(
          "--tolerance", a.tolerance,
          "metres, of --query tolerance: are A and B at most that far apart? Of --motions, above "
          "0: the clearance below which it may be undecided (default: 1e-7 of the smaller "
          "one's radius)")
      ->check(from(0.0, std::numeric_limits<double>::max(), "a number of metres, 0 or more,"))
      ->group(asked);
  command
      ->add_option("--repeat", a.repeat,
                   "passes over all poses or motions; the time of one is the median of its passes "
                   "(default 1)")
      ->check(from<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000"))
      ->group(asked);
  command->footer(
      std::string(
          "Example: corridor query a.obj b.obj --poses poses.txt --repeat 5 > hits.csv\n"
          "         corridor query a.obj b.obj --grid 20x20x20 --rotations 10 --query contacts\n"
          "         corridor query a.obj b.obj --motions motions.txt > first_contacts.csv\n"
          "CSV: pose,hit,bv_tests,triangle_tests; of contacts, one line each with its segment: "
          "pose,a,b,px,py,pz,qx,qy,qz; of distance pose,distance,ax,ay,az,bx,by,bz with a point of "
          "either; of tolerance pose,closer; of motions motion,verdict,t0,t1,gap,triangle_a,"
          "triangle_b,bv_tests,triangle_tests,splits: free, contact (no contact before t0, one at "
          "t1, at most 1/1024 of the motion later unless they graze) or undecided (none before t0; "
          "at t1 those triangles are gap metres apart); t is 0 where the motion begins and 1 where "
          "it ends, -1 is none. All count from 0.\n"
          "Touching is contact; meshes are surfaces. Times are of one query on one core, reading "
          "and printing aside; what is quicker than 5 µs is repeated until the clock can tell "
          "it.\n") +
      kExitStatus);
  command->callback([&] { status = queryCommand(a); });
}

/// An empty name or value is a shell variable that was not set: no message could name it later.
void refuseEmptyValues(CLI::App& program) {
  for (CLI::App* command : program.get_subcommands({}))
    for (CLI::Option* option : command->get_options())
      if (option->get_items_expected_max() > 0)
        option->check(CLI::Validator(
            [](std::string& text) { return text.empty() ? std::string("is empty") : ""; }, ""));
}

/// CLI11's words for what a command does not take come last word first, and guess nothing. What
/// stands before the command, or after a --, is left to the program.
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

/// The option that was given more often than it is taken, or "".
std::string repeatedOption(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    if (option->get_items_expected_max() == 1 && option->count() > 1)
      return option->get_name() + " is given " + std::to_string(option->count()) +
             " times; once is enough";
  return "";
}

/// What was wrong with the words of the command line, in one line.
std::string usageFault(const CLI::App& program, const CLI::ParseError& error,
                       const std::string& firstWord) {
  const auto given = program.get_subcommands();
  if (!given.empty()) {
    std::string fault;
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) fault = unknownWord(program, *given[0]);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) fault = repeatedOption(*given[0]);
    if (fault.empty()) fault = error.what();
    return fault + "; corridor " + given[0]->get_name() + " --help tells more";
  }
  if (firstWord.empty() || firstWord[0] == '-')
    return error.what() + std::string("; corridor --help tells more");
  const std::vector<std::string> commands{"solve", "verify",  "view", "benchmark",
                                          "check", "inspect", "query"};
  return "unknown command " + corridor::quotedWord(firstWord) +
         corridor::didYouMean(firstWord, commands) + "; there are: " + corridor::joined(commands);
}

}  // namespace

int main(int argc, char** argv) {
  openStandardStreams();
  // Where a file may not get longer (ulimit -f), writing fails, and is told as a full disk is,
  // instead of ending the program.
  std::signal(SIGXFSZ, SIG_IGN);
  if (const auto arithmetic = corridor::floatingPoint();
      arithmetic != corridor::FloatingPoint::standard) {
    std::cerr << "corridor: nothing can be proved here: " << corridor::described(arithmetic)
              << "; a library or a wrapper that is loaded with the program has set the processor "
                 "so\n";
    return kInternal;
  }
  CLI::App program("Corridor plans collision-free motions and proves each one.", "corridor");
  program.set_version_flag("--version", CORRIDOR_VERSION);
  program.require_subcommand(1);
  program.footer(std::string("corridor COMMAND --help tells more.\n") + kExitStatus);
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
