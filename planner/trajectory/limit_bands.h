#pragma once

#include <cstddef>
#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/trajectory/path_view.h"

namespace corridor {

/// The components of a configuration that are the position of one planar or floating joint: x and
/// y, or x, y and z. Their limits are limits of the length of the position's velocity, acceleration
/// and jerk vectors.
struct PositionGroup {
  Eigen::Index first = 0, count = 2;
};
std::vector<PositionGroup> positionGroups(const ConfigurationSpace& space);

/// Components of a configuration that have one limit together: one single component, the components
/// of a position, or the three components of a rotation vector. The limit is the element `first` of
/// a vector of limits.
struct LimitedNumbers {
  Eigen::Index first = 0, count = 1;
};
std::vector<LimitedNumbers> limitedNumbers(const ConfigurationSpace& space);

/// Returns, for each component, the ratio of its absolute value in `values` to its limit. For a
/// position or a rotation, the ratio of the vector's length to its limit is in the first component,
/// and the other components are 0.
Configuration sharesOf(const Configuration& values, const Configuration& limits,
                       const ConfigurationSpace& space);

/// The limits at points of a path, in the form that reachability analysis needs (LimitGrid). With x
/// = ṡ² and u = s̈, where s is the path parameter, a band is a limit |a·u + b·x| ≤ 1.
class LimitBands {
 public:
  LimitBands(const PathView& view, const JointLimits& limits, const KinematicTree& tree);

  std::size_t count() const { return count_; }
  /// Returns whether limits vary along a straight line: only limits of link speeds do.
  bool varies() const { return !limits_.links.empty(); }
  /// Computes the bands of a point of the path.
  /// @param length ds/dτ of the piece.
  /// @param a, b pointers to count() doubles each, which are set to the a and b of the bands.
  /// @returns the largest x that the limits of velocity and link speed allow; may be infinite.
  double at(std::size_t piece, double tau, double length, double* a, double* b) const;

 private:
  /// The number of directions in which a position's acceleration is limited. Each direction stands
  /// for two opposite sides of a regular polygon of 32 sides inside the circle that is the limit.
  static constexpr int kDirections = 16;

  const PathView& view_;
  const JointLimits& limits_;
  const KinematicTree& tree_;
  std::vector<PositionGroup> positions_;
  std::vector<Eigen::Index> singles_;  // components with a limit of their own
  std::size_t count_ = 0;
  mutable Configuration first_, second_;  // scratch memory
};

}  // namespace corridor
