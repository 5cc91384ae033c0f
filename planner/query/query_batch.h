#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "collision/course/body_depth.h"
#include "collision/course/test_costs.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/motion/edge_method.h"
#include "collision/queries/distance.h"
#include "planner/query/query_poses.h"

/// The queries of `corridor query`, and batches of queries that are timed. Volumes and overlap
/// tests are those of hierarchy/tree_kinds.h.
namespace corridor::app {

/// The kind of query that is run at every pose.
enum class QueryKind { interference, contacts, distance, tolerance, depth };
/// Returns whether the query tests volumes for overlap, so that the choice of an overlap test
/// matters. The other queries compute how far volumes are apart.
bool testsOverlap(QueryKind kind);
/// A kind of query, as users choose it and as its results are printed.
struct NamedQuery {
  std::string name;
  QueryKind kind;
  std::string header;  ///< the first line of its CSV
};
const std::vector<NamedQuery>& namedQueries();

/// One query of two meshes at many poses of b, with a at the identity.
struct Batch {
  const TriangleMesh &a, &b;
  const std::vector<Transform>& poses;
  QueryKind kind = QueryKind::interference;
  std::optional<TreeChoice> trees = TreeChoice{};  ///< unset: octrees, for interference only
  double tolerance = 0;                            ///< metres, for `QueryKind::tolerance` only
  int repeat = 1;                                  ///< passes over all poses
  /// Indices of the poses at which the cost of a single test of volumes and of triangles is
  /// measured, too. This is done for interference queries only. It is not done for the volume obb,
  /// whose kernel tests many pairs at once, nor for octrees.
  std::vector<std::size_t> measured = {};
};

/// The answer and the cost of one pose or motion.
struct Answer {
  bool hit = false;
  std::uint64_t boxTests = 0, primitiveTests = 0;
  double ns = 0;  ///< the median of the passes
};
/// One pair of triangles that touch at a pose, and the segment p, q that they share.
struct ContactRow {
  std::size_t pose;
  std::uint32_t a, b;
  Vec3 p, q;
};
/// The answer for one motion.
struct MotionAnswer {
  MotionResult result;
  std::uint64_t splits = 0;  ///< time intervals that were halved
};
struct BatchResult {
  std::vector<Answer> answers;      ///< per pose or motion; `hit`: contact, or within the tolerance
  std::vector<Distance> distances;  ///< per pose, only for `QueryKind::distance`
  std::vector<DepthBounds> depths;  ///< per pose, only for `QueryKind::depth`
  std::vector<ContactRow> contacts;   ///< only for `QueryKind::contacts`
  std::vector<MotionAnswer> motions;  ///< per motion
  double tolerance = 0;               ///< metres, for motions: the tolerance used
  TestCosts tests;                    ///< of the tests at `Batch::measured`
  double buildMsA = 0, buildMsB = 0;
  std::size_t bytesA = 0, bytesB = 0;
};

/// Builds both trees and runs the query at all poses, measuring each.
BatchResult runPoses(const Batch& batch);

/// The answers for one shape of a mesh that deforms.
struct FrameResult {
  BatchResult result;  ///< only the first frame's has the trees' build times and sizes
  double refitMs = 0;  ///< 0 for the first frame, whose tree is built
};
/// Returns the next shape of a, or nullopt if there is none.
using NextShape = std::function<std::optional<TriangleMesh>()>;
/// Runs the query at all poses for each shape of a: first `batch.a`, for which the tree is built,
/// then the shapes that `next` returns, to which the same tree is refitted.
/// @pre Every shape has as many triangles as `batch.a`, and no fault (`checkMesh`). The trees are
/// not octrees, which can't be refitted.
std::vector<FrameResult> runFrames(const Batch& batch, const NextShape& next);

/// Computes bounds of the penetration depth at all poses, with the 4-wide and the binary OBB trees,
/// which depth queries need.
/// @param direction the direction in which b leaves a; unset: the default of `DepthOptions`.
BatchResult runDepths(TriangleMesh a, TriangleMesh b, const std::vector<Transform>& poses,
                      const std::optional<Vec3>& direction, int repeat);

/// Computes the first contact along each motion of b, with a at rest, and measures it.
/// @param tolerance metres; unset: the larger of 1e-7 times the radius of the smaller bounding
/// sphere and `RigidMotion::roundingTolerance`.
BatchResult runMotions(TriangleMesh a, TriangleMesh b, const std::vector<PoseMotion>& motions,
                       const TreeChoice& trees, std::optional<double> tolerance, int repeat,
                       EdgeMethod method);

}  // namespace corridor::app
