#include "planner/robot/curve.h"

#include <cmath>

#include "collision/core/rounding.h"
#include "planner/robot/angles.h"

namespace corridor {

Configuration configurationAt(const ConfigurationSpace& space, const CurvePiece& piece,
                              double tau) {
  Eigen::MatrixXd b = piece.coefficients;
  for (int left = piece.degree(); left > 0; --left)
    for (int i = 0; i < left; ++i) b.col(i) = ((1 - tau) * b.col(i) + tau * b.col(i + 1)).eval();
  Configuration q = b.col(0);
  const Configuration from = piece.coefficients.col(0), to = piece.coefficients.rightCols<1>();
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    const auto first = static_cast<Eigen::Index>(c.first);
    q.segment<4>(first) = space.interpolate(from, to, tau).segment<4>(first);
  }
  return q;
}

CurvePiece straightPiece(const ConfigurationSpace& space, const Configuration& from,
                         const Configuration& to) {
  CurvePiece piece;
  piece.coefficients.resize(from.size(), 2);
  piece.coefficients << from, to;
  piece.error = Configuration::Zero(from.size());
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::circle) continue;
    const auto i = static_cast<Eigen::Index>(c.first);
    const CircleTurn turn = circleTurn(from[i], to[i]);
    if (turn.angle == to[i] - from[i]) continue;
    piece.coefficients(i, 1) = from[i] + turn.angle;
    // The sum rounds by u of itself; 2u leaves room for the rounding of this product.
    piece.error[i] = roundedUp(turn.error + 2 * kUnit * (std::abs(from[i]) + std::abs(turn.angle)));
  }
  return piece;
}

}  // namespace corridor
