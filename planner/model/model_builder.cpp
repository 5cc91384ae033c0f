#include "planner/model/model_builder.h"

#include <algorithm>
#include <cstdint>
#include <map>

#include "collision/core/spelling.h"
#include "planner/model/held_joints.h"
#include "planner/model/pair_proofs.h"
#include "planner/model/planned_joints.h"
#include "planner/model/robot_assembly.h"
#include "planner/robot/angles.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/robot_faults.h"

namespace corridor {
namespace {

/// Returns whether a pair is tested, except for tests that its proof covers.
bool isTested(const Model& model, std::size_t a, std::size_t b) {
  return model.filter.whyNotTested(a, b, Required::beyondProofs()).empty();
}

/// Excludes pairs of a robot's links from the tests: pairs that SRDF and robot.yaml allow, and
/// adjacent links. Two links are adjacent if all of these conditions hold:
/// - One is above the other in the tree.
/// - No link between them has shapes.
/// - At most one joint between them is not fixed, and this joint is neither planar nor floating.
/// Links with two moving joints between them, or with a planar or floating joint, can meet in many
/// configurations, so these pairs are tested.
void skipLinks(Model& model, std::size_t robot) {
  const RobotDescription& description = model.robots[robot].description;
  // A frame of the robot has at most one body.
  std::map<std::size_t, std::size_t> bodyOnFrame;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    if (model.bodies[b].robot == robot) bodyOnFrame[model.bodies[b].frame] = b;
  const auto bodyOf = [&](std::size_t link) -> std::optional<std::size_t> {
    const auto found = bodyOnFrame.find(model.robots[robot].linkFrames[link]);
    return found == bodyOnFrame.end() ? std::nullopt : std::optional(found->second);
  };
  const auto skip = [&](std::optional<std::size_t> a, std::optional<std::size_t> b,
                        const std::string& reason) {  // the first reason given for a pair is kept
    if (a && b && isTested(model, *a, *b)) model.filter.skip(*a, *b, reason);
  };
  std::map<std::string, std::size_t> linkNamed;
  for (std::size_t link = 0; link < description.links.size(); ++link)
    linkNamed[description.links[link].name] = link;
  // Calls visit(a, b, pair) for the links of each allowed pair.
  const auto forEachAllowed = [&](const auto& visit) {
    for (const AllowedPair& pair : description.allowed) {
      const auto a = linkNamed.find(pair.a), b = linkNamed.find(pair.b);
      if (a != linkNamed.end() && b != linkNamed.end()) visit(a->second, b->second, pair);
    }
  };
  forEachAllowed([&](std::size_t a, std::size_t b, const AllowedPair& pair) {
    if (!pair.proof) skip(bodyOf(a), bodyOf(b), pair.reason);
  });
  std::vector<const JointModel*> above(description.links.size(), nullptr);
  for (const JointModel& joint : description.joints) above[joint.child] = &joint;
  for (std::size_t link = 0; link < description.links.size(); ++link) {
    int moving = 0;
    for (const JointModel* joint = above[link]; joint; joint = above[joint->parent]) {
      if (joint->type != JointType::fixed) moving += isPoseJoint(joint->type) ? 2 : 1;
      if (moving > 1) break;
      const auto other = bodyOf(joint->parent);
      if (!other) continue;
      skip(bodyOf(link), other, "adjacent");
      break;
    }
  }
  // Pairs with a proof come last. If such a pair also has another reason not to be tested, the
  // proof is not needed.
  forEachAllowed([&](std::size_t a, std::size_t b, const AllowedPair& pair) {
    const auto bodyA = bodyOf(a), bodyB = bodyOf(b);
    if (!pair.proof || !bodyA || !bodyB || !isTested(model, *bodyA, *bodyB)) return;
    if (const auto proof = proofBetween(model.robots[robot], model.space, a, b, *pair.proof))
      model.filter.skipProved(*bodyA, *bodyB, *proof);
  });
}

}  // namespace

void ModelBuilder::fault(std::string text) {
  faults_.push_back({kFaultFile, 0, std::move(text)});
}

ModelBuilder& ModelBuilder::addRobot(ModelRobot robot) {
  for (const ModelRobot& other : model_.robots)
    if (other.name == robot.name)
      fault("two robots have the name " + quotedWord(robot.name) + "; each needs its own");
  if (!model_.bodies.empty() && !model_.bodies.back().robot)
    fault("robots must be added before obstacles");
  const auto single = assembleRobot(std::move(robot), model_);
  joints_.coordinates.insert(joints_.coordinates.end(), single.begin(), single.end());
  return *this;
}

ModelBuilder& ModelBuilder::addRobot(const std::filesystem::path& urdf,
                                     const UrdfOptions& options) {
  const std::size_t before = faults_.size();
  std::vector<std::filesystem::path> files;
  auto model = readUrdf(urdf, options.rules, faults_, files);
  if (model && !options.srdf.empty()) readSrdf(options.srdf, *model, faults_);
  if (!model || faults_.size() > before) return *this;
  ModelRobot robot;
  robot.name = options.name;
  robot.description = std::move(*model);
  robot.base = options.base;
  addDescribed(std::move(robot), options.joints, urdf.string());
  return *this;
}

ModelBuilder& ModelBuilder::addRobot(RobotParts parts, const RigidPose& base,
                                     const std::vector<std::string>& joints) {
  ModelRobot robot;
  robot.name = parts.name;
  robot.base = base;
  const std::string place = robotLabel(parts.name);
  auto model = makeRobot(std::move(parts), faults_);
  if (!model) return *this;
  robot.description = std::move(*model);
  addDescribed(std::move(robot), joints, place);
  return *this;
}

/// Chooses the joints that are planned for, and adds the robot. If the joints can't be planned for,
/// adds faults instead.
/// @param joints as in `UrdfOptions`.
/// @param place the robot's URDF, or another text with which messages name the robot.
void ModelBuilder::addDescribed(ModelRobot robot, const std::vector<std::string>& joints,
                                const std::string& place) {
  const std::size_t before = faults_.size();
  std::vector<std::size_t> active;
  for (const std::string& name : joints) {
    const auto j = findJoint(robot.description, name);
    if (j && canMove(robot.description.joints[*j]) &&
        std::find(active.begin(), active.end(), *j) == active.end())
      active.push_back(*j);
    else
      fault(quotedWord(name) + " is no joint of " + place +
            " that can be planned for (it is fixed, a mimic, or missing), or it is named twice");
  }
  if (joints.empty() && (active = allMoving(robot)).empty())
    faults_.push_back({place, 0, whyNoneMoves(robot)});
  if (faults_.size() > before) return;
  chooseJoints(robot, active);
  addRobot(std::move(robot));
}

ModelBuilder& ModelBuilder::addRigidBody(const std::string& name, JointType type,
                                         std::vector<PlacedShape> shapes, const Corners& bounds) {
  ModelRobot robot;
  robot.name = name;
  robot.description = rigidModel(name, type, std::move(shapes));
  return addRobot(std::move(robot)).bound(name, bounds);
}

ModelBuilder& ModelBuilder::addObstacle(std::string name, std::vector<PlacedShape> shapes,
                                        const std::optional<RigidPose>& X_WO) {
  if (shapes.empty()) return *this;
  if (!obstacles_.insert(name).second)
    fault("two obstacles have the name " + quotedWord(name) + "; give each a name of its own");
  // Robots come first. The search stops at the first obstacle: otherwise adding n obstacles would
  // take n² steps.
  const auto found =
      std::find_if(model_.bodies.begin(), model_.bodies.end(),
                   [&](const ModelBody& body) { return !body.robot || body.name == name; });
  if (found != model_.bodies.end() && found->robot) name.insert(0, "world/");
  std::size_t frame = 0;
  if (X_WO) frame = model_.tree.add({.name = name, .fixed = *X_WO});
  model_.bodies.push_back({std::move(name), frame, std::nullopt, std::move(shapes)});
  return *this;
}

ModelBuilder& ModelBuilder::addObstacle(const std::string& name, const Primitive& primitive,
                                        const RigidPose& at) {
  if (const auto why = checkPrimitive(primitive)) {
    fault(name + ": " + *why);
    return *this;
  }
  return addObstacle(name, {shapeOf(name, primitive, at)});
}

ModelBuilder& ModelBuilder::bound(std::string joint, const Corners& bounds) {
  bounds_.push_back({std::move(joint), bounds});
  return *this;
}

ModelBuilder& ModelBuilder::allow(std::string a, std::string b) {
  allowed_.push_back({std::move(a), std::move(b)});
  return *this;
}

void ModelBuilder::applyBounds() {
  const auto& groups = model_.space.groups();
  for (const Bound& bound : bounds_) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const CoordinateGroup& g) {
      return g.kind != CoordinateGroup::Kind::joints && g.name == bound.joint;
    });
    if (group == groups.end())
      fault("bounds of " + quotedWord(bound.joint) +
            ": there is no planar or floating joint, and "
            "no rigid body, of that name");
    else if (const std::string why = whyBadBounds(bound.corners, dimensionsOf(*group));
             !why.empty())
      fault("bounds of " + quotedWord(bound.joint) + ": " + why);
    else
      setBounds(model_.space, *group, bound.corners);
  }
  for (const CoordinateGroup& group : groups) {
    const bool given = std::any_of(bounds_.begin(), bounds_.end(),
                                   [&](const Bound& bound) { return bound.joint == group.name; });
    if (group.kind != CoordinateGroup::Kind::joints && !given)
      fault(quotedWord(group.name) + " needs bounds, since it has no limits");
  }
}

