#pragma once

#include <cstddef>
#include <vector>

#include "planner/robot/kinematic_tree.h"
#include "planner/verify/triangle_gap.h"

namespace corridor::verify {

/// The map x ↦ rotation·x + position, rounded; the caller knows by how much.
struct Placement {
  RealMat rotation = RealMat::Identity();
  RealVec position = RealVec::Zero();
};

/// Where a frame is at a time t of an edge, and how it moves there: a point x (in the coordinates
/// of the base) has the velocity linear + angular × x per unit of t.
struct FrameState {
  Placement at;
  RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
};

/// What strays from a curve within its tube do to the points of a frame, to first order; in the
/// coordinates of the base, at a time. A point x moves by Σ over the twists of c·(linear + angular
/// × x), each c anywhere in [−1, 1], and by Σ over the pivots of w × (x − at), each w any vector of
/// at most `angle`.
struct Strays {
  struct Twist {
    RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
    std::size_t number = 0;  ///< of the configuration: the joints that follow it stray as one
  };
  struct Pivot {
    RealVec at = RealVec::Zero();
    Real angle = 0;
  };
  std::vector<Twist> twists;
  std::vector<Pivot> pivots;
};

/// A frame as seen from one of its ancestors: the joints from `base`, which are not counted, to
/// `frame`.
struct Limb {
  std::size_t base = 0, frame = 0;
  std::vector<std::size_t> path;  ///< frames after `base`, in order, `frame` the last
};

/// @pre `base` is `frame` or one of its ancestors.
Limb limbOf(const KinematicTree& tree, std::size_t base, std::size_t frame);
std::size_t commonAncestor(const KinematicTree& tree, std::size_t a, std::size_t b);

/// What points of a frame, at most `radius` from its origin, can do along an edge, whatever the
/// time: constant reach weights (Schwarzer, Saha, Latombe 2005). With Δ_j what joint j does in all
/// of the edge, R_j the length of the chain from joint j to the frame plus `radius`, P_j = Σ |Δ_i|
/// of the turns before j:
///   |x'| ≤ speed = Σ_turns |Δ_j| R_j + Σ_slides |Δ_j|, per unit of t;
///   |x''| ≤ bend = Σ_turns |Δ_j| R_j (|Δ_j| + 2 P_j) + Σ_slides 2 |Δ_j| P_j,
/// since x'' is a sum over ordered pairs of joints, of the first's rotation vector times (the
/// second's share of x'), the second's share not longer than |Δ_j| R_j, and slides in a straight
/// line have none of their own. A stray of each variable within its tube moves x by at most `tube`
/// = Σ_turns τ_j R_j + Σ_slides τ_j.
///
/// Let joint j stray by δ_j from where it is at a time s after t, all |δ_j| ≤ τ_j: from its value
/// at t it is s·Δ_j + δ_j away. Going there from t in a straight line, all joints at once, is a
/// motion of the same kind with |s||Δ_j| + τ_j in place of |Δ_j|. (A rotation's stray is a turn by
/// at most τ about any axis, after the s·Δ: two turns one after the other about one point, with the
/// same R, add up like one.) So x is off its first order by at most half of `bend` with those,
/// which is a quadratic form in them:
///   |x − x(t) − s x'(t) − Σ δ_j ∂x/∂q_j(t)| ≤ (s² bend + |s| bendCross + bendTube) / 2.
struct Reach {
  Real speed = 0, bend = 0, tube = 0;
  Real bendCross = 0;  ///< twice the bilinear form of Δ and τ
  Real bendTube = 0;   ///< the form of τ
  Real size = 0;       ///< bounds every length that enters the pose; rounding is 2^-50 of it
  Real lengths = 0;    ///< `size` without what large angles add to it
};

/// The shorter way round a circle, radians, in [−π, π]: to − from in real arithmetic on the two
/// doubles, less whole turns. Off by at most 32u, u = 2^-64, however many turns the two are.
///
/// Where |to − from| ≤ π the difference rounds by πu. Otherwise the sines and cosines of both are
/// within 2u (the C library reduces their arguments with as many digits of π as they need), those
/// of the difference within 11u, and the arc tangent of these within 11√2·u + 2πu.
Real circleWay(double from, double to);

/// The curve of an edge by Corridor's definition, in the verifier's own arithmetic: lines linear in
/// t, circles the shorter way round, rotations by slerp of the quaternions normalised in real
/// arithmetic, by the shorter arc; frames by forward kinematics on the tree's stored doubles,
/// quaternions and axes normalised.
///
/// Rounding, u = 2^-64, t with at most 63 bits. Normalised quaternions are off by ≤ 5u each, their
/// slerp by < 128u (angle Ω = 2 atan2 of |q1 − q0| and |q1 + q0|, off by ≤ 32u; weights by ≤ 0.6
/// per unit of Ω and 8u), the rotation by < 256u. A turn by m·q0 + o + t·m·Δ is off by ≤ 8u times
/// `Line::terms` (products, sums and the rounding of Δ), sine, cosine and Rodrigues' matrix by
/// < 16u. A frame multiplies two such into the rotation, 10u more: < 300u a frame for rotations,
/// < 40u a frame else. With n frames a point is off by ≤ n·300u times the lengths that come after:
/// below 2^14·u·size = 2^-50·size for n ≤ 54; `Reach::size` grows with n beyond that, and with
/// the terms of angles.
class EdgeCurve {
 public:
  EdgeCurve(const KinematicTree& tree, const std::vector<Coordinate>& coordinates,
            const Configuration& from, const Configuration& to);

  /// The shorter way round is not unique within 1e-9 rad: the edge defines no curve.
  bool ambiguous() const { return ambiguous_; }
  /// A circle goes round through its seam, and a joint that mimics it does not come round with it
  /// (a slide, or a turn by a multiplier that is no whole number): the edge defines no curve, since
  /// that joint would jump.
  bool jumps() const { return jumps_; }
  FrameState at(const Limb& limb, Real t) const;
  Strays straysAt(const Limb& limb, Real t, const Configuration& tube) const;
  Configuration configuration(Real t) const;  ///< rounded
  Reach reach(const Limb& limb, Real radius, const Configuration& tube) const;

 private:
  /// What a coordinate does: number from + t·way; a rotation by slerp.
  struct Line {
    Real from = 0, way = 0;
    Real terms = 0;  ///< 8u of it bounds the rounding of from + t·way
  };
  struct Arc {
    Eigen::Matrix<Real, 4, 1> q0, q1;  // x, y, z, w
    Real omega = 0;                    // between them
    RealVec turn = RealVec::Zero();    // rotation vector of the whole, in the joint's frame
  };
  /// The way along the limb at t. Calls see(frame, X) at every joint, X being the place before it
  /// moves. @returns where the way ends.
  template <class See>
  Placement walk(const Limb& limb, Real t, const See& see) const;
  const Arc& arcOf(const Frame& frame) const;
  RealMat arcAt(const Arc& arc, Real t) const;
  Line valueOf(const Frame& frame) const;

  const KinematicTree& tree_;
  const std::vector<Coordinate>& coordinates_;
  std::vector<Line> lines_;         // a number of a configuration each
  std::vector<Arc> arcs_;           // a coordinate each; empty but for rotations
  std::vector<std::size_t> arcAt_;  // of the first number of a rotation
  bool ambiguous_ = false, jumps_ = false;
};

}  // namespace corridor::verify
