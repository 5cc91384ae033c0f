#include "planner/trajectory/trajectory_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "collision/core/fault_list.h"
#include "collision/core/shortest.h"
#include "planner/trajectory/curve_pieces.h"

namespace corridor {
namespace {

using Real = long double;

/// Adds a fault for each circle that jumps by more than half a turn between two rows.
void checkTurns(const TrajectoryRows& rows, std::size_t row, const ConfigurationSpace& space,
                FaultList& faults) {
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::circle) continue;
    const auto i = static_cast<Eigen::Index>(c.first);
    const double from = rows.rows[row - 1].positions[i], to = rows.rows[row].positions[i];
    if (std::abs(to - from) <= std::numbers::pi) continue;
    faults.add(rows.file, rows.rows[row].line,
               c.name + " jumps from " + shortest(from) + " to " + shortest(to) +
                   " rad, by more than half a turn: angles are literal; add or subtract whole turns "
                   "so that they go on, or add rows between");
  }
}

struct Place {
  double t = 0, value = 0;
};

/// Looks for a value outside of [lower, upper] in a part of a piece.
class BoundSearch {
 public:
  BoundSearch(Real lower, Real upper) : lower_(lower), upper_(upper) {}

  /// @param c the Bernstein coefficients of the part [begin, begin + width].
  std::optional<Place> find(std::vector<Real> c, Real begin, Real width, int depth) const {
    if (std::all_of(c.begin(), c.end(), [&](Real value) { return isInside(value); }))
      return std::nullopt;
    if (!isInside(c.front())) return placeOf(begin, c.front());
    if (depth == kDepth)
      return isInside(c.back()) ? placeOf(begin, c.front()) : placeOf(begin + width, c.back());
    // de Casteljau at 1/2: `c` becomes the right half.
    std::vector<Real> left{c.front()};
    for (std::size_t last = c.size() - 1; last > 0; --last) {
      for (std::size_t i = 0; i < last; ++i) c[i] = (c[i] + c[i + 1]) / 2;
      left.push_back(c.front());
    }
    if (const auto place = find(std::move(left), begin, width / 2, depth + 1)) return place;
    return find(std::move(c), begin + width / 2, width / 2, depth + 1);
  }

 private:
  // The coefficients of a part of width 2^-k exceed the polynomial by some 4^-k of their range. So
  // at this depth they exceed it by less than rounding.
  static constexpr int kDepth = 40;
  bool isInside(Real value) const { return lower_ <= value && value <= upper_; }
  static Place placeOf(Real t, Real value) {
    return {static_cast<double>(t), static_cast<double>(value)};
  }
  Real lower_, upper_;
};

}  // namespace

const char* nameOf(Between between) {
  return between == Between::linear ? "linear" : between == Between::cubic ? "cubic" : "quintic";
}

Between betweenOf(TrajectoryRows& rows, std::optional<Between> wanted) {
  const Between usual = rows.hasAccelerations ? Between::quintic
                        : rows.hasVelocities  ? Between::cubic
                                              : Between::linear;
  const Between between = wanted.value_or(usual);
  if (between > usual)
    throw InputError(Fault{rows.file, 0,
                           std::string("--between ") + nameOf(between) + " needs " +
                               (rows.hasVelocities ? "accelerations" : "times and velocities") +
                               ", which the file does not have; by default, " + nameOf(usual) +
                               " is used"});
  if (between < usual)
    rows.notes.push_back({rows.file + ": --between " + nameOf(between) + ": the file's " +
                              (between == Between::cubic  ? "accelerations"
                               : rows.hasAccelerations    ? "velocities and accelerations"
                                                          : "velocities") +
                              " are not used",
                          NoteWeight::motion});
  return between;
}

Curve curveOf(const TrajectoryRows& rows, const ConfigurationSpace& space, Between between) {
  FaultList faults(rows.file);
  Curve curve;
  const auto timeOf = [&](std::size_t k) {
    return rows.timed ? rows.rows[k].time : static_cast<double>(k);
  };
  curve.knots.push_back(timeOf(0));
  for (std::size_t k = 1; k < rows.rows.size(); ++k) {
    const TrajectoryRow &from = rows.rows[k - 1], &to = rows.rows[k];
    checkTurns(rows, k, space, faults);
    const Real duration = Real(timeOf(k)) - Real(timeOf(k - 1));
    const CurvePoint begin{from.positions, from.velocities, from.accelerations},
        end{to.positions, to.velocities, to.accelerations};
    curve.pieces.push_back(between == Between::linear
                               ? linearPiece(space, from.positions, to.positions)
                           : between == Between::cubic ? cubicPiece(space, begin, end, duration)
                                                       : quinticPiece(space, begin, end, duration));
    const CurvePiece& piece = curve.pieces.back();
    if (!piece.coefficients.allFinite() || !piece.error.allFinite())
      faults.add(rows.file, to.line,
                 "the values of this row and the row before are too large to compute with");
    curve.knots.push_back(timeOf(k));
  }
  faults.throwIfAny();
  return curve;
}

std::vector<OutsideBounds> outsideBounds(const ConfigurationSpace& space,
                                         std::span<const CurvePiece> pieces) {
  std::vector<OutsideBounds> all;
  for (std::size_t k = 0; k < space.coordinates().size(); ++k) {
    const Coordinate& c = space.coordinates()[k];
    if (c.kind != Coordinate::Kind::line) continue;
    const auto row = static_cast<Eigen::Index>(c.first);
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      // Halving in long double adds less than 2^-55 of the coefficients, a small part of the error.
      const Real slack = Real(pieces[p].error[row]) * 0.9L;
      const auto values = pieces[p].coefficients.row(row);
      const auto place = BoundSearch(c.lower - slack, c.upper + slack)
                             .find({values.begin(), values.end()}, 0, 1, 0);
      if (!place) continue;
      all.push_back({k, p, place->t, place->value});
      break;
    }
  }
  return all;
}

}  // namespace corridor
