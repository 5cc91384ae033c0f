#pragma once

#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "collision/motion/edge_method.h"
#include "collision/motion/rigid_motion.h"
#include "tests/support/meshes.h"

/// Bodies and motions that the tests of certified motions share.
namespace corridor::test {

inline Body bodyOf(TriangleMesh mesh) {
  return Body("", std::move(mesh));
}

inline MotionResult certify(const Body& moving, const Body& fixed, const RigidMotion& motion,
                            const MotionOptions& options, QueryContext& context,
                            EdgeMethod method = EdgeMethod::certified) {
  const MotionPair pair{&fixed, &moving};
  RigidEdge edge(motion);
  return certifyMotionBy(method, edge, {&pair, 1}, options, context);
}

/// What a suite that every edge method must pass is run with, and what its runs are called.
inline auto everyEdgeMethod() {
  return testing::Values(EdgeMethod::certified, EdgeMethod::adaptive, EdgeMethod::advancement);
}
inline std::string edgeMethodName(const testing::TestParamInfo<EdgeMethod>& method) {
  return edgeMethodNames().at(static_cast<std::size_t>(method.param));
}

/// Triangles about random points within `spread` of the origin.
inline TriangleMesh blob(std::mt19937_64& random, int count, double spread, double size) {
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 c = spread * Vec3(real(), real(), real());
    add(mesh, c, c + size * Vec3(real(), real(), real()), c + size * Vec3(real(), real(), real()));
  }
  return mesh;
}

/// Two poses within 2 m of the origin, most of them centimetres to metres apart, and turned as
/// much.
inline std::pair<RigidPose, RigidPose> randomEdge(std::mt19937_64& random) {
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const double length = std::pow(10.0, real(-2, 0.5));
  const RigidPose a{2 * Vec3(real(), real(), real()),
                    Eigen::Quaterniond(real(), real(), real(), real()).normalized()};
  const RigidPose b{a.p + length * Vec3(real(), real(), real()),
                    Eigen::Quaterniond(Eigen::AngleAxisd(
                        length * real(), Vec3(real(), real(), real()).normalized())) *
                        a.q};
  return {a, b};
}

inline RigidPose at(const Vec3& p) {
  return {p, Eigen::Quaterniond::Identity()};
}

inline RigidPose turned(const Vec3& p, double angle, const Vec3& axis) {
  return {p, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()))};
}

}  // namespace corridor::test
