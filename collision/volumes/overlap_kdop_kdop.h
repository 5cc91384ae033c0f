#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/volumes/kdop.h"
#include "collision/volumes/volume.h"

/// Tests two k-DOPs under any affine map, along the slab directions of both.
///
/// Derivation. In frame A, a point x of b is at M x + t. Its projection onto a direction L is m·x +
/// L·t with m = MᵀL. If m = Σ w_k d_k for slab directions d_k of b, then m·x ≤ Σ w_k·(high_k where
/// w_k > 0, else low_k), and m·x ≥ the same sum with the other ends. The remainder m − Σ w_k d_k
/// adds at most its length times the largest |x| (`VolumeBounds::reach`). So any three weights give
/// a proof. The three slab directions whose cone contains m give the weights of the best bound. The
/// weights are the same for all nodes, so they are computed once per query. Then an axis takes
/// three products per node.
namespace corridor {

namespace internal {

/// n ≈ Σ weight_k · direction of slab_k.
struct SlabSum {
  std::array<std::size_t, 3> slab;
  std::array<double, 3> weight;
  double error;  ///< upper bound of the length of (n − that sum)

  template <class Dop>
  double highest(const Dop& dop) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += weight[k] * (weight[k] > 0 ? dop.high[slab[k]] : dop.low[slab[k]]);
    return sum;
  }
  template <class Dop>
  double lowest(const Dop& dop) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += weight[k] * (weight[k] > 0 ? dop.low[slab[k]] : dop.high[slab[k]]);
    return sum;
  }
  double size() const { return std::abs(weight[0]) + std::abs(weight[1]) + std::abs(weight[2]); }
};

/// Returns n as a weighted sum of the three slab directions whose cone contains n.
template <int K>
SlabSum slabSum(const Vec3& n);

}  // namespace internal

template <int K>
class PairTest<Kdop<K>> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error) {
    const auto& n = slabDirections<K>();
    for (std::size_t i = 0; i < kSlabs; ++i) {
      ofA_[i] = axis(n[i], X_AB, a, b, error);
      ofA_[i].other = internal::slabSum<K>(X_AB.m.transpose() * n[i]);
      ofA_[i].slack += spill(ofA_[i].other, b.reach);
      // Here MᵀL is a slab direction of b itself, except for the defect of M from a rotation.
      const Vec3 L = X_AB.m * n[i];
      ofB_[i] = axis(L, X_AB, a, b, error);
      ofB_[i].other = internal::slabSum<K>(L);
      ofB_[i].slack += spill(ofB_[i].other, a.reach) +
                       roundedUp((X_AB.m.transpose() * L - n[i]).norm() * b.reach);
    }
  }

  bool separated(const Kdop<K>& a, const Kdop<K>& b, double pad) const {
    for (std::size_t i = 0; i < kSlabs; ++i)
      if (apart(gapOnA(i, a, b), roundedUp(pad * ofA_[i].length))) return true;
    for (std::size_t i = 0; i < kSlabs; ++i)
      if (apart(gapOnB(i, a, b), roundedUp(pad * ofB_[i].length))) return true;
    return false;
  }
  double distanceBound(const Kdop<K>& a, const Kdop<K>& b) const {
    double bound = 0;
    for (std::size_t i = 0; i < kSlabs; ++i) {
      bound = std::max(bound, gapOnA(i, a, b) / ofA_[i].length);
      bound = std::max(bound, gapOnB(i, a, b) / ofB_[i].length);
    }
    return bound < HUGE_VAL ? std::max(0.0, roundedDown(bound)) : 0;
  }

 private:
  static constexpr std::size_t kSlabs = Kdop<K>::kSlabs;
  struct Axis {
    internal::SlabSum other;  ///< the axis as a sum of slabs of the other body
    double offset = 0, length = 0, slack = 0;
  };

  static bool apart(double gap, double pad) { return gap > pad && gap < HUGE_VAL; }

  /// Returns axis L with the slack that every axis needs, for the caller's error and for rounding.
  /// L is a slab direction of a, or M times a slab direction of b. In both cases |L|₁ ≤ 3F and F ≥
  /// |L|/√3, with F = ‖M‖_F. So the weights of either body sum up to at most 9(1 + F)². Slab ends
  /// are below 4·reach: |n_i| ≤ √3, and the slabs of a convex part that is a cylinder are around
  /// the corners of its box. A gap takes ten sums and products. L·t takes 4u, and so does the
  /// rounding of MᵀL, from which `SlabSum::error` was computed.
  static Axis axis(const Vec3& L, const Transform& X_AB, const VolumeBounds& a,
                   const VolumeBounds& b, double error) {
    Axis made;
    const double f = 1 + X_AB.m.norm();
    made.offset = L.dot(X_AB.t);
    made.length = roundedUp(L.norm());
    made.slack = roundedUp(
        error * made.length +
        16 * kUnit * (36 * f * f * (a.reach + b.reach) + L.cwiseAbs().dot(X_AB.t.cwiseAbs())));
    return made;
  }
  static double spill(const internal::SlabSum& sum, double reach) {
    return roundedUp(sum.error * reach);
  }
  double gapOnA(std::size_t i, const Kdop<K>& a, const Kdop<K>& b) const {
    const Axis& L = ofA_[i];
    return std::max(L.other.lowest(b) + L.offset - a.high[i],
                    a.low[i] - (L.other.highest(b) + L.offset)) -
           L.slack;
  }
  double gapOnB(std::size_t i, const Kdop<K>& a, const Kdop<K>& b) const {
    const Axis& L = ofB_[i];
    return std::max(b.low[i] + L.offset - L.other.highest(a),
                    L.other.lowest(a) - (b.high[i] + L.offset)) -
           L.slack;
  }

  std::array<Axis, kSlabs> ofA_, ofB_;
};

}  // namespace corridor
