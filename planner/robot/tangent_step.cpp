#include "planner/robot/tangent_step.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/circle.h"
#include "planner/robot/angles.h"

namespace corridor {

namespace {

Eigen::Index stepSize(const Coordinate& c) {
  return c.kind == Coordinate::Kind::rotation ? 3 : 1;
}

/// Returns the quaternion of a rotation vector.
Eigen::Quaterniond rotationOf(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

}  // namespace

Eigen::Index tangentSize(const ConfigurationSpace& space) {
  Eigen::Index size = 0;
  for (const Coordinate& c : space.coordinates()) size += stepSize(c);
  return size;
}

TangentStep tangentWeights(const ConfigurationSpace& space) {
  TangentStep weights(tangentSize(space));
  Eigen::Index at = 0;
  for (const Coordinate& c : space.coordinates()) {
    // In the space's distance, a rotation counts with its quaternion angle, which is half of the
    // rotation angle.
    const bool rotation = c.kind == Coordinate::Kind::rotation;
    weights.segment(at, stepSize(c)).setConstant(rotation ? c.weight / 2 : c.weight);
    at += stepSize(c);
  }
  return weights;
}

Configuration displaced(const ConfigurationSpace& space, const Configuration& q,
                        const TangentStep& step) {
  Configuration moved = q;
  Eigen::Index at = 0;
  for (const Coordinate& c : space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    switch (c.kind) {
      case Coordinate::Kind::line:
        moved[i] = std::clamp(q[i] + step[at], std::min(c.lower, q[i]), std::max(c.upper, q[i]));
        break;
      case Coordinate::Kind::circle:
        moved[i] = intoCircle(q[i] + step[at]);
        break;
      case Coordinate::Kind::rotation: {
        const Eigen::Quaterniond before = unitQuaternion(Eigen::Quaterniond(q.data() + c.first));
        moved.segment<4>(i) = (rotationOf(step.segment<3>(at)) * before).normalized().coeffs();
        break;
      }
    }
    at += stepSize(c);
  }
  return moved;
}

}  // namespace corridor
