#pragma once

#include <optional>
#include <vector>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// The largest deviation of a path's end from a goal, inclusive. Where a value is 0, only rounding
/// is allowed.
struct GoalRegion {
  double position = 0;  ///< |Δp| of each planar or floating joint, metres
  double angle = 0;     ///< rotation angle of each planar or floating joint, radians
  double joint = 0;     ///< each single joint, rad or m
};

/// What a path must do: where it starts and ends, and how far it keeps from contact.
struct Task {
  Configuration start;
  std::vector<Configuration> goals;  ///< one or more; a path may end at any of them
  std::optional<GoalRegion> goalRegion;
  std::optional<double> goalThreshold;  ///< `.cfg` only: in the distance of the space
  /// Metres that the two bodies of every tested pair must keep apart; 0: touching is contact.
  double margin = 0;
  /// The half width of the tube that the proof covers, as `tubeOf` returns it.
  Configuration tube;
};

/// The tracking error that a proof shall cover. Unset values stand for rounding only.
struct TubeSpec {
  std::optional<double> joints;    ///< for each single joint, rad or m
  std::optional<double> position;  ///< for each coordinate of planar and floating joints, m
  std::optional<double> rotation;  ///< for the rotation of planar and floating joints, rad
};

/// Returns the half width of the tube that a proof covers, for each number of a configuration (m,
/// rad): the larger of `asked` and rounding. A rotation has its value at the first of its four
/// numbers. Rounding is 2^-40 of the coordinate's range; for a position, of the longest range of
/// its joint's coordinates.
Configuration tubeOf(const ConfigurationSpace& space, const TubeSpec& asked = {});

}  // namespace corridor
