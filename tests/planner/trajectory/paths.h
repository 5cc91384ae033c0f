#pragma once

#include <random>
#include <vector>

#include "planner/trajectory/time_law.h"

namespace corridor::test {

/// Returns a space of single joints with wide ranges, named "j0", "j1", …
inline ConfigurationSpace jointSpace(std::size_t joints) {
  ConfigurationSpace space;
  CoordinateGroup group;
  for (std::size_t j = 0; j < joints; ++j)
    group.coordinates.push_back(
        space.add({Coordinate::Kind::line, "j" + std::to_string(j), 0, -1e9, 1e9, true, 1}));
  space.addGroup(group);
  return space;
}

inline JointLimits uniformLimits(std::size_t size, double velocity, double acceleration,
                                 double jerk = std::numeric_limits<double>::infinity()) {
  const auto n = static_cast<Eigen::Index>(size);
  JointLimits limits;
  limits.velocity = Configuration::Constant(n, velocity);
  limits.acceleration = Configuration::Constant(n, acceleration);
  limits.jerk = Configuration::Constant(n, jerk);
  return limits;
}

/// Returns a piece with the given Bernstein coefficients, one list for each entry of a
/// configuration.
inline CurvePiece piece(const std::vector<std::vector<double>>& rows) {
  CurvePiece result;
  result.coefficients.resize(static_cast<Eigen::Index>(rows.size()),
                             static_cast<Eigen::Index>(rows.front().size()));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < rows[i].size(); ++k)
      result.coefficients(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = rows[i][k];
  result.error = Configuration::Zero(result.coefficients.rows());
  return result;
}

/// Returns a C² path through random points: a uniform cubic B-spline, converted to pieces.
inline std::vector<CurvePiece> randomSpline(std::size_t joints, std::size_t pieces,
                                            std::mt19937& random) {
  std::uniform_real_distribution<double> value(-1.5, 1.5);
  const auto n = static_cast<Eigen::Index>(joints);
  std::vector<Configuration> points;
  for (std::size_t i = 0; i < pieces + 3; ++i)
    points.push_back(Configuration::NullaryExpr(n, [&] { return value(random); }));
  std::vector<CurvePiece> path;
  for (std::size_t i = 0; i < pieces; ++i) {
    const auto &a = points[i], &b = points[i + 1], &c = points[i + 2], &d = points[i + 3];
    CurvePiece part;
    part.coefficients.resize(n, 4);
    part.coefficients.col(0) = (a + 4 * b + c) / 6;
    part.coefficients.col(1) = (2 * b + c) / 3;
    part.coefficients.col(2) = (b + 2 * c) / 3;
    part.coefficients.col(3) = (b + 4 * c + d) / 6;
    part.error = Configuration::Zero(n);
    path.push_back(part);
  }
  return path;
}

/// A configuration q, and its derivatives by time: v = q̇, a = q̈.
struct Sample {
  Configuration q, v, a;
};
/// Returns q, q̇ and q̈ of a law at a time, by the definitions in the headers: τ as a polynomial of
/// time in the power basis, and the path by de Casteljau's algorithm.
inline Sample sampleAt(const TimeLaw& law, const std::vector<CurvePiece>& path, double time) {
  std::size_t k = 0;
  while (k + 1 < law.segments.size() && law.segments[k + 1].time <= time) ++k;
  const LawSegment& s = law.segments[k];
  const double d = time - s.time;
  const double tau = s.tau + s.rate * d + s.acceleration * d * d / 2 + s.jerk * d * d * d / 6;
  const double rate = s.rate + s.acceleration * d + s.jerk * d * d / 2;
  const double acceleration = s.acceleration + s.jerk * d;
  const Eigen::MatrixXd& c = path[s.piece].coefficients;
  const auto evaluate = [&](const Eigen::MatrixXd& coefficients) {
    Eigen::MatrixXd b = coefficients;
    for (Eigen::Index left = b.cols() - 1; left > 0; --left)
      for (Eigen::Index i = 0; i < left; ++i)
        b.col(i) = ((1 - tau) * b.col(i) + tau * b.col(i + 1)).eval();
    return Configuration(b.col(0));
  };
  const auto derived = [](const Eigen::MatrixXd& b) -> Eigen::MatrixXd {
    if (b.cols() == 1) return Eigen::MatrixXd::Zero(b.rows(), 1);
    return (b.rightCols(b.cols() - 1) - b.leftCols(b.cols() - 1)) *
           static_cast<double>(b.cols() - 1);
  };
  const Configuration first = evaluate(derived(c)), second = evaluate(derived(derived(c)));
  return {evaluate(c), first * rate, second * (rate * rate) + first * acceleration};
}

}  // namespace corridor::test
