#pragma once

#include <memory>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include "collision/world/scene.h"
#include "planner/checker/rigid_checker.h"
#include "planner/checker/rigid_state_space.h"

namespace corridor::test {

/// The surface of a box with these edge lengths, about the origin of its frame at `at`.
inline TriangleMesh boxMesh(const Vec3& size, const Vec3& at = Vec3::Zero()) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(at + 0.5 * size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A bar of 1 × 0.2 × 0.2 in a hall of [−5, 5]³ with a wall of 0.001 at x = 0 that has a gap above y = 2.
struct Hall {
  explicit Hall(RigidSpace kind) : space(kind), scene(makeScene()), checker(scene, kind, Vec3::Constant(-5), Vec3::Constant(5), options(scene)) {
    si = std::make_shared<ompl::base::SpaceInformation>(makeStateSpace(kind, Vec3::Constant(-5), Vec3::Constant(5), 1));
  }

  static Scene makeScene() {
    std::vector<Body> moving, fixed;
    moving.emplace_back("bar", boxMesh({1, 0.2, 0.2}));
    fixed.emplace_back("wall", boxMesh({0.001, 7, 10}, {0, -1.5, 0}));
    return Scene(std::move(moving), std::move(fixed));
  }
  static MotionOptions options(const Scene& scene) {
    MotionOptions motion;
    motion.tolerance = scene.defaultTolerance();
    motion.tube = {1e-11, 1e-11};
    return motion;
  }
  RigidState at(double x, double y, double yaw = 0) const {
    RigidState state;
    state.pose.p = {x, y, 0};
    if (space == RigidSpace::SE3)
      state.pose.q = Eigen::AngleAxisd(yaw, Vec3::UnitZ());
    else
      state.yaw = yaw;
    return state;
  }
  ompl::base::ScopedState<> scoped(const RigidState& values) const {
    ompl::base::ScopedState<> state(si);
    writeState(space, values, state.get());
    return state;
  }

  RigidSpace space;
  Scene scene;
  RigidChecker checker;
  ompl::base::SpaceInformationPtr si;
};

}  // namespace corridor::test
