#include "collision/hierarchy/obb4_tree_pose.h"

#include <cassert>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/obb4_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/hierarchy/obb4_tree_pose.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/volumes/overlap_obb_faces-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// Three doubles and a zero, in one vector of four lanes, or in two vectors of two lanes.
struct Triple {
  using D = hn::CappedTag<double, 4>;
  using V = hn::Vec<D>;
  static constexpr std::size_t kLanes = hn::MaxLanes(D()), kParts = 4 / kLanes;
  V part[kParts];

  template <class Part>
  static HWY_INLINE Triple of(const Part& each) {
    Triple made;
    for (std::size_t i = 0; i < kParts; ++i) made.part[i] = each(i);
    return made;
  }
  /// Loads three doubles directly from the matrix. If a column were copied first, the load would
  /// have to wait for the stores of the copy.
  static HWY_INLINE Triple load(const double* x) {
    if constexpr (kParts == 1) return {hn::MaskedLoad(hn::FirstN(D(), 3), D(), x)};
    return of([&](std::size_t i) {
      return i == 0 ? hn::LoadU(D(), x)
                    : hn::IfThenElseZero(hn::FirstN(D(), 1), hn::Set(D(), x[2]));
    });
  }
  /// Stores whole vectors. After a masked store, the next load would have to wait for it.
  HWY_INLINE void store(double* four) const {
    for (std::size_t i = 0; i < kParts; ++i) hn::Store(part[i], D(), four + i * kLanes);
  }
  HWY_INLINE void demote(float* four) const {
    const hn::Rebind<float, D> f;
    for (std::size_t i = 0; i < kParts; ++i)
      hn::Store(hn::DemoteTo(f, part[i]), f, four + i * kLanes);
  }
  friend HWY_INLINE Triple operator+(const Triple& x, const Triple& y) {
    return of([&](std::size_t i) { return hn::Add(x.part[i], y.part[i]); });
  }
  friend HWY_INLINE Triple operator-(const Triple& x, const Triple& y) {
    return of([&](std::size_t i) { return hn::Sub(x.part[i], y.part[i]); });
  }
  friend HWY_INLINE Triple operator*(const Triple& x, double s) {
    return of([&](std::size_t i) { return hn::Mul(x.part[i], hn::Set(D(), s)); });
  }
  /// Returns x·s + this, rounded once if the target has fused multiply-add.
  HWY_INLINE Triple plus(const Triple& x, double s) const {
    return of([&](std::size_t i) { return hn::MulAdd(x.part[i], hn::Set(D(), s), part[i]); });
  }
  HWY_INLINE Triple abs() const {
    return of([&](std::size_t i) { return hn::Abs(part[i]); });
  }
  HWY_INLINE Triple squares() const {
    return of([&](std::size_t i) { return hn::Mul(part[i], part[i]); });
  }
  HWY_INLINE double sum() const {
    auto all = part[0];
    for (std::size_t i = 1; i < kParts; ++i) all = hn::Add(all, part[i]);
    return hn::GetLane(hn::SumOfLanes(D(), all));
  }
};

/// A matrix as its columns.
struct Columns {
  Triple col[3];

  explicit HWY_INLINE Columns(const Mat3& m)
      : col{Triple::load(&m(0, 0)), Triple::load(&m(0, 1)), Triple::load(&m(0, 2))} {}
  HWY_INLINE Columns(const Triple& x, const Triple& y, const Triple& z) : col{x, y, z} {}

