#pragma once

#include "collision/core/transform.h"
#include "collision/motion/rigid_motion.h"
#include "planner/problem/problem.h"

namespace corridor {

/// A state of a rigid body's space as plain values. SE3: `pose`. SE2: pose.p = (x, y, 0) and `yaw`;
/// pose.q is not looked at. Metres, radians.
struct RigidState {
  RigidPose pose;
  double yaw = 0;

  Vec3 xyYaw() const { return {pose.p.x(), pose.p.y(), yaw}; }
};

/// The state on Corridor's edge (design: «What an edge is») at t in [0, 1], to a few ulp at every
/// angle, half turns excepted, where the way is ambiguous and either is taken. Bit for bit `from`
/// at 0 and `to` at 1 (a yaw outside [−π, π] excepted: it comes back inside), and never outside the
/// box of the two positions. Quaternions need not have norm 1.
RigidState interpolate(RigidSpace space, const RigidState& from, const RigidState& to, double t);

/// Metres + weight × radians: |Δp| + weight·(angle between the quaternions, half that of the
/// rotation) in SE3; |Δp| + weight·|Δyaw|, the shorter way round, in SE2. 0 only for equal states.
double distance(RigidSpace space, double rotationWeight, const RigidState& a, const RigidState& b);

/// The angle of the rotation that leads from a to b, radians in [0, π].
double rotationAngle(RigidSpace space, const RigidState& a, const RigidState& b);

/// The way from a to b is a half turn within 1e-9 rad, so that the shorter one is not unique: no
/// edge (design: «What an edge is»).
bool ambiguous(RigidSpace space, const RigidState& a, const RigidState& b);

/// x ↦ R x + p, rounded.
Transform placement(RigidSpace space, const RigidState& state);

}  // namespace corridor
