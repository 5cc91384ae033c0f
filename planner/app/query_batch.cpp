#include "planner/app/query_batch.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <type_traits>
#include <utility>

#include "collision/motion/rigid_motion.h"
#include "collision/queries/contacts.h"
#include "collision/queries/distance_wide.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_wide.h"
#include "collision/volumes/pair_tests.h"
#include "planner/app/query_timing.h"

namespace corridor::app {
namespace {

/// `batch.fit` is one of its volume's names (`volumeKinds`).
ObbFit fitOf(const Batch& batch) {
  return obbFitNamed(batch.fit).value_or(ObbFit::triangles);
}

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

/// All poses of a batch in memory, asked one after the other, `passes` times over: passes over all
/// poses rather than repeats of each, so that a query finds the caches that other poses left.
/// `ask(pose number, context)` of these two trees is all that is timed. What is told of a pose is
/// its own: nothing is remembered of the answers to others.
template <class Tree, class Ask>
std::vector<Answer> timed(std::size_t count, int passes, const Tree& a, const Tree& b,
                          const Ask& ask) {
  std::vector<Answer> answers(count);
  const auto repeat = static_cast<std::size_t>(passes);
  std::vector<double> ns(answers.size() * repeat);
  QueryContext context;
  LastPair& last = context.lastPairs.of(&a, &b);
  for (std::size_t pass = 0; pass < repeat; ++pass)
    for (std::size_t i = 0; i < answers.size(); ++i) {
      Answer& answer = answers[i];
      const auto once = [&] {
        last = {};
        answer.hit = ask(i, context);
      };
      const auto first = [&] {
        context.counters = {};
        once();
        answer.boxTests = context.counters.boxTests;
        answer.triangleTests = context.counters.triangleTests;
      };
      ns[i * repeat + pass] = nanosecondsOf(first, once);
    }
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto begin = ns.begin() + static_cast<std::ptrdiff_t>(i * repeat);
    answers[i].ns = median(std::vector<double>(begin, begin + passes));
  }
  return answers;
}

/// The first contact and all of them, by an overlap test where the tree has a choice.
template <class Overlap, class Tree>
bool touching(const Tree& a, const Tree& b, const Transform& X, QueryContext& context) {
  if constexpr (std::is_same_v<Tree, ObbTree>)
    return interference<Overlap>(a, {}, b, X, context).has_value();
  else
    return interference(a, {}, b, X, context).has_value();
}
template <class Overlap, class Tree>
std::vector<TriangleContact> allContacts(const Tree& a, const Tree& b, const Transform& X,
                                         QueryContext& context) {
  if constexpr (std::is_same_v<Tree, ObbTree>)
    return contacts<Overlap>(a, {}, b, X, context);
  else
    return contacts(a, {}, b, X, context);
}

/// Builds both trees (`make(mesh)`) and asks them.
template <class Overlap = StandardOverlap, class Make>
BatchResult runOn(const Batch& batch, const Make& make) {
  BatchResult result;
  auto start = std::chrono::steady_clock::now();
  const auto a = make(batch.a);
  result.buildMsA = millisecondsSince(start);
  start = std::chrono::steady_clock::now();
  const auto b = make(batch.b);
  result.buildMsB = millisecondsSince(start);
  result.bytesA = a.bytes();
  result.bytesB = b.bytes();
  const Transform X_WA;
  switch (batch.asked) {
    case Asked::interference:
      result.answers =
          timed(batch.poses.size(), batch.repeat, a, b, [&](std::size_t i, QueryContext& context) {
            return touching<Overlap>(a, b, batch.poses[i], context);
          });
      break;
    case Asked::distance:
      result.distances.resize(batch.poses.size());
      result.answers =
          timed(batch.poses.size(), batch.repeat, a, b, [&](std::size_t i, QueryContext& context) {
            result.distances[i] = distance(a, X_WA, b, batch.poses[i], {}, context);
            return result.distances[i].distance == 0;
          });
      break;
    case Asked::tolerance:
      result.answers =
          timed(batch.poses.size(), batch.repeat, a, b, [&](std::size_t i, QueryContext& context) {
            return closerThan(a, X_WA, b, batch.poses[i], batch.tolerance, context);
          });
      break;
    case Asked::contacts: {
      std::vector<std::vector<TriangleContact>> found(batch.poses.size());
      result.answers =
          timed(batch.poses.size(), batch.repeat, a, b, [&](std::size_t i, QueryContext& context) {
            found[i] = allContacts<Overlap>(a, b, batch.poses[i], context);
            return !found[i].empty();
          });
      for (std::size_t i = 0; i < found.size(); ++i)
        for (const TriangleContact& c : found[i])
          result.contacts.push_back({i, c.a, c.b, c.p_W, c.q_W});
      break;
    }
  }
  return result;
}

/// Volumes without axes of their own have one fit, `plain`.
template <class Volume, class Overlap = StandardOverlap>
BatchResult runVolume(const Batch& batch) {
  return runOn<Overlap>(
      batch, [&](const TriangleMesh& mesh) { return VolumeTree<Volume>(mesh, {fitOf(batch)}); });
}

BatchResult runObb(const Batch& batch) {
  return batch.overlap == "gjk"         ? runVolume<Obb, Gjk>(batch)
         : batch.overlap == "lp"        ? runVolume<Obb, LinearProgram>(batch)
         : batch.overlap == "edge-face" ? runVolume<Obb, EdgeFace>(batch)
                                        : runVolume<Obb>(batch);
}

BatchResult runWide(const Batch& batch) {
  return runOn(batch, [&](const TriangleMesh& mesh) { return WideObbTree(mesh, fitOf(batch)); });
}

}  // namespace

