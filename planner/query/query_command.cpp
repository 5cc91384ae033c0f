#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "collision/geometry/mesh_file.h"
#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/other_program.h"
#include "planner/app/output.h"
#include "planner/query/commands.h"
#include "planner/query/query_batch.h"
#include "planner/query/query_deform.h"
#include "planner/query/query_hulls.h"
#include "planner/query/query_output.h"
#include "planner/query/query_poses.h"
#include "planner/query/query_trees.h"

namespace corridor::app {
namespace {

struct QueryArguments {
  std::string meshA, meshB;
  std::optional<std::string> poses;               ///< a file of poses, one per line
  std::optional<std::string> grid, lower, upper;  ///< "10x10x5", "x,y,z"
  std::optional<std::uint64_t> rotations, seed;   ///< with `grid` only
  std::optional<std::string> savePoses;           ///< with `grid` only: write its poses here
  std::optional<std::string> motions;        ///< instead of poses: a file of motions, one per line
  std::optional<std::string> edges;          ///< with `motions` only: the method; unset: the first
  std::optional<std::string> query, volume;  ///< `query`: with poses only; unset: the first
  std::optional<std::string> fit, overlap, build;  ///< unset: the first that the volume has
  std::optional<std::string> hulls;                ///< query the convex hulls, by this method
  std::vector<std::string> deform;                 ///< further shapes of A, one file per frame
  std::optional<std::string> direction;            ///< "x,y,z", for the depth of meshes
  bool coherent = false;                           ///< with `hulls` only: see `queryHulls`
  std::optional<double> tolerance;  ///< metres; for the tolerance query and for motions
  std::uint64_t repeat = 1;
};

/// The maximum number of queries of one command, all passes counted: each stores its time, 8 bytes.
constexpr std::uint64_t kMostQueries = 1'000'000'000;

/// Returns the query of this name, or the first if no name is given.
/// @throws InputError for an unknown name. The message lists the names.
const NamedQuery& queryNamed(const std::optional<std::string>& name) {
  if (!name) return namedQueries().front();
  std::vector<std::string> names;
  for (const NamedQuery& query : namedQueries()) {
    if (query.name == *name) return query;
    names.push_back(query.name);
  }
  throw InputError(Fault{"--query", 0,
                         "unknown query " + quotedWord(*name) + didYouMean(*name, names) +
                             "; there are: " + joined(names)});
}

/// Returns the words of the options for trees, as they were given.
TreeNames treeWords(const QueryArguments& a) {
  return {a.volume.value_or(""), a.fit.value_or(""), a.overlap.value_or(""), a.build.value_or("")};
}

std::vector<Transform> posesOf(const QueryArguments& a, const TriangleMesh& meshA,
                               const TriangleMesh& meshB) {
  if (a.poses) return readPoses(*a.poses);
  PoseGrid grid;
  grid.counts = parseCounts(*a.grid);
  grid.rotations = static_cast<std::size_t>(a.rotations.value_or(1));
  grid.seed = a.seed.value_or(1);
  if (a.lower) grid.lower = parsePoint("--lower", *a.lower);
  if (a.upper) grid.upper = parsePoint("--upper", *a.upper);
  return gridPoses(grid, meshA, meshB);
}

/// Tests those rules for combining options that CLI11 can't test. @throws InputError if the options
/// violate one of them.
void checkOptions(const QueryArguments& a) {
  if (a.motions) {
    const auto ofPoses = [&](const char* option, bool given) {
      if (given)
        throw InputError(Fault{option, 0, "applies to poses, not to --motions; leave it out"});
    };
    ofPoses("--poses", a.poses.has_value());
    ofPoses("--grid", a.grid.has_value());
    ofPoses("--query", a.query.has_value());
    ofPoses("--direction", a.direction.has_value());
    ofPoses("--deform", !a.deform.empty());
    if (a.tolerance && !(*a.tolerance > 0))
      throw InputError(Fault{"--tolerance", 0, "must be above 0 with --motions"});
  }
  if (a.poses && a.grid)
    throw InputError(Fault{"--grid", 0, "can't be used with --poses; give one of the two"});
  if (!a.poses && !a.grid && !a.motions)
    throw InputError(Fault{"--poses", 0, "one of --poses, --grid and --motions is required"});
  const auto ofGrid = [&](const char* option, bool given) {
    if (given && !a.grid) throw InputError(Fault{option, 0, "needs --grid, which is not given"});
  };
  if (a.edges && !a.motions)
    throw InputError(Fault{"--edges", 0, "needs --motions, which is not given"});
  ofGrid("--lower", a.lower.has_value());
  ofGrid("--upper", a.upper.has_value());
  ofGrid("--rotations", a.rotations.has_value());
  ofGrid("--seed", a.seed.has_value());
  ofGrid("--save-poses", a.savePoses.has_value());
}

void checkRepeats(const QueryArguments& a, std::size_t count, const char* what) {
  if (a.repeat <= kMostQueries / count) return;
  throw InputError(Fault{"--repeat", 0,
                         grouped(a.repeat) + " passes over " + counted(count, what) +
                             " are more than " + grouped(kMostQueries) + " queries"});
}

/// @throws InputError for an unknown name.
EdgeMethod methodNamed(const std::string& name) {
  if (const auto method = edgeMethodNamed(name); method && proves(*method)) return *method;
  throw InputError(Fault{"--edges", 0,
                         "unknown method " + quotedWord(name) +
                             didYouMean(name, provingMethodNames()) +
                             "; there are: " + joined(provingMethodNames())});
}

int queryMotions(const QueryArguments& a) {
  const std::string edges = a.edges.value_or(edgeMethodNames().front());
  const EdgeMethod method = methodNamed(edges);
  const TreeNames trees = chosenTrees(treeWords(a));
  requireNoOctree(trees, "--motions");
  if (method != EdgeMethod::directional) requireDefaultOverlap(trees, "--edges certified", edges);
  MeshFile meshA = readMeshFile(a.meshA), meshB = readMeshFile(a.meshB);
  const std::vector<PoseMotion> motions = readMotions(*a.motions);
  checkRepeats(a, motions.size(), "motion");
  const BatchResult result =
      runMotions(std::move(meshA.mesh), std::move(meshB.mesh), motions, treesNamed(trees),
                 a.tolerance, static_cast<int>(a.repeat), method);
  printMotions(result);
  const auto number = [&](MotionVerdict verdict) {
    return std::to_string(std::count_if(
        result.motions.begin(), result.motions.end(),
        [&](const MotionAnswer& motion) { return motion.result.verdict == verdict; }));
  };
  printSummary(
      result,
      {"edges=" + edges, "volume=" + trees.volume, "fit=" + trees.fit, "overlap=" + trees.overlap,
       "build=" + trees.build, "tolerance=" + rounded(result.tolerance),
       "motions=" + std::to_string(motions.size()), "free=" + number(MotionVerdict::free),
       "hits=" + number(MotionVerdict::contact), "undecided=" + number(MotionVerdict::undecided)});
  return kDone;
}

/// The meshes and the poses of a query. The constructor reads them, and writes the poses of a grid.
struct PoseInput {
  MeshFile meshA, meshB;
  std::vector<Transform> poses;

