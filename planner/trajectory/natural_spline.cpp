#include "planner/trajectory/natural_spline.h"

#include <algorithm>
#include <cmath>

namespace corridor {
namespace {

/// Returns the second derivatives m of the natural spline, one column for each state. At the inner
/// states,
///   h_{i−1}·m_{i−1} + 2(h_{i−1} + h_i)·m_i + h_i·m_{i+1} = 6(d_i − d_{i−1}),
/// where h_i = |q_{i+1} − q_i| and d_i = (q_{i+1} − q_i)/h_i. At both ends m is 0. The matrix is
/// diagonally dominant, so elimination needs no pivots.
Eigen::MatrixXd secondDerivatives(const std::vector<Configuration>& q,
                                  const std::vector<double>& h) {
  const std::size_t n = h.size();
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(q[0].size(), static_cast<Eigen::Index>(n) + 1);
  const auto slope = [&](std::size_t i) -> Configuration { return (q[i + 1] - q[i]) / h[i]; };
  // The elements above the diagonal, after elimination; the diagonal is then 1.
  std::vector<double> upper(n + 1, 0);
  for (std::size_t i = 1; i < n; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double diagonal = 2 * (h[i - 1] + h[i]) - h[i - 1] * upper[i - 1];
    upper[i] = h[i] / diagonal;
    m.col(column) = (6 * (slope(i) - slope(i - 1)) - h[i - 1] * m.col(column - 1)) / diagonal;
  }
  for (auto i = static_cast<Eigen::Index>(n) - 1; i > 0; --i)
    m.col(i) -= upper[static_cast<std::size_t>(i)] * m.col(i + 1);
  return m;
}

/// Returns an upper bound of |dq/dτ| on a piece: a polynomial is within the convex hull of its
/// Bernstein coefficients, and those of dq/dτ are degree·(c_{i+1} − c_i).
double largestSpeed(const CurvePiece& piece) {
  const int degree = piece.degree();
  const Eigen::MatrixXd& c = piece.coefficients;
  return degree * (c.rightCols(degree) - c.leftCols(degree)).colwise().norm().maxCoeff();
}

/// Returns the index of the first piece with a sample that touches something. Returns the number of
/// pieces if no sample does.
std::size_t firstTouching(const ConfigurationSpace& space, const std::vector<CurvePiece>& pieces,
                          const std::function<bool(const Configuration&)>& touches, double step) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const double samples = std::max(1.0, std::ceil(largestSpeed(pieces[k]) / step));
    for (double i = 0; i <= samples; ++i)
      if (touches(configurationAt(space, pieces[k], i / samples))) return k;
  }
  return pieces.size();
}

}  // namespace

std::vector<Configuration> statesOfLines(const std::vector<CurvePiece>& lines) {
  std::vector<Configuration> states;
  if (lines.empty()) return states;
  states.push_back(lines.front().coefficients.col(0));
  for (const CurvePiece& line : lines)
    if (const Configuration next = line.coefficients.rightCols<1>(); next != states.back())
      states.push_back(next);
  return states;
}

std::vector<CurvePiece> naturalSpline(const std::vector<Configuration>& states) {
  std::vector<double> h;
  for (std::size_t i = 0; i + 1 < states.size(); ++i)
    h.push_back((states[i + 1] - states[i]).norm());
  const Eigen::MatrixXd m = secondDerivatives(states, h);
  std::vector<CurvePiece> pieces;
  for (std::size_t i = 0; i < h.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Configuration slope = (states[i + 1] - states[i]) / h[i], m0 = m.col(column),
                        m1 = m.col(column + 1);
    const Configuration v0 = slope - h[i] / 6 * (2 * m0 + m1),
                        v1 = slope + h[i] / 6 * (m0 + 2 * m1);
    CurvePiece piece;
    piece.coefficients.resize(slope.size(), 4);
    piece.coefficients << states[i], states[i] + h[i] / 3 * v0, states[i + 1] - h[i] / 3 * v1,
        states[i + 1];
    piece.error = Configuration::Zero(slope.size());
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

InsertedSpline insertedSpline(const ConfigurationSpace& space, std::vector<Configuration> states,
                              const std::function<bool(const Configuration&)>& touches, double step,
                              std::size_t most) {
  InsertedSpline spline;
  for (;;) {
    spline.pieces = naturalSpline(states);
    const std::size_t k = firstTouching(space, spline.pieces, touches, step);
    spline.touches = k < spline.pieces.size();
    if (!spline.touches || spline.inserted == most) return spline;
    states.insert(states.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                  0.5 * (states[k] + states[k + 1]));
    ++spline.inserted;
  }
}

}  // namespace corridor
