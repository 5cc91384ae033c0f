#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/problem/problem.h"

/// Bounds of what moves as a whole: of the position of rigid robots, planar and floating joints.
namespace corridor {

/// Lower and upper corner; of what moves in the plane, z isn't used.
struct Corners {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};

/// The bounding box of the world's bodies. nullopt: there are none.
std::optional<Corners> boundsOfWorld(const Problem& problem);

/// Of the group's position in the problem's space.
Corners boundsOf(const Problem& problem, const CoordinateGroup& group);
void setBounds(Problem& problem, const CoordinateGroup& group, const Corners& corners);

/// Enlarges the bounds of the group to contain start and goals. @returns whether that was needed.
bool enlargeBounds(Problem& problem, const CoordinateGroup& group);

/// What is wrong with the bounds themselves, or "".
std::string whyBadBounds(const Corners& corners, std::size_t dimensions);

/// Why the group's position in a configuration is no legal one ("outside of the bounds: x = 9 is
/// not in [0, 1]"), or "".
std::string whyOutside(const Problem& problem, const CoordinateGroup& group,
                       const Configuration& q);

/// A joint with limits that mimics a full circle, and is outside of them.
struct FollowerOutside {
  std::string name;  ///< "s", "left/s"
  double value = 0, lower = 0, upper = 0;
};
/// Where angles of full circles are taken as they are, beyond a turn, what mimics them may leave
/// its own limits. Values within a rounding of a limit are within it.
std::vector<FollowerOutside> followersOutside(const Problem& problem, const Configuration& q);

/// 2 or 3.
std::size_t dimensionsOf(const CoordinateGroup& group);

}  // namespace corridor