std::vector<std::array<std::size_t, 2>> ModelBuilder::allowedBodies() {
  std::vector<std::array<std::size_t, 2>> allowed;
  std::vector<std::string> names;
  for (const ModelBody& body : model_.bodies) names.push_back(body.name);
  for (const auto& pair : allowed_) {
    std::vector<std::size_t> bodies;
    for (const std::string& name : pair) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end())
        fault("allow: there is no body " + quotedWord(name) + didYouMean(name, names) +
              knownWords(names));
      else if (std::find(found + 1, names.end(), name) != names.end())
        fault("allow: two bodies have the name " + quotedWord(name));
      else if (std::find(names.begin(), names.end(), "world/" + name) != names.end())
        fault("allow: " + quotedWord(name) + " names a link and the obstacle " +
              quotedWord("world/" + name) + "; rename the obstacle");
      else
        bodies.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (bodies.size() == 2) allowed.push_back({bodies[0], bodies[1]});
  }
  return allowed;
}

void setMovers(Model& model) {
  const std::vector<std::size_t> mover = moversOf(model.tree);
  std::vector<std::size_t> movers;
  for (const ModelBody& body : model.bodies) movers.push_back(mover[body.frame]);
  model.filter.setMovers(std::move(movers), fixedPartsOf(model));
}

