#pragma once

#include <cstddef>
#include <vector>

#include "planner/robot/kinematic_tree.h"
#include "planner/verify/triangle_gap.h"

namespace corridor::verify {

/// The map x ↦ rotation·x + position. Its numbers are rounded; the caller bounds their error.
struct Placement {
  RealMat rotation = RealMat::Identity();
  RealVec position = RealVec::Zero();
};

/// The placement of a frame at a time t of an edge, and its velocity there. A point x, in the
/// coordinates of the base, has the velocity linear + angular × x per unit of t.
struct FrameState {
  Placement at;
  RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
};

/// The first-order perturbations of the points of a frame at one time, for all curves within the
/// tube. In the coordinates of the base, a curve displaces a point x by a sum of
/// - c·(linear + angular × x) for each twist, with any c in [−1, 1];
/// - w × (x − at) for each pivot rotation, with any vector w of length at most `angle`.
struct Perturbation {
  struct Twist {
    RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
    /// Index in a configuration. All joints that this number moves share one twist.
    std::size_t number = 0;
  };
  struct PivotRotation {
    RealVec at = RealVec::Zero();
    Real angle = 0;
  };
  std::vector<Twist> twists;
  std::vector<PivotRotation> pivots;
};

/// A kinematic chain: the joints after the frame `base`, up to and including the joint of `frame`.
struct KinematicChain {
  std::size_t base = 0, frame = 0;
  std::vector<std::size_t> path;  ///< the frames after `base`, in order; the last is `frame`
};

/// @pre `base` is `frame` or one of its ancestors.
KinematicChain chainOf(const KinematicTree& tree, std::size_t base, std::size_t frame);
std::size_t commonAncestor(const KinematicTree& tree, std::size_t a, std::size_t b);

/// Bounds on the motion of points of a frame, for all times of an edge. The points are at most
/// `radius` from the frame's origin. The weights R_j are constant (Schwarzer, Saha, Latombe 2005).
///
/// Let Δ_j be the displacement of joint j along the whole edge. Let R_j be the length of the chain
/// from joint j to the frame, plus `radius`. Let P_j = Σ |Δ_i| over the revolute joints i before j.
/// Then, with derivatives by t,
///   |x'| ≤ speed = Σ_revolute |Δ_j| R_j + Σ_prismatic |Δ_j|,
///   |x''| ≤ bend = Σ_revolute |Δ_j| R_j (|Δ_j| + 2 P_j) + Σ_prismatic 2 |Δ_j| P_j.
/// The reason: x'' is a sum over ordered pairs of joints. The term of a pair is the cross product
/// of two vectors: the rotation vector of the joint nearer to the base, and the other joint's share
/// of x'. This share is not longer than |Δ_j| R_j (revolute) or |Δ_j| (prismatic). A prismatic
/// joint moves in a straight line, so its pair with itself is zero. A perturbation of each number
/// within its tube moves x by at most
///   tube = Σ_revolute τ_j R_j + Σ_prismatic τ_j.
///
/// Second order with perturbations. Let joint j deviate by δ_j, |δ_j| ≤ τ_j, from its value at a
/// time s after t. Then the joint is s·Δ_j + δ_j away from its value at t. Let all joints move
/// linearly from their values at t to these values. This is a motion of the same kind, with
/// |s||Δ_j| + τ_j instead of |Δ_j|. (The perturbation of a free rotation is a rotation by at most τ
/// about any axis, after s·Δ. Two successive rotations about one point have the same R. They are
/// bounded like one rotation by the sum of their angles.) So x differs from its first-order value
/// by at most half of `bend`, computed with the numbers |s||Δ_j| + τ_j. `bend` is a quadratic form
/// in these numbers, hence
///   |x − x(t) − s x'(t) − Σ δ_j ∂x/∂q_j(t)| ≤ (s² bend + |s| bendCross + bendTube) / 2.
struct Reach {
  Real speed = 0, bend = 0, tube = 0;
  Real bendCross = 0;  ///< the mixed terms of Δ and τ in the quadratic form
  Real bendTube = 0;   ///< the quadratic form with τ instead of Δ
  Real size = 0;       ///< upper bound of all lengths in the pose; rounding is below 2^-50 of it
  Real lengths = 0;    ///< `size` before it is increased for large angles
};

/// Returns the shorter way round a circle, radians, in [−π, π]: the real value of to − from, minus
/// whole turns. The result is off by at most 32u, u = 2^-64, for angles of any size.
///
/// Error: if |to − from| ≤ π, the difference is rounded by at most πu. Otherwise the sines and
/// cosines of both angles are off by at most 2u, because the C library reduces its arguments with
/// enough digits of π. Sine and cosine of the difference are off by at most 11u, and their arc
/// tangent by at most 11√2·u + 2πu.
Real circleDifference(double from, double to);

/// The curve of an edge, as ConfigurationSpace defines it, in the verifier's own arithmetic. Lines
/// are linear in t. Circles go the shorter way round. Rotations are the slerp of the quaternions,
/// normalised in real arithmetic, along the shorter arc. Frames follow by forward kinematics on the
/// tree's stored doubles, with quaternions and axes normalised.
///
/// Rounding, with u = 2^-64, and t of at most 63 bits:
/// - Normalised quaternions are off by ≤ 5u each, their slerp by < 128u, the rotation by < 256u.
///   (The angle Ω = 2 atan2(|q1 − q0|, |q1 + q0|) is off by ≤ 32u. The weights of the slerp are off
///   by ≤ 0.6 times this error plus 8u.)
/// - A revolute joint's value m·q0 + o + t·m·Δ is off by ≤ 8u times `Line::terms` (products, sums
///   and the rounding of Δ). Sine, cosine and Rodrigues' matrix are off by < 16u.
/// - Each frame multiplies two such matrices into the rotation, which adds 10u. In all, a frame
/// with
///   a free rotation adds < 300u, and any other frame < 40u.
/// - With n frames a point is off by ≤ n·300u times the length of the chain. This is below
///   2^14·u·size = 2^-50·size for n ≤ 54. For larger n, `Reach::size` is increased in proportion to
///   n. `Reach::size` is also increased for large `Line::terms` of angles.
class EdgeCurve {
 public:
  EdgeCurve(const KinematicTree& tree, const std::vector<Coordinate>& coordinates,
            const Configuration& from, const Configuration& to);

