#pragma once

#include <limits>

#include "collision/core/transform.h"
#include "planner/robot/curve.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// A constant pose in long double. Consecutive constant poses are multiplied in long double and
/// rounded to double once.
struct LongPose {
  using Scalar = long double;
  static_assert(std::numeric_limits<Scalar>::digits >= 64);
  using Mat = Eigen::Matrix<Scalar, 3, 3>;
  using Vec = Eigen::Matrix<Scalar, 3, 1>;
  Mat m = Mat::Identity();
  Vec t = Vec::Zero();
  double error = 0;   ///< upper bound of the operator norm of the error of m
  double length = 0;  ///< metres: sum of the lengths of the translations of all poses so far
  int poses = 0;      ///< number of poses multiplied so far

  /// Returns this pose followed by the fixed pose of `frame` and, if its joint is held, by the
  /// motion of that joint.
  LongPose then(const Frame& frame) const;
};

/// The pose X(t) = fixed · joint(t) of a frame along an edge or a piece of a curve, relative to an
/// ancestor of the frame: the nearest one that EdgeMotion keeps. `fixed` includes the constant
/// poses of all frames between the two. Everything that is constant on the edge is computed once
/// per edge. Each bound on rounding holds for the whole edge. Below, "edge" also stands for a piece
/// of a curve.
class MovingJoint {
 public:
  /// Makes the pose `fixed`, followed by the joint of `frame`. `fixed` includes the frame's own
  /// fixed pose.
  /// @param kind the kind of the coordinate that moves the joint.
  /// @param tube as in EdgeMotion, for all numbers of a Configuration.
  MovingJoint(const Frame& frame, const LongPose& fixed, Coordinate::Kind kind,
              const Configuration& tube);
  /// Makes a constant pose.
  explicit MovingJoint(const LongPose& fixed);

  void set(const Configuration& from, const Configuration& to);
  void set(const CurvePiece& piece);

  /// Returns the pose at t. On a piece of a curve, also sets `rate`, `axis` and `deviation` for t.
  Transform at(double t);

  Frame::Joint joint() const { return joint_; }  ///< `none`: a constant pose
  /// Half width of the tube for this joint, metres or radians. On a piece of a curve, it includes
  /// the piece's `error`.
  double tube() const { return tube_ + curveError_; }

  // Properties of the current edge:
  /// True if the edge defines no motion of the joint: a rotation by half a turn has no unique
  /// direction, a joint that mimics a circle would jump, a displacement overflows, or a
  /// number is not finite.
  bool ambiguous() const { return ambiguous_; }
  bool still() const { return largestRate_ == 0; }
  const Vec3& axis() const { return axis_; }  ///< unit vector, in the frame's coordinates
  /// Signed speed of the joint per unit of t, about or along the axis; rad or m. On a piece of a
  /// curve, the speed at the t of the last call of `at`.
  double rate() const { return rate_; }
  /// Returns an upper bound of |rate| + rateError on the whole edge.
  double largestRate() const { return largestRate_; }
  /// Returns an upper bound of the joint's deviation from the uniform motion with `rate`; rad or m.
  /// The bound holds in [t − h, t + h], for the t of the last call of `at`. It is 0 on an edge from
  /// state to state. It is infinite, so that nothing is proved, if the interval is not within [0,
  /// 1].
  double deviation(double h) const { return curve_.cols() == 0 ? 0 : curveDeviation(h); }
  /// Upper bounds, valid on the whole edge. `rateError`: the error of the vector rate·axis; the
  /// direction of `axis` may be off by another 32u. `rotationError`: the error of the matrix of
  /// `at`, as an operator norm. `shiftError`: the error of the vector of `at`, metres. `length`:
  /// the length of the exact vector of `at`, metres.
  double rateError() const { return rateError_; }
  double rotationError() const { return rotationError_; }
  double shiftError() const { return shiftError_; }
  double length() const { return length_; }
  /// The numbers of `at`, on an edge between two states. Revolute: the matrix at t is fixed + sin
  /// φ·sine + (1 − cos φ)·versine, with φ = angleAtZero + t·rate. Prismatic: the vector at t is
  /// shiftAtZero + t·shiftRate.
  const Mat3& fixed() const { return fixed_; }
  const Mat3& sine() const { return sine_; }
  const Mat3& versine() const { return versine_; }
  double angleAtZero() const { return angle_; }
  const Vec3& shiftAtZero() const { return from_; }
  const Vec3& shiftRate() const { return delta_; }

 private:
  void setValue(const Configuration& from, const Configuration& to);
  void setShift(const Configuration& from, const Configuration& to);
  void setRotation(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);
  /// @param V an upper bound of the magnitude of the joint's value, m or rad.
  void setCurveBounds(double V);
  void evaluateCurve(double t);
  double curveDeviation(double h) const;

  // The following members are constant. The matrix of a revolute joint is fixed·(1 + sin φ·K + (1 −
  // cos φ)·K²), K = axis×.
  Frame::Joint joint_ = Frame::Joint::none;
  Coordinate::Kind kind_ = Coordinate::Kind::line;
  Eigen::Index variable_ = 0, count_ = 1;
  double multiplier_ = 1, offset_ = 0;
  double tube_ = 0;
  Mat3 fixed_;
  Vec3 shift_;
  double fixedError_ = 0, fixedShiftError_ = 0, fixedLength_ = 0;
  Vec3 slideAxis_ = Vec3::Zero();  // fixed·axis

  // The following members are set for each edge. `matrixAtZero_` is the matrix of `at` for the
  // angle φ = 0.
  Mat3 matrixAtZero_, sine_ = Mat3::Zero(), versine_ = Mat3::Zero();
  double angle_ = 0;  // at t = 0
  Vec3 from_, delta_ = Vec3::Zero();
  Vec3 axis_ = Vec3::UnitX();
  double rate_ = 0, rateError_ = 0, largestRate_ = 0;
  double rotationError_ = 0, shiftError_ = 0, length_ = 0;
  bool ambiguous_ = false;

  // The members from here on are set for each piece of a curve, except for rotations. `curve_` has
  // the Bernstein coefficients of the joint's value (revolute, prismatic: first row only) or of its
  // vector (translation). It is empty if the current motion is an edge between two states.
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, CurvePiece::kLargestDegree + 1>
      curve_;
  double curveError_ = 0;                        // the piece's `error` of this joint, rad or m
  double largestSecond_ = 0, largestThird_ = 0;  // upper bounds of |q''| and |q'''|
  double second_ = 0;                            // upper bound of |q''| at evaluatedAt_
  double evaluatedAt_ = 0;                       // the t of the last call of evaluateCurve
};

}  // namespace corridor
