#include "planner/robot/curve.h"

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

}  // namespace corridor
