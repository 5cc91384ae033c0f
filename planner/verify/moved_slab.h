#pragma once

#include <vector>

#include "planner/verify/body_tree.h"

namespace corridor::verify {

/// The motion of a body's points around the middle of a time interval, to first order. The
/// coordinate system is fixed during the interval. A point x has the velocity linear + angular × x
/// per unit of t. The tube displaces it by `perturbation`.
struct BodyMotion {
  RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
  Perturbation perturbation;  ///< empty if the caller bounds the tube by other means
};

/// Converts the motion of a frame from the coordinates of its chain's base (`state`,
/// `perturbation`) to those of a frame that has the placement `at` in the base.
/// @pre `state` and `perturbation` belong to the same kinematic chain, at the same t.
BodyMotion motionSeenFrom(const Placement& at, const FrameState& state, Perturbation perturbation);

/// The width of the slab between two moving bodies along a direction n, to first order of the
/// motion. The width is a lower bound of their distance in the whole interval and tube, except for
/// second-order terms, which Reach bounds. The direction n is fixed in the coordinates in which the
/// bodies move, or turns with one of the bodies.
///
/// Points. A core point is a point of the body without its swept sphere. Let it be at x at the
/// middle. At a time s from the middle, |s| ≤ half, it is at
///   x + s·v(x) + Σ c_j T_j(x) + Σ w_k × (x − p_k),
/// except for second-order terms. Here v is the velocity; T_j are the twists of the perturbations,
/// |c_j| ≤ 1; p_k are the points of their pivot rotations w_k, |w_k| ≤ angle_k. A swept sphere
/// moves with its centre; its radius is the same in every pose.
///
/// Width. Let h_A be the support of A along n, and h_B that of B along −n. The width is −h_A − h_B,
/// with
///   h(s) = max over x of ±n·(x + s·v(x)) + Σ |n·T_j(x)| + Σ angle_k |n × (x − p_k)|.
/// The last term is the largest value of w·((x − p) × n) for vectors w of length at most `angle`.
/// Since T_j and v are affine, each term is convex in x. So the maximum is attained at a corner of
/// the core. The maximum is convex in s. So the width is concave in s, and smallest at s = −half or
/// s = half.
///
/// For core points the width is attained: at that corner, each c_j can be ±1 and each w_k can be
/// perpendicular to n. If one variable moves joints in the chains of both bodies (mimics), the
/// formula treats the variable's perturbations in the two chains as independent. The true width can
/// only be larger.
///
/// Discs and boxes. A disc about the corner x has the points x + d, with d perpendicular to the
/// axis, |d| ≤ r. Let ⟂ be the component perpendicular to the axis. Then n·(d + s ω × d) = d·(n + s
/// n × ω) ≤ r |(n + s n × ω)⟂|, |n·T_j(x + d)| ≤ |n·T_j(x)| + r |(n × ω_j)⟂|, and |n × d| ≤ r. A
/// box has the points x + d, |d_i| ≤ e_i: d·g ≤ Σ e_i |g_i|, and |n × d| ≤ |e|. With several terms,
/// these bounds may not be attained.
///
/// A direction that turns. A face that turns about its closest point stays beside the other body.
/// The face's far corners cross every slab of a fixed direction, unless the interval is as short as
/// gap / (length of the face · rate). So the direction may be n(s) = n + s·m, with m = turn × n.
/// For the core points x of A and y of B,
///   n(s)·(y(s) − x(s)) = n·(y − x) + s·(n·(v(y) − v(x)) + m·(y − x)) + s²·m·(v(y) − v(x)),
/// except for the terms that Reach bounds. The term m·(y − x) is affine, and is added to the
/// velocities. The last term and the tube along s·m are at most half·|m|·displacement. Let W be the
/// width without swept spheres of radii r, minus these terms. The distance is at least W/|n(s)| −
/// r, and 1/|n(s)| ≥ 1 − (half·|m|)²/2, because m is perpendicular to n. A slab with half·|m| > 1/8
/// is not used: its width is −infinity. So the terms with m are smaller than the lengths
/// themselves, and hardly increase the rounding.
///
/// The width is rounded by about 2^-58 of lengths that Reach::size includes. PairMotion::rounding
/// (2^-49 of Reach::size) covers this.
class MovedSlab {
 public:
  /// @param direction from a to b, of any length; with 0 the width is −infinity.
  /// @param turn the angular velocity of the direction, per unit of t.
  /// @param displacement upper bound of the sum of two displacements within the interval and the
  /// tube: of any point of A, and of any point of B. It is needed only if the direction turns.
  MovedSlab(const BodyMotion& a, const BodyMotion& b, Real half, const RealVec& direction,
            const RealVec& turn = RealVec::Zero(), Real displacement = 0);
  Real width(const ConvexSet& a, const ConvexSet& b) const;
  Real width(const CentredBox& a, const CentredBox& b) const;

 private:
  struct Affine {
    RealVec slope = RealVec::Zero();
    Real constant = 0;
    Real at(const RealVec& x) const { return slope.dot(x) + constant; }
  };
  struct Side {
    Affine back, forth;          // ±n·(x + s·v(x)) for s = −half, half
    std::vector<Affine> twists;  // n·T_j(x)
    std::vector<Perturbation::PivotRotation> pivots;
  };
  struct Support {
    Real back, forth;
  };
  Side sideOf(const BodyMotion& motion, Real half, const RealVec& along, const RealVec& rate) const;
  Real widthOf(const Support& a, const Support& b, Real radii) const;
  Real perturbationOf(const Side& side, const RealVec& x) const;
  Support supportOf(const Side& side, const ConvexSet& set) const;
  Support supportOf(const Side& side, const CentredBox& box) const;

  RealVec normal_ = RealVec::Zero();  // unit or zero
  Real lost_ = 0;                     // width lost by the last term and by the tube along s·m
  Real shorter_ = 0;                  // upper bound of 1 − 1/|n(s)|
  Side a_, b_;
};

/// The motion of a pair of bodies in a time interval, and its bounds. Lengths in metres.
struct PairMotion {
  BodyMotion a, b;       ///< in a's frame at the middle
  Real half = 0;         ///< half width of the interval, in t
  Real motionBound = 0;  ///< upper bound of any point's displacement from its place at the middle
  Real tube = 0;  ///< upper bound of any point's displacement within the tube, in any direction
  Real secondOrder = 0;  ///< upper bound of the terms that MovedSlab leaves out
  Real rounding = 0;
};

/// Thresholds for a lower bound of the clearance, metres.
struct Sought {
  Real needed = 0;  ///< a bound of this or less is useless
  Real little = 0;  ///< > `needed`; such a bound is enough if `wanted` costs too much
  Real wanted = 0;  ///< > `little`; a bound above this is of no more use than this
};

/// Returns a lower bound of the clearance of two bodies, for the whole interval and tube. Each near
/// pair of leaf primitives has a slab of its own. Returns −infinity if no bound above
/// `sought.needed` was found.
/// @param placed the bodies at the middle of the interval.
/// @param measured their distance there.
/// @param scratch memory for the pairs of leaf primitives.
Real boundBySlabs(BodyDistance& placed, const BodyGap& measured, const PairMotion& motion,
                  const Sought& sought, std::vector<LeafPair>& scratch);

}  // namespace corridor::verify
