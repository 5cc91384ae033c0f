#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "planner/robot/angles.h"
#include "planner/robot/configuration_space.h"

namespace corridor {

/// Returns the absolute difference of a and b in one coordinate, without the weight: metres, or
/// radians the shorter way round. For a rotation, the result is the quaternion angle, which is half
/// the rotation angle. The function is inline because planners spend much of their time in
/// distances.
/// @param a, b pointers to the first number of two configurations.
inline double differenceOf(const Coordinate& c, const double* a, const double* b) {
  if (c.kind == Coordinate::Kind::rotation)
    return quaternionAngle(Eigen::Quaterniond(a + c.first), Eigen::Quaterniond(b + c.first));
  const double from = a[c.first], to = b[c.first];
  return std::abs(c.kind == Coordinate::Kind::circle ? circleTurn(from, to).angle : to - from);
}
inline double differenceOf(const Coordinate& c, const Configuration& a, const Configuration& b) {
  return differenceOf(c, a.data(), b.data());
}

}  // namespace corridor
