#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "collision/geometry/mesh_file.h"
#include "planner/robot/placed_shape.h"

/// The parts of `corridor inspect`, one per kind of file, and what they share.
namespace corridor::app {

struct InspectArguments {
  std::string file;
  std::optional<std::string> unit, up;  ///< a mesh file's unit and up-axis
  bool selfIntersections = false;       ///< mesh files: compute self-intersections
  bool pairs = false;                   ///< problems: list every pair of bodies
  std::optional<std::string> against;   ///< a second mesh file: measure queries of the two
  std::optional<std::string> poses;     ///< file with poses of the second mesh, one per line
  bool json = false;
};

int inspectProblem(const InspectArguments& arguments);
int inspectRobot(const InspectArguments& arguments);  ///< a URDF or a robot.yaml

nlohmann::ordered_json meshJson(const MeshFile& file);
nlohmann::ordered_json shapeJson(const PlacedShape& shape);
/// Returns a shape in words: "36 triangles, piano.obj"; "box".
std::string shapeText(const PlacedShape& shape);

}  // namespace corridor::app
