#pragma once

#include <string>

#include "planner/solve/smooth_path.h"

/// Spaces whose coordinates all have the kind `line`, and curves in these spaces, for tests without
/// a robot.
namespace corridor {

/// Returns a space of `count` coordinates of the kind `line`, each within ±limit.
inline ConfigurationSpace lines(int count, double limit = 100) {
  ConfigurationSpace space;
  CoordinateGroup group;
  for (int i = 0; i < count; ++i) {
    Coordinate line;
    line.name = "q" + std::to_string(i);
    line.lower = -limit;
    line.upper = limit;
    group.coordinates.push_back(space.add(line));
  }
  space.addGroup(group);
  return space;
}

inline Configuration place(double x, double y) {
  Configuration q(2);
  q << x, y;
  return q;
}

inline const CurveTest kAllFree = [](const CurvePiece&, double) { return true; };

/// Returns the derivative of a piece of the given order by τ, at τ = tau, by de Casteljau's
/// algorithm.
inline Configuration derivative(const CurvePiece& piece, int order, double tau) {
  Eigen::MatrixXd b = piece.coefficients;
  int n = piece.degree();
  double factor = 1;
  for (; order > 0; --order, --n) {
    if (n == 0) return Configuration::Zero(b.rows());
    factor *= n;
    for (int i = 0; i < n; ++i) b.col(i) = (b.col(i + 1) - b.col(i)).eval();
  }
  for (int left = n; left > 0; --left)
    for (int i = 0; i < left; ++i) b.col(i) = ((1 - tau) * b.col(i) + tau * b.col(i + 1)).eval();
  return factor * b.col(0);
}

}  // namespace corridor
