#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/trajectory/limits_proof.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

struct EmitOptions {
  /// The curve between two rows: 3 is the cubic of positions and velocities, 5 the quintic that
  /// also meets the accelerations. For 5, the law should be smooth.
  int degree = 3;
  /// Rows per second. Unset: rows where they are needed.
  std::optional<double> rate = {};
  /// The largest distance of the rows' curve from the path, in each number; rad and m.
  double deviation = 1e-4;
};

/// A trajectory: rows, whose interpolant was proved to stay near the path and within the limits.
struct Emission {
  std::vector<TimedRow> rows;  ///< ascending times, from 0
  double duration = 0;         ///< seconds
  /// A bound of the distance of the rows' curve from the path, in each number, at every instant, up
  /// to rounding; rad and m. For rotations: the angle.
  double deviation = 0;
  /// Proved bounds of the largest share of each limit that is used at any instant; at most 1.
  /// Positions are no shares (see LimitRatios): if one leaves its bounds, this is no fault.
  LimitRatios ratios;
  /// The factor by which the law was slowed down, because it exceeded limits between the points of
  /// its grid; 1: not at all.
  double stretch = 1;
  std::size_t extraRows = 0;  ///< with a rate: rows between the regular ones, for the deviation
  std::string fault;          ///< why there are no rows, one line; or ""
};

/// Makes rows of a time law.
///
/// 1. Without a rate, a row stands at the end of each run, and rows are added by halving until the
///    curve between the rows is within `deviation` of the path, and uses no limit much more than
///    the law does. With a rate, each run between two stops first takes up to one period longer, so
///    that every stop is at a row. Rows are added where the deviation needs them.
/// 2. Distance: on each time interval between two rows that is in one segment of the law and in one
///    piece, the difference of the rows' curve and of the path q(τ(t)) is a polynomial. The
///    Bernstein coefficients of this polynomial bound the distance.
/// 3. Limits: limits_proof.h. If one is exceeded by a factor r, all times are multiplied by
///    max(r_velocity, r_link, r_acceleration^(1/2), r_jerk^(1/3)), and the proof is repeated. With
///    a rate, the law is slowed down instead, and rows are chosen again.
///
/// A law that does not start and end at rest can't be stretched, since this would change its rates
/// at the ends. The law is made again with smaller limits instead (`stretch` is 1 then).
/// @pre law.fault is empty, and the law was made for this path and these limits.
Emission emitRows(const TimeLaw& law, const std::vector<CurvePiece>& path,
                  const ConfigurationSpace& space, const JointLimits& limits,
                  const KinematicTree& tree, const EmitOptions& options = {});

}  // namespace corridor
