#include "collision/course/plane_separation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "collision/convex/rational-inl.h"
#include "collision/core/rounding.h"
#include "collision/course/polytope_shadow.h"

namespace corridor {
namespace {

/// A computed value, and a bound of its error.
struct Height {
  double value, error;
};

/// Returns normal·x − offset. The rounding of three products and three sums is at most 4u of the
/// sum of magnitudes. The computed sum of magnitudes is itself off by at most 4u. Underflow adds at
/// most 2^-1022 times the larger of 1 and the largest factor, for each operation.
Height height(const HalfSpace<3>& half, const Vec3& x) {
  const double size = half.normal.cwiseAbs().dot(x.cwiseAbs()) + std::abs(half.offset);
  const double tiny =
      0x1p-1018 * std::max({1.0, x.cwiseAbs().maxCoeff(), half.normal.cwiseAbs().maxCoeff()});
  return {half.normal.dot(x) - half.offset, 8 * kUnit * size + tiny};
}

/// Returns the sign of normal·x − offset, exactly.
int sideOf(const HalfSpace<3>& half, const Vec3& x) {
  const Height h = height(half, x);
  if (std::abs(h.value) > h.error && std::isfinite(h.error)) return h.value > 0 ? 1 : -1;
  seidel::Rational sum = -seidel::rational(half.offset);
  for (int k = 0; k < 3; ++k) sum += seidel::rational(half.normal[k]) * seidel::rational(x[k]);
  return sum.sign();
}

void requirePlane(const HalfSpace<3>& half) {
  if (!half.normal.allFinite() || !std::isfinite(half.offset))
    throw std::invalid_argument("the numbers of a plane must be finite");
  // The normal is tested by its bits, because under denormals-are-zero a comparison takes a
  // subnormal normal for 0.
  if (std::all_of(half.normal.data(), half.normal.data() + 3,
                  [](double x) { return exact::dyadic(x).mantissa == 0; }))
    throw std::invalid_argument("the normal of a plane must not be 0");
}

/// Returns the side of the polytope from the sides of its innermost and its outermost vertex: the
/// common side of both, or 0 if the polytope meets the plane.
int sideOf(int innermost, int outermost) {
  return innermost > 0 ? 1 : outermost < 0 ? -1 : 0;
}

}  // namespace

PlaneSeparation planeSeparation(const DobkinKirkpatrick& polytope, const HalfSpace<3>& halfSpace) {
  requirePlane(halfSpace);
  const auto at = [&](std::uint32_t v) { return polytope.polytope().vertices()[v]; };
  PlaneSeparation found;
  found.innermost = polytope.extreme(-halfSpace.normal);
  found.outermost = polytope.extreme(halfSpace.normal);
  found.side =
      sideOf(sideOf(halfSpace, at(found.innermost)), sideOf(halfSpace, at(found.outermost)));
  // The half-space is scaled so that its normal has a length of about 1: the square of the length
  // neither overflows nor vanishes.
  const double unit = powerOfTwo(halfSpace.normal.cwiseAbs().maxCoeff());
  const HalfSpace<3> scaled{halfSpace.normal / unit, halfSpace.offset / unit};
  const Height in = height(scaled, at(found.innermost)), out = height(scaled, at(found.outermost));
  const bool inner = found.side == 0 ? in.value > -out.value : found.side > 0;
  found.witness = inner ? found.innermost : found.outermost;
  // Heights that overflow bound nothing.
  const auto least = [](double value, double error) {
    return std::isfinite(value) && std::isfinite(error) ? value - error : -HUGE_VAL;
  };
  const double low = std::max(least(in.value, in.error), least(-out.value, out.error)),
               high = std::max(-least(-in.value, in.error), -least(out.value, out.error));
  // The length is off by a relative error of 3u, and each of the quotients and sums above by 1u.
  const double length = scaled.normal.norm();
  const auto down = [](double x) { return x > 0 ? roundedDown(x) : -roundedUp(-x); };
  found.lower = down(low / length);
  found.upper = -down(-high / length);
  if (found.side != 0) found.lower = std::max(found.lower, 0.0);
  if (found.side == 0) found.upper = std::min(found.upper, 0.0);
  return found;
}

int sideOfPlane(const DobkinKirkpatrick& polytope, const HalfSpace<3>& halfSpace) {
  requirePlane(halfSpace);
  const double largest = halfSpace.normal.cwiseAbs().maxCoeff();
  // Walks need a direction whose largest component is within 2^±400 (polytope_shadow.h).
  if (largest > 0x1p-400 && largest < 0x1p400) {
    PolytopeShadow in(polytope, -halfSpace.normal), out(polytope, halfSpace.normal);
    const auto at = [&](const PolytopeShadow& walk) {
      return sideOf(halfSpace, polytope.polytope().vertices()[walk.top()]);
    };
    int innermost = at(in), outermost = at(out);
    while (!(innermost <= 0 && outermost >= 0) && in.level() > 0) {
      if (in.refine()) innermost = at(in);
      if (out.refine()) outermost = at(out);
    }
    if (innermost <= 0 && outermost >= 0) return 0;
    if (in.isProved() && out.isProved()) return sideOf(innermost, outermost);
  }
  return planeSeparation(polytope, halfSpace).side;
}

}  // namespace corridor
