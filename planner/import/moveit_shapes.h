#pragma once

#include <optional>
#include <string>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "planner/problem/placement.h"
#include "planner/problem/yaml_reader.h"
#include "planner/robot/placed_shape.h"

/// Readers of the ROS messages that describe shapes in MoveIt's planning scenes. Each reader
/// returns nullopt if it added a fault. The parameter `path` is the path of the message's key in
/// the file, for the text of faults.
namespace corridor {

/// Reads a message geometry_msgs/Pose.
std::optional<Placement> readPose(const YamlValue& value, const std::string& path,
                                  YamlSource& source);

/// Reads a message shape_msgs/SolidPrimitive. Its type is a word or a number, such as `box` or 1.
std::optional<Primitive> readPrimitive(const YamlValue& value, const std::string& path,
                                       YamlSource& source);

/// Reads a message shape_msgs/Mesh.
std::optional<TriangleMesh> readMesh(const YamlValue& value, const std::string& path,
                                     YamlSource& source);

/// Reads a message octomap_msgs/Octomap. Returns the union of the occupied cells, placed at `at`.
/// As in MoveIt, the shape's name is "<octomap>", cells without a measurement are free, and a cell
/// is occupied if its probability is at least 0.5. Returns nullopt, without a fault, if the map has
/// no occupied cell.
std::optional<PlacedShape> readOctomap(const YamlValue& value, const std::string& path,
                                       const Placement& at, YamlSource& source);

}  // namespace corridor
