#include "planner/trajectory/curve_pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "collision/core/circle.h"

namespace corridor {
namespace {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

// Factors of the error bounds, derived in the header.
constexpr Real kLinear = 0x1p-49L, kCubic = 0x1p-45L, kQuintic = 0x1p-42L, kPower = 0x1p-47L,
               kSpline = 0x1p-46L;

/// Returns a bound as a double, rounded up. A bound of 0 would exclude results that underflow.
double roundedUp(Real bound) {
  return static_cast<double>(bound * (1 + 0x1p-50L) + 0x1p-1000L);
}

CurvePiece pieceOf(const RealMatrix& coefficients, const RealVector& error) {
  CurvePiece piece;
  piece.coefficients = coefficients.cast<double>();
  piece.error.resize(error.size());
  for (Eigen::Index i = 0; i < error.size(); ++i) piece.error[i] = roundedUp(error[i]);
  return piece;
}

/// Sets the rows of `piece.coefficients` that belong to rotations, from the quaternions in `from`
/// and `to`, without conversion. The error bound of a rotation is that of a controller's slerp in
/// doubles: 2^-44 rad = 512u, which is more than 160 roundings of a half turn. (moving_joint.cpp
/// counts the roundings of such a formula.)
void setRotations(const ConfigurationSpace& space, const Configuration& from,
                  const Configuration& to, CurvePiece& piece) {
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    const auto first = static_cast<Eigen::Index>(c.first);
    piece.coefficients.middleRows<4>(first).colwise() = from.segment<4>(first);
    piece.coefficients.rightCols<1>().segment<4>(first) = to.segment<4>(first);
    piece.error.segment<4>(first).setZero();
    piece.error[first] = 0x1p-44;
  }
}

void requireDegree(Eigen::Index degree) {
  if (degree < 1 || degree > CurvePiece::kLargestDegree)
    throw std::invalid_argument("the degree of a curve must be from 1 to 9");
}

/// Returns the value of the polar form of a B-spline's piece on [knots[k], knots[k + 1]], at
/// `degree` arguments: `degree` − ends times the left end, `ends` times the right end.
RealVector polarForm(const Eigen::MatrixXd& points, const std::vector<double>& knots, int degree,
                     std::size_t k, int ends) {
  const auto first = static_cast<Eigen::Index>(k) - degree;
  RealMatrix d = points.middleCols(first, degree + 1).cast<Real>();
  for (int level = 1; level <= degree; ++level) {
    const Real at = level <= degree - ends ? knots[k] : knots[k + 1];
    for (int j = degree; j >= level; --j) {
      const auto i = static_cast<std::size_t>(first + j);
      const Real left = knots[i], right = knots[i + static_cast<std::size_t>(degree - level) + 1];
      const Real alpha = (at - left) / (right - left);
      d.col(j) = (1 - alpha) * d.col(j - 1) + alpha * d.col(j);
    }
  }
  return d.col(degree);
}

}  // namespace

CurvePiece linearPiece(const ConfigurationSpace& space, const Configuration& from,
                       const Configuration& to) {
  RealMatrix c(from.size(), 2);
  c << from.cast<Real>(), to.cast<Real>();
  CurvePiece piece = pieceOf(c, kLinear * c.cwiseAbs().rowwise().sum());
  setRotations(space, from, to, piece);
  return piece;
}

CurvePiece cubicPiece(const ConfigurationSpace& space, const CurvePoint& from, const CurvePoint& to,
                      long double duration, long double durationError) {
  const auto p0 = from.position.cast<Real>(), p1 = to.position.cast<Real>();
  const auto v0 = from.velocity.cast<Real>() * duration, v1 = to.velocity.cast<Real>() * duration;
  RealMatrix c(p0.size(), 4);
  c << p0, p0 + v0 / 3, p1 - v1 / 3, p1;
  const Real share = durationError / duration;
  const RealVector positions = p0.cwiseAbs() + p1.cwiseAbs(),
                   velocities = v0.cwiseAbs() + v1.cwiseAbs();
  CurvePiece piece = pieceOf(c, kCubic * (positions + velocities) + share * velocities);
  setRotations(space, from.position, to.position, piece);
  return piece;
}

