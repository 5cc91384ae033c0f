#include "planner/trajectory/trajectory_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "collision/core/fault_list.h"
#include "collision/core/shortest.h"
#include "planner/trajectory/curve_pieces.h"
#include "planner/trajectory/row_faults.h"

namespace corridor {
namespace {

using Real = long double;

/// The rounding of durations. A controller may compute times in doubles, as seconds plus
/// nanoseconds times 1e-9. Then each of the two times of a piece has 3 roundings, and their
/// difference has one. So the duration is off by at most 7·2^-53 of the larger time.
constexpr Real kTimeRounding = 0x1p-50L;

/// Adds a fault for each circle coordinate that turns by more than half a turn from the row before
/// `row` to `row`. @pre row > 0
void checkTurns(const TrajectoryRows& rows, std::size_t row, const ConfigurationSpace& space,
                FaultList& faults) {
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::circle) continue;
    const auto i = static_cast<Eigen::Index>(c.first);
    const double from = rows.rows[row - 1].positions[i], to = rows.rows[row].positions[i];
    if (std::abs(to - from) <= std::numbers::pi) continue;
    faults.add(
        rows.file, rows.rows[row].line,
        c.name + " jumps from " + shortest(from) + " to " + shortest(to) +
            " rad, by more than half a turn: angles are used as they are written; add or subtract "
            "whole turns so that the angles continue, or add rows between");
  }
}

}  // namespace

const char* nameOf(RowInterpolation between) {
  return between == RowInterpolation::linear  ? "linear"
         : between == RowInterpolation::cubic ? "cubic"
                                              : "quintic";
}

RowInterpolation interpolationOf(TrajectoryRows& rows, std::optional<RowInterpolation> wanted) {
  const RowInterpolation usual = rows.hasAccelerations ? RowInterpolation::quintic
                                 : rows.hasVelocities  ? RowInterpolation::cubic
                                                       : RowInterpolation::linear;
  const RowInterpolation between = wanted.value_or(usual);
  if (between > usual)
    throw InputError(Fault{rows.file, 0,
                           std::string("--between ") + nameOf(between) + " needs " +
                               (rows.hasVelocities ? "accelerations" : "times and velocities") +
                               ", which the file does not have; by default, " + nameOf(usual) +
                               " is used"});
  if (between < usual)
    rows.notes.push_back({rows.file + ": --between " + nameOf(between) + ": the file's " +
                              (between == RowInterpolation::cubic ? "accelerations"
                               : rows.hasAccelerations            ? "velocities and accelerations"
                                                                  : "velocities") +
                              " are not used",
                          NoteWeight::motion});
  return between;
}

Curve curveOf(const TrajectoryRows& rows, const ConfigurationSpace& space,
              RowInterpolation between) {
  RowFaults rowFaults(rows.file);
  Curve curve;
  const auto timeOf = [&](std::size_t k) {
    return rows.timed ? rows.rows[k].time : static_cast<double>(k);
  };
  curve.knots.push_back(timeOf(0));
  for (std::size_t k = 1; k < rows.rows.size(); ++k) {
    const TrajectoryRow &from = rows.rows[k - 1], &to = rows.rows[k];
    const Real duration = Real(timeOf(k)) - Real(timeOf(k - 1));
    const Real off = kTimeRounding * std::max(std::abs(timeOf(k)), std::abs(timeOf(k - 1)));
    const CurvePoint begin{from.positions, from.velocities, from.accelerations},
        end{to.positions, to.velocities, to.accelerations};
    curve.pieces.push_back(
        between == RowInterpolation::linear  ? linearPiece(space, from.positions, to.positions)
        : between == RowInterpolation::cubic ? cubicPiece(space, begin, end, duration, off)
                                             : quinticPiece(space, begin, end, duration, off));
    const CurvePiece& piece = curve.pieces.back();
    rowFaults.row([&](FaultList& faults) {
      checkTurns(rows, k, space, faults);
      if (!piece.coefficients.allFinite() || !piece.error.allFinite())
        faults.add(rows.file, to.line,
                   "the values of this row and the row before are too large to compute with");
    });
    curve.knots.push_back(timeOf(k));
  }
  FaultList faults(rows.file);
  rowFaults.addTo(faults);
  faults.throwIfAny();
  return curve;
}

}  // namespace corridor
