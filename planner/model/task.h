#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/configuration_space.h"

namespace corridor {

/// The largest deviation of a path's end from a goal, inclusive. If a member is 0, positions and
/// the values of lines must be equal; circles and rotations may differ by rounding.
struct GoalRegion {
  double position = 0;  ///< |Δp| of each planar or floating joint, metres
  double angle = 0;     ///< rotation angle of each planar or floating joint, radians
  double joint = 0;     ///< each single joint, rad or m
};

/// What pairs of bodies keep beyond the margin of a task, if pairs have different margins. Bodies
/// are given by their indices in the model. Metres, 0 or more.
struct MarginsBeyond {
  double self = 0;   ///< pairs of links of the same robot
  double world = 0;  ///< all other pairs
  /// Single pairs, with the lower index first, in place of `self` and `world`.
  std::map<std::pair<std::size_t, std::size_t>, double> pairs;

  double of(std::size_t a, std::size_t b, bool sameRobot) const;
  double largest() const;
};

/// Distances that bodies keep in addition to the margin of a task. Bodies are given by their
/// indices in the model. Metres, 0 or more.
struct Padding {
  /// For single bodies: the distance that the body keeps from all bodies, except those of the same
  /// robot. The paddings of the two bodies of a pair add up.
  std::map<std::size_t, double> bodies;
  /// For pairs, with the lower index first: the distance that replaces the sum of the paddings of
  /// the two bodies.
  std::map<std::pair<std::size_t, std::size_t>, double> pairs;

  /// What pairs keep beyond the margin, and beyond the paddings above.
  MarginsBeyond beyond = {};

  bool empty() const { return bodies.empty() && pairs.empty() && beyond.largest() == 0; }
  /// Returns the padding of two bodies, with what they keep beyond the margin, rounded up.
  /// @param sameRobot whether both bodies belong to the same robot.
  double of(std::size_t a, std::size_t b, bool sameRobot) const;
  /// Returns an upper bound of the paddings of all pairs.
  double largest() const;
};

/// The requirements of a path: its start, its goals, and the distance that it keeps from contact.
struct Task {
  Configuration start;
  std::vector<Configuration> goals;  ///< one or more; a path may end at any of them
  std::optional<GoalRegion> goalRegion;
  std::optional<double> goalThreshold;  ///< `.cfg` only: largest distance to a goal, in the space's
                                        ///< metric
  /// Metres that the two bodies of every tested pair must keep apart; 0: touching is contact. If
  /// pairs have different margins, the smallest of them (`MarginsBeyond`).
  double margin = 0;
  Padding padding;
  /// The half widths of the tube that the proof covers, as `tubeOf` returns them.
  Configuration tube;
  /// Limits of speed, acceleration and jerk. They matter to time laws only (planner/trajectory).
  JointLimits limits;
};

/// What the tests of a model have to cover. Some pairs of links were proved never in contact
/// (`PairProof`). Such a pair is left out of the tests only if its proof covers the requirements.
struct Required {
  double margin = 0;  ///< metres that the two bodies of every pair must keep apart
  Padding padding;    ///< distances of bodies and pairs beyond the margin
  Configuration
      tube;  ///< half widths, as `tubeOf` returns them. Of another length: no proof counts

  /// Returns requirements that no proof covers. No pair is then left out because of a proof.
  static Required beyondProofs();
};

/// Returns the requirements of a task.
Required requiredBy(const Task& task);

/// The deviation from the path that a proof shall cover, in each coordinate that is planned for.
/// The tube is for errors of these coordinates: the tracking error of joints, offsets of encoders,
/// the localisation of a mobile base whose planar joint is planned for. The robot as a whole may
/// also be early or late on the path. A joint or robot that lags behind another is covered only up
/// to these values.
///
/// All other errors are excluded: the pose of a fixed base, the poses and axes of joints in their
/// links, the values of held joints, the deviation of a mimic joint from its rule, and the shapes
/// and positions of links and obstacles. The margin is for them (planner/README.md lists more).
///
/// If a member is unset, the proof covers only rounding in the coordinates that the member is for.
struct TubeSpec {
  std::optional<double> joints;    ///< for each single joint: rad, or m if it is prismatic
  std::optional<double> slides;    ///< for each prismatic joint, m; replaces `joints`
  std::optional<double> position;  ///< for each x, y and z of planar and floating joints, m
  std::optional<double> rotation;  ///< for the rotation of planar and floating joints, rad
  /// For single joints, by the names of their coordinates ("left/elbow"): rad, or m if prismatic.
  /// For the named joints, these values replace `joints` and `slides`.
  std::map<std::string, double> named = {};
};

/// Returns the half width of the tube that a proof covers, for each number of a configuration (m,
/// rad). Each half width is the one in `asked`, but at least 2^-40 times a range, for rounding. For
/// a single joint with limits, this range is upper − lower. For the position of a planar or
/// floating joint, it is the longest range of the joint's position coordinates. For circles and
/// rotations, it is 2π. A rotation has its half width at the first of its four numbers.
/// @pre the bounds of all positions are set.
Configuration tubeOf(const ConfigurationSpace& space, const TubeSpec& asked = {});

}  // namespace corridor
