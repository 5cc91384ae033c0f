#pragma once

#include <algorithm>
#include <random>
#include <span>
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

/// A way to prove a motion: a method, and the kind of trees that it uses.
struct Proof {
  EdgeMethod method = EdgeMethod::certified;
  TreeKind trees = TreeKind::obb4;

  Proof() = default;
  Proof(EdgeMethod method_, TreeKind trees_ = TreeKind::obb4) : method(method_), trees(trees_) {}

  MotionResult operator()(MotionSource& motion, std::span<const MotionPair> pairs,
                          MotionOptions options, QueryContext& context) const {
    options.trees = trees;
    return certifyMotionBy(method, motion, pairs, options, context);
  }
};

inline MotionResult certify(const Body& moving, const Body& fixed, const RigidMotion& motion,
                            const MotionOptions& options, QueryContext& context,
                            const Proof& proof = {}) {
  const MotionPair pair{&fixed, &moving};
  RigidEdge edge(motion);
  return proof(edge, {&pair, 1}, options, context);
}

/// Returns the parameters of the suite that every way to prove motions must pass: all methods on
/// the default trees, the default method also on other kinds of trees, and `adaptive` also on trees
/// of spheres.
inline auto everyProof() {
  using enum EdgeMethod;
  return testing::Values(Proof(certified), Proof(adaptive), Proof(advancement),
                         Proof(certified, TreeKind::obbBinary), Proof(certified, TreeKind::obbGjk),
                         Proof(certified, TreeKind::aabb), Proof(certified, TreeKind::sphere),
                         Proof(certified, TreeKind::rss), Proof(certified, TreeKind::kdop18),
                         Proof(adaptive, TreeKind::sphere));
}
/// Returns the name of a kind of trees as part of a test's name, for example "obb_binary_gjk".
inline std::string treeName(TreeKind trees) {
  std::string name;
  for (const VolumeKind& kind : volumeKinds())
    for (const std::string& overlap : kind.overlaps)
      if (treesNamed({kind.name, "", overlap}).trees == trees)
        name = kind.name + (overlap == kind.overlaps.front() ? "" : "_" + overlap);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
inline std::string proofName(const testing::TestParamInfo<Proof>& proof) {
  return edgeMethodNames().at(static_cast<std::size_t>(proof.param.method)) + "_" +
         treeName(proof.param.trees);
}

/// Draws a vector whose coordinates are in [-1, 1]. The order in which the coordinates are drawn is
/// fixed. If the coordinates were drawn as arguments of one call, the order would depend on the
/// compiler.
inline Vec3 randomInCube(std::mt19937_64& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  const double z = real(random), y = real(random), x = real(random);
  return {x, y, z};
}

/// Returns triangles with one corner at a random point of the cube [−spread, spread]³. The
/// coordinates of the other two corners differ from those of this point by at most `size`.
inline TriangleMesh blob(std::mt19937_64& random, int count, double spread, double size) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 c = spread * randomInCube(random);
    const Vec3 r = c + size * randomInCube(random);
    const Vec3 q = c + size * randomInCube(random);
    add(mesh, c, q, r);
  }
  return mesh;
}

/// Returns two poses. The first position is in a cube, with coordinates of at most 2 m. In most
/// cases the positions differ by centimetres to metres, and the rotations by hundredths of a radian
/// to some radians.
inline std::pair<RigidPose, RigidPose> randomEdge(std::mt19937_64& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  const double length = std::pow(10.0, std::uniform_real_distribution(-2.0, 0.5)(random));
  RigidPose a, b;
  a.p = 2 * randomInCube(random);
  const double z = real(random), y = real(random), x = real(random), w = real(random);
  a.q = Eigen::Quaterniond(w, x, y, z).normalized();
  b.p = a.p + length * randomInCube(random);
  const Vec3 axis = randomInCube(random).normalized();
  b.q = Eigen::Quaterniond(Eigen::AngleAxisd(length * real(random), axis)) * a.q;
  return {a, b};
}

inline RigidPose at(const Vec3& p) {
  return {p, Eigen::Quaterniond::Identity()};
}

inline RigidPose turned(const Vec3& p, double angle, const Vec3& axis) {
  return {p, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()))};
}

}  // namespace corridor::test
