#pragma once

#include "planner/verify/box_tree.h"

namespace corridor::verify {

/// A state of a path, in either space.
struct PathState {
  RigidPose pose;             ///< SE(3)
  Vec3 xyYaw = Vec3::Zero();  ///< SE(2)
};

/// The curve of an edge by Corridor's definition, for t in [0, 1]: position linear; in SE(3) the
/// slerp of the quaternions normalised in real arithmetic, by the shorter arc; in SE(2) the yaw
/// linear, the shorter way round, and z = 0.
///
/// Rounding, u = 2^-64, t with at most 63 bits. Normalised quaternions are off by ≤ 5u each (4
/// products, 3 sums, root, quotient). |q1 − q0| and |q1 + q0| are off by ≤ 14u, so the angle Ω = 2
/// atan2 of them is by ≤ 32u. The weights sin(tΩ)/sin Ω change by ≤ 0.6 per unit of Ω while Ω ≤
/// π/2, and round by ≤ 8u; their sum is ≤ √2. Together q(t) is off by ≤ 2·5u·0.71 + 2·0.6·32u +
/// 8u·√2 + 5u < 128u, hence the rotation by an angle of ≤ 256u, the entries of its matrix round by
/// ≤ 16u, and the image of a point x in it by ≤ 400u|x| + 8u|p|. In SE(2) the yaw is off by ≤ 8u of
/// its largest summand (π rounds by u/2 of itself, and is subtracted |Δ|/2π times), sine and cosine
/// by 2u. `rounding` = 2^-50·size = 2^14 u·size covers all of it amply; so also the rounding of a
/// placement to the doubles of a RigidPose (a quaternion ≤ 2^-53, the rotation ≤ 2^-52, a position
/// ≤ 2^-53|p|).
class EdgeCurve {
 public:
  EdgeCurve(const PathState& from, const PathState& to, bool planar);

  /// The shorter way round is not unique within 1e-9 rad: the edge is nothing that could be proved.
  bool ambiguous() const { return ambiguous_; }

  struct At {
    Placement placement;
    RigidPose pose;  ///< rounded to doubles
    double yaw = 0;  ///< SE(2)
  };
  At at(Real t) const;

  /// An upper bound of the way of any point within `reach` of the reference point while t changes
  /// by `dt`: a chord of a rotation by the angle α is 2 r sin(α/2) ≤ r·α, and ≤ 2r.
  Real travel(Real dt, Real reach) const;

  /// Metres; times 2^-50 it bounds the rounding of placements, given the same `reach`.
  Real size(Real reach) const;

 private:
  using Quaternion = Eigen::Matrix<Real, 4, 1>;  ///< x, y, z, w

  bool planar_;
  bool ambiguous_ = false;
  RealVec from_, way_;           ///< position
  Quaternion q0_, q1_;           ///< SE(3): unit, q0·q1 ≥ 0
  Real omega_ = 0;               ///< SE(3): angle between them, half that of the rotation
  Real yaw_ = 0, turn_ = 0;      ///< SE(2)
  Real length_ = 0, angle_ = 0;  ///< of the whole edge, rounded up
};

}  // namespace corridor::verify
