#include "planner/solve/curve_measure.h"

#include <algorithm>
#include <cmath>

#include "planner/trajectory/bernstein.h"

namespace corridor {
namespace {

constexpr int kPoints = 12;
constexpr double kContinuous = 1e-6;  ///< rad: a smaller angle is no corner, as in the time law
constexpr double kStopArc = 1e-3;

}  // namespace

double CurveMeasure::valueFor(Smoothing goal) const {
  if (goal == Smoothing::length) return length;
  if (goal == Smoothing::acceleration) return length * length * length * bend;
  return time;
}

CurveRuler::CurveRuler(const ConfigurationSpace& space, Configuration velocity,
                       Configuration acceleration) {
  const auto size = static_cast<Eigen::Index>(space.size());
  if (velocity.size() == 0) velocity = Configuration::Ones(size);
  if (acceleration.size() == 0) acceleration = Configuration::Ones(size);
  fastest_ = Configuration::Ones(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (std::isfinite(velocity[i])) continue;
    velocity[i] = std::isfinite(acceleration[i]) ? acceleration[i] : 1;
    fastest_[i] = INFINITY;
  }
  weight_ = velocity.cwiseInverse();
  seconds_ = velocity.cwiseQuotient(acceleration);
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    weight_.segment<4>(static_cast<Eigen::Index>(c.first)).setZero();
    seconds_.segment<4>(static_cast<Eigen::Index>(c.first)).setZero();
  }
  for (int degree = 0; degree < CurvePiece::kLargestDegree; ++degree) {
    Eigen::MatrixXd basis(degree + 1, kPoints);
    for (int k = 0; k < kPoints; ++k)
      bernstein::basis(degree, (k + 0.5) / kPoints, basis.col(k).data());
    bases_.push_back(std::move(basis));
  }
}

double CurveRuler::timeOf(const Configuration& difference) const {
  return difference.cwiseProduct(weight_).cwiseAbs().maxCoeff();
}

double CurveRuler::angleBetween(const Configuration& first, const Configuration& second) const {
  const Configuration a = first.cwiseProduct(weight_).stableNormalized(),
                      b = second.cwiseProduct(weight_).stableNormalized();
  const double angle = 2 * std::asin(std::min(1.0, (b - a).norm() / 2));
  return angle > kContinuous ? angle : 0;
}

MeasuredPiece CurveRuler::of(const CurvePiece& piece) const {
  const Eigen::MatrixXd c = weight_.asDiagonal() * piece.coefficients;
  const Eigen::Index n = piece.degree();
  const Eigen::MatrixXd steps = c.rightCols(n) - c.leftCols(n);
  MeasuredPiece result;
  result.gains = static_cast<double>(n) * (steps * bases_[static_cast<std::size_t>(n - 1)]);
  if (n == 1)
    result.slopes = Eigen::MatrixXd::Zero(c.rows(), kPoints);
  else
    result.slopes =
        static_cast<double>(n * (n - 1)) * ((steps.rightCols(n - 1) - steps.leftCols(n - 1)) *
                                            bases_[static_cast<std::size_t>(n - 2)]);
  result.lengths = Eigen::VectorXd::Zero(kPoints);
  result.fastest = Eigen::VectorXd::Constant(kPoints, INFINITY);
  for (int k = 0; k < kPoints; ++k) {
    auto tangent = result.gains.col(k);
    auto bend = result.slopes.col(k);
    const double speed = tangent.norm();
    if (!(speed > 0)) continue;
    tangent /= speed;
    bend /= speed * speed;
    bend -=
        tangent * tangent.dot(bend);  // the part along the tangent depends on the parameter only
    double& fastest = result.fastest[k];
    for (Eigen::Index i = 0; i < tangent.size(); ++i) {
      fastest = std::min(fastest, fastest_[i] / (tangent[i] * tangent[i]));
      fastest = std::min(fastest, 1 / (std::abs(bend[i]) * seconds_[i]));
    }
    const double bent = bend.cwiseProduct(seconds_).cwiseAbs().maxCoeff(), length = speed / kPoints;
    result.time += length * std::max(tangent.cwiseAbs().maxCoeff(), std::sqrt(bent));
    result.length += length;
    result.bend += bend.squaredNorm() * length;
    result.lengths[k] = length;
    // Let u = d²s/dt² and x = (ds/dt)². For each number, with its tangent t and its bend n,
    // |t·u + n·x| ≤ 1/seconds. So the bounds of u and −u are (1/seconds ∓ sgn(t)·n·x)/|t|.
    for (Eigen::Index i = 0; i < tangent.size(); ++i) {
      const double t = tangent[i], along = bend[i], size = std::abs(t) * seconds_[i];
      const bool limits = size > 1e-12;  // otherwise this number never limits the gain
      tangent[i] = limits ? 1 / size : INFINITY;
      bend[i] = limits ? along / t : 0;
    }
  }
  return result;
}

CurveMeasure CurveRuler::along(const std::vector<const MeasuredPiece*>& pieces,
                               const std::vector<double>& angles) const {
  CurveMeasure result;
  for (const MeasuredPiece* piece : pieces)
    result.length += piece->length, result.bend += piece->bend;
  for (const double angle : angles)
    if (angle > 0) result.bend += angle * angle / (kStopArc * result.length);

  struct Node {
    const MeasuredPiece* piece;
    Eigen::Index point;
    double x;        // (ds/dt)²
    bool afterStop;  // the robot rests before this part
    double length() const { return piece->lengths[point]; }
    double gain(double at, double sign) const {
      return (piece->gains.col(point) - sign * at * piece->slopes.col(point)).minCoeff();
    }
  };
  std::vector<Node> nodes;
  nodes.reserve(pieces.size() * kPoints);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    bool stop = k == 0 || angles[k - 1] > 0;
    for (Eigen::Index point = 0; point < kPoints; ++point) {
      if (!(pieces[k]->lengths[point] > 0)) continue;
      nodes.push_back({pieces[k], point, pieces[k]->fastest[point], stop});
      stop = false;
    }
  }
  // Lowers the speed at a node to what the robot can reach from the middle of the neighbouring
  // part, or from a stop.
  const auto limit = [&](Node& node, const Node* neighbour, double sign) {
    const Node& from = neighbour ? *neighbour : node;
    const double x = neighbour ? neighbour->x : 0,
                 way = neighbour ? (node.length() + from.length()) / 2 : node.length() / 2;
    node.x = std::min(node.x, x + 2 * way * std::max(0.0, from.gain(x, sign)));
  };
  for (std::size_t k = 0; k < nodes.size(); ++k)
    limit(nodes[k], nodes[k].afterStop ? nullptr : &nodes[k - 1], 1);
  for (std::size_t k = nodes.size(); k-- > 0;) {
    const bool rests = k + 1 == nodes.size() || nodes[k + 1].afterStop;
    limit(nodes[k], rests ? nullptr : &nodes[k + 1], -1);
  }
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double speed = std::sqrt(nodes[k].x), length = nodes[k].length();
    const bool rests = k + 1 == nodes.size() || nodes[k + 1].afterStop;
    if (nodes[k].afterStop) result.time += length / speed;
    result.time += rests ? length / speed
                         : (length + nodes[k + 1].length()) / (speed + std::sqrt(nodes[k + 1].x));
  }
  return result;
}

}  // namespace corridor
