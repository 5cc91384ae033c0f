#include "planner/problem/robot_file.h"

#include <algorithm>
#include <array>

#include "collision/core/nearest.h"
#include "planner/problem/format_key.h"
#include "planner/problem/keys.h"
#include "planner/problem/placement.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

/// The average of the distinct positions of corners, however often a mesh repeats them.
Vec3 centroid(const std::vector<ProblemMesh>& shapes) {
  std::vector<std::array<double, 3>> points;
  for (const ProblemMesh& shape : shapes)
    for (const auto& triangle : shape.source.mesh.triangles)
      for (const std::uint32_t i : triangle) {
        const Vec3& p = shape.source.mesh.vertices[i];
        points.push_back({p.x(), p.y(), p.z()});
      }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::array<long double, 3> sum{};
  for (const auto& p : points)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += p[k];
  const auto n = static_cast<long double>(points.size());
  return {static_cast<double>(sum[0] / n), static_cast<double>(sum[1] / n),
          static_cast<double>(sum[2] / n)};
}

/// @returns false if any shape was faulted.
bool readShapes(const YamlMap& file, RobotFile& robot, const std::filesystem::path& folder) {
  const YamlValue* shapes =
      file.require("shapes", "the robot's meshes, such as shapes: [{mesh: piano.obj, unit: m}]");
  if (!shapes) return false;
  if (shapes->kind != YamlValue::Kind::List || shapes->items.empty()) {
    file.fault("shapes",
               "a list of at least one {mesh: FILE} is needed, not " +
                   (shapes->kind == YamlValue::Kind::List ? "an empty one" : described(*shapes)));
    return false;
  }
  const std::size_t before = file.source().faults.size();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < shapes->items.size(); ++i) {
    const YamlMap map(shapes->items[i], "shapes[" + std::to_string(i) + "]",
                      &robotKeys().at("shapes[]"), file.source());
    const std::string own = map.text("name").value_or(std::to_string(i + 1));
    if (std::find(names.begin(), names.end(), own) != names.end())
      map.fault("name", quotedWord(own) + " is the name of another shape");
    names.push_back(own);
    if (auto mesh = readPlacedMesh(
            map, shapes->items.size() == 1 ? robot.name : robot.name + "/" + own, folder))
      robot.shapes.push_back(std::move(*mesh));
  }
  return file.source().faults.size() == before;
}

void shiftToReference(const YamlMap& file, RobotFile& robot, bool shapesAreSound) {
  const YamlValue* value = file.find("reference");
  if (!value) return;
  const bool planar = robot.space == RigidSpace::SE2;
  Vec3 reference = Vec3::Zero();
  if (value->kind == YamlValue::Kind::Scalar && value->text == "centroid") {
    if (!shapesAreSound) return;
    reference = centroid(robot.shapes);
    if (planar) reference.z() = 0;  // a planar robot keeps its height
    robot.notes.push_back("reference of " + robot.name + ": the centroid (" +
                          shortest(reference.x()) + ", " + shortest(reference.y()) + ", " +
                          shortest(reference.z()) + ") of its distinct vertices");
  } else if (value->kind == YamlValue::Kind::List) {
    const std::size_t count = planar && value->items.size() == 2 ? 2 : 3;
    const auto numbers = file.numbers("reference", count);
    if (!numbers) return;
    reference = Vec3((*numbers)[0], (*numbers)[1], count == 3 ? (*numbers)[2] : 0);
  } else {
    file.fault("reference",
               "a point [x, y, z] or the word centroid is needed, not " + described(*value));
    return;
  }
  for (ProblemMesh& shape : robot.shapes)
    for (Vec3& vertex : shape.source.mesh.vertices) {
      vertex -= reference;
      if (vertex.allFinite()) continue;
      file.fault("reference", "moves the mesh out of the range of doubles");
      return;
    }
}

}  // namespace

std::optional<RobotFile> readRobotFile(const std::filesystem::path& file, FaultList& faults) {
  YamlValue document;
  try {
    document = parseYaml(file.string(), readTextFile(file, "a robot (format: corridor-robot-1)"));
  } catch (const InputError& error) {
    faults.add(error);
    return std::nullopt;
  }
  YamlSource source{file.string(), faults, {}};
  if (!hasFormat(document, "corridor-robot-1", source)) return std::nullopt;
  const YamlMap map(document, "", &robotKeys().at(""), source);

  RobotFile robot;
  robot.name = map.text("name").value_or(nameOfFile(file, "robot"));
  map.require("rigid", "SE3 (moves and turns freely) or SE2 (moves in x and y, turns about z)");
  const auto space = map.choice("rigid", robotChoices().at("rigid"));
  robot.space = space == "SE2" ? RigidSpace::SE2 : RigidSpace::SE3;

  const bool sound = readShapes(map, robot, file.parent_path());
  if (space) shiftToReference(map, robot, sound);

  // One meaning for users, metres per radian of rotation, and OMPL's default for both spaces: half
  // a metre.
  double weight = 0.5;
  if (const YamlValue* weights = map.find("weights"))
    weight = YamlMap(*weights, "weights", &robotKeys().at("weights"), source)
                 .number("rotation", Range::Positive)
                 .value_or(weight);
  robot.rotationWeight = robot.space == RigidSpace::SE3 ? 2 * weight : weight;
  return space ? std::optional(std::move(robot)) : std::nullopt;
}

}  // namespace corridor