  HWY_INLINE Triple times(double x, double y, double z) const {
    return (col[0] * x).plus(col[1], y).plus(col[2], z);
  }
  HWY_INLINE Columns transposed() const {
    const Triple::D d;
    if constexpr (Triple::kParts == 1) {
      // Interleaving works on blocks of two lanes: xy0 is (m00 m01 | m20 m21), and so on.
      const auto x = col[0].part[0], y = col[1].part[0], z = col[2].part[0], zero = hn::Zero(d);
      const auto xy0 = hn::InterleaveLower(d, x, y), xy1 = hn::InterleaveUpper(d, x, y);
      const auto z0 = hn::InterleaveLower(d, z, zero), z1 = hn::InterleaveUpper(d, z, zero);
      return {{hn::ConcatLowerLower(d, z0, xy0)},
              {hn::ConcatLowerLower(d, z1, xy1)},
              {hn::ConcatUpperUpper(d, z0, xy0)}};
    } else {
      const auto row = [&](std::size_t half, const auto& pick) {
        return Triple::of([&](std::size_t i) {
          return i == 0 ? pick(col[0].part[half], col[1].part[half])
                        : pick(col[2].part[half], hn::Zero(d));
        });
      };
      const auto lower = [&](auto x, auto y) { return hn::InterleaveLower(d, x, y); };
      const auto upper = [&](auto x, auto y) { return hn::InterleaveUpper(d, x, y); };
      return {row(0, lower), row(0, upper), row(1, lower)};
    }
  }
};