  explicit PoseInput(const QueryArguments& a)
      : meshA(readMeshFile(a.meshA)),
        meshB(readMeshFile(a.meshB)),
        poses(posesOf(a, meshA.mesh, meshB.mesh)) {
    checkRepeats(a, poses.size() * (a.deform.size() + 1), "pose");
    std::vector<std::filesystem::path> inputs = {a.meshA, a.meshB};
    inputs.insert(inputs.end(), a.deform.begin(), a.deform.end());
    requireNotAnInput(a.savePoses, "--save-poses", inputs, "the query");
    if (a.savePoses) writePoses(*a.savePoses, poses);
  }
};

/// Tests the options of a query with --hulls. @throws InputError for unknown names, and for options
/// that apply to trees only.
void checkHullOptions(const QueryArguments& a) {
  requireHullQuery(*a.hulls, a.query, a.coherent);
  const auto ofTrees = [](const char* option, bool given) {
    if (given)
      throw InputError(Fault{option, 0, "can't be used with --hulls, which needs no trees"});
  };
  if (a.motions)
    throw InputError(Fault{"--hulls", 0, "can't be used with --motions; leave one of them out"});
  ofTrees("--deform", !a.deform.empty());
  ofTrees("--volume", a.volume.has_value());
  ofTrees("--fit", a.fit.has_value());
  ofTrees("--overlap", a.overlap.has_value());
  ofTrees("--build", a.build.has_value());
  ofTrees("--tolerance", a.tolerance.has_value());
  if (a.direction)
    throw InputError(Fault{"--direction", 0, "is for the depth of meshes, not with --hulls"});
}

/// Computes and prints bounds of the penetration depth at many poses. @returns the exit status.
int queryDepth(const QueryArguments& a, const NamedQuery& query) {
  for (const auto& [option, given] :
       {std::pair("--volume", a.volume.has_value()), std::pair("--fit", a.fit.has_value()),
        std::pair("--overlap", a.overlap.has_value()), std::pair("--build", a.build.has_value())})
    if (given)
      throw InputError(
          Fault{option, 0, "can't be used with --query depth, which chooses its trees"});
  if (a.tolerance)
    throw InputError(Fault{"--tolerance", 0, "needs --query tolerance or --motions"});
  if (!a.deform.empty())
    throw InputError(Fault{"--deform", 0,
                           "can't be used with --query depth; use interference, distance or "
                           "tolerance"});
  std::optional<Vec3> direction;
  if (a.direction) direction = parsePoint("--direction", *a.direction);
  if (direction && direction->isZero(0))
    throw InputError(Fault{"--direction", 0, "0,0,0 is no direction; give a vector x,y,z"});
  PoseInput input(a);
  const BatchResult result = runDepths(std::move(input.meshA.mesh), std::move(input.meshB.mesh),
                                       input.poses, direction, static_cast<int>(a.repeat));
  printCsv(query, result);
  const auto hits = std::ranges::count_if(result.answers, &Answer::hit);
  printSummary(result, {"query=" + query.name, "poses=" + std::to_string(input.poses.size()),
                        "hits=" + std::to_string(hits)});
  return kDone;
}

int queryCommand(const QueryArguments& a) {
  checkOptions(a);
  if (a.hulls) checkHullOptions(a);
  if (a.coherent && !a.hulls)
    throw InputError(Fault{"--coherent", 0, "needs --hulls, which is not given"});
  requireWritable(a.savePoses, "--save-poses");
  if (a.hulls) {
    const PoseInput input(a);
    queryHulls({input.meshA.mesh, a.meshA}, {input.meshB.mesh, a.meshB}, input.poses, *a.hulls,
               a.query, a.coherent, static_cast<int>(a.repeat));
    return kDone;
  }
  if (a.motions) return queryMotions(a);
  const NamedQuery& query = queryNamed(a.query);
  if (query.kind == QueryKind::depth) return queryDepth(a, query);
  const TreeNames trees = chosenTrees(treeWords(a));
  if (query.kind != QueryKind::interference) requireNoOctree(trees, query.name);
  if (query.kind == QueryKind::tolerance && !a.tolerance)
    throw InputError(
        Fault{"--tolerance", 0, "is needed with --query tolerance: a distance in metres"});
  if (query.kind != QueryKind::tolerance && a.tolerance)
    throw InputError(Fault{"--tolerance", 0, "needs --query tolerance or --motions"});
  if (a.direction) throw InputError(Fault{"--direction", 0, "needs --query depth"});
  if (!testsOverlap(query.kind))
    requireDefaultOverlap(trees, "--query interference or contacts", query.name);
  if (!a.deform.empty()) requireFrames(query, trees);
  const PoseInput input(a);
  const Batch batch{input.meshA.mesh,
                    input.meshB.mesh,
                    input.poses,
                    query.kind,
                    trees.volume == kOctree ? std::nullopt : std::optional(treesNamed(trees)),
                    a.tolerance.value_or(0),
                    static_cast<int>(a.repeat)};
  std::vector<std::string> words = {
      "query=" + query.name,  "volume=" + trees.volume,
      "fit=" + trees.fit,     "overlap=" + trees.overlap,
      "build=" + trees.build, "poses=" + std::to_string(input.poses.size())};
  BatchResult result;
  if (a.deform.empty()) {
    result = runPoses(batch);
    printCsv(query, result);
  } else {
    AllFrames all = queryFrames(query, batch, a.meshA, a.deform);
    words.push_back("frames=" + std::to_string(a.deform.size() + 1));
    words.push_back("refit_ms=" + rounded(all.refitMs));
    result = std::move(all.result);
  }
  words.push_back("hits=" +
                  std::to_string(std::count_if(result.answers.begin(), result.answers.end(),
                                               [](const Answer& answer) { return answer.hit; })));
  printSummary(result, words);
  return kDone;
}

}  // namespace

void addQuery(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<QueryArguments>();  // the callback keeps it
  QueryArguments& a = *arguments;
  CLI::App* command = program.add_subcommand("query", kQueryHelp);
  command
      ->add_option("A", a.meshA,
                   "a mesh file, in metres unless its format has another unit; it does not move")
      ->required();
  command
      ->add_option("B", a.meshB,
                   "a mesh file, likewise; it is placed at the poses, or moves along the motions")
      ->required();
  const char* poses = "Poses of B";
  command
      ->add_option("--poses", a.poses,
                   "a file of poses (-: standard input), one per line: r00 r01 r02 r10 r11 r12 r20 "
                   "r21 r22 tx ty tz; a point b of B is at R b + t; # starts a comment")
      ->group(poses);
  command
      ->add_option("--grid", a.grid,
                   "NXxNYxNZ: put the centre of B's bounds on every point of a lattice; x changes "
                   "fastest")
      ->group(poses);
  command
      ->add_option("--lower", a.lower,
                   "x,y,z in metres: the lattice's first point (default: the lower corner of A's "
                   "bounds, enlarged by half the diagonal of B's bounds)")
      ->group(poses);
  command
      ->add_option("--upper", a.upper,
                   "x,y,z in metres: the lattice's last point (default: the upper corner of the "
                   "same box)")
      ->group(poses);
  command
      ->add_option("--rotations", a.rotations,
                   "repeat the lattice this many times, each with B in another random orientation; "
                   "the first is the identity (default 1)")
      ->check(isWithin<std::uint64_t>(1, 10'000'000, "a whole number from 1 to 10000000"))
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
                       joined(provingMethodNames()))
      ->group("Motions of B");
  command
      ->add_option(
          "--deform", a.deform,
          "with poses: mesh files with further shapes of A, in order; write A and B before "
          "this option. Each has the same triangles as A, with moved vertices. The query "
          "(not contacts or depth) is run for A and for each shape; the tree of A is "
          "refitted, not built anew")
      ->group("Shapes of A");
  const char* asked = "Query";
  const auto named = [](const auto& kinds) {
    std::vector<std::string> names;
    for (const auto& kind : kinds) names.push_back(kind.name);
    return joined(names);
  };
  const auto variants = [](std::vector<std::string> VolumeKind::*of) {
    std::string text = "the first in each list is the default";
    for (const VolumeKind& kind : volumeKinds())
      text += "; with " + kind.name + ": " + joined(kind.*of);
    return text;
  };
  command
      ->add_option("--query", a.query,
                   "the query; the first is the default: " + named(namedQueries()))
      ->group(asked);
  command
      ->add_option(
          "--direction", a.direction,
          "x,y,z, of any length: with --query depth of meshes, the direction along which B "
          "leaves A (default: the best of several); depth chooses its trees")
      ->group(asked);
  command
      ->add_option("--volume", a.volume,
                   "the bounding volume; the first is the default: " + named(volumeKinds()) + ", " +
                       kOctree + " (a tree over space, for --query interference only)")
      ->group(asked);
  command
      ->add_option("--fit", a.fit, "what the volumes are fitted to; " + variants(&VolumeKind::fits))
      ->group(asked);
  command
      ->add_option("--overlap", a.overlap,
                   "the overlap test of two volumes, for queries that use one; " +
                       variants(&VolumeKind::overlaps))
      ->group(asked);
  command
      ->add_option("--build", a.build,
                   "how trees are built; top-down splits at the mean, median at the median, "
                   "bottom-up merges neighbours; " +
                       variants(&VolumeKind::builds))
      ->group(asked);
  command
      ->add_option(
          "--tolerance", a.tolerance,
          "metres. With --query tolerance: report whether A and B are at most this far apart. With "
          "--motions, above 0: a motion whose clearance is below twice this may be undecided "
          "(default: 1e-7 times the radius of the smaller mesh's bounding sphere, or what the "
          "rounding of poses needs, if "
          "that is more)")
      ->check(isWithin(0.0, std::numeric_limits<double>::max(), "a number of metres, 0 or more,"))
      ->group(asked);
  command
      ->add_option(
          "--hulls", a.hulls,
          "take A and B as the convex hulls of their vertices, which must not all be on one "
          "plane, with --query interference, distance or depth. The methods: " +
              joined(hullMethods()) +
              ". hierarchy, climbing and every-vertex differ in how they find the vertex that is "
              "farthest along a direction. The others are other algorithms. lp tests for a "
              "separating plane by linear programming, on the rounded vertices of B at each pose "
              "(interference only). vclip finds the closest vertices, edges or faces (no depth). "
              "axes tests the normals of faces and the cross products of edges (interference "
              "only); its "
              "time grows with the product of the numbers of edges, so it is for small hulls. "
              "barba-langerman tests parts of an inner hierarchy of A against parts of an outer "
              "one of B (interference only)")
      ->group(asked);
  command
      ->add_flag(
          "--coherent", a.coherent,
          "with --hulls, for poses that follow each other in small steps: begin each query "
          "with what the query before has found (the last simplex; vclip: the last features; "
          "axes: the last axis). Answers are the same, up to the error of distances; the "
          "column steps shows the work saved")
      ->group(asked);
  command
      ->add_option("--repeat", a.repeat,
                   "number of passes over all poses or motions; the time of each is the median of "
                   "its passes (default 1)")
      ->check(isWithin<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000"))
      ->group(asked);
  command->footer(
      std::string(
          "Example: corridor query a.obj b.obj --poses poses.txt --repeat 5 > hits.csv\n"
          "         corridor query a.obj b.obj --grid 20x20x20 --rotations 10 --query contacts\n"
          "         corridor query a.obj b.obj --motions motions.txt > first_contacts.csv\n"
          "         corridor query a.obj b.obj --poses poses.txt --deform a1.obj a2.obj a3.obj\n"
          "CSV on stdout; poses, motions and triangles count from 0:\n"
          "  interference: pose,hit,bv_tests,triangle_tests\n"
          "  contacts: pose,a,b,px,py,pz,qx,qy,qz, one line per pair of triangles that touch, with "
          "the ends p and q of the segment that they share\n"
          "  distance: pose,distance,ax,ay,az,bx,by,bz,nx,ny,nz, with a closest point of each mesh "
          "and the direction from A to B (0 for contact)\n"
          "  depth: pose,lower,upper,dx,dy,dz,triangle_a,triangle_b: B must move by at least "
          "lower, and leaves A by upper along the direction; triangle_a and triangle_b are the "
          "deepest pair\n"
          "  with --hulls: interference: pose,hit,steps; distance: pose,distance,lower,nx,ny,nz,ax,"
          "ay,az,bx,by,bz,steps, with a proved lower bound, the direction that proves it, and a "
          "closest point of each hull; depth: pose,lower,upper,nx,ny,nz,ax,ay,az,bx,by,bz,steps, "
          "with bounds of the "
          "least length by which B must move to leave A, and the direction; steps are rounds of "
          "the search, with vclip also pairs of features, with axes the axes tested, with lp 0, "
          "with barba-langerman the tests of two parts\n"
          "  tolerance: pose,closer, which is 1 if A and B are at most the tolerance apart\n"
          "  with --deform: frame before these columns, 0 for A itself; after them refit_ms, the "
          "time to refit the tree of A to the frame, and query_ns\n"
          "  motions: motion,verdict,t0,t1,gap,triangle_a,triangle_b,bv_tests,triangle_tests,"
          "splits\n"
          "Verdicts of motions: free; contact: no contact before t0, and one at t1, where t1 - t0 "
          "is at most 1/1024 unless the meshes graze; undecided: no contact before t0, and at t1 "
          "the two triangles are gap metres apart. t is 0 at the start of a motion and 1 at its "
          "end. A value that does not exist is -1.\n"
          "Touching is contact; meshes are surfaces. Times are those of one query on one core, "
          "without reading and printing. A query shorter than 5 µs is repeated; its time is the "
          "mean.\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = queryCommand(*arguments); });
}

}  // namespace corridor::app
