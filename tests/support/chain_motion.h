#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/motion/certify_motion.h"

namespace corridor::test {

/// A kinematic chain of revolute and prismatic joints from body a to body b. Joint values are
/// linear or quadratic in t. Poses are products of exponentials, computed in long double. Tests use
/// these poses as the reference for the positions of points. `relativeMotion` reports them rounded
/// to double.
class ChainMotion final : public MotionSource {
 public:
  using Vec3L = Eigen::Matrix<long double, 3, 1>;
  using Mat3L = Eigen::Matrix<long double, 3, 3>;
  struct Joint {
    bool slides = false;                              ///< true: prismatic; false: revolute
    Vec3 axis = Vec3::UnitZ(), point = Vec3::Zero();  ///< at joint value 0; |axis| is not 0
    double from = 0, to = 0;
    double bend = 0;  ///< the joint value is from + t(to − from) + bend·t(1 − t), rad or m

    long double value(long double t) const {
      return from + t * (static_cast<long double>(to) - from) + bend * t * (1 - t);
    }
    long double rate(long double t) const {
      return static_cast<long double>(to) - from + bend * (1 - 2 * t);
    }
  };
  struct Pose {
    Mat3L R = Mat3L::Identity();
    Vec3L t = Vec3L::Zero();
    Vec3L operator*(const Vec3L& p) const { return R * p + t; }
  };

  explicit ChainMotion(std::vector<Joint> joints) : joints_(std::move(joints)) {}

  /// Returns the pose at time t after the first `count` joints, as seen from body a.
  Pose pose(long double t, std::size_t count) const {
    Pose X;
    for (std::size_t j = 0; j < count; ++j) {
      const Joint& joint = joints_[j];
      const long double value = joint.value(t);
      const Vec3L axis = joint.axis.cast<long double>().normalized(),
                  point = joint.point.cast<long double>();
      if (joint.slides) {
        X.t += X.R * axis * value;
      } else {
        const Mat3L R = turn(axis, value);
        X.t += X.R * (point - R * point);
        X.R = (X.R * R).eval();
      }
    }
    return X;
  }
  Pose pose(long double t) const { return pose(t, joints_.size()); }

  RelativeMotion relativeMotion(std::size_t, double t, double h) override {
    const Pose X = pose(t);
    Vec3L linear = Vec3L::Zero(), angular = Vec3L::Zero();
    long double size = X.t.norm();
    screws_.clear();
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      const Joint& joint = joints_[j];
      const Pose before = pose(t, j);
      const Vec3L axis = before.R * joint.axis.cast<long double>().normalized(),
                  point = before * joint.point.cast<long double>();
      const long double half = h * joint.rate(t);
      if (joint.slides) {
        linear += half * axis;
      } else {
        linear += half * axis.cross(X.t - point);
        angular += half * axis;
      }
      size += point.norm() + std::abs(half) * (1 + (X.t - point).norm());
      screws_.push_back(
          {.kind = joint.slides ? ScrewMotion::Kind::prismatic : ScrewMotion::Kind::revolute,
           .axis = axis.cast<double>(),
           .point = point.cast<double>(),
           .amount = roundedUp(static_cast<double>(std::abs(half))),
           .deviation = joint.bend == 0 ? 0 : roundedUp(std::abs(joint.bend) * h * h)});
    }
    RelativeMotion w;
    w.X_AB = {X.R.cast<double>(), X.t.cast<double>()};
    w.linear = linear.cast<double>();
    w.angular = angular.cast<double>();
    w.speed = roundedUp(w.linear.norm());
    w.angle = roundedUp(w.angular.norm());
    w.screws = screws_;
    // Each number is rounded once. With u the unit roundoff, one joint causes errors of at most 4u
    // times the sum of all lengths and 4u times the sum of all angles. The factor 16u leaves room
    // for several joints.
    w.fixedError = 16 * kUnit * static_cast<double>(size);
    w.reachError = 16 * kUnit * static_cast<double>(1 + angular.norm());
    return w;
  }
  bool ambiguous() const override { return false; }
  bool still() const override { return false; }

  static Mat3L turn(const Vec3L& axis, long double value) {
    Mat3L K;
    K << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
    const long double half = std::sin(value / 2);
    return Mat3L::Identity() + std::sin(value) * K + 2 * half * half * K * K;
  }

 private:
  std::vector<Joint> joints_;
  std::vector<ScrewMotion> screws_;
};

}  // namespace corridor::test