Model ModelBuilder::buildForReader() {
  if (!faults_.empty()) throw InputError(std::move(faults_));
  if (!joints_.coordinates.empty()) model_.space.addGroup(std::move(joints_));
  for (std::size_t r = 0; r < model_.robots.size(); ++r) skipLinks(model_, r);
  setMovers(model_);
  Model model = std::move(model_);
  *this = ModelBuilder();
  return model;
}

Model ModelBuilder::build() {
  applyBounds();
  const auto allowed = allowedBodies();
  if (faults_.empty()) requireFewPairs(model_, kFaultFile);
  Model model = buildForReader();
  for (const auto& [a, b] : allowed) model.filter.skip(a, b, "allow");
  return model;
}

RobotDescription rigidModel(const std::string& name, JointType type,
                            std::vector<PlacedShape> shapes) {
  RobotDescription model;
  model.name = name;
  model.mount = type;
  model.links.push_back({name, std::move(shapes)});
  return model;
}

PlacedShape shapeOf(std::string name, const Primitive& primitive, const RigidPose& at) {
  PlacedShape shape;
  shape.name = std::move(name);
  shape.primitive = primitive;
  shape.at = at;
  shape.parts.push_back(placed(primitive, {rotationMatrix(unitQuaternion(at.q)), at.p}));
  return shape;
}

PlacedShape shapeOf(std::string name, TriangleMesh mesh, bool solid) {
  PlacedShape shape;
  shape.name = std::move(name);
  MeshFile file;
  file.mesh = std::move(mesh);
  shape.mesh = std::make_shared<const MeshFile>(std::move(file));
  shape.solid = solid;
  return shape;
}

void requireFewPairs(const Model& model, const std::string& place) {
  constexpr double most = 1e7;  // a scene with this many pairs takes some 500 MB
  if (const double pairs = pairCount(model); pairs > most)
    throw InputError(Fault{place, 0,
                           "has " + std::to_string(static_cast<std::uint64_t>(pairs)) +
                               " pairs of bodies, but at most 10000000 are supported; join "
                               "shapes that do not move relative to each other into one body"});
}

}  // namespace corridor
