#pragma once

#include <vector>

#include "planner/verify/box_tree.h"

namespace corridor::verify {

/// How the core points of a body move about the middle of an interval, in coordinates that stand
/// still there: x has the velocity linear + angular × x per unit of t, and strays.
struct BodyMotion {
  RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
  Strays strays;  ///< none: they are counted otherwise
};

/// `state` and `strays` are of the same limb at the same t; `at` is the placement of the
/// coordinates that the motion is wanted in.
BodyMotion motionSeenFrom(const Placement& at, const FrameState& state, Strays strays);

/// The width of the slab between two moving bodies along a direction n that is fixed in the
/// coordinates in which they move, to first order of the motion.
///
/// At a time s from the middle, |s| ≤ half, a core point x is at x + s·v(x) + Σ c_j T_j(x) + Σ w_k
/// × (x − p_k), but for what Reach counts for the second order: v its velocity, T_j the twists, p_k
/// the pivots of its strays. Balls move with their centres, and are as wide in any pose. So the
/// width is, with h_A the support of A's along n, h_B that of B's along −n,
///   −h_A − h_B,  h(s) = max over x of ±n·(x + s·v(x)) + Σ |n·T_j(x)| + Σ angle_k |n × (x − p_k)|
/// (w·((x − p) × n), w any vector of at most `angle`). Everything under the maximum is convex in x
/// (T_j and v are affine), so that it is attained at a corner of the core, and the maximum itself
/// is convex in s, so that −h_A − h_B is concave and least at one of s = ±half. That is no more
/// than what the strays can do: each c_j is at ±1 at that corner, and each w_k across n; only that
/// two bodies share joints (of two limbs that mimic one) isn't made use of.
///
/// A disc about the corner x has x + d, d across the axis, |d| ≤ r: there n·(d + s ω × d) = d·(n +
/// s n × ω) ≤ r times what of that is across the axis; |n·T_j(x + d)| ≤ |n·T_j(x)| + r |n × ω_j,
/// across the axis|, and |n × d| ≤ r. A box has x + d, |d_i| ≤ e_i: d·g ≤ Σ e_i |g_i| likewise, |n
/// × d| ≤ |e|; these two are bounds, not attained where several terms are.
///
/// Rounding: of relative 2^-58 or so of lengths that Reach::size has all in it.
class MovedSlab {
 public:
  /// @param direction from a to b, of any length; 0: the width is −infinity.
  MovedSlab(const BodyMotion& a, const BodyMotion& b, Real half, const RealVec& direction);
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
    std::vector<Strays::Pivot> pivots;
  };
  struct Support {
    Real back, forth;
  };
  Side sideOf(const BodyMotion& motion, Real half, const RealVec& along) const;
  Real straysOf(const Side& side, const RealVec& x) const;
  Support supportOf(const Side& side, const ConvexSet& set) const;
  Support supportOf(const Side& side, const CentredBox& box) const;

  RealVec normal_ = RealVec::Zero();  // unit, or zero
  Side a_, b_;
};

/// A pair of bodies in an interval: how they move, and how far at most.
struct PairMotion {
  BodyMotion a, b;       ///< in a's frame at the middle
  Real half = 0;         ///< of the interval, in t
  Real travel = 0;       ///< of any point within the interval, from where it is at the middle
  Real tube = 0;         ///< of any point, by the strays, whatever the direction
  Real secondOrder = 0;  ///< what MovedSlab leaves out
  Real rounding = 0;
};

/// What a bound of the clearance is looked for for.
struct Sought {
  Real needed = 0;  ///< a bound of this or less is none
  Real little = 0;  ///< more than `needed`: of use, if no more can be had at a reasonable cost
  Real wanted = 0;  ///< a larger one is of no use
};

/// A lower bound of the clearance of two bodies, `placed` at the middle and measured there, all
/// over the interval and the tube, by a slab of its own for each pair of pieces that comes near;
/// −infinity if it isn't more than is needed. `scratch` is for the pairs.
Real boundBySlabs(BodyDistance& placed, const BodyGap& measured, const PairMotion& motion,
                  const Sought& sought, std::vector<PiecePair>& scratch);

}  // namespace corridor::verify
