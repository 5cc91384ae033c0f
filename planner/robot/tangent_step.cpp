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

/// Returns the rotation vector of the shorter rotation from one quaternion to another.
Eigen::Vector3d turnBetween(const double* from, const double* to) {
  const Eigen::Quaterniond turn =
      unitQuaternion(Eigen::Quaterniond(to)) * unitQuaternion(Eigen::Quaterniond(from)).conjugate();
  const double sine = turn.vec().norm();  // of half the angle
  if (sine == 0) return Eigen::Vector3d::Zero();
  return std::copysign(2 * std::atan2(sine, std::abs(turn.w())) / sine, turn.w()) * turn.vec();
}

/// Returns the change of a line, or of a circle by the shorter way.
double differenceIn(const Coordinate& c, const Configuration& from, const Configuration& to) {
  const auto i = static_cast<Eigen::Index>(c.first);
  return c.kind == Coordinate::Kind::circle ? circleTurn(from[i], to[i]).angle : to[i] - from[i];
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

TangentStep stepBetween(const ConfigurationSpace& space, const Configuration& from,
                        const Configuration& to) {
  TangentStep step(tangentSize(space));
  Eigen::Index at = 0;
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind == Coordinate::Kind::rotation)
      step.segment<3>(at) = turnBetween(from.data() + c.first, to.data() + c.first);
    else
      step[at] = differenceIn(c, from, to);
    at += stepSize(c);
  }
  return step;
}

double weightedLength(const ConfigurationSpace& space, const Configuration& from,
                      const Configuration& to, const TangentStep& weights) {
  double squares = 0;
  Eigen::Index at = 0;
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind == Coordinate::Kind::rotation) {
      const Eigen::Vector3d turn = turnBetween(from.data() + c.first, to.data() + c.first);
      squares += turn.cwiseProduct(weights.segment<3>(at)).squaredNorm();
    } else {
      squares += std::pow(weights[at] * differenceIn(c, from, to), 2);
    }
    at += stepSize(c);
  }
  return std::sqrt(squares);
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
