#include "planner/checker/rigid_checker.h"

#include <cmath>

namespace corridor {

RigidChecker::RigidChecker(const Scene& scene, RigidSpace space, const Vec3& lower,
                           const Vec3& upper, const MotionOptions& options)
    : scene_(scene), space_(space), lower_(lower), upper_(upper), options_(options) {
  options_.earliest = false;
}

bool RigidChecker::inBounds(const RigidState& state) const {
  // In this form NaN is outside.
  for (int i = 0; i < (space_ == RigidSpace::SE3 ? 3 : 2); ++i)
    if (!(state.pose.p[i] >= lower_[i] && state.pose.p[i] <= upper_[i])) return false;
  if (space_ == RigidSpace::SE2) return std::isfinite(state.yaw);
  const double norm = state.pose.q.norm();
  return norm > 0 && std::isfinite(norm);
}

MotionResult RigidChecker::state(const RigidState& at) const {
  return space_ == RigidSpace::SE3
             ? scene_.certifyState(at.pose, options_, contexts_.mine())
             : scene_.certifyStatePlanar(at.xyYaw(), options_, contexts_.mine());
}

MotionResult RigidChecker::edge(const RigidState& from, const RigidState& to, bool earliest) const {
  MotionOptions options = options_;
  options.earliest = earliest;
  return space_ == RigidSpace::SE3
             ? scene_.certifyEdge(from.pose, to.pose, options, contexts_.mine())
             : scene_.certifyEdgePlanar(from.xyYaw(), to.xyYaw(), options, contexts_.mine());
}

std::optional<Contact> RigidChecker::interference(const RigidState& at) const {
  QueryContext& context = contexts_.mine();
  const std::uint64_t before = context.counters.states;
  const std::optional<Contact> contact = scene_.interference(placement(space_, at), context);
  context.counters.states = before + 1;  // the scene counts pairs of bodies
  return contact;
}

bool RigidChecker::certifiedState(const RigidState& at) const {
  return inBounds(at) && state(at).verdict == MotionVerdict::free;
}

bool RigidChecker::certifiedEdge(const RigidState& from, const RigidState& to) const {
  return inBounds(from) && inBounds(to) && edge(from, to, false).verdict == MotionVerdict::free;
}

}  // namespace corridor
