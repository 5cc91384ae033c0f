#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "planner/robot/curve.h"

/// Bounds of curves, as the verifier judges them.
namespace corridor {

/// A place where a curve is outside of the bounds of a coordinate, or where it could not be proved
/// to be within them.
struct OutsideBounds {
  std::size_t coordinate = 0;  ///< index into ConfigurationSpace::coordinates()
  std::size_t piece = 0;
  double t = 0;      ///< the parameter of the piece, in [0, 1]
  double value = 0;  ///< the value of the coordinate at t, m or rad
};

/// Proves that the line coordinates (Coordinate::Kind::line) of a curve stay within their bounds
/// everywhere, not only at the rows. For each coordinate for which the proof fails, returns a place
/// in the first piece for which it fails (verify/polynomial_range.h). The rows themselves are
/// compared exactly. Between the rows, the curve may be beyond a bound by the piece's error bound,
/// or by 2^-42 of its largest coefficient if that is less.
std::vector<OutsideBounds> outsideBounds(const ConfigurationSpace& space,
                                         std::span<const CurvePiece> pieces);

}  // namespace corridor
