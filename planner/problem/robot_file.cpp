#include "planner/problem/robot_file.h"

#include <algorithm>
#include <array>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "planner/model/model_builder.h"
#include "planner/problem/format_key.h"
#include "planner/problem/keys.h"
#include "planner/problem/shape_yaml.h"
#include "planner/problem/urdf_robot.h"
#include "planner/problem/yaml_ledger.h"
#include "planner/robot/urdf_file.h"

namespace corridor {
namespace {

/// Returns the average of the distinct positions of triangle corners and of primitives' points.
/// Equal positions count once.
Vec3 centroid(const std::vector<PlacedShape>& shapes) {
  std::vector<std::array<double, 3>> points;
  const auto add = [&](const Vec3& p) { points.push_back({p.x(), p.y(), p.z()}); };
  for (const PlacedShape& shape : shapes) {
    for (const Vec2& p : shape.polygon) add({p.x(), p.y(), 0});
    // All points of a polygon's parts are corners of the polygon.
    for (const ConvexPart& part : shape.parts)
      std::for_each(part.points.begin(), part.points.end(), add);
    if (!shape.mesh) continue;
    for (const auto& triangle : shape.mesh->mesh.triangles)
      for (const std::uint32_t i : triangle) add(shape.mesh->mesh.vertices[i]);
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

void shiftToReference(const YamlMap& file, RobotDescription& model, bool shapesAreSound) {
  const YamlValue* value = file.find("reference");
  if (!value) return;
  std::vector<PlacedShape>& shapes = model.links.front().shapes;
  const bool planar = model.mount == JointType::planar;
  Vec3 reference = Vec3::Zero();
  if (value->kind == YamlValue::Kind::Scalar && value->text == "centroid") {
    if (!shapesAreSound) return;
    reference = centroid(shapes);
    if (planar) reference.z() = 0;  // a planar robot keeps its z coordinates
    model.notes.push_back({"reference of " + model.name + ": the centroid (" +
                           shortest(reference.x()) + ", " + shortest(reference.y()) + ", " +
                           shortest(reference.z()) + ") of its distinct vertices"});
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
  for (PlacedShape& shape : shapes)
    if (const std::string why = shift(shape, -reference); !why.empty()) {
      file.fault("reference", why);
      return;
    }
}

/// Reads a rigid robot. Returns nullopt if the value of `rigid` is neither SE2 nor SE3.
std::optional<RobotSetup> readRigid(const YamlMap& map, const std::string& name,
                                    const std::filesystem::path& folder, RobotSetup setup) {
  for (const char* key : {"srdf", "xacro", "packages", "visuals", "limits", "collada_up", "group",
                          "joints", "hold", "states", "allow", "never_in_contact"})
    if (map.find(key)) map.fault(key, "is for robots with joints (urdf: FILE); this one is rigid");
  const auto rigid = map.choice("rigid", robotChoices().at("rigid"));
  const std::size_t before = map.source().faults.size();
  // A robot whose `rigid` is absent or faulty counts as planar.
  const bool isPlanar = !rigid || *rigid == "SE2";
  std::vector<PlacedShape> shapes;
  ShapeFiles files{setup.files};
  if (map.require("shapes", "the robot's shapes, such as shapes: [{mesh: piano.obj, unit: m}]"))
    shapes = readShapes(map, robotKeys().at("shapes[]"), {name, folder, {}, isPlanar}, files);
  const bool sound = map.source().faults.size() == before && !shapes.empty();
  if (const YamlValue* weights = map.find("weights")) {
    const YamlMap inner(*weights, "weights", &robotKeys().at("weights"), map.source());
    setup.robot.rotationWeight =
        inner.number("rotation", Range::Positive).value_or(setup.robot.rotationWeight);
    if (inner.find("joints")) inner.fault("joints", "this robot is rigid and has no joints");
  }
  if (!rigid) return std::nullopt;
  setup.robot.description = rigidModel(
      name, *rigid == "SE2" ? JointType::planar : JointType::floating, std::move(shapes));
  shiftToReference(map, setup.robot.description, sound);
  return setup;
}

}  // namespace

std::optional<RobotSetup> readRobotFile(const std::filesystem::path& file, FaultList& faults,
                                        std::vector<Note>& notesOfFaulty, const std::string& group,
                                        RobotUse use, FileCache* cache) {
  RobotSetup setup;
  if (isUrdf(file)) return readBareUrdf(file, use, faults, notesOfFaulty, cache);

  setup.files.push_back(file);
  YamlValue document;
  try {
    document = parseYaml(file.string(), readTextFile(file, "a robot (format: corridor-robot-1)"));
  } catch (const InputError& error) {
    faults.add(error);
    return std::nullopt;
  }
  const std::size_t faultsBefore = faults.size();
  YamlSource source{file.string(), faults, {}};
  source.cache = cache;
  if (!acceptsFormat(document, "corridor-robot-1", source)) return std::nullopt;
  const YamlMap map(document, "", &robotKeys().at(""), source);
  const std::string name = map.text("name").value_or(nameOfFile(file, "robot"));
  const auto kind = map.requireOne({"rigid", "urdf"}, "one of rigid and urdf",
                                   "rigid: SE3 (moves and rotates freely), rigid: SE2 (moves in x "
                                   "and y, rotates about z), or urdf: arm.urdf (has joints)");
  std::optional<RobotSetup> read;
  if (kind == "urdf")
    read =
        readUrdfRobot(map, name, group, file.parent_path(), use, std::move(setup), notesOfFaulty);
  else if (kind == "rigid")
    read = readRigid(map, name, file.parent_path(), std::move(setup));
  if (faults.size() == faultsBefore)
    addAll(notesOnUnread(document, file.string(), DefaultValues::count), source.notes);
  addAll(source.notes, read ? read->robot.description.notes : notesOfFaulty);
  return read;
}

RobotSetup readRobotAlone(const std::filesystem::path& file, RobotUse use, FileCache* cache) {
  std::optional<RobotSetup> setup;
  std::vector<Note> notes;
  readWithNotes(notes, [&] {
    FaultList faults(file.string());
    setup = readRobotFile(file, faults, notes, "", use, cache);
    if (setup) notes = setup->robot.description.notes;
    faults.throwIfAny();
  });
  return std::move(*setup);
}

}  // namespace corridor
