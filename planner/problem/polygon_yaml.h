#pragma once

#include <string>

#include "planner/problem/yaml_reader.h"
#include "planner/robot/placed_shape.h"

namespace corridor {

/// Reads `polygon: [[x, y], …]`, a simple polygon in the plane z = 0, and moves it by X. Sets the
/// shape's `polygon`, and cuts it into the shape's convex parts. Returns false if a fault was
/// added.
bool readPolygon(const YamlMap& map, const Transform& X, PlacedShape& shape);

/// Translates a polygon. The moved corners are rounded to doubles, so the convex parts are made
/// again. Returns "", or the reason why the polygon can't be moved; its corners may then be moved
/// already.
std::string shiftPolygon(PlacedShape& shape, const Vec3& by);

}  // namespace corridor
