#include "planner/checker/rigid_state_space.h"

#include "collision/core/rounding.h"

namespace corridor {

namespace ob = ompl::base;

namespace {

// One implementation for both classes; all is read before anything is written, so that `state` may
// be either end.
template <RigidSpace space>
void interpolateStates(const ob::State* from, const ob::State* to, double t, ob::State* state) {
  writeState(space, interpolate(space, readState(space, from), readState(space, to), t), state);
}

/// OMPL normalises quaternions in passing (enforceBounds), and means the same state: 64u of angle,
/// see `inGoal`.
template <RigidSpace space>
bool equal(const ob::State* a, const ob::State* b) {
  const RigidState s = readState(space, a), t = readState(space, b);
  return s.pose.p == t.pose.p && rotationAngle(space, s, t) <= 64 * kUnit;
}

template <RigidSpace space>
double distanceOf(double weight, const ob::State* a, const ob::State* b) {
  return distance(space, weight, readState(space, a), readState(space, b));
}

}  // namespace

RigidSE3StateSpace::RigidSE3StateSpace(double rotationWeight) {
  setSubspaceWeight(1, rotationWeight);
}

void RigidSE3StateSpace::interpolate(const ob::State* from, const ob::State* to, double t,
                                     ob::State* state) const {
  interpolateStates<RigidSpace::SE3>(from, to, t, state);
}

double RigidSE3StateSpace::distance(const ob::State* a, const ob::State* b) const {
  return distanceOf<RigidSpace::SE3>(getSubspaceWeight(1), a, b);
}

bool RigidSE3StateSpace::equalStates(const ob::State* a, const ob::State* b) const {
  return equal<RigidSpace::SE3>(a, b);
}

RigidSE2StateSpace::RigidSE2StateSpace(double rotationWeight) {
  setSubspaceWeight(1, rotationWeight);
}

void RigidSE2StateSpace::interpolate(const ob::State* from, const ob::State* to, double t,
                                     ob::State* state) const {
  interpolateStates<RigidSpace::SE2>(from, to, t, state);
}

double RigidSE2StateSpace::distance(const ob::State* a, const ob::State* b) const {
  return distanceOf<RigidSpace::SE2>(getSubspaceWeight(1), a, b);
}

bool RigidSE2StateSpace::equalStates(const ob::State* a, const ob::State* b) const {
  return equal<RigidSpace::SE2>(a, b);
}

std::shared_ptr<ob::StateSpace> makeStateSpace(RigidSpace space, const Vec3& lower,
                                               const Vec3& upper, double rotationWeight) {
  const unsigned dimension = space == RigidSpace::SE3 ? 3 : 2;
  ob::RealVectorBounds bounds(dimension);
  for (unsigned i = 0; i < dimension; ++i) {
    bounds.setLow(i, lower[i]);
    bounds.setHigh(i, upper[i]);
  }
  if (space == RigidSpace::SE3) {
    auto made = std::make_shared<RigidSE3StateSpace>(rotationWeight);
    made->setBounds(bounds);
    return made;
  }
  auto made = std::make_shared<RigidSE2StateSpace>(rotationWeight);
  made->setBounds(bounds);
  return made;
}

RigidState readState(RigidSpace space, const ob::State* state) {
  RigidState values;
  if (space == RigidSpace::SE3) {
    const auto* s = state->as<ob::SE3StateSpace::StateType>();
    values.pose.p = {s->getX(), s->getY(), s->getZ()};
    values.pose.q = {s->rotation().w, s->rotation().x, s->rotation().y, s->rotation().z};
  } else {
    const auto* s = state->as<ob::SE2StateSpace::StateType>();
    values.pose.p = {s->getX(), s->getY(), 0};
    values.yaw = s->getYaw();
  }
  return values;
}

void writeState(RigidSpace space, const RigidState& values, ob::State* state) {
  if (space == RigidSpace::SE3) {
    auto* s = state->as<ob::SE3StateSpace::StateType>();
    s->setXYZ(values.pose.p.x(), values.pose.p.y(), values.pose.p.z());
    ob::SO3StateSpace::StateType& q = s->rotation();
    q.x = values.pose.q.x();
    q.y = values.pose.q.y();
    q.z = values.pose.q.z();
    q.w = values.pose.q.w();
  } else {
    auto* s = state->as<ob::SE2StateSpace::StateType>();
    s->setXY(values.pose.p.x(), values.pose.p.y());
    s->setYaw(values.yaw);
  }
}

}  // namespace corridor
