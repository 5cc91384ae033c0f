#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "collision/motion/relative_motion.h"
#include "planner/verify/verify_path.h"

namespace corridor::test {

/// Returns the surface of the box from `lower` to `upper`.
inline TriangleMesh boxMesh(const Vec3& lower, const Vec3& upper) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1 ? upper : lower).x(), (i & 2 ? upper : lower).y(),
                               (i & 4 ? upper : lower).z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh oneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

inline RigidPose poseOf(const Vec3& p, double angle = 0, const Vec3& axis = Vec3::UnitZ()) {
  return {p, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()))};
}

inline Vec3 randomVec(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

inline RigidPose randomPose(std::mt19937_64& random, double size) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return {randomVec(random, size), Eigen::Quaterniond(w, x, y, z)};
}

/// A rigid body (SE3, or SE2 with `planar`) among fixed obstacles, as a kinematic tree.
struct RigidWorld {
  KinematicTree tree;
  ConfigurationSpace space;
  std::vector<VerifyBody> moving, fixed;
  double margin = 0, tolerance = 1e-7;
  Tube tube;
  std::uint64_t workLimit = 2'000'000;
  bool obstaclesFirst = true;  ///< whether the obstacle is the first body of each pair

  explicit RigidWorld(bool planar) {
    const std::vector<std::string> lines =
        planar ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"};
    for (const std::string& name : lines) {
      Coordinate line;
      line.name = name;
      line.lower = -100;
      line.upper = 100;
      space.add(line);
    }
    Coordinate turn;
    turn.kind = planar ? Coordinate::Kind::circle : Coordinate::Kind::rotation;
    turn.name = planar ? "yaw" : "rotation";
    space.add(turn);
    Frame shift;
    shift.joint = Frame::Joint::translation;
    shift.variable = 0;
    shift.count = lines.size();
    Frame rotate;
    rotate.parent = tree.add(shift);
    rotate.joint = planar ? Frame::Joint::revolute : Frame::Joint::rotation;
    rotate.axis = Vec3::UnitZ();
    rotate.variable = lines.size();
    tree.add(rotate);
  }

  static Configuration configuration(const RigidPose& pose) {
    Configuration q(7);
    q << pose.p, pose.q.coeffs();
    return q;
  }
  static Configuration configuration(const Eigen::Vector3d& xyYaw) { return xyYaw; }

  PathProblem problem() const {
    PathProblem plain;
    plain.tree = &tree;
    plain.space = &space;
    plain.bodies = moving;
    for (VerifyBody& body : plain.bodies) body.frame = 2;
    for (const VerifyBody& body : fixed) {
      plain.bodies.push_back(body);
      for (std::size_t m = 0; m < moving.size(); ++m)
        if (const std::size_t o = plain.bodies.size() - 1; obstaclesFirst)
          plain.pairs.push_back({o, m});
        else
          plain.pairs.push_back({m, o});
    }
    plain.margin = margin;
    plain.tolerance = tolerance;
    plain.workLimit = workLimit;
    plain.tube = Configuration::Constant(static_cast<Eigen::Index>(space.size()), tube.position);
    for (const Coordinate& c : space.coordinates())
      if (c.kind != Coordinate::Kind::line)
        plain.tube[static_cast<Eigen::Index>(c.first)] = tube.rotation;
    return plain;
  }
};

template <class State>
PathReport verifyRigid(RigidWorld& world, const std::vector<State>& states) {
  std::vector<Configuration> path;
  for (const State& state : states) path.push_back(RigidWorld::configuration(state));
  return verifyPath(world.problem(), path);
}

inline RigidPose poseIn(const Configuration& q) {
  return {q.head<3>(), Eigen::Quaterniond(q[6], q[3], q[4], q[5])};
}

/// Returns triangles with edges of about `edge`, scattered over a cube of half width `size`.
inline TriangleMesh randomSoup(std::mt19937_64& random, int triangles, double size, double edge) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(triangles); ++i) {
    const Vec3 centre = randomVec(random, size);
    for (int j = 0; j < 3; ++j) mesh.vertices.push_back(centre + randomVec(random, edge));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace corridor::test
