#pragma once

#include <memory>

#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>

#include "planner/checker/rigid_state.h"

namespace corridor {

/// OMPL's SE(3) with Corridor's edges: `interpolate`, `distance` and `equalStates` as in
/// rigid_state.h. OMPL 1.5.2's own return `from` for rotations under 9e-5 rad, even at t = 1, take
/// them for distance 0, and flip the way near half turns on a last bit.
class RigidSE3StateSpace : public ompl::base::SE3StateSpace {
 public:
  explicit RigidSE3StateSpace(double rotationWeight);
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  bool equalStates(const ompl::base::State* a, const ompl::base::State* b) const override;
};

/// The same for SE(2). Yaws that come out are in [−π, π].
class RigidSE2StateSpace : public ompl::base::SE2StateSpace {
 public:
  explicit RigidSE2StateSpace(double rotationWeight);
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  bool equalStates(const ompl::base::State* a, const ompl::base::State* b) const override;
};

/// One of the two, with bounds of the reference point (SE2: x and y).
/// @throws ompl::Exception where a bound isn't lower < upper.
std::shared_ptr<ompl::base::StateSpace> makeStateSpace(RigidSpace space, const Vec3& lower,
                                                       const Vec3& upper, double rotationWeight);

RigidState readState(RigidSpace space, const ompl::base::State* state);
void writeState(RigidSpace space, const RigidState& values, ompl::base::State* state);

}  // namespace corridor
