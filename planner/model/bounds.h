#pragma once

#include <optional>

#include "planner/model/model.h"

/// Bounds on the positions of rigid robots and of planar and floating joints. Each of these robots
/// and joints has a `CoordinateGroup`, of kind planar or floating.
namespace corridor {

/// Lower and upper corner of a box, metres. For planar motion z is not used.
struct Corners {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};

/// Returns 2 for a planar group, 3 for a floating one.
std::size_t dimensionsOf(const CoordinateGroup& group);

/// Returns the bounds of the group's position, or NaN if they are not set yet.
Corners boundsOf(const ConfigurationSpace& space, const CoordinateGroup& group);
void setBounds(ConfigurationSpace& space, const CoordinateGroup& group, const Corners& corners);

/// Returns what is wrong with the bounds (a lower bound is not below the upper bound, or a range is
/// infinite), or "".
std::string whyBadBounds(const Corners& corners, std::size_t dimensions);

/// Returns the bounding box of the obstacles, or nullopt if there are none.
std::optional<Corners> boundsOfWorld(const Model& model);

/// A joint that mimics a continuous joint and is outside of its own limits.
struct FollowerOutside {
  std::string name;  ///< "s", "left/s"
  double value = 0, lower = 0, upper = 0;
};
/// Returns the joints that mimic a continuous joint and are outside of their own limits in `q`.
/// Such a joint can be outside if an angle of `q` is outside of [−π, π], or if its URDF gives it
/// neither lower nor upper (both limits are then 0). In all other cases the reader has narrowed the
/// range of the mimicked joint. Limits are widened by rounding: 2^-40·(|value| + |offset|).
std::vector<FollowerOutside> followersOutside(const Model& model, const Configuration& q);

}  // namespace corridor
