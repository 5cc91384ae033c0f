#include "planner/trajectory/path_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "planner/robot/tangent_step.h"
#include "planner/trajectory/bernstein.h"

namespace corridor {
namespace {

constexpr int kSizes = CurvePiece::kLargestDegree + 1;

Eigen::Quaterniond quaternionOf(const Eigen::Vector4d& numbers) {
  return Eigen::Quaterniond(Eigen::Vector4d(numbers.stableNormalized()));
}

}  // namespace

PathView::PathView(const std::vector<CurvePiece>& path, const ConfigurationSpace& space)
    : path_(path), space_(space) {
  for (const Coordinate& c : space.coordinates())
    if (c.kind == Coordinate::Kind::rotation)
      rotations_.push_back(static_cast<Eigen::Index>(c.first));
  turns_.reserve(path.size() * rotations_.size());
  for (const CurvePiece& piece : path)
    for (const Eigen::Index r : rotations_)
      turns_.push_back(
          rotationVector(piece.coefficients.col(0).segment<4>(r),
                         piece.coefficients.col(piece.coefficients.cols() - 1).segment<4>(r)));
}

Configuration PathView::value(std::size_t piece, double tau) const {
  const Eigen::MatrixXd& c = path_[piece].coefficients;
  std::array<double, kSizes> weights;
  bernstein::basis(path_[piece].degree(), tau, weights.data());
  Configuration q = c * Eigen::Map<const Eigen::VectorXd>(weights.data(), c.cols());
  for (std::size_t r = 0; r < rotations_.size(); ++r) {
    const Eigen::Quaterniond by = rotationOf(turn(piece, r) * tau);
    const Eigen::Vector4d from = c.col(0).segment<4>(rotations_[r]);
    q.segment<4>(rotations_[r]) = (by * quaternionOf(from)).coeffs().normalized();
  }
  return q;
}

void PathView::derivatives(std::size_t piece, double tau, Configuration& first,
                           Configuration& second) const {
  const Eigen::MatrixXd& c = path_[piece].coefficients;
  const int n = path_[piece].degree();
  std::array<double, kSizes> weights;
  first = Configuration::Zero(c.rows());
  second = Configuration::Zero(c.rows());
  if (n >= 2) {
    bernstein::basis(n - 2, tau, weights.data());
    for (int i = 0; i + 2 <= n; ++i)
      second += weights[i] * (c.col(i + 2) - 2 * c.col(i + 1) + c.col(i));
    second *= n * (n - 1);
  }
  bernstein::basis(n - 1, tau, weights.data());
  for (int i = 0; i < n; ++i) first += weights[i] * (c.col(i + 1) - c.col(i));
  first *= n;
  for (std::size_t r = 0; r < rotations_.size(); ++r) {
    first.segment<4>(rotations_[r]) << turn(piece, r), 0;
    second.segment<4>(rotations_[r]).setZero();
  }
}

Configuration PathView::thirdDerivative(std::size_t piece, double tau) const {
  const Eigen::MatrixXd& c = path_[piece].coefficients;
  const int n = path_[piece].degree();
  Configuration third = Configuration::Zero(c.rows());
  if (n < 3) return third;
  std::array<double, kSizes> weights;
  bernstein::basis(n - 3, tau, weights.data());
  for (int i = 0; i + 3 <= n; ++i)
    third += weights[i] * (c.col(i + 3) - 3 * c.col(i + 2) + 3 * c.col(i + 1) - c.col(i));
  for (const Eigen::Index r : rotations_) third.segment<4>(r).setZero();
  return third * (n * (n - 1) * (n - 2));
}

double PathView::speedBound(std::size_t piece) const {
  const Eigen::MatrixXd& c = path_[piece].coefficients;
  double most = 0;
  for (Eigen::Index i = 0; i + 1 < c.cols(); ++i) {
    Configuration step = c.col(i + 1) - c.col(i);
    for (const Eigen::Index r : rotations_) step.segment<4>(r).setZero();
    most = std::max(most, step.stableNorm());
  }
  most *= path_[piece].degree();
  for (std::size_t r = 0; r < rotations_.size(); ++r)
    most = std::hypot(most, turn(piece, r).norm());
  return most;
}

bool PathView::isStraight(std::size_t piece) const {
  return path_[piece].degree() == 1;
}

}  // namespace corridor
