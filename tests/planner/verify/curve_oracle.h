#pragma once

#include <algorithm>
#include <vector>

#include "planner/robot/curve.h"
#include "tests/planner/verify/random_arm.h"

namespace corridor::test {

/// The motion of an arm along a piece of a curve, for tests: forward kinematics by Eigen's
/// transforms, and polynomials as sums of Bernstein's basis functions, in long double. It shares no
/// code with the verifier.
class CurveOracle {
 public:
  using Real = long double;
  using Vec = Eigen::Matrix<Real, 3, 1>;
  using Pose = Eigen::Transform<Real, 3, Eigen::Isometry>;

  CurveOracle(const KinematicTree& tree, const CurvePiece& piece) : tree_(tree), piece_(piece) {}

  Real value(std::size_t row, Real t) const {
    Real sum = 0, binomial = 1;
    const int n = piece_.degree();
    for (int i = 0; i <= n; ++i) {
      sum += binomial * std::pow(t, i) * std::pow(1 - t, n - i) *
             Real(piece_.coefficients(static_cast<Eigen::Index>(row), i));
      binomial = binomial * (n - i) / (i + 1);
    }
    return sum;
  }

  Pose pose(std::size_t frame, Real t) const {
    if (frame == 0) return Pose::Identity();
    const Frame& f = tree_.frames[frame];
    Pose at = pose(f.parent, t);
    at.translate(Vec(f.fixed.p.cast<Real>()));
    at.rotate(Eigen::Quaternion<Real>(f.fixed.q.cast<Real>()).normalized());
    const Vec axis = f.axis.cast<Real>().normalized();
    const auto joint = [&] {
      const Real q = f.variable == Frame::noVariable ? 0 : value(f.variable, t);
      return f.multiplier * q + f.offset;
    };
    if (f.joint == Frame::Joint::revolute) at.rotate(Eigen::AngleAxis<Real>(joint(), axis));
    if (f.joint == Frame::Joint::prismatic) at.translate(Vec(joint() * axis));
    if (f.joint == Frame::Joint::translation) {
      Vec shift = Vec::Zero();
      for (std::size_t k = 0; k < f.count; ++k)
        shift[static_cast<Eigen::Index>(k)] = value(f.variable + k, t);
      at.translate(shift);
    }
    if (f.joint == Frame::Joint::rotation) {
      const auto column = [&](Eigen::Index k) {
        const Eigen::Vector4d q =
            piece_.coefficients.block<4, 1>(static_cast<Eigen::Index>(f.variable), k);
        return Eigen::Quaternion<Real>(Eigen::Matrix<Real, 4, 1>(q.cast<Real>())).normalized();
      };
      at.rotate(column(0).slerp(t, column(piece_.degree())));
    }
    return at;
  }

  /// Returns the distance, at t, of the segment pq, which moves with `frame`, from a point that
  /// moves with the frame `other`.
  Real distance(std::size_t frame, const Vec3& p, const Vec3& q, std::size_t other,
                const Vec3& point, Real t) const {
    const Pose at = pose(frame, t);
    const Vec a = at * p.cast<Real>(), b = at * q.cast<Real>(),
              x = pose(other, t) * point.cast<Real>();
    const Vec along = b - a;
    const Real share = along.isZero(0) ? 0 : (x - a).dot(along) / along.squaredNorm();
    return (a + std::clamp<Real>(share, 0, 1) * along - x).norm();
  }

  /// Returns the least value of a function on [0, 1], found by samples and golden-section search.
  template <class Function>
  static Real least(const Function& f, int samples = 500) {
    std::vector<std::pair<Real, int>> found;
    for (int i = 0; i <= samples; ++i) found.emplace_back(f(Real(i) / samples), i);
    std::sort(found.begin(), found.end());
    Real best = found[0].first;
    for (int k = 0; k < 6; ++k) {
      Real low = std::max<Real>(0, Real(found[k].second - 1) / samples),
           high = std::min<Real>(1, Real(found[k].second + 1) / samples);
      const Real golden = (std::sqrt(Real(5)) - 1) / 2;
      Real a = high - golden * (high - low), b = low + golden * (high - low), fa = f(a), fb = f(b);
      for (int step = 0; step < 50; ++step) {
        if (fa < fb) {
          high = b, b = a, fb = fa, a = high - golden * (high - low), fa = f(a);
        } else {
          low = a, a = b, fa = fb, b = low + golden * (high - low), fb = f(b);
        }
        best = std::min({best, fa, fb});
      }
    }
    return best;
  }

 private:
  const KinematicTree& tree_;
  const CurvePiece& piece_;
};

/// Returns a random piece of a curve of the arm. The coefficients are multiples of 2^-23 in [−1.5,
/// 1.5], so halving a piece of degree up to 9 is exact in double.
/// @param spread a power of two from 1/8 to 1: the size of the motion.
inline CurvePiece randomPiece(const Arm& arm, int degree, std::mt19937_64& random,
                              double spread = 1) {
  CurvePiece piece;
  piece.coefficients.resize(static_cast<Eigen::Index>(arm.space.size()), degree + 1);
  for (Eigen::Index k = 0; k <= degree; ++k)
    for (Eigen::Index row = 0; row < piece.coefficients.rows(); ++row)
      piece.coefficients(row, k) =
          std::uniform_int_distribution<int>(-(3 << 19), 3 << 19)(random) * 0x1p-20;
  const Configuration first = piece.coefficients.col(0) * (1 - spread);
  piece.coefficients = (piece.coefficients * spread).colwise() + first;
  piece.error = Configuration::Zero(piece.coefficients.rows());
  return piece;
}

}  // namespace corridor::test
