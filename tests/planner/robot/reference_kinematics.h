#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "planner/robot/curve.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor::test {

using LongReal = long double;
using Vec3L = Eigen::Matrix<LongReal, 3, 1>;
using Mat3L = Eigen::Matrix<LongReal, 3, 3>;
using Vec4L = Eigen::Matrix<LongReal, 4, 1>;

/// A pose and its derivatives with respect to the parameter t.
struct MovingPose {
  Mat3L m = Mat3L::Identity(), dm = Mat3L::Zero();
  Vec3L t = Vec3L::Zero(), dt = Vec3L::Zero();

  MovingPose operator*(const MovingPose& x) const {
    return {m * x.m, dm * x.m + m * x.dm, m * x.t + t, dm * x.t + m * x.dt + dt};
  }
  MovingPose inverse() const {
    return {m.transpose(), dm.transpose(), -m.transpose() * t,
            -dm.transpose() * t - m.transpose() * dt};
  }
  Vec3L at(const Vec3& p) const { return m * p.cast<LongReal>() + t; }
  Vec3L velocity(const Vec3& p) const { return dm * p.cast<LongReal>() + dt; }
};

inline Mat3L crossL(const Vec3L& a) {
  Mat3L K;
  K << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return K;
}

/// Maps a point by the numbers that X stores, in long double.
inline Vec3L exactly(const Transform& X, const Vec3& p) {
  return X.m.cast<LongReal>() * p.cast<LongReal>() + X.t.cast<LongReal>();
}

/// An independent implementation of edges, pieces of curves and forward kinematics, in long double.
/// Its formulas differ from those of the tested code: quaternions joint by joint, slerp as a sum
/// weighted by sines, derivatives by the product rule.
class ReferenceKinematics {
 public:
  ReferenceKinematics(const KinematicTree& tree, const ConfigurationSpace& space,
                      const Configuration& from, const Configuration& to)
      : tree_(tree), space_(space), from_(from), to_(to) {}
  ReferenceKinematics(const KinematicTree& tree, const ConfigurationSpace& space,
                      const CurvePiece& piece)
      : tree_(tree),
        space_(space),
        piece_(&piece),
        from_(piece.coefficients.col(0)),
        to_(piece.coefficients.col(piece.degree())) {}

  std::vector<MovingPose> poses(LongReal t) const {
    std::vector<MovingPose> all(tree_.frames.size());
    for (std::size_t f = 1; f < all.size(); ++f) all[f] = all[tree_.frames[f].parent] * place(f, t);
    return all;
  }
  /// Returns the motion of frame b in frame a. Frames that both kinematic chains have in common are
  /// left out, so they add no rounding.
  MovingPose relative(std::size_t a, std::size_t b, LongReal t) const {
    MovingPose ofA, ofB;
    while (a != b) {
      (a > b ? ofA : ofB) = place(std::max(a, b), t) * (a > b ? ofA : ofB);
      (a > b ? a : b) = tree_.frames[std::max(a, b)].parent;
    }
    return ofA.inverse() * ofB;
  }