/// Returns an upper bound of ν = ‖MMᵀ − I‖₂ = ‖MᵀM − I‖₂: the sum of the magnitudes of all entries
/// of MMᵀ − I. Returns NaN if an entry of M is NaN or infinite.
HWY_INLINE double defectOf(const Mat3& m, const Columns& columns) {
  static constexpr double kIdentity[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto off = [&](int j) {
    return (columns.times(m(j, 0), m(j, 1), m(j, 2)) - Triple::load(kIdentity[j])).abs();
  };
  // An entry takes three products, two sums and a difference, so it is off by 4u·(Σ|m_ik||m_jk| +
  // 1). Over all entries, the first term adds up to Σ_k(Σ_i|m_ik|)² ≤ 3·Σ|m_ik|² ≤ 9(1 + ν), and
  // the second to 9. Together: below 80u if ν < 1/10.
  return roundedUp((off(0) + off(1) + off(2)).sum() + 80 * kUnit);
}

void relate(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b, const Transform& X_WB,
            double pad, Obb4TreePose& pose) {
  const Columns A(X_WA.m), B(X_WB.m);
  const Vec3 &oA = a.origin(), &oB = b.origin();
  const Triple tA = Triple::load(X_WA.t.data()), tB = Triple::load(X_WB.t.data());
  // Let o_A and o_B be the trees' origins. A point at x relative to o_B, in b's frame, is at y =
  // M_A⁻¹(M_B x + D) relative to o_A, in a's frame, with D = M_B o_B + t_B − M_A o_A − t_A. The
  // code uses M_Aᵀ instead of M_A⁻¹. The difference M_A⁻¹ − M_Aᵀ = (I − M_AᵀM_A) M_A⁻¹ has a norm ≤
  // ν_A/√(1 − ν_A), where ν_A is the ν of M_A (`defectOf`).
  const Triple D = tB.plus(B.col[0], oB[0]).plus(B.col[1], oB[1]).plus(B.col[2], oB[2]) -
                   tA.plus(A.col[0], oA[0]).plus(A.col[1], oA[1]).plus(A.col[2], oA[2]);
  const double defectA = defectOf(X_WA.m, A), defectB = defectOf(X_WB.m, B);
  constexpr double kUsable = 0x1p-6;
  // No pair of boxes is pruned in two cases:
  // * The defect of a map is `kUsable` or more, or NaN.
  // * A mesh is above 2^960 m. From 2^1000 m on, the tree's unit doesn't bring the mesh into [−1,
  //   1]. Moreover, if an entry of m·unitA were flushed to zero, a point of b would move by up to
  //   2^-1022·unitA⁻¹ times its coordinates. The margins don't cover this.
  const bool usable =
      defectA < kUsable && defectB < kUsable && a.length() <= 0x1p960 && b.length() <= 0x1p960;
  // D has at most five roundings per coordinate. `terms` bounds the sum of all terms of its
  // coordinates, with |M_ij| ≤ 1.1.
  const double terms = ((Triple::load(oA.data()).abs() + Triple::load(oB.data()).abs()) * 3.4 +
                        (tA.abs() + tB.abs()))
                           .sum();
  // |M x| ≤ √(1 + ν)|x|. The code takes kUsable for ν, so that this test need not wait for the
  // computation of the defects.
  const double spheres =
      roundedUp((a.radius() + b.radius()) * (1 + kUsable) + 6 * kUnit * terms + pad);
  pose.apart =
      usable && D.squares().sum() * (1 - 0x1p-48) > spheres * spheres * (1 + 0x1p-48) + kTiny;
  if (pose.apart) return;

  const Columns At = A.transposed();
  alignas(32) double d[4];
  D.store(d);
  const Columns M(At.times(X_WB.m(0, 0), X_WB.m(1, 0), X_WB.m(2, 0)),
                  At.times(X_WB.m(0, 1), X_WB.m(1, 1), X_WB.m(2, 1)),
                  At.times(X_WB.m(0, 2), X_WB.m(1, 2), X_WB.m(2, 2)));
  // For M = M_AᵀM_B, ‖MᵀM − I‖ ≤ ‖M_BᵀM_B − I‖ + ‖M_B‖²‖M_A M_Aᵀ − I‖. The rounding of m, 3.1u·√3
  // per entry, adds at most 2·√3 times as much.
  const double defect = defectB + 1.1 * defectA + 24 * kUnit;
  // Entries of m and of the offset take three products and two sums each. As a norm their error is
  // 3.1u·3.
  const double reach = 1.1 * b.radius() + D.abs().sum();
  // Differences and products that underflow, and are flushed to zero, lose less than 2^-1018.
  const double metres =
      1.2 * ((1.1 * defectA + 32 * kUnit) * reach + 6 * kUnit * terms) + 0x1p-1015;
  pose.unitA = 1 / a.length();
  pose.scale = b.length() * pose.unitA;  // a power of two; 0 or infinite if out of range
  const Triple t = At.times(d[0], d[1], d[2]) * pose.unitA;
  const double error = usable ? metres * pose.unitA : HUGE_VAL;
  constexpr double u = 0x1p-24;
  pose.floats.relative = static_cast<float>(180 * u + 10 * defect);
  // The factor rounds up. It covers the conversion to float and the length of cross axes.
  pose.floats.absoluteMargin = static_cast<float>(
      (error + u * (33 * pose.scale + 3.1 * t.abs().sum() + 6) + 0x1p-118) * (1 + 0x1p-16));
  // |M_A x| ≥ √(1 − ν)·|x|.
  pose.shrink = usable ? roundedDown(1 - defectA) : 0;
  pose.leafError = static_cast<float>(error * (1 + 0x1p-20) + 0x1p-118);
  pose.floats.scale = static_cast<float>(pose.scale);
  for (int j = 0; j < 3; ++j) {
    M.col[j].store(pose.columns[j]);
    M.col[j].demote(pose.floats.turn[j]);
  }
  t.store(pose.columns[3]);
  t.demote(pose.floats.offset);
  if (pad < HUGE_VAL)
    pose.apart = facesSeparate(a.root(), b.root(), pose.floats, pad > 0 ? pose.inUnitsOfA(pad) : 0);
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(relate);

Obb4TreePose::Obb4TreePose(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b,
                           const Transform& X_WB, double pad) {
  assert(standardFloatingPoint());
  HWY_DYNAMIC_DISPATCH(relate)(a, X_WA, b, X_WB, pad, *this);
}

float Obb4TreePose::inUnitsOfA(double metres) const {
  if (!(shrink > 0)) return HUGE_VALF;
  return static_cast<float>(metres / shrink * unitA * (1 + 0x1p-20));
}

}  // namespace corridor
#endif
