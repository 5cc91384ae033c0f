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

/// Returns the bounds of the group's position. Bounds that are not set yet are NaN.
Corners boundsOf(const ConfigurationSpace& space, const CoordinateGroup& group);
void setBounds(ConfigurationSpace& space, const CoordinateGroup& group, const Corners& corners);

/// Returns what is wrong with the bounds, or "". Bounds are wrong if a lower bound is not below its
/// upper bound, or if their difference is not a finite double.
std::string whyBadBounds(const Corners& corners, std::size_t dimensions);

/// Returns the bounding box of a shape, metres. It is not rounded outwards, so no proof may use it.
/// @param X the pose of the shape's coordinates in the frame of the box.
Corners boundsOf(const PlacedShape& shape, const Transform& X = {});
/// Returns the bounding box of the obstacles, or nullopt if there are none.
std::optional<Corners> boundsOfWorld(const Model& model);

}  // namespace corridor
