#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "collision/core/circle.h"

namespace corridor {

/// Norm 1, whatever the size of the coefficients. @pre finite, not zero.
inline Eigen::Quaterniond unitQuaternion(const Eigen::Quaterniond& q) {
  const double squared = q.squaredNorm();
  if (squared > 1e-200 && squared < 1e200) return q.normalized();
  const Eigen::Vector4d scaled = q.coeffs() / q.coeffs().cwiseAbs().maxCoeff();
  return Eigen::Quaterniond(Eigen::Vector4d(scaled / scaled.norm()));
}

/// Half the angle of the rotation from a to b, in [0, π/2], whatever their norms. Planners spend
/// half of their own time on it: of the relative quaternion (vector, scalar) the smaller part is
/// taken by its arc sine or cosine, which is well conditioned there and costs half of an arc
/// tangent. Within 4u·√3 for the vector's sums of four products, and some ulp; 0 for equal
/// quaternions.
inline double quaternionAngle(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const double squares = a.squaredNorm() * b.squaredNorm();
  const bool plain = squares > 1e-200 && squares < 1e200;
  const Eigen::Quaterniond p = plain ? a : unitQuaternion(a), q = plain ? b : unitQuaternion(b);
  const double scale = plain ? 1 / std::sqrt(squares) : 1;
  const double x = p.w() * q.x() - q.w() * p.x() + (p.z() * q.y() - p.y() * q.z()),
               y = p.w() * q.y() - q.w() * p.y() + (p.x() * q.z() - p.z() * q.x()),
               z = p.w() * q.z() - q.w() * p.z() + (p.y() * q.x() - p.x() * q.y());
  const double sine = std::sqrt(x * x + y * y + z * z) * scale, cosine = std::abs(p.dot(q)) * scale;
  return sine < cosine ? std::asin(sine) : std::acos(std::min(cosine, 1.0));
}

}  // namespace corridor
