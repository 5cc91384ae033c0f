// What the boxes of a wide tree do in a window of time, for every SIMD target: included once per
// target by foreach_target.h.

// clang-format off
#if defined(CORRIDOR_WIDE_TRAVEL_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_WIDE_TRAVEL_INL_H_
#undef CORRIDOR_WIDE_TRAVEL_INL_H_
#else
#define CORRIDOR_WIDE_TRAVEL_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "hwy/highway.h"
#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/motion/motion_window.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What triangles of leaves do in a window of time, as `Obb4Travel` says of boxes: of several
/// leaves at once, in a's unit; bounds rounded up. `linear` is that of the point which their
/// corners are relative to (`TriangleCorners::center`), rounded.
struct LeafTravel {
  float linear[3], angular[3];
  float remainder = 0;  ///< beyond first order, along any unit vector
  float cap = 0, pad = 0;
};

/// What the four boxes of a node do.
struct NodeTravel : Obb4Travel {
  unsigned far;  ///< of which boxes (a bit each) `cap` exceeds the tolerance
};

/// `travelOf` (motion_window.h, with its derivation) for the four boxes of a node at once, each as
/// the sphere around it, of the nodes asked for last. All in the unit of the tree that looks on.
///
/// Rounding beyond that of `travelOf`: a centre's lever M(o + 2^unit·c) has terms up to |o| + |c|,
/// |c| ≤ 3·2^unit ≤ 6 radii of the tree: below 11 reaches in |.|₁. A box reaches |half|₂(1 + 2^-20)
/// from its centre, for the defect of its axes.
class WideTravel {
 public:
  WideTravel(const WideObbTree& b, const MotionWindow& window, double unitA, double margin,
             double tolerance)
      : b_(b),
        window_(window),
        unitA_(unitA),
        unit_(unitA * (1 + 0x1p-15)),
        margin_(margin),
        tolerance_(tolerance),
        lever0_(window.X_AB.m * b.origin()),
        // Lever and point together: 16u of |t|₁ + |y|₁ + radius.
        loose_(16 * kUnit * (sum(window.X_AB.t) + 12 * b.reach()) + 0x1p-500),
        scale_(1 + kUnit * static_cast<double>(64 + 8 * window.screws.size())) {
    std::fill_n(held_, kSize, WideObbTree::kNone);
  }

  const NodeTravel& of(const WideObbTree::Node& node) {
    const auto number = static_cast<std::uint32_t>(&node - b_.nodes().data());
    const std::uint32_t slot = number * 0x9e3779b1U >> (32 - kBits);  // Knuth's multiplicative hash
    if (held_[slot] != number) {
      held_[slot] = number;
      compute(node, travels_[slot]);
    }
    return travels_[slot];
  }

  /// Of the leaves that are these lanes of a node (a bit each); `linear` is left to `setLinear`.
  LeafTravel ofLeaves(const WideObbTree::Node& node, unsigned lanes) {
    const NodeTravel& boxes = of(node);
    LeafTravel leaves;
    const auto angle = static_cast<float>(window_.angle * (1 + 0x1p-20));
    std::copy_n(boxes.angular, 3, leaves.angular);
    // NaN: nothing is told.
    const auto raise = [](float& most, float x) {
      most = x < HUGE_VALF ? std::max(most, x) : HUGE_VALF;
    };
    for (int j = 0; j < 4; ++j) {
      if (!(lanes >> j & 1)) continue;
      raise(leaves.remainder, boxes.bend[j] * angle + boxes.curvature[j]);
      raise(leaves.cap, boxes.cap[j]);
      raise(leaves.pad, boxes.pad[j]);
    }
    return leaves;
  }

  /// For corners that are relative to `center` (in a's unit, from a's origin).
  void setLinear(LeafTravel& leaves, const double* center, const Vec3& originA) const {
    const Vec3 y = Vec3(center[0], center[1], center[2]) / unitA_ + originA - window_.X_AB.t;
    const Vec3 linear = (window_.linear + window_.angular.cross(y)) * unitA_;
    for (int k = 0; k < 3; ++k) leaves.linear[k] = static_cast<float>(linear[k]);
  }

 private:
  using D = hn::CappedTag<double, 4>;
  using V = hn::Vec<D>;
  static constexpr D d_{};

  static double sum(const Vec3& v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }
  static V set(double x) { return hn::Set(d_, x); }
  static V dot(V x0, V x1, V x2, V y0, V y1, V y2) {
    return hn::MulAdd(x2, y2, hn::MulAdd(x1, y1, hn::Mul(x0, y0)));
  }
  static V norm(V x, V y, V z) { return hn::Sqrt(dot(x, y, z, x, y, z)); }

