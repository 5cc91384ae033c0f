#include "planner/trajectory/link_speed.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace corridor {
namespace {

/// The pose of a frame in the world, its angular velocity, and the velocity of its origin.
struct MovingFrame {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero(), linear = Eigen::Vector3d::Zero();
};

MovingFrame childOf(const MovingFrame& parent, const Frame& frame, const Configuration& q,
                    const Configuration& velocity) {
  MovingFrame child;
  const Eigen::Vector3d arm = parent.R * frame.fixed.p;
  child.R = parent.R * frame.fixed.q.normalized().toRotationMatrix();
  child.p = parent.p + arm;
  child.angular = parent.angular;
  child.linear = parent.linear + parent.angular.cross(arm);
  const bool moves = frame.moves();
  const auto variable = moves ? static_cast<Eigen::Index>(frame.variable) : 0;
  switch (frame.joint) {
    case Frame::Joint::none:
      break;
    case Frame::Joint::revolute: {
      const Eigen::Vector3d axis = frame.axis.stableNormalized();
      if (moves) child.angular += child.R * axis * (frame.multiplier * velocity[variable]);
      const double angle = frame.offset + (moves ? frame.multiplier * q[variable] : 0);
      child.R *= Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      break;
    }
    case Frame::Joint::prismatic: {
      const Eigen::Vector3d axis = child.R * frame.axis.stableNormalized();
      const Eigen::Vector3d way =
          axis * (frame.offset + (moves ? frame.multiplier * q[variable] : 0));
      child.p += way;
      child.linear += child.angular.cross(way);
      if (moves) child.linear += axis * (frame.multiplier * velocity[variable]);
      break;
    }
    case Frame::Joint::translation: {
      Eigen::Vector3d shift = Eigen::Vector3d::Zero(), speed = Eigen::Vector3d::Zero();
      const auto count = static_cast<Eigen::Index>(frame.count);
      shift.head(count) = q.segment(variable, count);
      speed.head(count) = velocity.segment(variable, count);
      child.p += child.R * shift;
      child.linear += child.angular.cross(child.R * shift) + child.R * speed;
      break;
    }
    case Frame::Joint::rotation: {
      child.angular += child.R * velocity.segment<3>(variable);
      const Eigen::Vector4d numbers = q.segment<4>(variable);
      child.R *= Eigen::Quaterniond(Eigen::Vector4d(numbers.stableNormalized())).toRotationMatrix();
      break;
    }
  }
  return child;
}

}  // namespace

std::vector<double> linkSpeedShares(const KinematicTree& tree, const std::vector<LinkSpeed>& links,
                                    const Configuration& q, const Configuration& velocity) {
  std::vector<double> shares;
  if (links.empty()) return shares;
  std::size_t last = 0;
  for (const LinkSpeed& link : links) last = std::max(last, link.frame);
  std::vector<MovingFrame> frames(last + 1);
  for (std::size_t f = 1; f <= last; ++f)
    frames[f] = childOf(frames[tree.frames[f].parent], tree.frames[f], q, velocity);
  for (const LinkSpeed& link : links) {
    const MovingFrame& frame = frames[link.frame];
    double fastest = 0;
    for (const Eigen::Vector3d& point : link.points)
      fastest = std::max(fastest, (frame.linear + frame.angular.cross(frame.R * point)).norm());
    shares.push_back(fastest / link.speed);
  }
  return shares;
}

PointBounds pointBounds(const KinematicTree& tree, const LinkSpeed& link,
                        const Configuration& reach, const Configuration& velocity,
                        const Configuration& acceleration) {
  // The loop goes from the link to the world. In each frame, a point has |r| ≤ L, |ṙ| ≤ V and |r̈|
  // ≤ A relative to the frame's origin. The frame rotates the point about this origin, with |ω| ≤ w
  // and |ω̇| ≤ e, and translates it, with |d| ≤ l, |ḋ| ≤ v and |d̈| ≤ c. In the parent frame, the
  // point is at R·r + d. The bounds of its position, velocity and acceleration there are
  //   L + l;  V + w·L + v;  A + 2·w·V + e·L + w²·L + c.
  double length = 0, speed = 0, result = 0;
  for (const Eigen::Vector3d& point : link.points) length = std::max(length, point.norm());
  for (std::size_t f = link.frame; f != 0; f = tree.frames[f].parent) {
    const Frame& frame = tree.frames[f];
    double w = 0, e = 0, l = frame.fixed.p.norm(), v = 0, c = 0;
    const bool moves = frame.moves();
    const auto i = moves ? static_cast<Eigen::Index>(frame.variable) : 0;
    const double by = std::abs(frame.multiplier);
    switch (frame.joint) {
      case Frame::Joint::none:
        break;
      case Frame::Joint::revolute:
        if (moves) w = by * velocity[i], e = by * acceleration[i];
        break;
      case Frame::Joint::prismatic:
        l += std::abs(frame.offset);
        if (moves) l += by * reach[i], v = by * velocity[i], c = by * acceleration[i];
        break;
      case Frame::Joint::translation: {
        const auto count = static_cast<Eigen::Index>(frame.count);
        l += reach.segment(i, count).norm();
        v = velocity.segment(i, count).norm();
        c = acceleration.segment(i, count).norm();
        break;
      }
      case Frame::Joint::rotation:
        w = velocity.segment<3>(i).norm();
        e = acceleration.segment<3>(i).norm();
        break;
    }
    result += 2 * w * speed + (e + w * w) * length + c;
    speed += w * length + v;
    length += l;
  }
  return {speed, result};
}

}  // namespace corridor
