#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "collision/core/circle.h"

namespace corridor {

/// Returns whether an angle that is given in radians is probably meant in degrees. This is assumed
/// if the magnitude of the angle is a multiple of 15 and larger than 2π, as for 90 or -180.
inline bool seemsDegrees(double radians) {
  return std::abs(radians) > 2 * std::numbers::pi && std::remainder(radians, 15) == 0;
}

/// Returns whether a value in radians that is outside of [lower, upper] is obviously meant in
/// degrees. This is assumed if the magnitude of the value is more than 2π, and the value is within
/// the limits if it is read as degrees.
inline bool fitsAsDegrees(double value, double lower, double upper) {
  const double radians = value * (std::numbers::pi / 180);
  return std::abs(value) > 2 * std::numbers::pi && lower <= radians && radians <= upper;
}

/// Returns the normalised quaternion, without overflow or underflow for coefficients of any size.
/// @pre `q` is finite and not zero.
inline Eigen::Quaterniond unitQuaternion(const Eigen::Quaterniond& q) {
  const double squared = q.squaredNorm();
  if (squared > 1e-200 && squared < 1e200) return q.normalized();
  const Eigen::Vector4d scaled = q.coeffs() / q.coeffs().cwiseAbs().maxCoeff();
  return Eigen::Quaterniond(Eigen::Vector4d(scaled / scaled.norm()));
}

/// Returns the quaternion angle between a and b, which is half the angle of the rotation from a to
/// b. The result is in [0, π/2] radians, for quaternions of any norm above 0; it is 0 for equal
/// quaternions.
///
/// The error is at most 4u·√3, from the sums of four products in the vector part, plus a few ulp of
/// the result. Here u = 2^-53.
///
/// Planners spend half of their own time in this function, so it is fast. The length of the
/// relative quaternion's vector part is the sine of the angle, and the magnitude of the scalar part
/// is the cosine. The function takes the arc sine of the sine if the sine is smaller than the
/// cosine, and otherwise the arc cosine of the cosine. Each of the two functions is well
/// conditioned where it is used, and costs half as much as an arc tangent.
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
