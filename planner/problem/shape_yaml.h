#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/placement.h"
#include "planner/robot/placed_shape.h"

/// Readers of the shapes of robots and obstacles in problem and robot files.
namespace corridor {

/// The context in which a shape is read.
struct ShapePlace {
  std::string name;              ///< the shape's name
  std::filesystem::path folder;  ///< the folder that file names are relative to
  Placement outer = {};          ///< placement of the obstacle that lists the shape in `shapes`
};

/// Reads a mesh or a primitive, and applies unit, up-axis and placement. Returns nullopt if a fault
/// was added.
/// @param files gets the shape's file, if it has one.
std::optional<PlacedShape> readShape(const YamlMap& map, const ShapePlace& place,
                                     std::vector<std::filesystem::path>& files);

/// Reads the list `shapes` of a robot or an obstacle. A single shape gets the name `place.name`.
/// Each of several shapes gets this name, a slash, and its own name or its number from 1. Shapes
/// with faults are left out. @pre the map has `shapes`.
/// @param keys the legal keys of one shape.
std::vector<PlacedShape> readShapes(const YamlMap& map, const MapKeys& keys,
                                    const ShapePlace& place,
                                    std::vector<std::filesystem::path>& files);

/// Translates a shape. @returns whether all its coordinates are still finite.
bool shift(PlacedShape& shape, const Vec3& by);

/// Adds a file to the list, unless the list already has it.
void addFile(std::vector<std::filesystem::path>& files, const std::filesystem::path& file);

}  // namespace corridor
