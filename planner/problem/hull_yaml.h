#pragma once

#include <optional>

#include "planner/problem/yaml_reader.h"
#include "planner/robot/placed_shape.h"

namespace corridor {

/// Returns the value of `convex: true` or `convex: false` beside `mesh`: whether the mesh's convex
/// hull is the model. Returns nullopt if there is no such key. Adds a fault for keys that do not
/// fit.
std::optional<bool> readHullKey(const YamlMap& map);

/// Replaces the mesh by its convex hull, one convex part, with a note on the hull's largest
/// distance from the mesh. Returns false if a fault was added: the hull is farther from the mesh
/// than `deviation` allows.
bool replaceByHull(const YamlMap& map, PlacedShape& shape);

}  // namespace corridor
