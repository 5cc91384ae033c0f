// Motion bounds of the boxes of a 4-wide OBB tree in a time interval, for every SIMD target:
// foreach_target.h includes this file once per target.

// clang-format off
#if defined(CORRIDOR_MOTION_BOUND4_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_MOTION_BOUND4_INL_H_
#undef CORRIDOR_MOTION_BOUND4_INL_H_
#else
#define CORRIDOR_MOTION_BOUND4_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hwy/highway.h"
#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/motion/relative_motion.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The motion bound of the triangles of several leaves in a time interval, in a's unit, rounded up.
/// The terms are those of `Obb4MotionBound`. The corners are relative to a point
/// (`TriangleCorners::center`). `linear` is the first-order displacement of this point, rounded.
struct LeafMotionBound {
  float linear[3], angular[3];
  float remainder = 0;  ///< bound of the displacement beyond first order, along any unit vector
  float isotropic = 0, pad = 0;
};

/// The motion bounds of the four boxes of a node.
struct NodeMotionBound : Obb4MotionBound {
  unsigned far;  ///< one bit per box: set if the box's `isotropic` exceeds the tolerance
};

/// Computes `motionBound` (derivation: relative_motion.cpp) for the bounding spheres of a node's
/// four boxes at once. Caches the bounds of up to 16 nodes. All lengths are in the unit of tree a.
///
/// Rounding in addition to that of `motionBound`:
/// * The lever of a centre is M(o + 2^unit·c), where M is the matrix of the relative pose, o the
///   origin of tree b, 2^unit metres its unit, and c the stored centre. It has terms up to |o| +
///   |2^unit·c|, where |2^unit·c| ≤ 3·2^unit, at most 6 times the tree's radius. In |.|₁ these
///   terms are below 11 times the tree's `reach()`.
/// * A box extends at most |half|₂(1 + 2^-20) from its centre. The factor covers the defect of its
///   axes.
class MotionBound4 {
 public:
  MotionBound4(const Obb4Tree& b, const RelativeMotion& relative, double unitA, double margin,
               double tolerance)
      : b_(b),
        relative_(relative),
        unitA_(unitA),
        unit_(unitA * (1 + 0x1p-15)),
        margin_(margin),
        tolerance_(tolerance),
        lever0_(relative.X_AB.m * b.origin()),
        // Rounding of lever and point together: at most 16u·(|t|₁ + |y|₁ + radius).
        leverError_(16 * kUnit * (norm1(relative.X_AB.t) + 12 * b.reach()) + 0x1p-500),
        scale_(1 + kUnit * static_cast<double>(64 + 8 * relative.screws.size())) {
    std::fill_n(held_, kSize, Obb4Tree::kNone);
  }

  const NodeMotionBound& of(const Obb4Tree::Node& node) {
    const auto number = static_cast<std::uint32_t>(&node - b_.nodes().data());
    const std::uint32_t slot = number * 0x9e3779b1U >> (32 - kBits);  // Knuth's multiplicative hash
    if (held_[slot] != number) {
      held_[slot] = number;
      compute(node, bounds_[slot]);
    }
    return bounds_[slot];
  }

  /// Returns the bound for the leaves in these lanes of a node (one bit each). `linear` is not set;
  /// `setLinear` sets it.
  LeafMotionBound ofLeaves(const Obb4Tree::Node& node, unsigned lanes) {
    const NodeMotionBound& boxes = of(node);
    LeafMotionBound leaves;
    const auto angle = static_cast<float>(relative_.angle * (1 + 0x1p-20));
    std::copy_n(boxes.angular, 3, leaves.angular);
    // NaN becomes infinity, which proves nothing.
    const auto raise = [](float& most, float x) {
      most = x < HUGE_VALF ? std::max(most, x) : HUGE_VALF;
    };
    for (int j = 0; j < 4; ++j) {
      if (!(lanes >> j & 1)) continue;
      raise(leaves.remainder, boxes.secondOrderAcross[j] * angle + boxes.secondOrder[j]);
      raise(leaves.isotropic, boxes.isotropic[j]);
      raise(leaves.pad, boxes.pad[j]);
    }
    return leaves;
  }

