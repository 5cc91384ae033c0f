#include "planner/import/moveit_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/import/moveit_frames.h"
#include "planner/import/moveit_matrix.h"
#include "planner/import/moveit_shapes.h"
#include "planner/problem/urdf_robot.h"
#include "planner/problem/yaml_ledger.h"

namespace corridor {
namespace {

// The fields of the messages. Unknown keys are faults, because a misspelt key may move an obstacle.
const MapKeys kScene{
    {"name", "robot_state", "robot_model_name", "fixed_frame_transforms",
     "allowed_collision_matrix", "link_padding", "link_scale", "object_colors", "world", "is_diff"},
    {}};
const MapKeys kWorld{{"collision_objects", "octomap"}, {}};
const MapKeys kPosedOctomap{{"header", "origin", "octomap"}, {}};
const MapKeys kObject{
    {"header", "pose", "id", "type", "primitives", "primitive_poses", "meshes", "mesh_poses",
     "planes", "plane_poses", "subframe_names", "subframe_poses", "operation"},
    {}};

/// Returns the paddings of links, by their names (metres). Adds a fault for each link that the
/// scene scales.
std::map<std::string, double> readLinks(const YamlMap& scene) {
  for (const YamlValue* const item : itemsOf(scene, "link_scale")) {
    const YamlMap map(*item, "link_scale", nullptr, scene.source());
    map.ignore({"link_name"});
    if (map.number("scale").value_or(1) != 1)
      map.fault("scale",
                "links are tested in their own size; use link_padding, or padding in the "
                "problem, for a distance to keep");
  }
  std::map<std::string, double> padding;
  for (const YamlValue* const item : itemsOf(scene, "link_padding")) {
    const YamlMap map(*item, "link_padding", nullptr, scene.source());
    const auto link = map.text("link_name");
    const auto metres = map.number("padding", Range::NotNegative);
    if (!link)
      map.require("link_name", "the link that is padded");
    else if (metres && !padding.emplace(*link, *metres).second)
      map.fault("link_name", "link_padding names " + quotedWord(*link) + " twice");
  }
  std::erase_if(padding, [](const auto& link) { return link.second == 0; });
  return padding;
}

}  // namespace

MoveitScene::MoveitScene(const std::filesystem::path& file, FaultList& faults)
    : document_(parseYaml(file.string(), readTextFile(file, "a planning scene of MoveIt"))),
      source_{file.string(), faults, {}} {
  for (const char* key : {"group_name", "goal_constraints", "start_state", "workspace_parameters"})
    if (hasKey(document_, key))
      throw InputError(Fault{file.string(), 0,
                             "is a motion plan request, not a planning scene (it has " +
                                 std::string(key) + "); write moveit: {request: FILE}"});
  const YamlMap scene(document_, "", &kScene, source_);
  scene.ignore({"name", "object_colors"});
  if (scene.flag("is_diff").value_or(false))
    scene.fault("is_diff",
                "the scene is a difference to another one, so objects may be missing; save the "
                "whole scene, or write false if the file has all objects");
  state_ = readMoveitState(scene, "robot_state");
}

void MoveitScene::hold(RobotSetup& setup) {
  const RobotDescription& robot = setup.robot.description;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    worldIsLink_ |= i != robot.root && robot.links[i].name == "world";
  if (state_) holdAt(*state_, "robot_state of the scene", source_, setup);
}

void MoveitScene::addWorld(const std::string& root, const RigidPose& base, ModelBuilder& builder) {
  const YamlMap scene = message();
  scene.require("world", "the collision objects of a planning scene of MoveIt");
  padding_ = readLinks(scene);
  const SceneFrames frames{root, base, worldIsLink_};
  frames.checkTransforms(scene);
  const YamlValue* const value = scene.find("world");
  if (!value) return;
  const YamlMap world(*value, "world", &kWorld, source_);
  if (const YamlValue* const octomap = world.find("octomap");
      octomap && octomap->kind != YamlValue::Kind::Null) {
    const YamlMap posed(*octomap, "world.octomap", &kPosedOctomap, source_);
    const YamlValue* const map = posed.find("octomap");
    Placement at;
    if (map && map->kind == YamlValue::Kind::Map &&
        isEmpty(YamlMap(*map, posed.pathOf("octomap"), nullptr, source_), "data")) {
      posed.ignore({"header", "origin"});  // ROS 1 writes zeros, which are no rotation
    } else {
      at = frames.placementOf(posed);
      if (const YamlValue* const origin = posed.find("origin"))
        at = at * readPose(*origin, posed.pathOf("origin"), source_).value_or(Placement());
    }
    if (map && map->kind == YamlValue::Kind::Map) {
      const std::string own = frameOf(YamlMap(*map, posed.pathOf("octomap"), nullptr, source_));
      if (const std::string outer = frameOf(posed); !own.empty() && own != outer)
        source_.notes.push_back({source_.file + ": world.octomap.octomap.header: the frame " +
                                     quotedWord(own) + " is not used; that of the message around " +
                                     "it is " + quotedWord(outer),
                                 NoteWeight::coverage});
    }
    if (auto shape = map ? readOctomap(*map, posed.pathOf("octomap"), at, source_) : std::nullopt) {
      const std::string name = shape->name;
      builder.addObstacle(name, {std::move(*shape)});
    }
  }
  std::set<std::string> ids;
  for (const YamlValue* const item : itemsOf(world, "collision_objects")) {
    const YamlMap nameless(*item, "world.collision_objects", nullptr, source_);
    const auto id = nameless.text("id");
    if (!id) {
      nameless.require("id", "the object's name");
      continue;
    }
    const YamlMap object(*item, "object " + quotedWord(*id), &kObject, source_);
    object.ignore({"type", "subframe_names", "subframe_poses"});
    Placement outer = frames.placementOf(object);
    if (!ids.insert(*id).second)
      object.fault("id", "another object has this name");
    else if (builder.hasObstacle(*id))
      object.fault("id",
                   "the problem's world has an obstacle of this name, too; rename one of them");
    // The field is a byte, which ROS 2 writes as text: "\0", "\x02".
    if (const auto operation = object.text("operation");
        operation && lowered(*operation) != "add" && *operation != "0" && *operation != "2" &&
        *operation != std::string(1, '\0') && *operation != "\x02")
      object.fault("operation", "only ADD (0) is supported, not " + quotedWord(*operation));
    for (const char* const key : {"planes", "plane_poses"})
      if (!isEmpty(object, key)) object.fault(key, "planes are not supported; use a flat box");
    if (const YamlValue* const pose = object.find("pose"))
      outer = outer * readPose(*pose, object.pathOf("pose"), source_).value_or(Placement());
    std::vector<PlacedShape> shapes;
    const auto readAll = [&](const char* key, const char* poseKey, const auto& make) {
      const auto items = itemsOf(object, key), poses = itemsOf(object, poseKey);
      if (items.size() != poses.size() && !poses.empty())
        return object.fault(poseKey, std::to_string(items.size()) +
                                         " are needed, one for each of " + key + ", not " +
                                         std::to_string(poses.size()));
      for (std::size_t i = 0; i < items.size(); ++i) {
        const std::string place = "[" + std::to_string(i) + "]";
        const auto inner = poses.empty()
                               ? std::optional(Placement())
                               : readPose(*poses[i], object.pathOf(poseKey) + place, source_);
        if (inner) make(*items[i], object.pathOf(key) + place, outer * *inner);
      }
    };
    readAll("primitives", "primitive_poses",
            [&](const YamlValue& shape, const std::string& path, const Placement& at) {
              if (const auto primitive = readPrimitive(shape, path, source_))
                shapes.push_back(shapeOf(*id, *primitive, at.pose));
            });
    readAll("meshes", "mesh_poses",
            [&](const YamlValue& shape, const std::string& path, const Placement& at) {
              auto mesh = readMesh(shape, path, source_);
              if (!mesh) return;
              if (!at.isIdentity())
                for (Vec3& vertex : mesh->vertices) vertex = at.X * vertex;
              shapes.push_back(shapeOf(*id, std::move(*mesh)));
              shapes.back().at = at.pose;
            });
    if (shapes.empty() && isEmpty(object, "primitives") && isEmpty(object, "meshes"))
      object.fault("primitives", "the object has neither primitives nor meshes");
    if (!builder.hasObstacle(*id)) builder.addObstacle(*id, std::move(shapes));
  }
}

std::vector<Note> MoveitScene::takeNotes(const Problem& problem) {
  const Model& model = problem.model;
  if (state_) compareWithProblem(*state_, problem, source_);
  std::vector<Note> notes = std::exchange(source_.notes, {});
  noteNames(model, notes);
  addAll(notesOnUnread(document_, source_.file, DefaultValues::sayNothing), notes);
  return notes;
}

void MoveitScene::noteNames(const Model& model, std::vector<Note>& notes) {
  const RobotDescription& robot = model.robots.front().description;
  const std::string name = message().textOrNone("robot_model_name");
  if (!name.empty() && name != robot.name && name != robot.urdfName)
    notes.push_back({source_.file + ": is for robot " + quotedWord(name) + ", and is used for " +
                         quotedWord(robot.urdfName.empty() ? robot.name : robot.urdfName),
                     NoteWeight::coverage});
  std::vector<std::string> noLinks;
  for (const auto& [link, metres] : padding_)
    if (std::none_of(robot.links.begin(), robot.links.end(),
                     [&, &wanted = link](const LinkModel& l) { return l.name == wanted; }))
      noLinks.push_back(link);
  if (!noLinks.empty())
    notes.push_back({source_.file + ": its link_padding has names of no links (" +
                         std::to_string(noLinks.size()) + "): " + joinedFirst(noLinks, 3),
                     NoteWeight::coverage});
  const YamlValue* const matrix = message().find("allowed_collision_matrix");
  if (!matrix || matrix->kind != YamlValue::Kind::Map) return;
  const YamlMap map(*matrix, "allowed_collision_matrix", nullptr, source_);
  std::set<std::string> known;
  for (const LinkModel& link : robot.links) known.insert(link.name);
  for (const ModelBody& body : model.bodies) known.insert(body.name);
  std::vector<std::string> unknown;
  for (const YamlValue* const item : itemsOf(map, "entry_names"))
    if (!known.contains(item->text)) unknown.push_back(item->text);
  if (!unknown.empty())
    notes.push_back({source_.file +
                     ": its allowed_collision_matrix has names of neither links nor obstacles (" +
                     std::to_string(unknown.size()) + "): " + joinedFirst(unknown, 3)});
}

void MoveitScene::applyAllowed(Model& model) {
  applyAllowedMatrix(message(), model);
}

Padding MoveitScene::paddingOf(const Model& model) const {
  Padding padding;
  for (std::size_t i = 0; i < model.bodies.size(); ++i)
    if (const auto found = padding_.find(model.bodies[i].name);
        model.bodies[i].robot && found != padding_.end())
      padding.bodies[i] = found->second;
  return padding;
}

}  // namespace corridor
