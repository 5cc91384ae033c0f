#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "collision/core/error.h"
#include "collision/geometry/mesh_file.h"
#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/other_program.h"
#include "planner/app/output.h"
#include "planner/app/read_mesh.h"
#include "planner/query/commands.h"
#include "planner/query/query_batch.h"
#include "planner/query/query_deform.h"
#include "planner/query/query_hulls.h"
#include "planner/query/query_options.h"
#include "planner/query/query_output.h"
#include "planner/query/query_poses.h"
#include "planner/query/query_trees.h"

namespace corridor::app {
namespace {

/// The maximum number of queries of one command, all passes counted: each stores its time, 8 bytes.
constexpr std::uint64_t kMostQueries = 1'000'000'000;

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

void checkRepeats(const QueryArguments& a, std::size_t count, const char* what) {
  if (a.repeat <= kMostQueries / count) return;
  throw InputError(Fault{"--repeat", 0,
                         grouped(a.repeat) + " passes over " + counted(count, what) +
                             " are more than " + grouped(kMostQueries) + " queries"});
}

int queryMotions(const QueryArguments& a) {
  if (a.tolerance && !(*a.tolerance > 0))
    throw InputError(Fault{"--tolerance", 0, "must be above 0 with --motions"});
  const std::string edges = a.edges.value_or(edgeMethodNames().front());
  const EdgeMethod method = *edgeMethodNamed(edges);
  const TreeNames trees = chosenTrees(treeWords(a));
  requireNoOctree(trees, "--motions");
  if (method != EdgeMethod::certified) requireDefaultOverlap(trees, "--edges certified", edges);
  MeshFile meshA = readMeshAndPrintNotes(a.meshA), meshB = readMeshAndPrintNotes(a.meshB);
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

/// The meshes and the poses of a query.
struct PoseInput {
  MeshFile meshA, meshB;
  std::vector<Transform> poses;
};

PoseInput readPoseInput(const QueryArguments& a) {
  PoseInput input{readMeshAndPrintNotes(a.meshA), readMeshAndPrintNotes(a.meshB), {}};
  input.poses = posesOf(a, input.meshA.mesh, input.meshB.mesh);
  checkRepeats(a, input.poses.size() * (a.deform.size() + 1), "pose");
  return input;
}

/// Writes the poses to the file of --save-poses, if it is given.
void savePoses(const QueryArguments& a, const std::vector<Transform>& poses) {
  std::vector<std::filesystem::path> inputs = {a.meshA, a.meshB};
  inputs.insert(inputs.end(), a.deform.begin(), a.deform.end());
  requireNotAnInput(a.savePoses, "--save-poses", inputs, "the query");
  if (a.savePoses) writePoses(*a.savePoses, poses);
}

/// Returns the vector of --direction. @throws InputError if it is 0.
std::optional<Vec3> directionOf(const QueryArguments& a) {
  if (!a.direction) return std::nullopt;
  const Vec3 direction = parsePoint("--direction", *a.direction);
  if (direction.isZero(0))
    throw InputError(Fault{"--direction", 0, "0,0,0 is no direction; give a vector x,y,z"});
  return direction;
}

/// Computes and prints bounds of the penetration depth at many poses. @returns the exit status.
int queryDepth(const QueryArguments& a, const NamedQuery& query) {
  const std::optional<Vec3> direction = directionOf(a);
  PoseInput input = readPoseInput(a);
  savePoses(a, input.poses);
  const BatchResult result = runDepths(std::move(input.meshA.mesh), std::move(input.meshB.mesh),
                                       input.poses, direction, static_cast<int>(a.repeat));
  printCsv(query, result);
  const auto hits = std::ranges::count_if(result.answers, &Answer::hit);
  printSummary(result, {"query=" + query.name, "poses=" + std::to_string(input.poses.size()),
                        "hits=" + std::to_string(hits)});
  return kDone;
}

int queryConvexHulls(const QueryArguments& a) {
  requireHullQuery(*a.hulls, a.query, a.direction.has_value(), a.coherent);
  const std::optional<Vec3> direction = directionOf(a);
  const PoseInput input = readPoseInput(a);
  savePoses(a, input.poses);
  queryHulls({input.meshA.mesh, a.meshA}, {input.meshB.mesh, a.meshB}, input.poses, *a.hulls,
             a.query, direction, a.coherent, static_cast<int>(a.repeat));
  return kDone;
}

/// Runs the query on the trees of the meshes at many poses. @returns the exit status.
int queryTrees(const QueryArguments& a, const NamedQuery& query) {
  const TreeNames trees = chosenTrees(treeWords(a));
  if (query.kind != QueryKind::interference) requireNoOctree(trees, query.name);
  if (query.kind == QueryKind::tolerance && !a.tolerance)
    throw InputError(
        Fault{"--tolerance", 0, "is needed with --query tolerance: a distance in metres"});
  if (!testsOverlap(query.kind))
    requireDefaultOverlap(trees, "--query interference or contacts", query.name);
  if (!a.deform.empty()) requireFrames(query, trees);
  const PoseInput input = readPoseInput(a);
  savePoses(a, input.poses);
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

int runQuery(const QueryArguments& a) {
  requireWritable(a.savePoses, "--save-poses");
  if (a.hulls) return queryConvexHulls(a);
  if (a.motions) return queryMotions(a);
  const auto& queries = namedQueries();
  const NamedQuery& query =
      a.query ? *std::ranges::find(queries, *a.query, &NamedQuery::name) : queries.front();
  return query.kind == QueryKind::depth ? queryDepth(a, query) : queryTrees(a, query);
}

}  // namespace

void addQuery(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<QueryArguments>();  // the callback keeps it
  CLI::App* command = program.add_subcommand("query", kQueryHelp);
  declareOptions(*command, *arguments);
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
          "least length by which B must move to leave A, at all or along --direction (inf, if no "
          "length is proved to be enough), and the direction; steps are rounds of "
          "the search, with vclip also pairs of features, with axes the axes tested, with lp 0, "
          "with barba-langerman the tests of two parts, with descent the pairs of pyramids; the "
          "depth "
          "by descent has no lower bound and no points (0), and n is the normal of the plane that "
          "proves upper\n"
          "  tolerance: pose,closer, which is 1 if A and B are at most the tolerance apart\n"
          "  with --deform: frame before these columns, 0 for A itself; after them refit_ms, the "
          "time to refit the tree of A to the frame, and query_ns\n"
          "  motions: motion,verdict,t0,t1,gap,triangle_a,triangle_b,bv_tests,triangle_tests,"
          "splits\n"
          "Verdicts of motions: free; contact: no contact before t0, and one at t1, where t1 - t0 "
          "is at most 1/1024 unless the meshes graze. Contact is decided at the pose of the motion "
          "at t1; "
          "at 0 and 1 it has the rotation nearest to the matrix in the file. undecided: no contact "
          "before t0, and at t1 "
          "the two triangles are gap metres apart. t is 0 at the start of a motion and 1 at its "
          "end. A value that does not exist is -1.\n"
          "Touching is contact; meshes are surfaces. Times are those of one query on one core, "
          "without reading and printing. A query shorter than 5 µs is repeated; its time is the "
          "mean.\n") +
      kExitStatus);
  command->callback([=, &status] {
    checkOptions(*command);
    status = runQuery(*arguments);
  });
}

}  // namespace corridor::app
