#pragma once

#include <utility>

#include "collision/motion/rigid_motion.h"
#include "tests/support/meshes.h"

/// Bodies and motions that the tests of certified motions share.
namespace corridor::test {

inline Body bodyOf(TriangleMesh mesh) {
  return Body("", std::move(mesh));
}

inline MotionResult certify(const Body& moving, const Body& fixed, const RigidMotion& motion,
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
