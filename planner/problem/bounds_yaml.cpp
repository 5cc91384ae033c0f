#include "planner/problem/bounds_yaml.h"

#include <cmath>
#include <numbers>

#include "collision/core/shortest.h"
#include "planner/problem/bounds_of_ends.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/keys.h"
#include "planner/problem/urdf_robot.h"
#include "planner/robot/angles.h"

namespace corridor {
namespace {

const CoordinateGroup& groupOf(const ConfigurationSpace& space, const PlannedJoint& planned) {
  std::size_t g = 0;
  while (space.groups()[g].coordinates.front() != planned.coordinate) ++g;
  return space.groups()[g];
}

const char* form(std::size_t dimensions) {
  return dimensions == 3 ? "at: [[x, y, z], [x, y, z]]" : "at: [[x, y], [x, y]]";
}

/// Reads {at: [[lower corner], [upper corner]]} as the bounds of the group's position.
void readCorners(const YamlValue& value, const std::string& path, const CoordinateGroup& group,
                 Problem& problem, YamlSource& source) {
  const YamlMap map(value, path, &problemKeys().at("bounds"), source);
  const std::size_t count = dimensionsOf(group);
  const YamlValue* at =
      map.require("at", std::string("the lower and the upper corner, ") + form(count));
  if (!at) return;
  if (at->kind != YamlValue::Kind::List || at->items.size() != 2)
    return map.fault("at", std::string("the lower and the upper corner are needed, ") +
                               form(count) + ", not " + described(*at));
  const auto lower = readNumbers(at->items[0], count, map.pathOf("at"), source);
  const auto upper = readNumbers(at->items[1], count, map.pathOf("at"), source);
  if (!lower || !upper) return;
  Corners corners;
  for (std::size_t k = 0; k < count; ++k) {
    corners.lower[static_cast<Eigen::Index>(k)] = (*lower)[k];
    corners.upper[static_cast<Eigen::Index>(k)] = (*upper)[k];
  }
  if (const std::string why = whyBadBounds(corners, count); !why.empty())
    map.fault("at", why);
  else
    setBounds(problem.model.space, group, corners);
}

/// Narrows a single joint's limits to [lower, upper], the value of `key`.
void narrow(const YamlMap& map, const std::string& key, bool degrees, const PlannedJoint& planned,
            Problem& problem) {
  const auto given = map.numbers(key, 2);
  if (!given) return;
  const double unit = degrees ? std::numbers::pi / 180 : 1;
  const double lower = (*given)[0] * unit, upper = (*given)[1] * unit;
  Coordinate& c = problem.model.space.coordinates()[planned.coordinate];
  if (!(lower < upper))
    return map.fault(key, "the lower bound first, then the upper one: " + shortest((*given)[0]) +
                              " is not below " + shortest((*given)[1]));
  if (!std::isfinite(upper - lower))
    return map.fault(key, "the range from " + shortest((*given)[0]) + " to " +
                              shortest((*given)[1]) + " is larger than any double");
  if (!degrees && planned.type != JointType::prismatic &&
      (seemsDegrees(lower) || seemsDegrees(upper)))
    problem.source.notes.push_back({map.pathOf(key) + ": [" + shortest(lower) + ", " +
                                        shortest(upper) + "] is in radians; for degrees, write " +
                                        key + "_deg",
                                    NoteWeight::motion});
  // With bounds, a continuous joint becomes a line coordinate.
  if (c.kind == Coordinate::Kind::circle) {
    c.kind = Coordinate::Kind::line;
    c.lower = lower;
    c.upper = upper;
    return;
  }
  const std::string path = map.pathOf(key);
  const auto low = withinLimits(lower, c.lower, c.upper, path, problem.source.notes),
             high = withinLimits(upper, c.lower, c.upper, path, problem.source.notes);
  if (!low || !high) return map.fault(key, outsideLimits(low ? upper : lower, c.lower, c.upper));
  c.lower = *low;
  c.upper = *high;
}

void readOfJoints(const YamlValue& value, const std::string& path, const ModelRobot& robot,
                  Problem& problem, YamlSource& source) {
  const RobotDescription& model = robot.description;
  const YamlMap map(value, path, nullptr, source);
  readJointValues(map, model, [&](std::size_t j, const YamlValue::Entry& entry, bool degrees) {
    for (const PlannedJoint& planned : robot.plannedJoints) {
      if (planned.name != model.joints[j].name) continue;
      if (isPoseJoint(planned.type))
        readCorners(entry.value, map.pathOf(entry.key), groupOf(problem.model.space, planned),
                    problem, source);
      else
        narrow(map, entry.key, degrees, planned, problem);
      return;
    }
    map.fault(entry.key, "is not planned for; remove its bounds");
  });
}

/// Adds a fault for each planar or floating joint without bounds, since such joints have no limits.
void requireBounds(const YamlMap& file, const Model& model) {
  for (const ModelRobot& robot : model.robots) {
    if (robot.isRigid()) continue;
    for (const PlannedJoint& planned : robot.plannedJoints) {
      if (!isPoseJoint(planned.type)) continue;
      const CoordinateGroup& group = groupOf(model.space, planned);
      if (!std::isnan(boundsOf(model.space, group).lower.x())) continue;
      const std::string own = planned.name + ": {" + form(dimensionsOf(group)) + "}";
      file.source().fault(0, "missing bounds of the joint " + group.name + ": bounds: {" +
                                 (robot.name.empty() ? own : robot.name + ": {" + own + "}") +
                                 "} is needed, since it has no limits");
    }
  }
}

}  // namespace

void readBounds(const YamlMap& file, Problem& problem) {
  YamlSource& source = file.source();
  const std::size_t before = source.faults.size();
  const std::vector<ModelRobot>& robots = problem.model.robots;
  const auto ofRobot = [&](const ModelRobot& robot, const YamlValue& value,
                           const std::string& path) {
    if (robot.isRigid())
      readCorners(value, path, groupOf(problem.model.space, robot.plannedJoints.front()), problem,
                  source);
    else
      readOfJoints(value, path, robot, problem, source);
  };
  if (const YamlValue* value = file.find("bounds")) {
    if (robots.front().name.empty()) {
      ofRobot(robots.front(), *value, "bounds");
    } else {
      MapKeys keys;
      for (const ModelRobot& robot : robots) keys.legal.push_back(robot.name);
      const YamlMap map(*value, "bounds", &keys, source);
      for (const ModelRobot& robot : robots)
        if (const YamlValue* own = map.find(robot.name))
          ofRobot(robot, *own, map.pathOf(robot.name));
    }
  }
  if (source.faults.size() == before) requireBounds(file, problem.model);
}

void setDefaultBounds(Problem& problem, YamlSource& source) {
  const auto world = boundsOfWorld(problem.model);
  for (const CoordinateGroup& group : problem.model.space.groups()) {
    if (group.kind == CoordinateGroup::Kind::joints ||
        !std::isnan(boundsOf(problem.model.space, group).lower.x()))
      continue;
    const bool alone = problem.model.robots.front().name.empty();
    const std::string needed = std::string("bounds: {") + (alone ? "" : group.name + ": {") +
                               form(dimensionsOf(group)) + (alone ? "}" : "}}") + " is needed";
    if (!world) {
      source.fault(0, "missing key \"bounds\": there is no world to take them from, so " + needed);
      continue;
    }
    setBounds(problem.model.space, group, *world);
    enlargeBounds(problem, group);
    const Corners corners = boundsOf(problem.model.space, group);
    if (whyBadBounds(corners, dimensionsOf(group)).empty()) {
      problem.source.notes.push_back(
          {"bounds" + (alone ? "" : " of " + group.name) +
               ": those of the world, start and goal, since none are given",
           NoteWeight::motion});
      continue;
    }
    int flat = 0;
    while (corners.lower[flat] < corners.upper[flat]) ++flat;
    source.fault(0, std::string("missing key \"bounds\": world, start and goal lie in a plane (") +
                        "xyz"[flat] + " = " + shortest(corners.lower[flat]) + "), so " + needed);
  }
}

}  // namespace corridor
