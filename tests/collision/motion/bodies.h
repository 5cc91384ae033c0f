#pragma once

#include "collision/motion/rigid_motion.h"

/// Bodies and motions that the tests of certified motions share.
namespace corridor::test {

inline void add(TriangleMesh& mesh, const Vec3& p, const Vec3& q, const Vec3& r) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {p, q, r});
  mesh.triangles.push_back({n, n + 1, n + 2});
}

inline TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.emplace_back(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                            i & 4 ? high[2] : low[2]);
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

inline MotionResult certify(const ObbTree& moving, const ObbTree& fixed, const RigidMotion& motion,
                            const MotionOptions& options, QueryContext& context) {
  const MotionPair pair{&fixed, &moving};
  RigidEdge edge(motion);
  return certifyMotion(edge, {&pair, 1}, options, context);
}

inline RigidPose at(const Vec3& p) {
  return {p, Eigen::Quaterniond::Identity()};
}

inline RigidPose turned(const Vec3& p, double angle, const Vec3& axis) {
  return {p, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()))};
}

}  // namespace corridor::test