  /// Returns whether the shorter way round is not unique within 1e-9 rad. Then the edge defines no
  /// curve.
  bool ambiguous() const { return ambiguous_; }
  /// Returns whether a joint would jump. Then the edge defines no curve. A joint jumps if it mimics
  /// a circle that crosses its seam at ±π, and has another pose after a full turn of the circle.
  /// Such a joint is prismatic, or revolute with a multiplier that is not a whole number.
  bool jumps() const { return jumps_; }
  FrameState at(const KinematicChain& chain, Real t) const;
  Perturbation perturbationAt(const KinematicChain& chain, Real t, const Configuration& tube) const;
  Configuration configuration(Real t) const;  ///< rounded
  Reach reach(const KinematicChain& chain, Real radius, const Configuration& tube) const;

 private:
  /// The value of a number of the configuration along the edge: from + t·way.
  struct Line {
    Real from = 0, way = 0;
    Real terms = 0;  ///< 8u·terms bounds the rounding of from + t·way
  };
  struct Arc {
    Eigen::Matrix<Real, 4, 1> q0, q1;  // x, y, z, w
    Real omega = 0;                    // angle between q0 and q1
    RealVec turn = RealVec::Zero();    // rotation vector of the whole arc, in the joint's frame
  };
  /// Computes the placement of the chain's last frame at t. Calls see(frame, X) for every joint,
  /// with X the placement before the joint.
  template <class See>
  Placement walk(const KinematicChain& chain, Real t, const See& see) const;
  const Arc& arcOf(const Frame& frame) const;
  RealMat arcAt(const Arc& arc, Real t) const;
  Line valueOf(const Frame& frame) const;

  const KinematicTree& tree_;
  const std::vector<Coordinate>& coordinates_;
  std::vector<Line> lines_;         // one per number of a configuration
  std::vector<Arc> arcs_;           // one per rotation
  std::vector<std::size_t> arcAt_;  // index in arcs_, by the rotation's first number
  bool ambiguous_ = false, jumps_ = false;
};

}  // namespace corridor::verify
