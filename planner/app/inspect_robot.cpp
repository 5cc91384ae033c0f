#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "planner/app/commands.h"
#include "planner/app/inspect.h"
#include "planner/app/output.h"
#include "planner/model/bounds.h"
#include "planner/problem/assembly.h"
#include "planner/problem/robot_file.h"
#include "planner/robot/joint_types.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

std::string jointLine(const RobotDescription& model, const JointModel& joint) {
  std::string text = "\"" + joint.name + "\": " + nameOf(joint.type) + ", " +
                     model.links[joint.parent].name + " to " + model.links[joint.child].name;
  if (!joint.mimic && (std::isfinite(joint.lower) || std::isfinite(joint.upper)))
    text += ", " + rounded(joint.lower) + " to " + rounded(joint.upper) +
            (joint.type == JointType::prismatic ? " m" : " rad");
  if (joint.mimic)
    text += ", " + rounded(joint.mimic->multiplier) + " times " +
            model.joints[joint.mimic->joint].name + " + " + rounded(joint.mimic->offset);
  return text;
}

ordered_json jointJson(const RobotDescription& model, const JointModel& joint) {
  ordered_json j = {{"name", joint.name},
                    {"type", nameOf(joint.type)},
                    {"parent", model.links[joint.parent].name},
                    {"child", model.links[joint.child].name}};
  if (std::isfinite(joint.lower)) j["lower"] = joint.lower;
  if (std::isfinite(joint.upper)) j["upper"] = joint.upper;
  if (joint.mimic)
    j["mimic"] = {{"joint", model.joints[joint.mimic->joint].name},
                  {"multiplier", joint.mimic->multiplier},
                  {"offset", joint.mimic->offset}};
  return j;
}

std::string shapesText(const LinkModel& link) {
  std::string text = "\"" + link.name + "\": ";
  if (link.shapes.empty()) text += "no shapes";
  for (std::size_t i = 0; i < link.shapes.size(); ++i)
    text += (i ? "; " : "") + shapeText(link.shapes[i]);
  return text;
}

/// Returns the largest distance of a point of the link from the link's origin, metres.
double radiusOf(const LinkModel& link) {
  double radius = 0;
  for (const PlacedShape& shape : link.shapes)
    forEachPoint(shape,
                 [&](const Vec3& p, double own) { radius = std::max(radius, p.norm() + own); });
  return radius;
}

/// Returns the largest distance by which a joint can translate its child link, metres; infinite
/// without limits. For a joint that mimics another, the distance follows from the range of that
/// other joint, since a mimic's own limits need not restrict it.
double slideOf(const RobotDescription& model, const JointModel& joint) {
  if (joint.type == JointType::planar || joint.type == JointType::floating)
    return std::numeric_limits<double>::infinity();
  if (joint.type != JointType::prismatic) return 0;
  const auto farther = [](double a, double b) { return std::max(std::abs(a), std::abs(b)); };
  if (!joint.mimic) return farther(joint.lower, joint.upper);
  const auto [leader, multiplier, offset] = *joint.mimic;
  if (multiplier == 0) return std::abs(offset);  // even if the leader has no limits: 0·∞ is NaN
  const JointModel& other = model.joints[leader];
  return farther(multiplier * other.lower + offset, multiplier * other.upper + offset);
}

/// Returns, for each link, an upper bound of the distance of its points from the root's origin: the
/// distance with the chain stretched out and all prismatic joints at their farther limits. The
/// bound is infinite for links behind a planar or floating joint, or behind a prismatic joint
/// without limits.
std::vector<double> reachOfLinks(const RobotDescription& model) {
  std::vector<double> origin(model.links.size(), 0), reach;
  for (const JointModel& joint : model.joints)  // parents before children
    origin[joint.child] = origin[joint.parent] + joint.X_PJ.p.norm() + slideOf(model, joint);
  for (std::size_t i = 0; i < model.links.size(); ++i)
    reach.push_back(origin[i] + radiusOf(model.links[i]));
  return reach;
}

/// Describes a polygon, a point cloud or an octree.
ordered_json partsJson(const PlacedShape& shape) {
  const double radius = shape.parts.front().radius;
  const auto [lower, upper] = boundsOf(shape);
  ordered_json j;
  if (!shape.polygon.empty()) j["polygon_points"] = shape.polygon.size();
  j[!shape.polygon.empty() ? "pieces" : radius > 0 ? "balls" : "cubes"] = shape.parts.size();
  if (radius > 0) j["radius_m"] = radius;
  j["lower_m"] = {lower.x(), lower.y(), lower.z()};
  j["upper_m"] = {upper.x(), upper.y(), upper.z()};
  return j;
}

}  // namespace

