#pragma once

#include <cstddef>
#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/trajectory/path_view.h"

namespace corridor {

/// The numbers of a configuration whose limits are those of a vector's length: x and y (z) of a
/// planar (floating) joint.
struct PositionGroup {
  Eigen::Index first = 0, count = 2;
};
std::vector<PositionGroup> positionGroups(const ConfigurationSpace& space);

/// Numbers of a configuration that have one limit together: a single number, a position or a
/// rotation (the three numbers of its rotation vector). The limit is that of `first`.
struct LimitedNumbers {
  Eigen::Index first = 0, count = 1;
};
std::vector<LimitedNumbers> limitedNumbers(const ConfigurationSpace& space);

/// Returns the share of its limit that each number of `values` uses. For a position or a rotation,
/// the length of its vector counts: its first number has the share, and its other numbers have 0.
Configuration sharesOf(const Configuration& values, const Configuration& limits,
                       const ConfigurationSpace& space);

/// The limits of a path, as reachability analysis needs them (LimitGrid).
class LimitBands {
 public:
  LimitBands(const PathView& view, const JointLimits& limits, const KinematicTree& tree);

  std::size_t count() const { return count_; }
  /// Whether limits vary along a straight line: limits of link speeds do.
  bool varies() const { return !limits_.links.empty(); }
  /// Computes the bands of a point of the path.
  /// @param length ds/dτ of the piece.
  /// @param a, b get count() numbers each.
  /// @returns the largest x that velocities allow; may be infinite.
  double at(std::size_t piece, double tau, double length, double* a, double* b) const;

 private:
  /// Directions in which the length of a position's acceleration is limited: half of the sides of a
  /// regular polygon inside the circle.
  static constexpr int kDirections = 16;

  const PathView& view_;
  const JointLimits& limits_;
  const KinematicTree& tree_;
  std::vector<PositionGroup> positions_;
  std::vector<Eigen::Index> singles_;  // numbers with a limit of their own, rotations left out
  std::size_t count_ = 0;
  mutable Configuration first_, second_;  // scratch memory
};

}  // namespace corridor
