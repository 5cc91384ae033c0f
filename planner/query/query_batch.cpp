#include "planner/query/query_batch.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <type_traits>
#include <utility>

#include "collision/core/quantiles.h"
#include "collision/course/octree_interference.h"
#include "collision/course/query_timing.h"
#include "collision/hierarchy/with_trees.h"
#include "collision/motion/rigid_motion.h"
#include "collision/queries/contacts.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"

namespace corridor::app {
namespace {

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// Runs and measures `ask(index of a pose, context)` for `count` poses, `passes` times. Each pass
/// runs over all poses. (If one pose were repeated instead, its data would already be in the
/// processor's caches.) No query starts from the pair of triangles that the query before it found.
/// So neither cost nor answer of a pose depends on the poses before it.
template <class Ask>
std::vector<Answer> timed(std::size_t count, int passes, const Ask& ask) {
  std::vector<Answer> answers(count);
  const auto repeat = static_cast<std::size_t>(passes);
  std::vector<double> ns(answers.size() * repeat);
  QueryContext context;
  for (std::size_t pass = 0; pass < repeat; ++pass)
    for (std::size_t i = 0; i < answers.size(); ++i) {
      Answer& answer = answers[i];
      const auto once = [&] {
        context.lastPairs.clear();
        answer.hit = ask(i, context);
      };
      const auto first = [&] {
        context.counters = {};
        once();
        answer.boxTests = context.counters.boxTests;
        answer.primitiveTests = context.counters.primitiveTests;
      };
      ns[i * repeat + pass] = nanosecondsOf(first, once);
    }
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto begin = ns.begin() + static_cast<std::ptrdiff_t>(i * repeat);
    answers[i].ns = medianOf(std::vector<double>(begin, begin + passes));
  }
  return answers;
}

/// Builds a tree by `make()`, and returns it. Sets `ms` to the time, and `bytes` to the size of the
/// tree.
template <class Make>
auto measured(const Make& make, double& ms, std::size_t& bytes) {
  const auto start = std::chrono::steady_clock::now();
  auto tree = make();
  ms = millisecondsSince(start);
  bytes = tree.bytes();
  return tree;
}

/// Runs interference queries on octrees.
BatchResult runOnOctrees(const Batch& batch) {
  BatchResult result;
  const Octree a = measured([&] { return Octree(batch.a); }, result.buildMsA, result.bytesA);
  const Octree b = measured([&] { return Octree(batch.b); }, result.buildMsB, result.bytesB);
  result.answers =
      timed(batch.poses.size(), batch.repeat, [&](std::size_t i, QueryContext& context) {
        return interference(Posed(a), Posed(b, batch.poses[i]), context).has_value();
      });
  return result;
}

/// Runs the batch on the trees of its meshes.
template <class Overlap, class Tree>
void runOn(const Batch& batch, const Tree& a, const Tree& b, BatchResult& result) {
  switch (batch.kind) {
    case QueryKind::interference:
      result.answers =
          timed(batch.poses.size(), batch.repeat, [&](std::size_t i, QueryContext& context) {
            return interference<Overlap>(Posed(a), Posed(b, batch.poses[i]), context).has_value();
          });
      if constexpr (!std::is_same_v<Tree, Obb4Tree>)
        if (!batch.measured.empty()) {
          std::vector<Transform> poses;
          for (const std::size_t i : batch.measured) poses.push_back(batch.poses[i]);
          result.tests = testCosts<Overlap>(a, b, poses);
        }
      break;
    case QueryKind::distance:
      result.distances.resize(batch.poses.size());
      result.answers =
          timed(batch.poses.size(), batch.repeat, [&](std::size_t i, QueryContext& context) {
            result.distances[i] = distance(Posed(a), Posed(b, batch.poses[i]), {}, context);
            return result.distances[i].distance == 0;
          });
      break;
    case QueryKind::tolerance:
      result.answers =
          timed(batch.poses.size(), batch.repeat, [&](std::size_t i, QueryContext& context) {
            return closerThan(Posed(a), Posed(b, batch.poses[i]), batch.tolerance, context);
          });
      break;
    case QueryKind::contacts: {
      std::vector<std::vector<TriangleContact>> found(batch.poses.size());
      result.answers =
          timed(batch.poses.size(), batch.repeat, [&](std::size_t i, QueryContext& context) {
            found[i] = contacts<Overlap>(Posed(a), Posed(b, batch.poses[i]), context);
            return !found[i].empty();
          });
      for (std::size_t i = 0; i < found.size(); ++i)
        for (const TriangleContact& c : found[i])
          result.contacts.push_back({i, c.a, c.b, c.p_W, c.q_W});
      break;
    }
    case QueryKind::depth:  // `runDepths`
      break;
  }
}

/// Calls `run.operator()<Overlap>(make)`, where `make(mesh)` builds a tree of the batch's kind.
/// @pre the batch's trees are not octrees.
template <class Run>
auto withTreesOf(const Batch& batch, const Run& run) {
  const auto& [trees, params] = *batch.trees;
  if (trees == TreeKind::obb4)
    return run.template operator()<StandardOverlap>(
        [fit = params.fit](const TriangleMesh& mesh) { return Obb4Tree(mesh, fit); });
  return withVolume(trees, [&, how = params]<class Volume, class Overlap>() {
    return run.template operator()<Overlap>(
        [&](const TriangleMesh& mesh) { return VolumeTree<Volume>(mesh, how); });
  });
}

/// The size of a body's tree, and the time to build it.
struct BuiltTree {
  std::size_t bytes = 0;
  double ms = 0;
};
BuiltTree builtTree(const Body& body, TreeKind trees) {
  const auto start = std::chrono::steady_clock::now();
  const auto built = [&](const auto& tree) {
    return BuiltTree{tree.bytes(), millisecondsSince(start)};
  };
  if (trees == TreeKind::obb4) return built(body.tree());
  return withVolume(
      trees, [&]<class Volume, class Overlap>() { return built(body.volumeTree<Volume>()); });
}

}  // namespace

