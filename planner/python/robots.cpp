#include "planner/python/robots.h"

#include <pybind11/stl.h>

#include "collision/core/spelling.h"
#include "planner/python/arrays.h"
#include "planner/python/shapes.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/robot_faults.h"

namespace corridor::python {
namespace {

Corners cornersOf(const py::handle bounds, const char* name) {
  const std::vector<Vec3> rows = pointsOf(bounds.cast<Array>(), name);
  if (rows.size() != 2) refuse(name, "two points are needed: [[x, y, z], [x, y, z]]");
  return {rows[0], rows[1]};
}

/// Sets the bounds of planar and floating joints.
void addBounds(ModelBuilder& builder, const std::string& robot, const py::dict& bounds) {
  for (const auto& [key, corners] : bounds) {
    const auto joint = key.cast<std::string>();
    builder.bound(robot.empty() ? joint : robot + "/" + joint,
                  cornersOf(corners, ("bounds of " + joint).c_str()));
  }
}

RobotParts::Joint jointFrom(const py::dict& given) {
  RobotParts::Joint joint;
  joint.name = given["name"].cast<std::string>();
  const auto type = given["type"].cast<std::string>();
  const auto known = jointType(type);
  if (!known) throw py::value_error("type: " + notOneOf(type, jointTypeNames()));
  joint.type = *known;
  joint.parent = given["parent"].cast<std::string>();
  joint.child = given["child"].cast<std::string>();
  const auto axis = given["axis"].cast<std::array<double, 3>>();
  joint.axis = Vec3(axis[0], axis[1], axis[2]);
  joint.lower = given["lower"].cast<std::optional<double>>();
  joint.upper = given["upper"].cast<std::optional<double>>();
  joint.velocity = given["velocity"].cast<std::optional<double>>();
  if (!given["mimic"].is_none()) {
    const auto [leader, multiplier, offset] =
        given["mimic"].cast<std::tuple<std::string, double, double>>();
    joint.mimic = {leader, multiplier, offset};
  }
  joint.X_PJ = poseOf(given["origin"], "origin");
  return joint;
}

RobotParts partsFrom(const std::string& name, const py::dict& robot) {
  RobotParts parts;
  parts.name = name;
  std::vector<Fault> faults;
  const auto collect = [&](const auto& read) {
    try {
      read();
    } catch (const py::value_error& error) {
      faults.push_back({robotLabel(name), 0, error.what()});
    } catch (const InputError& error) {  // a fault of a mesh file
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  };
  for (const py::handle each : robot["links"].cast<py::list>()) {
    const auto pair = each.cast<std::pair<std::string, py::list>>();
    const std::string& link = pair.first;
    const py::list& shapes = pair.second;
    LinkModel& added = parts.links.emplace_back();
    added.name = link;
    if (!shapes.empty()) collect([&] { added.shapes = shapesFrom(link, shapes); });
  }
  for (const py::handle each : robot["joints"].cast<py::list>()) {
    const auto joint = each.cast<py::dict>();
    const std::string owner = owned("joint", joint["name"].cast<std::string>());
    collect([&] {
      try {
        parts.joints.push_back(jointFrom(joint));
      } catch (const py::value_error& error) {
        throw py::value_error(owner + ": " + error.what());
      }
    });
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  parts.allow = robot["allow"].cast<std::vector<std::array<std::string, 2>>>();
  return parts;
}

}  // namespace

void addRobot(ModelBuilder& builder, const py::dict& robot) {
  const auto name = robot["name"].cast<std::string>();
  if (!robot.contains("urdf") && !robot.contains("links")) {
    builder.addRigidBody(
        name, robot["planar"].cast<bool>() ? JointType::planar : JointType::floating,
        shapesFrom(name, robot["shapes"].cast<py::list>()), cornersOf(robot["bounds"], "bounds"));
    return;
  }
  const RigidPose base = poseOf(robot["base"], "base");
  const auto joints = robot["plan"].cast<std::vector<std::string>>();
  if (robot.contains("urdf")) {
    UrdfOptions options;
    options.name = name;
    options.base = base;
    options.srdf = robot["srdf"].cast<std::string>();
    options.joints = joints;
    builder.addRobot(robot["urdf"].cast<std::string>(), options);
  } else {
    builder.addRobot(partsFrom(name, robot), base, joints);
  }
  addBounds(builder, name, robot["bounds"].cast<py::dict>());
}

}  // namespace corridor::python
