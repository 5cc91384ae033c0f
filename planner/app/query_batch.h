#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/motion/edge_method.h"
#include "collision/queries/distance.h"
#include "planner/app/query_poses.h"

/// What `corridor query` can ask (of which trees: hierarchy/tree_kinds.h), and the batch that is
/// timed.
namespace corridor::app {

/// What is asked of every pose.
enum class Asked { interference, contacts, distance, tolerance };
/// Does it ask whether volumes overlap, so that `Batch::overlap` is a choice? The others ask how
/// far apart they are.
bool testsOverlap(Asked asked);
struct QueryKind {
  std::string name;
  Asked asked;
  std::string header;  ///< of its CSV
};
const std::vector<QueryKind>& queryKinds();

/// What a batch is: two meshes, poses of b with a at the identity, and the trees that are asked.
struct Batch {
  const TriangleMesh &a, &b;
  const std::vector<Transform>& poses;
  Asked asked = Asked::interference;
  TreeChoice trees;
  double tolerance = 0;  ///< metres, of `Asked::tolerance`
  int repeat = 1;
};

/// A pose's answer and cost.
struct Answer {
  bool hit = false;
  std::uint64_t boxTests = 0, triangleTests = 0;
  double ns = 0;  ///< the median of the repeats
};
/// One contact of a pose.
struct ContactRow {
  std::size_t pose;
  std::uint32_t a, b;
  Vec3 p, q;
};
/// A motion's answer.
struct MotionAnswer {
  MotionResult result;
  std::uint64_t splits = 0;  ///< windows of time that were halved
};
struct BatchResult {
  std::vector<Answer> answers;        ///< by pose; a hit is a contact, or closer than the tolerance
  std::vector<Distance> distances;    ///< by pose, of `Asked::distance`
  std::vector<ContactRow> contacts;   ///< of `Asked::contacts`
  std::vector<MotionAnswer> motions;  ///< by motion
  double tolerance = 0;               ///< metres, of motions
  double buildMsA = 0, buildMsB = 0;
  std::size_t bytesA = 0, bytesB = 0;
};

/// Builds the trees and asks them.
BatchResult runPoses(const Batch& batch);

/// The first contact of motions of b, a at rest.
/// @param tolerance metres; unset: 1e-7 of the smaller one's radius, or what the
/// rounding of the poses needs, if that is larger.
BatchResult runMotions(TriangleMesh a, TriangleMesh b, const std::vector<PoseMotion>& motions,
                       const TreeChoice& trees, std::optional<double> tolerance, int repeat,
                       EdgeMethod method);

}  // namespace corridor::app
