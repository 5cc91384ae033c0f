#pragma once

#include "planner/verify/convex_gap.h"
#include "tests/planner/verify/rigid_world.h"

namespace corridor::test {

inline verify::Placement placementOf(const RigidPose& pose) {
  return {pose.q.normalized().toRotationMatrix().cast<verify::Real>(), pose.p.cast<verify::Real>()};
}

/// A tree with a joint of each kind; one joint mimics another.
struct Arm {
  KinematicTree tree;
  ConfigurationSpace space;
  std::size_t tip = 0, side = 0;

  explicit Arm(std::mt19937_64& random) {
    const auto variable = [&](Coordinate::Kind kind) {
      Coordinate c;
      c.kind = kind;
      return space.coordinates()[space.add(c)].first;
    };
    const auto frame = [&](std::size_t parent, Frame::Joint joint, std::size_t first) {
      Frame f;
      f.parent = parent;
      f.fixed = randomPose(random, 0.7);
      f.joint = joint;
      f.axis = randomVec(random, 1);
      f.variable = first;
      f.count = 3;
      return tree.add(f);
    };
    const std::size_t x = variable(Coordinate::Kind::line);
    variable(Coordinate::Kind::line), variable(Coordinate::Kind::line);
    const std::size_t q = variable(Coordinate::Kind::rotation),
                      pan = variable(Coordinate::Kind::line),
                      lift = variable(Coordinate::Kind::circle),
                      slide = variable(Coordinate::Kind::line);
    std::size_t at = frame(0, Frame::Joint::translation, x);
    at = frame(at, Frame::Joint::rotation, q);
    const std::size_t fork = at = frame(at, Frame::Joint::revolute, pan);
    at = frame(at, Frame::Joint::revolute, lift);
    tip = frame(at, Frame::Joint::prismatic, slide);
    side = frame(fork, Frame::Joint::revolute, pan);
    tree.frames[side].multiplier = -0.7;
    tree.frames[side].offset = 0.2;
  }
  Configuration random(std::mt19937_64& generator) const {
    Configuration q(static_cast<Eigen::Index>(space.size()));
    std::uniform_real_distribution<double> uniform(-1.5, 1.5);
    for (double& value : q) value = uniform(generator);
    return q;
  }
};

/// Returns a random convex set about `shift`: for the kinds 0 to 4 a sphere, a rod, a cylinder, a
/// box or a triangle.
inline verify::ConvexSet randomSet(std::mt19937_64& random, int kind, const Vec3& shift) {
  ConvexPart part;
  if (kind == 0) part = {{Vec3::Zero()}, 0.4, false};
  if (kind == 1) part = {{Vec3(0, 0, -0.35), Vec3(0, 0, 0.35)}, 0.2, false};
  if (kind == 2) part = {{Vec3(0, 0, -0.4), Vec3(0, 0, 0.4)}, 0.3, true};
  if (kind == 3)
    for (int i = 0; i < 8; ++i)
      part.points.emplace_back(i & 1 ? 0.15 : -0.15, i & 2 ? 0.3 : -0.3, i & 4 ? 0.45 : -0.45);
  if (kind == 4)
    for (int i = 0; i < 3; ++i) part.points.push_back(randomVec(random, 0.5));
  RigidPose pose = randomPose(random, 0.2);
  pose.p += shift;
  return verify::placed(part, placementOf(pose));
}

}  // namespace corridor::test
