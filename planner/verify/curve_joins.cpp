#include "planner/verify/curve_joins.h"

#include <algorithm>
#include <cmath>

#include <boost/multiprecision/cpp_int.hpp>

#include "planner/verify/triangle_gap.h"

namespace corridor::verify {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using RealQuaternion = Eigen::Matrix<Real, 4, 1>;

bool numbersJoin(double a, double b, double errorA, double errorB) {
  if (Real(a) == Real(b)) return true;  // in long double, denormals count whatever the mode
  return abs(Rational(a) - Rational(b)) <= Rational(errorA) + Rational(errorB);
}

/// Returns whether two quaternions are multiples of each other.
bool sameRotation(const Eigen::Vector4d& p, const Eigen::Vector4d& q) {
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = i + 1; j < 4; ++j)
      if (Rational(p[i]) * Rational(q[j]) != Rational(p[j]) * Rational(q[i])) return false;
  return true;
}

bool rotationsJoin(const Eigen::Vector4d& p, const Eigen::Vector4d& q, double errorP,
                   double errorQ) {
  if (sameRotation(p, q)) return true;
  const RealQuaternion a = p.cast<Real>().normalized(), b = q.cast<Real>().normalized();
  const Real apart = (a - b).norm(), across = (a + b).norm();
  const Real angle = 4 * std::atan2(std::min(apart, across), std::max(apart, across));
  return angle + 0x1p-58L <= (Real(errorP) + Real(errorQ)) * (1 - 0x1p-60L);
}

}  // namespace

bool joins(const std::vector<Coordinate>& coordinates, const CurvePiece& before,
           const CurvePiece& after) {
  const Eigen::Index last = before.degree();
  return std::all_of(coordinates.begin(), coordinates.end(), [&](const Coordinate& c) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::rotation)
      return rotationsJoin(before.coefficients.block<4, 1>(i, last),
                           after.coefficients.block<4, 1>(i, 0), before.error[i], after.error[i]);
    return numbersJoin(before.coefficients(i, last), after.coefficients(i, 0), before.error[i],
                       after.error[i]);
  });
}

}  // namespace corridor::verify