BatchResult runPoses(const Batch& batch) {
  if (!batch.trees) return runOnOctrees(batch);
  return withTreesOf(batch, [&]<class Overlap>(const auto& make) {
    BatchResult result;
    const auto a = measured([&] { return make(batch.a); }, result.buildMsA, result.bytesA);
    const auto b = measured([&] { return make(batch.b); }, result.buildMsB, result.bytesB);
    runOn<Overlap>(batch, a, b, result);
    return result;
  });
}

std::vector<FrameResult> runFrames(const Batch& batch, const NextShape& next) {
  return withTreesOf(batch, [&]<class Overlap>(const auto& make) {
    std::vector<FrameResult> frames(1);
    BatchResult& first = frames.front().result;
    auto a = measured([&] { return make(batch.a); }, first.buildMsA, first.bytesA);
    const auto b = measured([&] { return make(batch.b); }, first.buildMsB, first.bytesB);
    runOn<Overlap>(batch, a, b, first);
    while (const std::optional<TriangleMesh> shape = next()) {
      FrameResult& frame = frames.emplace_back();
      const auto refit = [&] { a.refit(*shape); };
      frame.refitMs = nanosecondsOf(refit, refit) / 1e6;
      runOn<Overlap>(batch, a, b, frame.result);
    }
    return frames;
  });
}

BatchResult runDepths(TriangleMesh meshA, TriangleMesh meshB, const std::vector<Transform>& poses,
                      const std::optional<Vec3>& direction, int repeat) {
  BatchResult result;
  const Body a("A", std::move(meshA)), b("B", std::move(meshB));
  for (const TreeKind trees : {TreeKind::obb4, TreeKind::obbBinary}) {
    const BuiltTree treeA = builtTree(a, trees), treeB = builtTree(b, trees);
    result.bytesA += treeA.bytes;
    result.buildMsA += treeA.ms;
    result.bytesB += treeB.bytes;
    result.buildMsB += treeB.ms;
  }
  DepthOptions options;
  if (direction) options.directions = {*direction};
  result.depths.resize(poses.size());
  result.answers = timed(poses.size(), repeat, [&](std::size_t i, QueryContext& context) {
    result.depths[i] = depthBounds(a, b, poses[i], options, context);
    return result.depths[i].upper > 0;
  });
  return result;
}

BatchResult runMotions(TriangleMesh meshA, TriangleMesh meshB,
                       const std::vector<PoseMotion>& motions, const TreeChoice& trees,
                       std::optional<double> tolerance, int repeat, EdgeMethod method) {
  BatchResult result;
  const Body a("A", std::move(meshA), false, trees.params),
      b("B", std::move(meshB), false, trees.params);
  const BuiltTree treeA = builtTree(a, trees.trees), treeB = builtTree(b, trees.trees);
  result.bytesA = treeA.bytes;
  result.buildMsA = treeA.ms;
  result.bytesB = treeB.bytes;
  result.buildMsB = treeB.ms;
  MotionOptions options;
  double farthest = 0;
  for (const PoseMotion& motion : motions)
    farthest = std::max({farthest, motion.from.p.stableNorm(), motion.to.p.stableNorm()});
  for (const Body* body : {&a, &b}) farthest += body->sphereCenter().norm() + body->sphereRadius();
  options.tolerance =
      tolerance.value_or(std::max(1e-7 * std::min(a.sphereRadius(), b.sphereRadius()),
                                  RigidMotion::roundingTolerance(farthest)));
  if (!(options.tolerance > 0))
    options.tolerance = 1e-300;  // both bodies are single points: any tolerance will do
  options.earliest = true;
  options.trees = trees.trees;
  result.tolerance = options.tolerance;
  std::vector<RigidEdge> edges;
  for (const PoseMotion& motion : motions)
    edges.emplace_back(
        RigidMotion::spatial(motion.from, motion.to, {.position = 0, .rotation = motion.defect}));
  const MotionPair pair{&a, &b, 0, 0, 1};
  result.motions.resize(motions.size());
  result.answers = timed(motions.size(), repeat, [&](std::size_t i, QueryContext& context) {
    MotionAnswer& answer = result.motions[i];
    const std::uint64_t splits = context.counters.splits;
    answer.result = certifyMotionBy(method, edges[i], {&pair, 1}, options, context);
    answer.splits = context.counters.splits - splits;
    return answer.result.verdict == MotionVerdict::contact;
  });
  return result;
}

bool testsOverlap(QueryKind kind) {
  return kind == QueryKind::interference || kind == QueryKind::contacts;
}

const std::vector<NamedQuery>& namedQueries() {
  static const std::vector<NamedQuery> queries = {
      {"interference", QueryKind::interference, "pose,hit,bv_tests,triangle_tests"},
      {"contacts", QueryKind::contacts, "pose,a,b,px,py,pz,qx,qy,qz"},
      {"distance", QueryKind::distance, "pose,distance,ax,ay,az,bx,by,bz,nx,ny,nz"},
      {"tolerance", QueryKind::tolerance, "pose,closer"},
      {"depth", QueryKind::depth, "pose,lower,upper,dx,dy,dz,triangle_a,triangle_b"}};
  return queries;
}

}  // namespace corridor::app