BatchResult runMotions(TriangleMesh meshA, TriangleMesh meshB,
                       const std::vector<PoseMotion>& motions, const std::string& fit,
                       std::optional<double> tolerance, int repeat, EdgeMethod method) {
  BatchResult result;
  const TreeParams params{obbFitNamed(fit).value_or(ObbFit::triangles)};
  const Body a("A", std::move(meshA), false, params), b("B", std::move(meshB), false, params);
  auto start = std::chrono::steady_clock::now();
  result.bytesA = a.tree().bytes();
  result.buildMsA = millisecondsSince(start);
  start = std::chrono::steady_clock::now();
  result.bytesB = b.tree().bytes();
  result.buildMsB = millisecondsSince(start);
  MotionOptions options;
  options.tolerance = tolerance.value_or(1e-7 * std::min(a.sphereRadius(), b.sphereRadius()));
  if (!(options.tolerance > 0)) options.tolerance = 1e-300;  // a single point; any will do
  options.earliest = true;
  result.tolerance = options.tolerance;
  std::vector<RigidEdge> edges;
  for (const PoseMotion& motion : motions)
    edges.emplace_back(RigidMotion::spatial(motion.from, motion.to, {}));
  const MotionPair pair{&a, &b, 0, 0, 1};
  result.motions.resize(motions.size());
  result.answers =
      timed(motions.size(), repeat, a.tree(), b.tree(), [&](std::size_t i, QueryContext& context) {
        MotionAnswer& answer = result.motions[i];
        const std::uint64_t splits = context.counters.splits;
        answer.result = certifyMotionBy(method, edges[i], {&pair, 1}, options, context);
        answer.splits = context.counters.splits - splits;
        return answer.result.verdict == MotionVerdict::contact;
      });
  return result;
}

bool testsOverlap(Asked asked) {
  return asked == Asked::interference || asked == Asked::contacts;
}

const std::vector<QueryKind>& queryKinds() {
  static const std::vector<QueryKind> kinds = {
      {"interference", Asked::interference, "pose,hit,bv_tests,triangle_tests"},
      {"contacts", Asked::contacts, "pose,a,b,px,py,pz,qx,qy,qz"},
      {"distance", Asked::distance, "pose,distance,ax,ay,az,bx,by,bz"},
      {"tolerance", Asked::tolerance, "pose,closer"}};
  return kinds;
}

const std::vector<VolumeKind>& volumeKinds() {
  static const std::vector<VolumeKind> kinds = {
      {"obb", {"triangles", "vertices", "hull"}, {"sat"}, runWide},
      {"obb-binary", {"triangles", "vertices", "hull"}, {"sat", "gjk", "lp", "edge-face"}, runObb},
      {"aabb", {"plain"}, {"sat"}, runVolume<Aabb>},
      {"sphere", {"plain"}, {"centers"}, runVolume<BoundingSphere>},
      {"rss", {"triangles", "vertices", "hull"}, {"rectangles"}, runVolume<Rss>},
      {"kdop14", {"plain"}, {"intervals"}, runVolume<Kdop<14>>},
      {"kdop18", {"plain"}, {"intervals"}, runVolume<Kdop<18>>},
      {"kdop26", {"plain"}, {"intervals"}, runVolume<Kdop<26>>}};
  return kinds;
}

}  // namespace corridor::app
