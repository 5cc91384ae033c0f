#pragma once

#include "planner/problem/yaml_reader.h"
#include "planner/robot/placed_shape.h"

namespace corridor {

/// What `convex` says beside `mesh`. Without `mesh`, `convex` is a shape of its own.
enum class HullKey {
  none,    ///< `mesh` or `convex` is not given
  hull,    ///< `true`: the mesh's convex hull is the model
  mesh,    ///< `false`: the mesh is the model
  faulty,  ///< neither `true` nor `false`; a fault was added
};

/// Reads `convex` beside `mesh`. Adds a fault for other keys that do not fit.
HullKey readHullKey(const YamlMap& map);

/// Returns whether a value is the word true or false, without quotes.
bool isBoolean(const YamlValue& value);

/// Replaces the mesh by its convex hull, one convex part, with a note on the hull's largest
/// distance from the mesh. The hull's corners are in their final place, so the shape's `at` becomes
/// the identity. Returns false if a fault was added: the hull is farther from the mesh than
/// `deviation` allows.
/// @pre the mesh's placement is applied.
bool replaceByHull(const YamlMap& map, PlacedShape& shape);

}  // namespace corridor
