#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/placement.h"
#include "planner/robot/placed_shape.h"

/// Shapes of robots and worlds, as problem and robot files write them.
namespace corridor {

/// Where a shape belongs.
struct ShapePlace {
  std::string name;              ///< the shape's
  std::filesystem::path folder;  ///< that file names start from
  Placement outer = {};          ///< of the group that it is in
};

/// A mesh or a primitive with everything applied. nullopt: faulted.
/// @param files gets the shape's file, if it has one.
std::optional<PlacedShape> readShape(const YamlMap& map, const ShapePlace& place,
                                     std::vector<std::filesystem::path>& files);

/// The list `shapes` of a robot or an obstacle. The shapes are called `place.name` where there is
/// one, else "name/their own" or "name/number". What is faulted is left out.
/// @param keys of one of them.
std::vector<PlacedShape> readShapes(const YamlMap& map, const MapKeys& keys,
                                    const ShapePlace& place,
                                    std::vector<std::filesystem::path>& files);

/// Moves a shape. @returns false: out of the range of doubles.
bool shift(PlacedShape& shape, const Vec3& by);

/// Adds a file, unless it has been named before.
void addFile(std::vector<std::filesystem::path>& files, const std::filesystem::path& file);

}  // namespace corridor