 private:
  /// Returns the motion of a frame in its parent's frame.
  MovingPose place(std::size_t f, LongReal t) const {
    const Frame& frame = tree_.frames[f];
    MovingPose fixed;
    fixed.m = rotation(frame.fixed.q.coeffs().cast<LongReal>().stableNormalized());
    fixed.t = frame.fixed.p.cast<LongReal>();
    return fixed * joint(frame, t);
  }
  static Mat3L rotation(const Vec4L& q) {
    return Eigen::Quaternion<LongReal>(q).toRotationMatrix();
  }
  const Coordinate& coordinate(std::size_t number) const {
    for (const Coordinate& c : space_.coordinates())
      if (c.first == number) return c;
    throw std::logic_error("no such coordinate");
  }
  /// Returns entry i of the configuration, and the derivative of this entry by t.
  std::pair<LongReal, LongReal> number(std::size_t i, LongReal t) const {
    const auto k = static_cast<Eigen::Index>(i);
    if (piece_) return {bernstein(k, piece_->degree(), 0, t), rateOf(k, t)};
    const LongReal q0 = from_[k];
    LongReal delta = static_cast<LongReal>(to_[k]) - q0;
    if (coordinate(i).kind == Coordinate::Kind::circle)
      delta = std::remainder(delta, 2 * std::numbers::pi_v<LongReal>);
    return {q0 + t * delta, delta};
  }
  /// Returns Σ C(n, i) t^i (1 − t)^(n−i) d_(i+first).
  LongReal bernstein(Eigen::Index row, int n, int first, LongReal t) const {
    LongReal sum = 0, binomial = 1;
    for (int i = 0; i <= n; ++i) {
      sum += binomial * std::pow(t, static_cast<LongReal>(i)) *
             std::pow(1 - t, static_cast<LongReal>(n - i)) * piece_->coefficients(row, first + i);
      binomial = binomial * (n - i) / (i + 1);
    }
    return sum;
  }
  LongReal rateOf(Eigen::Index row, LongReal t) const {
    const int n = piece_->degree();
    return n * (bernstein(row, n - 1, 1, t) - bernstein(row, n - 1, 0, t));
  }
  MovingPose joint(const Frame& frame, LongReal t) const {
    MovingPose X;
    const Vec3L axis = frame.axis.cast<LongReal>().stableNormalized();
    LongReal value = frame.offset, rate = 0;
    if (frame.variable != Frame::noVariable &&
        (frame.joint == Frame::Joint::revolute || frame.joint == Frame::Joint::prismatic)) {
      const auto [q, dq] = number(frame.variable, t);
      value = frame.multiplier * q + frame.offset;
      rate = frame.multiplier * dq;
    }
    switch (frame.joint) {
      case Frame::Joint::none:
        break;
      case Frame::Joint::revolute: {
        X.m = rotation((Vec4L() << std::sin(value / 2) * axis, std::cos(value / 2)).finished());
        X.dm = rate * crossL(axis) * X.m;
        break;
      }
      case Frame::Joint::prismatic:
        X.t = value * axis;
        X.dt = rate * axis;
        break;
      case Frame::Joint::translation:
        for (std::size_t k = 0; k < frame.count; ++k)
          std::tie(X.t[static_cast<Eigen::Index>(k)], X.dt[static_cast<Eigen::Index>(k)]) =
              number(frame.variable + k, t);
        break;
      case Frame::Joint::rotation: {
        const auto first = static_cast<Eigen::Index>(frame.variable);
        const Vec4L q0 = from_.segment<4>(first).cast<LongReal>().stableNormalized();
        Vec4L q1 = to_.segment<4>(first).cast<LongReal>().stableNormalized();
        if (q0.dot(q1) < 0) q1 = -q1;
        const LongReal angle = 2 * std::atan2((q1 - q0).norm(), (q1 + q0).norm()),
                       s = std::sin(angle);
        const bool tiny = angle < 1e-12L;
        const LongReal a = tiny ? 1 - t : std::sin((1 - t) * angle) / s;
        const LongReal b = tiny ? t : std::sin(t * angle) / s;
        const LongReal da = tiny ? -1 : -angle * std::cos((1 - t) * angle) / s;
        const LongReal db = tiny ? 1 : angle * std::cos(t * angle) / s;
        const Eigen::Quaternion<LongReal> q(Vec4L((a * q0 + b * q1).normalized())),
            dq(Vec4L(da * q0 + db * q1));
        X.m = q.toRotationMatrix();
        X.dm = 2 * crossL((dq * q.conjugate()).vec()) * X.m;
        break;
      }
    }
    return X;
  }

  const KinematicTree& tree_;
  const ConfigurationSpace& space_;
  const CurvePiece* piece_ = nullptr;  // not owned; null: an edge
  Configuration from_, to_;
};

}  // namespace corridor::test