std::string shapeText(const PlacedShape& shape) {
  // The shapes of a MoveIt message have no file of their own.
  const std::string file = shape.file.empty() ? "" : ", " + shape.file.string();
  if (!shape.mesh && shape.primitive) return nameOf(*shape.primitive);
  if (!shape.polygon.empty())
    return "polygon of " + counted(shape.polygon.size(), "point") + ", in " +
           counted(shape.parts.size(), "convex piece");
  if (!shape.mesh) {
    const bool balls = shape.parts.front().radius > 0;
    const auto [lower, upper] = boundsOf(shape);
    return counted(shape.parts.size(), balls ? "ball" : "cube") +
           (balls ? " of radius " + rounded(shape.parts.front().radius) + " m" : "") + file +
           ", from " + rounded(lower) + " to " + rounded(upper);
  }
  return counted(shape.mesh->mesh.triangles.size(), "triangle") + (shape.solid ? " (solid)" : "") +
         file;
}

ordered_json shapeJson(const PlacedShape& shape) {
  ordered_json j = shape.mesh ? meshJson(*shape.mesh) : ordered_json{};
  if (shape.primitive)
    j["primitive"] = nameOf(*shape.primitive);
  else if (!shape.mesh)
    j.update(partsJson(shape));
  j["name"] = shape.name;
  if (!shape.primitive && shape.polygon.empty()) j["file"] = shape.file.string();
  j["solid"] = shape.solid || !shape.mesh;
  return j;
}

/// Prints that a group or state can't be used, and adds this to the JSON. Does nothing if it can be
/// used. @param why the reason; "": it can be used.
/// @returns whether it can't be used.
bool reportUnusable(const char* kind, const std::string& name, const std::string& why,
                    const ResultPrinter& out, ordered_json& json) {
  if (why.empty()) return false;
  json["unusable"].push_back({{"kind", kind}, {"name", name}, {"reason", why}});
  out.line(kind, quotedWord(name) + ": can't be used: " + why, Tone::bad);
  return true;
}

int inspectRobot(const InspectArguments& a) {
  const RobotSetup setup = readRobotAlone(a.file, RobotUse::describe);
  const RobotDescription& model = setup.robot.description;
  std::vector<Note> found = notesOf(setup);
  addAll(notesOnMeshes(model), found);
  const std::vector<std::string> notes = textsOf(found);
  ordered_json j = {{"format", "corridor-inspect-robot-2"},
                    {"file", a.file},
                    {"name", model.name},
                    {"root", model.links[model.root].name},
                    {"joints", ordered_json::array()},
                    {"links", ordered_json::array()},
                    {"allowed", ordered_json::array()},
                    {"groups", ordered_json::object()},
                    {"states", ordered_json::object()},
                    {"unusable", ordered_json::array()},
                    {"notes", notes}};
  const ResultPrinter out(a.json);
  out.line("robot", a.file);
  out.line("name", model.name);
  out.line("root", model.links[model.root].name);
  for (const JointModel& joint : model.joints) {
    j["joints"].push_back(jointJson(model, joint));
    out.line("joint", jointLine(model, joint));
  }
  const std::vector<double> reach = reachOfLinks(model);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const LinkModel& link = model.links[i];
    ordered_json l = {{"name", link.name}, {"shapes", ordered_json::array()}};
    for (const PlacedShape& shape : link.shapes) l["shapes"].push_back(shapeJson(shape));
    if (std::isfinite(reach[i])) l["reach_m"] = reach[i];
    j["links"].push_back(l);
    out.line("link", shapesText(link));
  }
  const auto farthest = std::max_element(reach.begin(), reach.end());
  if (!std::isfinite(*farthest))
    out.line("reach",
             "unlimited, because at least one joint has no limits; a problem must set its bounds");
  else if (!model.joints.empty())
    out.line("reach", "at most " + rounded(*farthest) + " m from the origin of " +
                          model.links[model.root].name + ": link " +
                          model.links[static_cast<std::size_t>(farthest - reach.begin())].name);
  for (const AllowedPair& pair : model.allowed) {
    j["allowed"].push_back({{"a", pair.a}, {"b", pair.b}, {"reason", pair.reason}});
    if (pair.proof)
      j["allowed"].back()["proof"] = {{"margin", pair.proof->margin},
                                      {"beyond_limits", pair.proof->beyondLimits}};
  }
  out.line("pairs allowed to touch", grouped(model.allowed.size()));
  for (const auto& [name, group] : model.groups) {
    if (reportUnusable("group", name, group.unusable, out, j)) continue;
    j["groups"][name] = group.joints;
    out.line("group", quotedWord(name) + ": " + joined(group.joints));
  }
  for (const auto& [name, state] : model.states) {
    if (reportUnusable("state", name, state.unusable, out, j)) continue;
    j["states"][name] = state.values;
    std::string text;
    for (const auto& [joint, value] : state.values)
      text += (text.empty() ? "" : ", ") + joint + ": " + rounded(value);
    out.line("state", quotedWord(name) + ": {" + text + "}");
  }
  for (const std::string& note : condensed(notes)) out.line("note", note);
  if (a.json) std::cout << jsonText(j) << '\n';
  return kDone;
}

}  // namespace corridor::app
