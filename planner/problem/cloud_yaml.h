#pragma once

#include "collision/geometry/occupancy_map.h"
#include "planner/problem/shape_yaml.h"

namespace corridor {

/// Reads a point cloud or a map. `points: {file: cloud.ply, radius: 0.01}` is the union of balls
/// about the points of a file; `octomap: {file: map.bt}` is the union of a map's occupied cubes.
/// Sets the file, the parts and the notes of `shape`, and adds the file to `files`.
/// @param kind     "points" or "octomap": the key in `map`
/// @param keys     the legal keys of the map that is the value of this key
/// @param options  unit and up-axis; used only for points
/// @param X        the pose of the cloud or map in the frame of its body
/// @returns true, or false if a fault was added.
bool readCloud(const YamlMap& map, const std::string& kind, const MapKeys& keys,
               const std::filesystem::path& folder, const MeshFileOptions& options,
               const Transform& X, PlacedShape& shape, std::vector<std::filesystem::path>& files);

/// Returns the occupied cubes of a map as boxes. @param X the pose of the map in the frame of its
/// body.
std::vector<ConvexPart> cubesOf(const OccupancyMap& map, const Transform& X);

}  // namespace corridor
