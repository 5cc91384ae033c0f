#include "planner/robot/tangent_step.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/circle.h"
#include "planner/robot/angles.h"
#include "planner/robot/difference.h"

namespace corridor {

Eigen::Quaterniond rotationOf(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle));
}

Eigen::Vector3d rotationVector(const Eigen::Vector4d& a, const Eigen::Vector4d& b) {
  const auto quaternionOf = [](const Eigen::Vector4d& numbers) {
    return Eigen::Quaterniond(Eigen::Vector4d(numbers.stableNormalized()));
  };
  // R_b = exp(v)·R_a, where v is in the coordinates of the frame in which a and b are given.
  Eigen::Quaterniond turn = quaternionOf(b) * quaternionOf(a).conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().stableNorm();
  if (sine == 0) return Eigen::Vector3d::Zero();
  return turn.vec() * (2 * std::atan2(sine, turn.w()) / sine);
}

Eigen::Index stepSize(const Coordinate& coordinate) {
  return coordinate.kind == Coordinate::Kind::rotation ? 3 : 1;
}

std::vector<Eigen::Index> firstsInStep(const ConfigurationSpace& space) {
  std::vector<Eigen::Index> firsts;
  Eigen::Index at = 0;
  for (const Coordinate& c : space.coordinates()) {
    firsts.push_back(at);
    at += stepSize(c);
  }
  return firsts;
}

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
    const auto i = static_cast<Eigen::Index>(c.first);
    switch (c.kind) {
      case Coordinate::Kind::line:
        step[at] = to[i] - from[i];
        break;
      case Coordinate::Kind::circle:
        step[at] = circleTurn(from[i], to[i]).angle;
        break;
      case Coordinate::Kind::rotation:
        step.segment<3>(at) = rotationVector(from.segment<4>(i), to.segment<4>(i));
        break;
    }
    at += stepSize(c);
  }
  return step;
}

double weightedLength(const ConfigurationSpace& space, const Configuration& from,
                      const Configuration& to, const TangentStep& weights) {
  double squares = 0;
  Eigen::Index at = 0;
  for (const Coordinate& c : space.coordinates()) {
    // The difference of a rotation is half of its angle.
    const double unit = c.kind == Coordinate::Kind::rotation ? 2 : 1,
                 length = unit * weights[at] * differenceOf(c, from, to);
    squares += length * length;
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
