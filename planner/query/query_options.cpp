#include "planner/query/query_options.h"

#include <algorithm>
#include <type_traits>
#include <variant>

#include <CLI/CLI.hpp>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/motion/edge_method.h"
#include "planner/app/options.h"
#include "planner/query/query_batch.h"
#include "planner/query/query_hulls.h"
#include "planner/query/query_trees.h"

namespace corridor::app {
namespace {

/// The member that takes the value. A `std::string` is required; a `bool` makes the option a flag.
using Target =
    std::variant<std::string QueryArguments::*, std::optional<std::string> QueryArguments::*,
                 std::vector<std::string> QueryArguments::*, std::uint64_t QueryArguments::*,
                 std::optional<std::uint64_t> QueryArguments::*,
                 std::optional<double> QueryArguments::*, bool QueryArguments::*>;

/// `conditions` are options that are given, such as "--grid", or that have a value, such as
/// "--query depth".
struct Rule {
  std::vector<std::string> conditions;
  std::string fault;  ///< what is wrong, after the name of the option
};

/// What is tested if the option is given.
struct Checks {
  CLI::Validator value = {};            ///< tests the value alone
  std::string noun = {};                ///< what `words` name
  std::vector<std::string> words = {};  ///< the possible values; empty: any value
  std::vector<Rule> excludes = {};      ///< none of the conditions may hold
  std::vector<Rule> needs = {};         ///< one of each rule's conditions must hold
};

struct Row {
  std::string name;
  Target target;
  const char* heading;
  std::string help;
  Checks checks = {};
};

template <class Kinds>
std::vector<std::string> namesOf(const Kinds& kinds) {
  std::vector<std::string> names;
  for (const auto& kind : kinds) names.push_back(kind.name);
  return names;
}

std::string wordsPerVolume(std::vector<std::string> VolumeKind::*words) {
  std::string text = "the first in each list is the default";
  for (const VolumeKind& kind : volumeKinds())
    text += "; with " + kind.name + ": " + joined(kind.*words);
  return text;
}

Rule needed(const std::string& option) {
  return {{option}, "needs " + option + ", which is not given"};
}

/// Returns all options in the order of the help, in which `checkOptions` checks them, too.
std::vector<Row> allOptions() {
  using Q = QueryArguments;
  const char *poses = "Poses of B", *motions = "Motions of B", *shapes = "Shapes of A",
             *query = "Query";
  const Rule noMotions{{"--motions"}, "applies to poses, not to --motions; leave it out"};
  const Rule noHulls{{"--hulls"}, "can't be used with --hulls, which needs no trees"};
  const Rule noDepth{{"--query depth"},
                     "can't be used with --query depth, which chooses its trees"};
  return {
      {"A", &Q::meshA, kOptions,
       "a mesh file, in metres unless its format has another unit; it does not move"},
      {"B", &Q::meshB, kOptions,
       "a mesh file, likewise; it is placed at the poses, or moves along the motions"},
      {"--poses", &Q::poses, poses,
       "a file of poses (-: standard input), one per line: r00 r01 r02 r10 r11 r12 r20 r21 r22 tx "
       "ty tz; a point b of B is at R b + t; # starts a comment",
       Checks{.excludes = {noMotions}}},
      {"--grid", &Q::grid, poses,
       "NXxNYxNZ: put the centre of B's bounds on every point of a lattice; x changes fastest",
       Checks{.excludes = {noMotions,
                           Rule{{"--poses"}, "can't be used with --poses; give one of the two"}}}},
      {"--lower", &Q::lower, poses,
       "x,y,z in metres: the lattice's first point (default: the lower corner of A's bounds, "
       "enlarged by half the diagonal of B's bounds)",
       Checks{.needs = {needed("--grid")}}},
      {"--upper", &Q::upper, poses,
       "x,y,z in metres: the lattice's last point (default: the upper corner of the same box)",
       Checks{.needs = {needed("--grid")}}},
      {"--rotations", &Q::rotations, poses,
       "repeat the lattice this many times, each with B in another random orientation; the first "
       "is the identity (default 1)",
       Checks{.value = isWithin<std::uint64_t>(1, 10'000'000, "a whole number from 1 to 10000000"),
              .needs = {needed("--grid")}}},
      {"--seed", &Q::seed, poses, "random seed of the orientations (default 1)",
       Checks{.value = isSeed(), .needs = {needed("--grid")}}},
      {"--save-poses", &Q::savePoses, poses,
       "write the grid's poses to this file, as --poses reads them",
       Checks{.needs = {needed("--grid")}}},
      {"--motions", &Q::motions, motions,
       "instead of poses: a file of B's motions (-: standard input), one per line: the first and "
       "the last pose, 12 numbers each, as for --poses. B moves straight and rotates the shorter "
       "way (slerp; a half turn is undecided). Reports the first contact of each motion"},
      {"--edges", &Q::edges, motions,
       "the method that proves motions; the first is the default: " + joined(provingMethodNames()),
       Checks{.noun = "method", .words = provingMethodNames(), .needs = {needed("--motions")}}},
      {"--deform", &Q::deform, shapes,
       "with poses: mesh files with further shapes of A, in order; write A and B before this "
       "option. Each has the same triangles as A, with moved vertices. The query (not contacts or "
       "depth) is run for A and for each shape; the tree of A is refitted, not built anew",
       Checks{
           .excludes =
               {noMotions, noHulls,
                Rule{
                    {"--query depth"},
                    "can't be used with --query depth; use interference, distance or tolerance"}}}},
      {"--query", &Q::query, query,
       "the query; the first is the default: " + joined(namesOf(namedQueries())),
       Checks{.noun = "query", .words = namesOf(namedQueries()), .excludes = {noMotions}}},
      {"--direction", &Q::direction, query,
       "x,y,z, of any length: with --query depth, the direction along which B leaves A (default: "
       "for meshes the best of several, for hulls the best of all)",
       Checks{.excludes = {noMotions}, .needs = {Rule{{"--query depth"}, "needs --query depth"}}}},
      {"--volume", &Q::volume, query,
       "the bounding volume; the first is the default: " + joined(namesOf(volumeKinds())) + ", " +
           kOctree + " (a tree over space, for --query interference only)",
       Checks{.excludes = {noHulls, noDepth}}},
      {"--fit", &Q::fit, query,
       "what the volumes are fitted to; " + wordsPerVolume(&VolumeKind::fits),
       Checks{.excludes = {noHulls, noDepth}}},
      {"--overlap", &Q::overlap, query,
       "the overlap test of two volumes, for queries that use one; " +
           wordsPerVolume(&VolumeKind::overlaps),
       Checks{.excludes = {noHulls, noDepth}}},
      {"--build", &Q::build, query,
       "how trees are built; top-down splits at the mean, median at the median, bottom-up merges "
       "neighbours; " +
           wordsPerVolume(&VolumeKind::builds),
       Checks{.excludes = {noHulls, noDepth}}},
      {"--tolerance", &Q::tolerance, query,
       "metres. With --query tolerance: report whether A and B are at most this far apart. With "
       "--motions, above 0: a motion whose clearance is below twice this may be undecided "
       "(default: 1e-7 times the radius of the smaller mesh's bounding sphere, or what the "
       "rounding of poses needs, if that is more)",
       Checks{.value = isMetres(),
              .excludes = {noHulls},
              .needs = {Rule{{"--query tolerance", "--motions"},
                             "needs --query tolerance or --motions"}}}},
      {"--hulls", &Q::hulls, query,
       "take A and B as the convex hulls of their vertices, with --query interference, distance or "
       "depth. The first three methods and lp take flat hulls, too. The methods: " +
           joined(hullMethods()) +
           ". hierarchy, climbing and every-vertex differ in how they find the vertex that is "
           "farthest along a direction. The others are other algorithms. lp tests for a separating "
           "plane by linear programming, on the rounded vertices of B at each pose (interference "
           "only). vclip finds the closest vertices, edges or faces (no depth). axes tests the "
           "normals of faces and the cross products of edges (interference only); its time grows "
           "with the product of the numbers of edges, so it is for small hulls. barba-langerman "
           "tests parts of an inner hierarchy of A against parts of an outer one of B "
           "(interference only). descent is Dobkin and Kirkpatrick's own search in the hierarchies "
           "of A and B (distance, and depth with --direction). Verdicts of axes, vclip and "
           "barba-langerman are exact; so are "
           "those "
           "of lp, for the rounded vertices. The others may report contact for gaps below "
           "2^-44 "
           "of the largest coordinate",
       Checks{.noun = "method",
              .words = hullMethods(),
              .excludes = {Rule{{"--motions"},
                                "can't be used with --motions; leave one of them out"}}}},
      {"--coherent", &Q::coherent, query,
       "with --hulls, for poses that follow each other in small steps: begin each query with what "
       "the query before has found (the last simplex; vclip: the last features; axes: the last "
       "axis). Answers are the same, up to the error of distances; the column steps shows the work "
       "saved",
       Checks{.needs = {needed("--hulls")}}},
      {"--repeat", &Q::repeat, query,
       "number of passes over all poses or motions; the time of each is the median of its passes "
       "(default 1)",
       Checks{.value = isWithin<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000")}},
  };
}

bool holds(const CLI::App& command, const std::string& condition) {
  const std::size_t space = condition.find(' ');
  const CLI::Option& option = *command.get_option(condition.substr(0, space));
  return option.count() > 0 &&
         (space == std::string::npos || option.as<std::string>() == condition.substr(space + 1));
}

/// @throws InputError if the option is given, and one of its checks fails.
void checkOption(const CLI::App& command, const Row& row) {
  if (!holds(command, row.name)) return;
  const auto& [value, noun, words, excludes, needs] = row.checks;
  const auto require = [&](bool isRight, const std::string& fault) {
    if (!isRight) throw InputError(Fault{row.name, 0, fault});
  };
  const auto applies = [&](const Rule& rule) {
    return std::ranges::any_of(
        rule.conditions, [&](const std::string& condition) { return holds(command, condition); });
  };
  if (!words.empty()) {
    const auto word = command.get_option(row.name)->as<std::string>();
    require(std::ranges::count(words, word) > 0, "unknown " + noun + " " + quotedWord(word) +
                                                     didYouMean(word, words) +
                                                     "; there are: " + joined(words));
  }
  for (const Rule& rule : excludes) require(!applies(rule), rule.fault);
  for (const Rule& rule : needs) require(applies(rule), rule.fault);
}

}  // namespace

void declareOptions(CLI::App& command, QueryArguments& arguments) {
  for (const Row& row : allOptions())
    std::visit(
        [&](const auto member) {
          auto& target = arguments.*member;
          using T = std::decay_t<decltype(target)>;
          CLI::Option* option = nullptr;
          if constexpr (std::is_same_v<T, bool>)
            option = command.add_flag(row.name, target, row.help);
          else
            option = command.add_option(row.name, target, row.help)->check(row.checks.value);
          option->group(row.heading)->required(std::is_same_v<T, std::string>);
        },
        row.target);
}

void checkOptions(const CLI::App& command) {
  const auto given = [&](const std::string& option) { return holds(command, option); };
  if (!given("--poses") && !given("--grid") && !given("--motions"))
    throw InputError(Fault{"--poses", 0, "one of --poses, --grid and --motions is required"});
  for (const Row& row : allOptions()) checkOption(command, row);
}

}  // namespace corridor::app
