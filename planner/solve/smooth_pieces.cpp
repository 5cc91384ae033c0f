#include "planner/solve/smooth_pieces.h"

namespace corridor {

bool rotates(const ConfigurationSpace& space, const Configuration& from, const Configuration& to) {
  for (const Coordinate& c : space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::rotation && from.segment<4>(i) != to.segment<4>(i)) return true;
  }
  return false;
}

void restRotations(const ConfigurationSpace& space, const Configuration& q, CurvePiece& piece) {
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    const auto i = static_cast<Eigen::Index>(c.first);
    piece.coefficients.middleRows<4>(i).colwise() = q.segment<4>(i);
  }
}

bool isWithinBounds(const ConfigurationSpace& space, const CurvePiece& piece) {
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::line) continue;
    const auto row = piece.coefficients.row(static_cast<Eigen::Index>(c.first));
    if (row.minCoeff() < c.lower || row.maxCoeff() > c.upper) return false;
  }
  return true;
}

}  // namespace corridor
