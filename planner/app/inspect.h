#pragma once

#include <nlohmann/json.hpp>

#include "collision/geometry/mesh_file.h"
#include "planner/app/commands.h"
#include "planner/robot/placed_shape.h"

/// What `corridor inspect` tells, by kind of file.
namespace corridor::app {

int inspectProblem(const InspectArguments& arguments);
int inspectRobot(const InspectArguments& arguments);  ///< a URDF, or robot.yaml
int inspectCost(const InspectArguments& arguments);   ///< a mesh against another

/// A mesh file in the unit and with the up-axis that were asked for.
MeshFile meshFileAsked(const std::string& file, const InspectArguments& arguments);
nlohmann::ordered_json meshJson(const MeshFile& file);
nlohmann::ordered_json shapeJson(const PlacedShape& shape);
/// "36 triangles, piano.obj"; "box".
std::string shapeText(const PlacedShape& shape);

}  // namespace corridor::app
