#include "planner/verify/curve_joins.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <boost/multiprecision/cpp_int.hpp>

#include "planner/verify/triangle_gap.h"

namespace corridor::verify {
namespace {

using Fraction = boost::multiprecision::cpp_rational;
using RealQuaternion = Eigen::Matrix<Real, 4, 1>;

/// Conversions by way of long double keep denormals in every mode of the vector unit. (Comparisons
/// of doubles don't, even if they are written in long double: compilers narrow them.)
Fraction exact(Real value) {
  return Fraction(value);
}

bool numbersJoin(double a, double b, double errorA, double errorB) {
  if (std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b)) return true;
  return abs(exact(a) - exact(b)) <= exact(errorA) + exact(errorB);
}

/// Returns whether two quaternions are multiples of each other.
bool sameRotation(const Eigen::Vector4d& p, const Eigen::Vector4d& q) {
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = i + 1; j < 4; ++j)
      if (exact(p[i]) * exact(q[j]) != exact(p[j]) * exact(q[i])) return false;
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