  /// Sets `linear` for corners that are relative to `center`. `center` is a point in a's unit,
  /// relative to a's origin.
  void setLinear(LeafMotionBound& leaves, const double* center, const Vec3& originA) const {
    const Vec3 y = Vec3(center[0], center[1], center[2]) / unitA_ + originA - relative_.X_AB.t;
    const Vec3 linear = (relative_.linear + relative_.angular.cross(y)) * unitA_;
    for (int k = 0; k < 3; ++k) leaves.linear[k] = static_cast<float>(linear[k]);
  }

 private:
  using D = hn::CappedTag<double, 4>;
  using V = hn::Vec<D>;
  static constexpr D d_{};

  static double norm1(const Vec3& v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }
  static V set(double x) { return hn::Set(d_, x); }
  static V dot(V x0, V x1, V x2, V y0, V y1, V y2) {
    return hn::MulAdd(x2, y2, hn::MulAdd(x1, y1, hn::Mul(x0, y0)));
  }
  static V norm(V x, V y, V z) { return hn::Sqrt(dot(x, y, z, x, y, z)); }

  void compute(const Obb4Tree::Node& node, NodeMotionBound& bound) const {
    const hn::Rebind<float, D> f;
    const RelativeMotion& w = relative_;
    const double length = b_.length();
    const auto store = [&](V v, float* four, std::size_t at) {
      hn::StoreU(hn::DemoteTo(f, v), f, four + at);
    };
    for (int k = 0; k < 3; ++k) bound.angular[k] = static_cast<float>(w.angular[k]);
    bound.far = 0;
    for (std::size_t at = 0; at < 4; at += hn::Lanes(d_)) {
      const auto row = [&](const float* four) {
        return hn::Mul(set(length), hn::PromoteTo(d_, hn::LoadU(f, four + at)));
      };
      const V c0 = row(node.vectors[0][Obb4::kCenter]), c1 = row(node.vectors[1][Obb4::kCenter]),
              c2 = row(node.vectors[2][Obb4::kCenter]);
      V y[3], x[3];
      for (int k = 0; k < 3; ++k) {
        const Mat3& m = w.X_AB.m;
        y[k] = hn::Add(dot(c0, c1, c2, set(m(k, 0)), set(m(k, 1)), set(m(k, 2))), set(lever0_[k]));
        x[k] = hn::Add(y[k], set(w.X_AB.t[k]));
      }
      const V radius =
          hn::Mul(set(1 + 0x1p-20), norm(row(node.half[0]), row(node.half[1]), row(node.half[2])));
      const V lever = norm(y[0], y[1], y[2]);
      const V reach = hn::Add(radius, set(leverError_));
      const V error = hn::MulAdd(set(w.reachError), hn::Add(lever, reach), set(w.fixedError));
      const V grown = hn::Add(reach, error);

      const V zero = hn::Zero(d_);
      V displaced = zero, rate = zero, second = zero, pad = error, tubeGrowth = zero,
        singleTravel = zero, deviated = zero;
      int turns = 0;
      bool slid = false, isLastToMove = false;
      for (std::size_t j = w.screws.size(); j-- > 0;) {
        const ScrewMotion& screw = w.screws[j];
        const V amount = set(screw.amount), deviation = set(screw.deviation),
                tube = set(screw.tube);
        if (screw.kind == ScrewMotion::Kind::prismatic) {
          displaced = hn::Add(displaced, hn::Add(amount, deviation));
          rate = hn::Add(rate, amount);
          deviated = hn::Add(deviated, deviation);
          pad = hn::Add(pad, tube);
          slid = slid || screw.amount != 0;
          continue;
        }
        V d[3];
        for (int k = 0; k < 3; ++k) d[k] = hn::Sub(x[k], set(screw.point[k]));
        const V sides = hn::Add(hn::Add(hn::Abs(d[0]), hn::Abs(d[1])), hn::Abs(d[2]));
        V r = hn::MulAdd(set(16 * kUnit), sides, grown);
        if (screw.kind == ScrewMotion::Kind::revolute) {
          const V a0 = set(screw.axis[0]), a1 = set(screw.axis[1]), a2 = set(screw.axis[2]);
          r = hn::Add(r, norm(hn::NegMulAdd(a2, d[1], hn::Mul(a1, d[2])),
                              hn::NegMulAdd(a0, d[2], hn::Mul(a2, d[0])),
                              hn::NegMulAdd(a1, d[0], hn::Mul(a0, d[1]))));
        } else {
          r = hn::Add(r, norm(d[0], d[1], d[2]));
        }
        pad = hn::MulAdd(r, tube, pad);
        tubeGrowth = hn::MulAdd(displaced, tube, tubeGrowth);
        const double most = screw.amount + screw.deviation;
        if (most == 0) continue;
        const V far = hn::Add(r, displaced);
        deviated = hn::MulAdd(far, deviation, deviated);
        if (screw.amount > 0) {
          const V onward = hn::Mul(far, amount);
          isLastToMove = turns == 0 && !slid;
          if (isLastToMove) singleTravel = onward;
          ++turns;
          second = hn::MulAdd(amount, hn::MulAdd(set(2), rate, onward), second);
          rate = hn::Add(rate, onward);
        }
        displaced = hn::MulAdd(r, set(chord(most)), displaced);
      }
      const V l[3] = {hn::NegMulAdd(set(w.angular[2]), y[1], hn::Mul(set(w.angular[1]), y[2])),
                      hn::NegMulAdd(set(w.angular[0]), y[2], hn::Mul(set(w.angular[2]), y[0])),
                      hn::NegMulAdd(set(w.angular[1]), y[0], hn::Mul(set(w.angular[0]), y[1]))};
      V v[3];
      for (int k = 0; k < 3; ++k) v[k] = hn::Add(l[k], set(w.linear[k]));
      // A bound of the error of v. The error comes from the products in v, and from the lever.
      const V blur = hn::MulAdd(set(16 * kUnit), hn::MulAdd(set(w.angle), lever, set(w.speed)),
                                set(w.angle * leverError_));
      const V first = hn::Add(hn::MulAdd(set(w.angle), grown, norm(v[0], v[1], v[2])),
                              hn::Add(hn::MulAdd(set(0.5), second, blur), deviated));
      const bool isSingleRotation = turns == 1 && isLastToMove;
      const V scaled = set(scale_ * unit_);
      const V isotropic = hn::Mul(scaled, hn::Add(hn::Min(displaced, first), tubeGrowth));
      const V tilt = set(isSingleRotation ? w.reachError + 8 * kUnit : 0.5);
      store(isotropic, bound.isotropic, at);
      V secondOrder = hn::MulAdd(tilt, second, hn::Add(hn::Add(tubeGrowth, blur), deviated));
      if (isSingleRotation) secondOrder = hn::MulAdd(set(w.reachError), singleTravel, secondOrder);
      store(hn::Mul(scaled, secondOrder), bound.secondOrder, at);
      store(isSingleRotation ? hn::Mul(scaled, hn::Mul(set(0.5), singleTravel)) : zero,
            bound.secondOrderAcross, at);
      store(hn::MulAdd(scaled, hn::Add(pad, set(margin_)), set(0x1p-118)), bound.pad, at);
      for (int k = 0; k < 3; ++k)
        hn::StoreU(hn::DemoteTo(f, hn::Mul(set(unitA_), v[k])), f, bound.linear[k] + at);
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d_, hn::Not(hn::Le(isotropic, set(tolerance_ * unitA_))), bits);
      bound.far |= static_cast<unsigned>(bits[0]) << at;
    }
  }

  const Obb4Tree& b_;
  const RelativeMotion& relative_;
  double unitA_, unit_, margin_, tolerance_;
  Vec3 lever0_;  // lever of the tree's origin, metres
  double leverError_, scale_;
  static constexpr int kBits = 4, kSize = 1 << kBits;
  std::uint32_t held_[kSize];
  NodeMotionBound bounds_[kSize];
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
