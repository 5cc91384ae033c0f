#include "planner/problem/tube_yaml.h"

#include <algorithm>
#include <numbers>

#include "collision/core/spelling.h"
#include "planner/model/model.h"
#include "planner/problem/keys.h"

namespace corridor {
namespace {

/// Returns the coordinates of all single (revolute, continuous and prismatic) joints.
std::vector<const Coordinate*> singleJoints(const ConfigurationSpace& space) {
  std::vector<const Coordinate*> joints;
  for (const CoordinateGroup& group : space.groups())
    if (group.kind == CoordinateGroup::Kind::joints)
      for (const std::size_t i : group.coordinates) joints.push_back(&space.coordinates()[i]);
  return joints;
}

bool slides(const Coordinate& c) {
  return c.kind == Coordinate::Kind::line && !c.angular;
}

/// Reads those keys of `tube` that are names of joints.
void readNamed(const YamlMap& map, const ConfigurationSpace& space, TubeSpec& tube) {
  const std::vector<const Coordinate*> joints = singleJoints(space);
  std::vector<std::string> known = problemKeys().at("tube").legal;
  for (const Coordinate* joint : joints) known.push_back(joint->name);
  for (const YamlValue::Entry* entry : map.entries()) {
    const std::vector<std::string>& legal = problemKeys().at("tube").legal;
    const auto find = [&](const std::string& name) {
      return std::find_if(joints.begin(), joints.end(),
                          [&](const Coordinate* joint) { return joint->name == name; });
    };
    if (std::find(legal.begin(), legal.end(), entry->key) != legal.end()) {
      if (find(entry->key) != joints.end())
        map.fault(entry->key, "is also the name of a joint; rename the joint");
      continue;
    }
    auto joint = find(entry->key);
    const bool degrees = joint == joints.end() && entry->key.ends_with("_deg");
    if (degrees) joint = find(entry->key.substr(0, entry->key.size() - 4));
    if (joint == joints.end()) {
      map.fault(entry->key, "this is no key of tube, and no planned joint has this name" +
                                didYouMean(entry->key, known) + knownWords(known));
    } else if (degrees && slides(**joint)) {
      map.fault(entry->key,
                (*joint)->name + " is prismatic; use " + (*joint)->name + ", in metres");
    } else if (tube.named.contains((*joint)->name)) {
      map.fault(entry->key, (*joint)->name + " is given twice, in radians and in degrees");
    } else if (const auto number = map.number(entry->key, Range::NotNegative)) {
      tube.named[(*joint)->name] = degrees ? *number * (std::numbers::pi / 180) : *number;
    }
  }
}

}  // namespace

TubeSpec readTube(const YamlMap& file, const ConfigurationSpace& space, bool isComplete) {
  TubeSpec tube;
  const YamlValue* value = file.find("tube");
  if (!value) return tube;
  const YamlMap map(*value, "tube", nullptr, file.source(), "{joints: 0.001}");
  tube.joints = map.angle("joints", Range::NotNegative);
  tube.slides = map.number("slides", Range::NotNegative);
  tube.position = map.number("position", Range::NotNegative);
  tube.rotation = map.angle("rotation", Range::NotNegative);
  if (!isComplete) return tube;
  readNamed(map, space, tube);
  const std::vector<const Coordinate*> joints = singleJoints(space);
  for (const char* key : {"joints", "joints_deg"})
    if (map.find(key) && joints.empty())
      map.fault(key,
                "there are no revolute or prismatic joints here; use position (m) and rotation or "
                "rotation_deg");
  const bool anySlides = std::any_of(joints.begin(), joints.end(),
                                     [](const Coordinate* joint) { return slides(*joint); });
  if (map.find("slides") && !anySlides) map.fault("slides", "there is no planned prismatic joint");
  for (const char* key : {"position", "rotation", "rotation_deg"})
    if (map.find(key) && !hasPoseJoints(space))
      map.fault(key,
                "there is no rigid body and no planar or floating joint here; use joints (rad, or "
                "m for prismatic joints)");
  if (map.find("joints_deg") && !tube.slides)
    for (const Coordinate* joint : joints)
      if (slides(*joint) && !tube.named.contains(joint->name))
        map.fault("joints_deg", joint->name +
                                    " is prismatic; add the key slides (m), or use the key joints "
                                    "(rad, and m for prismatic joints) instead");
  return tube;
}

}  // namespace corridor
