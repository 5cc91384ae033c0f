#include "planner/trajectory/row_rotation.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "collision/core/circle.h"

namespace corridor {

// Rounding, with u = 2^-64. Let a and b be the quaternions of the two rows, N = |a||b|, and (v, w)
// the quaternion b·a*, with w ≥ 0 after a change of sign. It is N·(sin φ·n, cos φ), where n is the
// axis and 2φ the angle of the rotation, so the rotation vector is 2φ·n. Nothing is normalised: the
// rotation vector depends only on the ratios of the four numbers. Squares and products of doubles
// neither overflow nor underflow in long double.
// - Each number of b·a* is a sum of four products, each of which has at most four roundings. By
//   Cauchy and Schwarz, the number is off by at most 4uN. So the quaternion is off by at most 8uN.
//   The map to the rotation vector stretches distances on the unit sphere by at most 2 along a
//   great circle through (0, 1), and by 2φ/sin φ ≤ π across it: the rotation vector is off by 8π·u.
// - |v| is off by 3u of itself, which changes φ by at most 3u of itself. The arc tangent is off by
//   2u, the quotient 2φ/|v| by 3u + u more, and its product with v by u: 10u of |2φ·n| ≤ π.
// - The duration is the difference of two doubles, off by u. The division by it adds u.
// In all, duration·rate is off by at most (8 + 12)π·u < 63u, and terms of second order. The code
// uses 128u = 2^-57, which also covers the rounding of the error itself.
RowRotation rowRotation(const TimedRow& from, const TimedRow& to, Eigen::Index first) {
  using Real = long double;
  using RealVec = Eigen::Matrix<Real, 3, 1>;
  const Eigen::Matrix<Real, 4, 1> a = from.position.segment<4>(first).cast<Real>(),
                                  b = to.position.segment<4>(first).cast<Real>();
  RowRotation result;
  const bool rests = a == b || a == -b;
  Real w = a.dot(b);
  RealVec v = a[3] * b.head<3>() - b[3] * a.head<3>() - b.head<3>().cross(a.head<3>());
  if (w < 0) w = -w, v = -v;
  const Real sine = rests ? 0 : v.norm(), angle = 2 * std::atan2(sine, w),
             duration = Real(to.time) - Real(from.time);
  result.ambiguous =
      a.isZero(0) || b.isZero(0) || !(angle < std::numbers::pi_v<Real> - kHalfTurnBand);
  if (rests) return result;
  if (sine > 0) result.rate = v * (angle / sine / duration);
  result.error = 0x1p-57L / duration;
  return result;
}

}  // namespace corridor