  void compute(const WideObbTree::Node& node, NodeTravel& travel) const {
    const hn::Rebind<float, D> f;
    const MotionWindow& w = window_;
    const double length = b_.length();
    const auto store = [&](V v, float* four, std::size_t at) {
      hn::StoreU(hn::DemoteTo(f, v), f, four + at);
    };
    for (int k = 0; k < 3; ++k) travel.angular[k] = static_cast<float>(w.angular[k]);
    travel.far = 0;
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
      const V reach = hn::Add(radius, set(loose_));
      const V error = hn::MulAdd(set(w.reachError), hn::Add(lever, reach), set(w.fixedError));
      const V grown = hn::Add(reach, error);

      const V zero = hn::Zero(d_);
      V displaced = zero, rate = zero, second = zero, pad = error, stray = zero, sole = zero;
      int turns = 0;
      bool slid = false, alone = false;
      for (std::size_t j = w.screws.size(); j-- > 0;) {
        const ScrewTravel& screw = w.screws[j];
        const V amount = set(screw.amount), tube = set(screw.tube);
        if (screw.kind == ScrewTravel::Kind::slide) {
          displaced = hn::Add(displaced, amount);
          rate = hn::Add(rate, amount);
          pad = hn::Add(pad, tube);
          slid = slid || screw.amount != 0;
          continue;
        }
        V d[3];
        for (int k = 0; k < 3; ++k) d[k] = hn::Sub(x[k], set(screw.point[k]));
        const V sides = hn::Add(hn::Add(hn::Abs(d[0]), hn::Abs(d[1])), hn::Abs(d[2]));
        V r = hn::MulAdd(set(16 * kUnit), sides, grown);
        if (screw.kind == ScrewTravel::Kind::turn) {
          const V a0 = set(screw.axis[0]), a1 = set(screw.axis[1]), a2 = set(screw.axis[2]);
          r = hn::Add(r, norm(hn::NegMulAdd(a2, d[1], hn::Mul(a1, d[2])),
                              hn::NegMulAdd(a0, d[2], hn::Mul(a2, d[0])),
                              hn::NegMulAdd(a1, d[0], hn::Mul(a0, d[1]))));
        } else {
          r = hn::Add(r, norm(d[0], d[1], d[2]));
        }
        pad = hn::MulAdd(r, tube, pad);
        stray = hn::MulAdd(displaced, tube, stray);
        if (screw.amount == 0) continue;
        const V onward = hn::Mul(hn::Add(r, displaced), amount);
        alone = turns == 0 && !slid;
        if (alone) sole = onward;
        ++turns;
        second = hn::MulAdd(amount, hn::MulAdd(set(2), rate, onward), second);
        rate = hn::Add(rate, onward);
        displaced = hn::MulAdd(r, set(chord(screw.amount)), displaced);
      }
      const V l[3] = {hn::NegMulAdd(set(w.angular[2]), y[1], hn::Mul(set(w.angular[1]), y[2])),
                      hn::NegMulAdd(set(w.angular[0]), y[2], hn::Mul(set(w.angular[2]), y[0])),
                      hn::NegMulAdd(set(w.angular[1]), y[0], hn::Mul(set(w.angular[0]), y[1]))};
      V v[3];
      for (int k = 0; k < 3; ++k) v[k] = hn::Add(l[k], set(w.linear[k]));
      // What v is off by: its products' rounding, and the lever's.
      const V blur = hn::MulAdd(set(16 * kUnit), hn::MulAdd(set(w.angle), lever, set(w.speed)),
                                set(w.angle * loose_));
      const V first = hn::Add(hn::MulAdd(set(w.angle), grown, norm(v[0], v[1], v[2])),
                              hn::MulAdd(set(0.5), second, blur));
      const bool bends = turns == 1 && alone;
      const V scaled = set(scale_ * unit_);
      const V cap = hn::Mul(scaled, hn::Add(hn::Min(displaced, first), stray));
      const V tilt = set(bends ? w.reachError + 8 * kUnit : 0.5);
      store(cap, travel.cap, at);
      V curvature = hn::MulAdd(tilt, second, hn::Add(stray, blur));
      if (bends) curvature = hn::MulAdd(set(w.reachError), sole, curvature);
      store(hn::Mul(scaled, curvature), travel.curvature, at);
      store(bends ? hn::Mul(scaled, hn::Mul(set(0.5), sole)) : zero, travel.bend, at);
      store(hn::MulAdd(scaled, hn::Add(pad, set(margin_)), set(0x1p-118)), travel.pad, at);
      for (int k = 0; k < 3; ++k)
        hn::StoreU(hn::DemoteTo(f, hn::Mul(set(unitA_), v[k])), f, travel.linear[k] + at);
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d_, hn::Not(hn::Le(cap, set(tolerance_ * unitA_))), bits);
      travel.far |= static_cast<unsigned>(bits[0]) << at;
    }
  }

  const WideObbTree& b_;
  const MotionWindow& window_;
  double unitA_, unit_, margin_, tolerance_;
  Vec3 lever0_;  // of the tree's origin, metres
  double loose_, scale_;
  static constexpr int kBits = 4, kSize = 1 << kBits;
  std::uint32_t held_[kSize];
  NodeTravel travels_[kSize];
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
