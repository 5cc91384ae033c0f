#pragma once

#include <limits>

#include "collision/core/transform.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// A pose in long double: what doesn't move is put together in it, and rounded once.
struct LongPose {
  using Scalar = long double;
  static_assert(std::numeric_limits<Scalar>::digits >= 64);
  using Mat = Eigen::Matrix<Scalar, 3, 3>;
  using Vec = Eigen::Matrix<Scalar, 3, 1>;
  Mat m = Mat::Identity();
  Vec t = Vec::Zero();
  double error = 0;   ///< of m, as an operator norm
  double length = 0;  ///< metres, the sum of the lengths of what was put together
  int poses = 0;      ///< and how many

  /// `frame` after this: its fixed pose, and its joint where that is held.
  LongPose then(const Frame& frame) const;
};

/// A frame's place in the one that it is seen from, X(t) = fixed · joint(t), along an edge: what is
/// constant on the edge is computed once, and its rounding is a bound for the whole of it.
class MovingJoint {
 public:
  /// The pose `fixed` (which includes the frame's own) and after it the frame's joint.
  /// @param kind of the coordinate that moves it. @param tube of all numbers of a Configuration.
  MovingJoint(const Frame& frame, const LongPose& fixed, Coordinate::Kind kind,
              const Configuration& tube);
  /// A constant pose.
  explicit MovingJoint(const LongPose& fixed);

  void set(const Configuration& from, const Configuration& to);

  Transform at(double t) const;

  Frame::Joint joint() const { return joint_; }  ///< `none`: constant
  double tube() const { return tube_; }          ///< metres or radians

  // Of the edge:
  bool ambiguous() const { return ambiguous_; }
  bool still() const { return rate_ == 0; }
  const Vec3& axis() const { return axis_; }  ///< unit, in the frame itself
  /// What the joint does per unit of t, about or along the axis; signed. rad or m.
  double rate() const { return rate_; }
  /// Bounds: of |rate·axis − the real one| (`axis` may besides be off by 32u), of the matrix (as an
  /// operator norm) and the vector (metres) of `at`, and of the real vector's length.
  double rateError() const { return rateError_; }
  double rotationError() const { return rotationError_; }
  double shiftError() const { return shiftError_; }
  double length() const { return length_; }

 private:
  void setValue(const Configuration& from, const Configuration& to);
  void setShift(const Configuration& from, const Configuration& to);
  void setRotation(const Configuration& from, const Configuration& to);

  // Of the model. A turn's matrix is fixed·(1 + sin φ·K + (1 − cos φ)·K²), K = axis×.
  Frame::Joint joint_ = Frame::Joint::none;
  Coordinate::Kind kind_ = Coordinate::Kind::line;
  Eigen::Index variable_ = 0, count_ = 1;
  double multiplier_ = 1, offset_ = 0;
  double tube_ = 0;
  Mat3 fixed_;
  Vec3 shift_;
  double fixedError_ = 0, fixedShiftError_ = 0, fixedLength_ = 0;
  Vec3 slideAxis_ = Vec3::Zero();  // fixed·axis

  // Of the edge.
  Mat3 still_, sine_ = Mat3::Zero(), versine_ = Mat3::Zero();
  double angle_ = 0;  // at t = 0
  Vec3 from_, delta_ = Vec3::Zero();
  Vec3 axis_ = Vec3::UnitX();
  double rate_ = 0, rateError_ = 0;
  double rotationError_ = 0, shiftError_ = 0, length_ = 0;
  bool ambiguous_ = false;
};

}  // namespace corridor