CurvePiece quinticPiece(const ConfigurationSpace& space, const CurvePoint& from,
                        const CurvePoint& to, long double duration, long double durationError) {
  const auto p0 = from.position.cast<Real>(), p1 = to.position.cast<Real>();
  const auto v0 = from.velocity.cast<Real>() * duration, v1 = to.velocity.cast<Real>() * duration;
  const auto a0 = from.acceleration.cast<Real>() * (duration * duration),
             a1 = to.acceleration.cast<Real>() * (duration * duration);
  RealMatrix c(p0.size(), 6);
  c << p0, p0 + v0 / 5, p0 + 2 * v0 / 5 + a0 / 20, p1 - 2 * v1 / 5 + a1 / 20, p1 - v1 / 5, p1;
  const Real share = durationError / duration;
  const RealVector positions = p0.cwiseAbs() + p1.cwiseAbs(),
                   velocities = v0.cwiseAbs() + v1.cwiseAbs(),
                   accelerations = a0.cwiseAbs() + a1.cwiseAbs();
  CurvePiece piece = pieceOf(c, kQuintic * (positions + velocities + accelerations) +
                                    share * (velocities + (2 + share) * accelerations));
  setRotations(space, from.position, to.position, piece);
  return piece;
}

CurvePiece powerPiece(const Eigen::MatrixXd& coefficients, double duration) {
  const Eigen::Index n = coefficients.cols() - 1;
  requireDegree(n);
  // The coefficients of the power series in τ = t/duration.
  RealMatrix terms = coefficients.cast<Real>();
  Real power = 1;
  for (Eigen::Index k = 0; k <= n; ++k, power *= duration) terms.col(k) *= power;
  // c_i = Σ_{k ≤ i} C(i, k) / C(n, k) · terms_k (Farouki and Rajan 1987, equation 3).
  RealMatrix c = RealMatrix::Zero(coefficients.rows(), n + 1);
  for (Eigen::Index i = 0; i <= n; ++i) {
    Real share = 1;  // C(i, k) / C(n, k)
    for (Eigen::Index k = 0; k <= i; ++k) {
      c.col(i) += share * terms.col(k);
      if (k < n) share *= Real(i - k) / Real(n - k);
    }
  }
  return pieceOf(c, kPower * terms.cwiseAbs().rowwise().sum());
}

Curve splineCurve(const Eigen::MatrixXd& points, const std::vector<double>& knots, int degree) {
  requireDegree(degree);
  const auto count = static_cast<std::size_t>(points.cols()), p = static_cast<std::size_t>(degree);
  if (count <= p || knots.size() != count + p + 1)
    throw std::invalid_argument("a B-spline of n control points needs n + degree + 1 knots");
  if (!std::is_sorted(knots.begin(), knots.end()) || !(knots[p] < knots[count]))
    throw std::invalid_argument("the knots of a B-spline must ascend");
  const RealVector error = kSpline * points.cwiseAbs().rowwise().maxCoeff().cast<Real>();
  Curve curve;
  curve.knots.push_back(knots[p]);
  for (std::size_t k = p; k < count; ++k) {
    if (!(knots[k] < knots[k + 1])) continue;
    RealMatrix c(points.rows(), degree + 1);
    for (int i = 0; i <= degree; ++i) c.col(i) = polarForm(points, knots, degree, k, i);
    curve.pieces.push_back(pieceOf(c, error));
    curve.knots.push_back(knots[k + 1]);
  }
  return curve;
}

Curve curveOfPath(const ConfigurationSpace& space, const std::vector<Configuration>& states) {
  if (states.size() < 2) throw std::invalid_argument("a path of two or more states is needed");
  constexpr Real kTurn = 2 * std::numbers::pi_v<Real>;
  Curve curve;
  curve.knots.push_back(0);
  // For each circle coordinate, the angle of the whole turns added so far.
  Configuration turns = Configuration::Zero(states.front().size());
  for (std::size_t k = 0; k + 1 < states.size(); ++k) {
    if (space.ambiguous(states[k], states[k + 1]))
      throw std::invalid_argument("the shorter way of an edge is ambiguous");
    Configuration from = states[k], to = states[k + 1];
    Configuration error = Configuration::Zero(from.size());
    for (const Coordinate& c : space.coordinates()) {
      if (c.kind != Coordinate::Kind::circle) continue;
      const auto i = static_cast<Eigen::Index>(c.first);
      const auto unwrapped = [&](double angle) {
        const auto value = static_cast<double>(Real(angle) + Real(turns[i]) * kTurn);
        const double off = 0x1p-52 * std::abs(value) + 0x1p-60 * std::abs(turns[i]);
        if (turns[i] != 0) error[i] = std::max(error[i], off);
        return value;
      };
      from[i] = unwrapped(from[i]);
      // Far less than half a turn off, so that the number of turns is right.
      const Real way = circleTurn(states[k][i], to[i]).angle;
      turns[i] +=
          static_cast<double>(std::round((way - (Real(to[i]) - Real(states[k][i]))) / kTurn));
      to[i] = unwrapped(to[i]);
    }
    CurvePiece piece = linearPiece(space, from, to);
    piece.error += error;
    curve.pieces.push_back(std::move(piece));
    curve.knots.push_back(static_cast<double>(k + 1));
  }
  return curve;
}

}  // namespace corridor
