#include "planner/robot/moving_joint.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/core/rounding.h"
#include "planner/robot/angles.h"

namespace corridor {
namespace {

using Scalar = LongPose::Scalar;

LongPose::Mat crossMatrix(const LongPose::Vec& a) {
  LongPose::Mat K;
  K << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return K;
}

LongPose::Vec unitAxis(const Vec3& axis) {
  return axis.cast<Scalar>().stableNormalized();
}

/// Returns K and K² for K = axis×. The rotation by φ is 1 + sin φ·K + (1 − cos φ)·K².
std::pair<LongPose::Mat, LongPose::Mat> rodrigues(const LongPose::Vec& axis) {
  const LongPose::Mat K = crossMatrix(axis);
  return {K, K * K};
}

// Error constants, with u the unit roundoff. The norm of a matrix error is bounded by the Frobenius
// norm of the errors of the entries.
//
// Constant poses. Rounding a long double pose to double costs 2^-53·√3 < 2u for a matrix with rows
// of norm 1. Each product of poses in long double costs less than 2^-58 (some 30 roundings of
// 2^-64).
//
// Revolute joint, fixed + sin φ·FK + (1 − cos φ)·FK²:
// - the three constant matrices: √3 + √2 + 2√2 < 6u;
// - sine and cosine, 1 ulp each, doubled as a reserve for libm: 4u each; with the rounding of 1 −
//   cos φ: 9u;
// - the sum, 3 roundings of terms with norms √3, √2, 2√2: 18u.
// The sum of these errors is below 40u. The error of φ is added separately.
constexpr double kConstantPoseError = 0x1p-58;
constexpr double kTurnError = 40 * kUnit;
// Free rotation (collision/motion/rigid_motion.cpp derives the first two items):
// - normalising: 6u per quaternion; the relative quaternion: 20u;
// - the angle θ = 2·atan2(s, w): 48u; the axis: 20u/s + 3u, where θ/s ≤ π. The rotation vector is
//   therefore within 48u + 73u, below 2^-45.
// - the matrices, and their sum with sine and cosine: below 200u for the orientation;
// - the product of `fixed` with each of the three matrices (norms √3, √2, 2√2): 3u·√3·6 + 6·2u <
//   44u.
// The orientation is within 2^-44 = 512u.
constexpr double kFreeTurnError = 0x1p-44;
constexpr double kFreeRateError = 0x1p-45;

/// The square of a number of at least this magnitude is a normal number. Smaller motions are
/// treated as rest; EdgeMotion's least error covers them.
constexpr double kLeastMotion = 0x1p-500;
/// Returns whether a displacement is treated as rest. A displacement with NaN is not: Eigen's
/// `maxCoeff` would drop a NaN that is not the first coefficient.
bool isRest(const Vec3& v) {
  return (v.array().abs() < kLeastMotion).all();
}

}  // namespace

LongPose LongPose::then(const Frame& frame) const {
  const Eigen::Quaternion<Scalar> q(
      Eigen::Matrix<Scalar, 4, 1>(frame.fixed.q.coeffs().cast<Scalar>().stableNormalized()));
  LongPose next = *this;
  next.t += m * frame.fixed.p.cast<Scalar>();
  next.m = m * rotationMatrix(q);
  next.length = roundedUp(length + frame.fixed.p.norm());
  if (frame.variable == Frame::noVariable) {
    if (frame.joint == Frame::Joint::revolute) {
      const auto [K, KK] = rodrigues(unitAxis(frame.axis));
      const Scalar value = frame.offset;
      next.m += next.m * (std::sin(value) * K + (1 - std::cos(value)) * KK);
    } else if (frame.joint == Frame::Joint::prismatic) {
      next.t += next.m * (frame.offset * unitAxis(frame.axis));
      next.length = roundedUp(next.length + std::abs(frame.offset));
    }
  }
  ++next.poses;
  next.error = 2 * kUnit + next.poses * kConstantPoseError;
  return next;
}

MovingJoint::MovingJoint(const LongPose& fixed)
    : fixed_(fixed.m.cast<double>()),
      shift_(fixed.t.cast<double>()),
      fixedError_(fixed.error),
      // Rounding the sum to double costs 2u·length. In long double, the vector of each pose is
      // rotated. Each such rotation adds less than 2^-5 times this error.
      fixedShiftError_(2 * kUnit * fixed.length * (1 + 0x1p-5 * fixed.poses)),
      fixedLength_(fixed.length),
      matrixAtZero_(fixed_),
      from_(shift_),
      rotationError_(fixedError_),
      shiftError_(fixedShiftError_),
      length_(fixedLength_) {}

MovingJoint::MovingJoint(const Frame& frame, const LongPose& fixed, Coordinate::Kind kind,
                         const Configuration& tube)
    : MovingJoint(fixed) {
  joint_ = frame.joint;
  kind_ = kind;
  variable_ = static_cast<Eigen::Index>(frame.variable);
  multiplier_ = frame.multiplier;
  offset_ = frame.offset;
  tube_ = tube[variable_];
  if (joint_ == Frame::Joint::translation) {
    count_ = static_cast<Eigen::Index>(frame.count);
    tube_ = tube.segment(variable_, count_).norm();
  } else if (joint_ != Frame::Joint::rotation) {
    tube_ *= std::abs(multiplier_);
    const LongPose::Vec axis = unitAxis(frame.axis);
    axis_ = axis.cast<double>();
    slideAxis_ = (fixed.m * axis).cast<double>();
    if (joint_ == Frame::Joint::revolute) {
      const auto [K, KK] = rodrigues(axis);
      sine_ = (fixed.m * K).cast<double>();
      versine_ = (fixed.m * KK).cast<double>();
    }
  }
  tube_ = tube_ == 0 ? 0 : roundedUp(tube_);  // NaN stays NaN
}

Transform MovingJoint::at(double t) {
  const bool curved = curve_.cols() > 0;
  if (curved) evaluateCurve(t);
  Transform X{matrixAtZero_, from_};
  if (joint_ == Frame::Joint::revolute || joint_ == Frame::Joint::rotation) {
    const double phi = curved ? angle_ : angle_ + t * rate_;
    // 1 − cos φ cancels for small φ, but only its absolute error matters.
    X.m += std::sin(phi) * sine_ + (1 - std::cos(phi)) * versine_;
  } else if (!curved) {
    X.t += t * delta_;
  }
  return X;
}

void MovingJoint::set(const Configuration& from, const Configuration& to) {
  curve_.resize(3, 0);
  curveError_ = 0;
  if (joint_ == Frame::Joint::translation) setShift(from, to);
  if (joint_ == Frame::Joint::rotation)
    setRotation(Eigen::Quaterniond(from.data() + variable_),
                Eigen::Quaterniond(to.data() + variable_));
  if (joint_ == Frame::Joint::revolute || joint_ == Frame::Joint::prismatic) setValue(from, to);
  largestRate_ = rate_ == 0 ? 0 : std::abs(rate_) + rateError_;
}

// A piece of degree n, with u the unit roundoff. V is an upper bound: of the magnitude of each
// coefficient, or, for a translation, of the length of the vector of the largest coordinates. The
// coefficients c_i of the value m·q + o have rounding errors of at most 2uV.
//
// Evaluation by de Casteljau. A step (1 − t)a + tb rounds by at most 4uV: 1 − t, two products and
// the sum, each u times terms whose sum is at most V. After n steps, with the coefficients: (4n +
// 2)uV. For vectors this holds for each coordinate, and so for the length.
//
// Derivatives are differences of values after n − 1, n − 2 steps:
// - n(b_1 − b_0): both are off by (4n − 2)uV, and the difference and the product round by 2u of a
//   term of at most 2nV. Together these errors are below 8n²uV + 4nuV; the code uses 12n²uV.
// - n(n − 1)(b_2 − 2b_1 + b_0): four times (4n − 6)uV, and four roundings of terms of at most 4V.
//   Together these errors are below n²(16n + 16)uV; the code uses 36n³uV.
// On [0, 1], |q'| ≤ n·max|Δc|, |q''| ≤ n(n − 1)·max|Δ²c| and |q'''| ≤ n(n − 1)(n − 2)·max|Δ³c|,
// because a polynomial is in the convex hull of its coefficients. A difference of order k of the
// rounded coefficients is off by 2^k·2uV, and its own roundings add k·2^k·uV. For k ≤ 3 both are
// below 8·2^k·uV.
//
// Deviation. By Taylor's formula, |q(t + s) − q(t) − s q'(t)| ≤ ½s² max|q''|, and on the interval
// |q''| ≤ |q''(t)| + h·max|q'''|.
void MovingJoint::set(const CurvePiece& piece) {
  curve_.resize(3, 0);
  curveError_ = 0;
  if (joint_ == Frame::Joint::none) return;
  const auto& d = piece.coefficients;
  if (joint_ == Frame::Joint::rotation) {
    setRotation(Eigen::Quaterniond(Eigen::Vector4d(d.col(0).segment<4>(variable_))),
                Eigen::Quaterniond(Eigen::Vector4d(d.rightCols<1>().col(0).segment<4>(variable_))));
    largestRate_ = rate_ == 0 ? 0 : std::abs(rate_) + rateError_;
    curveError_ = piece.error[variable_] == 0 ? 0 : roundedUp(piece.error[variable_]);
    return;
  }
  curve_.setZero(3, d.cols());
  const bool translates = joint_ == Frame::Joint::translation;
  double V = 0;
  if (translates) {
    curve_.topRows(count_) = d.middleRows(variable_, count_);
    curveError_ = piece.error.segment(variable_, count_).norm();
    V = roundedUp(curve_.cwiseAbs().rowwise().maxCoeff().norm());
  } else {
    curve_.row(0) = (multiplier_ * d.row(variable_)).array() + offset_;
    curveError_ = std::abs(multiplier_) * piece.error[variable_];
    V = roundedUp(std::abs(multiplier_) * d.row(variable_).cwiseAbs().maxCoeff() +
                  std::abs(offset_));
  }
  curveError_ = curveError_ == 0 ? 0 : roundedUp(curveError_);
  // Largest coefficients, as in V, need not notice NaN.
  ambiguous_ = !curve_.allFinite();
  setCurveBounds(V);
  const double valueError = (4 * piece.degree() + 2) * kUnit * V;
  if (joint_ == Frame::Joint::revolute) {
    rotationError_ = roundedUp(kTurnError + fixedError_ + valueError);
  } else {
    // The rounding errors of the products and sums are smaller than in `setValue` and `setShift`.
    shiftError_ = roundedUp(fixedShiftError_ + valueError + 32 * kUnit * V +
                            4 * kUnit * fixedLength_ + 3 * V * fixedError_);
    length_ = roundedUp(fixedLength_ + 2 * V);
  }
  evaluateCurve(0);
}

void MovingJoint::setCurveBounds(double V) {
  const double n = static_cast<double>(curve_.cols() - 1);
  double largest[4] = {};  // largest magnitude of the differences of each order
  auto difference = curve_;
  for (Eigen::Index order = 1; order < std::min<Eigen::Index>(4, curve_.cols()); ++order) {
    const Eigen::Index count = curve_.cols() - order;
    for (Eigen::Index i = 0; i < count; ++i)
      difference.col(i) = (difference.col(i + 1) - difference.col(i)).eval();
    largest[order] = difference.leftCols(count).colwise().norm().maxCoeff();
  }
  rateError_ = largestRate_ = largestSecond_ = largestThird_ = 0;
  if (largest[1] == 0) return;  // the joint rests
  const auto bound = [&](double factor, int order) {
    return factor > 0 ? roundedUp(factor * (largest[order] + 8 * (1 << order) * kUnit * V)) : 0;
  };
  rateError_ = roundedUp(12 * n * n * kUnit * V);
  largestRate_ = roundedUp(bound(n, 1) + rateError_);
  largestSecond_ = bound(n * (n - 1), 2);
  largestThird_ = bound(n * (n - 1) * (n - 2), 3);
}

void MovingJoint::evaluateCurve(double t) {
  const auto n = static_cast<int>(curve_.cols()) - 1;
  evaluatedAt_ = t;
  auto b = curve_;
  Vec3 second = Vec3::Zero();
  for (int left = n; left > 1; --left) {
    if (left == 2) second = n * (n - 1) * ((b.col(2) - b.col(1)) - (b.col(1) - b.col(0)));
    for (int i = 0; i < left; ++i) b.col(i) = ((1 - t) * b.col(i) + t * b.col(i + 1)).eval();
  }
  const Vec3 rate = n * (b.col(1) - b.col(0));
  const Vec3 value = (1 - t) * b.col(0) + t * b.col(1);
  if (joint_ == Frame::Joint::translation) {
    from_ = shift_ + fixed_ * value;
    rate_ = still() || isRest(rate) ? 0 : rate.norm();
    axis_ = rate_ > 0 ? Vec3(rate / rate_) : Vec3::UnitX();
  } else {
    angle_ = value[0];
    rate_ = still() ? 0 : rate[0];
    if (joint_ == Frame::Joint::prismatic) from_ = shift_ + value[0] * slideAxis_;
  }
  // `rateError_` is 12n²uV.
  second_ = n < 2 ? 0 : roundedUp(second.norm() + 3 * n * rateError_);
}

double MovingJoint::curveDeviation(double h) const {
  const double second = std::min(largestSecond_, second_ + h * largestThird_);
  if (evaluatedAt_ - h < 0 || evaluatedAt_ + h > 1)
    return second > 0 ? std::numeric_limits<double>::infinity() : 0;
  return second > 0 && h > 0 ? roundedUp(0.5 * h * h * second) : 0;
}

void MovingJoint::setValue(const Configuration& from, const Configuration& to) {
  const double q0 = from[variable_], q1 = to[variable_];
  double delta = q1 - q0, deltaError = 0;
  ambiguous_ = !std::isfinite(delta);
  if (kind_ == Coordinate::Kind::circle) {
    const CircleTurn turn = circleTurn(q0, q1);
    // A revolute joint that mimics a circle by a whole multiplier returns to the same pose after a
    // full turn of the circle. Any other joint that mimics a circle would jump if the shorter way
    // is not the difference of the stored angles, but full turns less.
    const bool comesRound =
        joint_ == Frame::Joint::revolute && multiplier_ == std::trunc(multiplier_);
    ambiguous_ = !(std::isfinite(q0) && std::isfinite(q1)) || turn.ambiguous() ||
                 (!comesRound && turn.angle != delta);
    delta = turn.angle;
    deltaError = std::abs(multiplier_) * turn.error;
  }
  const double value = multiplier_ * q0 + offset_;
  rate_ = multiplier_ * delta;
  // Let V = |m|·max|q| + |o|. Errors: m·q0 + o, 2uV; m·Δ (|Δ| ≤ 2·max|q|, rounded), 4uV; its
  // product with t, 2uV; the sum, 3uV. (The sum is at most V, or 3V where a circle crosses its
  // seam.) Together these errors are 11uV, or 12uV with the products of roundings.
  const double V = std::abs(multiplier_) * std::max(std::abs(q0), std::abs(q1)) + std::abs(offset_);
  const double valueError = 12 * kUnit * V + deltaError;
  rateError_ = q0 == q1 ? 0 : roundedUp(2 * kUnit * std::abs(rate_) + deltaError);
  if (joint_ == Frame::Joint::revolute) {
    angle_ = value;
    rotationError_ = roundedUp(kTurnError + fixedError_ + valueError);
    return;
  }
  // Errors besides `valueError`, with |rate| ≤ 2V and the constant part p:
  // - the slide axis, which has the error of `fixed`, times the value and the rate: 3V·fixedError;
  // - value·axis: uV; rate·axis: 2uV; its product with t: 2uV;
  // - the two sums: at most u(|p| + V) and u(|p| + 3V).
  // Together these errors are 9uV + 2u|p| + 3V·fixedError; the code adds 18uV + 4u|p| +
  // 3V·fixedError.
  from_ = shift_ + value * slideAxis_;
  delta_ = rate_ * slideAxis_;
  shiftError_ = roundedUp(fixedShiftError_ + valueError + 18 * kUnit * V +
                          4 * kUnit * fixedLength_ + 3 * V * fixedError_);
  length_ = roundedUp(fixedLength_ + 2 * V);
}

void MovingJoint::setShift(const Configuration& from, const Configuration& to) {
  Vec3 p0 = Vec3::Zero(), p1 = Vec3::Zero();
  p0.head(count_) = from.segment(variable_, count_);
  p1.head(count_) = to.segment(variable_, count_);
  Vec3 delta = p1 - p0;
  ambiguous_ = !delta.allFinite();
  if (isRest(delta)) delta.setZero();
  from_ = shift_ + fixed_ * p0;
  delta_ = fixed_ * delta;
  rate_ = delta.norm();
  rateError_ = 8 * kUnit * rate_;
  axis_ = rate_ > 0 ? Vec3(delta / rate_) : Vec3::UnitX();
  // Let S be the length of the vector of the largest coordinates. fixed·p0 and fixed·Δ (|Δ| ≤ 2S)
  // round by 3√3u and inherit 2u from `fixed`: 8uS + 16uS. Δ and its product with t round by 2uS
  // each, the sums by u(S + |p|) each. Together these errors are below 32uS + 4u|p|.
  const double S = p0.cwiseAbs().cwiseMax(p1.cwiseAbs()).norm();
  shiftError_ =
      roundedUp(fixedShiftError_ + 32 * kUnit * S + 4 * kUnit * fixedLength_ + S * fixedError_);
  length_ = roundedUp(fixedLength_ + S);
}

void MovingJoint::setRotation(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond q0 = unitQuaternion(a), q1 = unitQuaternion(b);
  const bool equal = a.coeffs() == b.coeffs() || a.coeffs() == -b.coeffs();
  Eigen::Quaterniond turn = q1 * q0.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double s = turn.vec().norm();
  const bool turns = !equal && s >= kLeastMotion;
  const Vec3 axis = turns ? Vec3(turn.vec() / s) : Vec3::UnitX();
  rate_ = turns ? 2 * std::atan2(s, turn.w()) : 0;
  rateError_ = equal ? 0 : kFreeRateError;
  ambiguous_ = !turn.coeffs().allFinite() || CircleTurn{rate_, 0}.ambiguous();
  const Mat3 R0 = q0.toRotationMatrix();
  Mat3 K;
  K << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  const Mat3 KR0 = K * R0;
  matrixAtZero_ = fixed_ * R0;
  sine_ = fixed_ * KR0;
  versine_ = fixed_ * (K * KR0);
  axis_ = R0.transpose() * axis;
  rotationError_ = kFreeTurnError + fixedError_;
}

}  // namespace corridor
