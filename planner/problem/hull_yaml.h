#pragma once

#include "planner/problem/yaml_reader.h"
#include "planner/robot/placed_shape.h"

namespace corridor {

/// The meaning of the key `convex` in a map that also has the key `mesh`. (Without `mesh`, `convex`
/// is a shape of its own.)
enum class HullKey {
  none,    ///< the map does not have both keys
  hull,    ///< `true`: the mesh's convex hull is the model
  mesh,    ///< `false`: the mesh is the model
  faulty,  ///< neither `true` nor `false`; a fault was added
};

/// Reads the key `convex` if the map also has the key `mesh`. Adds a fault for the key `solid`
/// beside `convex: true`, and for the key `deviation` without `convex: true`.
HullKey readHullKey(const YamlMap& map);

/// Returns whether a value is `true` or `false`, written without quotes.
bool isBoolean(const YamlValue& value);

/// Replaces the shape's mesh by the mesh's convex hull, as one convex part. Adds a note on the
/// largest distance of the hull's surface from the mesh. The hull's corners are in their final
/// place, so the shape's `at` becomes the identity. Returns false, and does not change the shape,
/// if a fault was added, for example because the hull is not proved to be as near to the mesh as
/// `deviation` requires.
/// @pre The mesh's placement has been applied to its vertices.
bool replaceByHull(const YamlMap& map, PlacedShape& shape);

}  // namespace corridor
