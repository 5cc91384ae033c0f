#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/trajectory/limits_proof.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

struct EmitOptions {
  /// The degree of the curve between two rows: 3 is the cubic that has the rows' positions and
  /// velocities, 5 the quintic that also has their accelerations. For 5, the law should be smooth
  /// (TimeLawOptions).
  int degree = 3;
  /// Regular rows per second. Unset: rows only where they are needed.
  std::optional<double> rate = {};
  /// The largest distance of the rows' curve from the path, in each component of a configuration;
  /// rad and m.
  double deviation = 1e-4;
};

/// A trajectory: rows. The curve that interpolates the rows is proved to keep the limits. Its
/// distance from the path is bounded by `deviation`; this bound does not include rounding.
struct Emission {
  std::vector<TimedRow> rows;  ///< ascending times, from 0
  double duration = 0;         ///< seconds
  /// A bound of the distance of the rows' curve from the path at every instant, in each component
  /// of a configuration, up to rounding; rad and m. For rotations: the angle between the two, rad.
  double deviation = 0;
  /// For velocity, acceleration, jerk and link speed: a proved bound of the largest ratio of a
  /// value to its limit at any instant, at most 1. `ratios.position` is a distance instead (see
  /// LimitRatios). A position that leaves its bounds is not a fault.
  LimitRatios ratios;
  /// The factor by which all times of the law were multiplied, because the rows' curve exceeded
  /// limits; 1: the law was not slowed down.
  double stretch = 1;
  std::size_t extraRows = 0;  ///< with a rate: the number of rows that were added by halving
  std::string fault;          ///< one line: why there are no rows; "" if there are rows
};

/// Makes rows of a time law.
///
/// 1. Without a rate, a row is placed at each stop, at the start, at the end and, if the space has
///    rotations, at the ends of pieces. Time intervals between rows are then halved until the curve
///    is within `deviation` of the path, and exceeds no limit by much. With a rate, each motion
///    between two stops is first slowed down so that it takes a whole number of periods; so every
///    stop is at a regular row. Rows are then added between the regular rows by the same rule.
/// 2. Distance: the time between two rows is cut at the ends of the law's segments. On each part,
///    the rows' curve minus the path q(τ(t)) is a polynomial. The Bernstein coefficients of this
///    polynomial bound the distance.
/// 3. Limits: see limits_proof.h. Let r be the largest ratio of a value to its limit, for each kind
///    of limit. If one of these r is above 1, all times are multiplied by max(r_velocity, r_link,
///    r_acceleration^(1/2), r_jerk^(1/3)), and the proof is repeated. With a rate, the law is
///    slowed down instead, and rows are chosen again.
///
/// A law that does not start and end at rest can't be slowed down as a whole, since this would
/// change its rates at the ends. Such a law is made again with smaller limits instead, and
/// `stretch` stays 1.
/// @pre law.fault is empty, and the law was made for this path and these limits.
Emission emitRows(const TimeLaw& law, const std::vector<CurvePiece>& path,
                  const ConfigurationSpace& space, const JointLimits& limits,
                  const KinematicTree& tree, const EmitOptions& options = {});

}  // namespace corridor
