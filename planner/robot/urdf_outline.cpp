#include "planner/robot/urdf_outline.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "collision/core/decimal_number.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/mesh_limits.h"
#include "planner/robot/angles.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

using Element = XmlFile::Element;
using Numbers = std::optional<std::vector<double>>;

/// Reports a fault unless the attribute has `count` numbers above 0.
void checkSize(XmlFile& file, Element& shape, const char* attribute, std::size_t count,
               const std::string& owner) {
  file.require(shape, attribute, owner);
  const Numbers sizes = file.numbers(shape, attribute, count, owner);
  if (sizes && !std::all_of(sizes->begin(), sizes->end(), [](double size) { return size > 0; }))
    file.fault(shape.FindAttribute(attribute)->GetLineNum(),
               owner + ": " + shape.Name() + " " + attribute + " must be above 0, not " +
                   shape.Attribute(attribute));
}

void checkMesh(XmlFile& file, Element& shape, MeshStore& meshes, UrdfCollision& collision,
               const std::string& owner, std::vector<Note>& notes) {
  file.checkLeaf(shape, {"filename", "scale"}, owner, notes);
  const Numbers scale = file.numbers(shape, "scale", 3, owner);
  if (scale && std::find(scale->begin(), scale->end(), 0.0) != scale->end())
    file.fault(shape.FindAttribute("scale")->GetLineNum(),
               owner + ": mesh scale must not be 0, which makes the mesh flat");
  const auto name = file.text(shape, "filename", owner);
  if (!name) return;
  const MeshStore::FoundMesh place = meshes.add(*name);
  collision.mesh = place.file;
  if (!place.complaint.empty())
    file.fault(shape.FindAttribute("filename")->GetLineNum(),
               owner + ": mesh " + quotedPath(*name) + ": " + place.complaint);
}

void checkShape(XmlFile& file, Element& shape, MeshStore& meshes, UrdfCollision& collision,
                const std::string& owner, std::vector<Note>& notes) {
  const std::string kind = shape.Name();
  if (kind == "box" || kind == "sphere" || kind == "cylinder" || kind == "capsule")
    file.checkLeaf(shape,
                   kind == "box"      ? std::vector<std::string>{"size"}
                   : kind == "sphere" ? std::vector<std::string>{"radius"}
                                      : std::vector<std::string>{"radius", "length"},
                   owner, notes);
  if (kind == "box") return checkSize(file, shape, "size", 3, owner);
  if (kind == "sphere") return checkSize(file, shape, "radius", 1, owner);
  if (kind == "cylinder" || kind == "capsule") {
    checkSize(file, shape, "radius", 1, owner);
    checkSize(file, shape, "length", 1, owner);
    collision.isCapsule = kind == "capsule";
    if (collision.isCapsule) shape.SetName("cylinder");
    return;
  }
  if (kind == "mesh") return checkMesh(file, shape, meshes, collision, owner, notes);
  const std::vector<std::string> known{"box", "cylinder", "capsule", "sphere", "mesh"};
  const auto near = mostSimilar(kind, known);
  file.fault(shape.GetLineNum(),
             owner + ": unknown geometry <" + kind + ">" +
                 (near ? " (did you mean <" + *near + ">?)"
                       : "; <box>, <cylinder>, <capsule>, <sphere> or <mesh> is needed"));
}

/// Reads <origin>, and checks its position, which urdfdom reads.
/// @returns roll, pitch and yaw, radians.
Vec3 readOrigin(XmlFile& file, Element& parent, const std::string& owner,
                std::vector<Note>& notes) {
  Element* const element = file.child(parent, "origin", owner);
  if (!element) return Vec3::Zero();
  if (const auto* quaternion = element->FindAttribute("quat_xyzw"))  // of URDF 1.2
    file.fault(quaternion->GetLineNum(), owner + ": origin quat_xyzw is not supported; use rpy");
  else
    file.checkLeaf(*element, {"xyz", "rpy"}, owner, notes);
  file.numbers(*element, "xyz", 3, owner);
  const Numbers rpy = file.numbers(*element, "rpy", 3, owner);
  if (rpy && std::any_of(rpy->begin(), rpy->end(), seemsDegrees))
    notes.push_back(
        {file.at(element->GetLineNum(), owner + ": origin rpy=\"" + element->Attribute("rpy") +
                                            "\" is in radians, as URDF requires; are "
                                            "these degrees?"),
         NoteWeight::coverage});
  return rpy ? Vec3((*rpy)[0], (*rpy)[1], (*rpy)[2]) : Vec3::Zero();
}

UrdfCollision readCollision(XmlFile& file, Element& element, MeshStore& meshes,
                            const std::string& owner, std::vector<Note>& notes) {
  UrdfCollision collision;
  collision.line = element.GetLineNum();
  file.checkAttributes(element, {"name", "group"}, owner, notes);
  file.checkChildren(element, {"origin", "geometry"},
                     {"material", "verbose", "contact_coefficients"}, owner, notes);
  collision.rpy = readOrigin(file, element, owner, notes);
  Element* const geometry = file.child(element, "geometry", owner);
  Element* const shape = geometry ? geometry->FirstChildElement() : nullptr;
  if (geometry) file.checkAttributes(*geometry, {}, owner, notes);
  if (geometry) file.checkText(*geometry, owner, notes);
  if (!shape) {
    file.fault(geometry ? geometry->GetLineNum() : element.GetLineNum(),
               owner + ": " + (geometry ? "<geometry> is empty" : "<collision> has no <geometry>") +
                   "; <box>, <cylinder>, <sphere> or <mesh> is needed");
    return collision;
  }
  checkShape(file, *shape, meshes, collision, owner, notes);
  if (const Element* second = shape->NextSiblingElement())
    file.fault(second->GetLineNum(),
               owner + ": a second shape in one <geometry>; it needs a <collision> of its own");
  return collision;
}

UrdfLink readLink(XmlFile& file, Element& element, const UrdfRules& rules, MeshStore& meshes,
                  std::vector<std::string>& visible, std::vector<Note>& notes) {
  UrdfLink link{file.text(element, "name", "").value_or(""), element.GetLineNum(), {}};
  const std::string owner = owned("link", link.name);
  file.checkAttributes(element, {"name", "type"}, owner, notes);
  if (!element.FirstChildElement("collision") && element.FirstChildElement("visual")) {
    if (rules.visualsCollide)
      while (Element* const visual = element.FirstChildElement("visual"))
        visual->SetName("collision");
    else
      visible.push_back(link.name);
  }
  file.checkChildren(element, {"collision"},
                     {"visual", "inertial", "material", "sensor", "contact", "gazebo"}, owner,
                     notes);
  for (Element* collision = element.FirstChildElement("collision"); collision;
       collision = collision->NextSiblingElement("collision"))
    link.collisions.push_back(readCollision(file, *collision, meshes, owner, notes));
  return link;
}

std::optional<JointType> readType(XmlFile& file, Element& element, const std::string& owner) {
  const auto name = file.text(element, "type", owner);
  if (!name) return std::nullopt;
  if (const auto type = jointType(*name)) return type;
  const std::vector<std::string> known = jointTypeNames();
  const std::string near = didYouMean(*name, known);
  file.fault(element.FindAttribute("type")->GetLineNum(),
             owner + ": unknown type " + quotedWord(*name) +
                 (near.empty() ? "; one of " + joined(known) + " is needed" : near));
  return std::nullopt;
}

/// Reads <parent> or <child>.
/// @returns the link's name; empty if a fault was reported.
std::string readEnd(XmlFile& file, Element& joint, const char* end, const std::string& owner,
                    std::vector<Note>& notes) {
  if (Element* const element = file.child(joint, end, owner)) {
    file.checkLeaf(*element, {"link"}, owner, notes);
    return file.text(*element, "link", owner).value_or("");
  }
  file.fault(joint.GetLineNum(), owner + ": <" + std::string(end) + " link=\"…\"/> is missing");
  return "";
}

void checkAxis(XmlFile& file, Element& joint, std::optional<JointType> type,
               const std::string& owner, std::vector<Note>& notes) {
  Element* const axis = file.child(joint, "axis", owner);
  if (axis) file.checkLeaf(*axis, {"xyz"}, owner, notes);
  if (!axis || !type || *type == JointType::fixed || *type == JointType::floating) return;
  file.require(*axis, "xyz", owner);
  const Numbers xyz = file.numbers(*axis, "xyz", 3, owner);
  if (xyz && std::all_of(xyz->begin(), xyz->end(), [](double x) { return x == 0; }))
    file.fault(axis->FindAttribute("xyz")->GetLineNum(),
               owner + ": the axis is zero; a direction is needed, such as xyz=\"0 0 1\"");
}

/// Reads <limit>. Corridor does not use effort. resolveMimics() checks the range.
std::optional<UrdfLimit> readLimit(XmlFile& file, Element& joint, std::optional<JointType> type,
                                   const std::string& owner, std::vector<Note>& notes) {
  const bool ranged = type == JointType::revolute || type == JointType::prismatic;
  Element* const element = file.child(joint, "limit", owner);
  if (!element) return std::nullopt;
  UrdfLimit limit;
  limit.line = element->GetLineNum();
  const auto read = [&](const char* name) -> std::optional<double> {
    if (!element->FindAttribute(name)) return std::nullopt;
    const Numbers numbers = file.numbers(*element, name, 1, owner);
    return numbers ? numbers->front() : NAN;
  };
  limit.lower = read("lower");
  limit.upper = read("upper");
  const char* const velocity = element->Attribute("velocity");
  const bool isUnlimited =
      velocity && decimalNumber(velocity) == std::numeric_limits<double>::infinity();
  if (!isUnlimited) limit.velocity = read("velocity");
  if (limit.velocity.value_or(0) < 0)
    file.fault(element->FindAttribute("velocity")->GetLineNum(),
               owner + ": its velocity must not be below 0, but is " + velocity);
  std::vector<std::string> missing;
  for (const char* name : {"effort", "velocity"})
    if (!element->FindAttribute(name)) missing.push_back(name);
  if (isUnlimited)
    notes.push_back(
        {file.at(limit.line, owner + ": its velocity is not limited (" + velocity + ")")});
  if (!missing.empty())
    notes.push_back({file.at(limit.line, owner + ": <limit> has no " + joined(missing))});
  if (ranged || type == JointType::continuous)
    file.checkLeaf(*element, {"lower", "upper", "effort", "velocity"}, owner, notes);
  // Many programs write 0 and 0.
  if (type == JointType::continuous &&
      (limit.lower.value_or(0) != 0 || limit.upper.value_or(0) != 0))
    notes.push_back({file.at(limit.line, owner + ": is continuous, so lower and upper of its "
                                                 "<limit> are not used; a joint that they limit is "
                                                 "of type revolute"),
                     NoteWeight::motion});
  return limit;
}

std::optional<UrdfMimic> readMimic(XmlFile& file, Element& joint, const std::string& owner,
                                   std::vector<Note>& notes) {
  Element* const element = file.child(joint, "mimic", owner);
  if (!element) return std::nullopt;
  file.checkLeaf(*element, {"joint", "multiplier", "offset"}, owner, notes);
  UrdfMimic mimic;
  mimic.line = element->GetLineNum();
  if (const Numbers multiplier = file.numbers(*element, "multiplier", 1, owner))
    mimic.multiplier = multiplier->front();
  if (const Numbers offset = file.numbers(*element, "offset", 1, owner))
    mimic.offset = offset->front();
  const auto name = file.text(*element, "joint", owner);
  if (!name) return std::nullopt;
  mimic.joint = *name;
  return mimic;
}

/// Reads the soft limits of <safety_controller>, and narrows the joint's limits by them if `apply`
/// is true. @returns whether the soft limits are narrower and were not applied.
bool narrow(XmlFile& file, Element& element, bool apply, const std::string& owner, UrdfJoint& joint,
            std::vector<Note>& notes) {
  Element* const safety = file.child(element, "safety_controller", owner);
  const auto isGiven = [&](const char* limit) {
    return safety->FindAttribute(limit) && safety->DoubleAttribute(limit) != 0;
  };
  if (safety && joint.type == JointType::continuous &&
      (isGiven("soft_lower_limit") || isGiven("soft_upper_limit")))
    notes.push_back({file.at(safety->GetLineNum(),
                             owner + ": is continuous, so its soft limits are not used; a joint "
                                     "that they limit is of type revolute"),
                     NoteWeight::motion});
  if (!safety || !joint.limit) return false;
  if (joint.type != JointType::revolute && joint.type != JointType::prismatic) return false;
  file.checkLeaf(*safety, {"soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"},
                 owner, notes);
  if (apply &&
      !(safety->FindAttribute("soft_lower_limit") && safety->FindAttribute("soft_upper_limit")))
    notes.push_back({file.at(safety->GetLineNum(),
                             owner + ": a soft limit is missing, so the joint's own limit is used, "
                                     "not the format's default, 0"),
                     NoteWeight::motion});
  const Numbers softLower = file.numbers(*safety, "soft_lower_limit", 1, owner);
  const Numbers softUpper = file.numbers(*safety, "soft_upper_limit", 1, owner);
  const double lower = joint.limit->lower.value_or(0), upper = joint.limit->upper.value_or(0);
  const double least = softLower ? std::max(lower, softLower->front()) : lower;
  const double most = softUpper ? std::min(upper, softUpper->front()) : upper;
  if (least == lower && most == upper) return false;
  if (apply && least > most && lower <= upper)
    file.fault(safety->GetLineNum(), owner + ": its soft limits leave no range: from " +
                                         shortest(least) + " to " + shortest(most));
  else if (apply && least != lower)
    joint.limit->lower = least;
  if (apply && least <= most && most != upper) joint.limit->upper = most;
  return !apply;
}

UrdfJoint readJoint(XmlFile& file, Element& element, const UrdfRules& rules,
                    std::vector<std::string>& soft, std::vector<Note>& notes) {
  UrdfJoint joint;
  joint.name = file.text(element, "name", "").value_or("");
  joint.line = element.GetLineNum();
  const std::string owner = owned("joint", joint.name);
  file.checkAttributes(element, {"name", "type"}, owner, notes);
  file.checkChildren(element, {"origin", "parent", "child", "axis", "limit", "mimic"},
                     {"dynamics", "calibration", "safety_controller", "hardwareInterface"}, owner,
                     notes);
  joint.type = readType(file, element, owner);
  joint.parent = readEnd(file, element, "parent", owner, notes);
  joint.child = readEnd(file, element, "child", owner, notes);
  joint.rpy = readOrigin(file, element, owner, notes);
  checkAxis(file, element, joint.type, owner, notes);
  joint.limit = readLimit(file, element, joint.type, owner, notes);
  if (narrow(file, element, rules.softLimits, owner, joint, notes)) soft.push_back(joint.name);
  joint.mimic = readMimic(file, element, owner, notes);
  if (joint.mimic && joint.type == JointType::fixed)
    notes.push_back({file.at(joint.line, owner + ": is fixed, so its <mimic> is not used"),
                     NoteWeight::motion});
  return joint;
}

/// What <ros2_control> says of joints that is not used: the first element of each kind.
struct ControlOfJoints {
  const Element* limits = nullptr;  ///< <limits>, or <param name="min"> of an interface
  const Element* mimic = nullptr;   ///< <param name="mimic">

  void find(const Element& control) {
    for (const Element* joint = control.FirstChildElement("joint"); joint;
         joint = joint->NextSiblingElement("joint"))
      for (const Element* part = joint->FirstChildElement(); part;
           part = part->NextSiblingElement()) {
        if (!limits && part->Name() == std::string_view("limits")) limits = part;
        if (!mimic && part->Attribute("name", "mimic")) mimic = part;
        for (const Element* param = part->FirstChildElement("param"); param && !limits;
             param = param->NextSiblingElement("param"))
          if (param->Attribute("name", "min") || param->Attribute("name", "max")) limits = param;
      }
  }
};

/// Returns the first element whose name or file name says that it makes a joint mimic another, as
/// plugins of Gazebo do; or nullptr.
const Element* mimicPlugin(const Element& element) {
  for (const Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const char* const file = child->Attribute("filename");
    if (lowered(child->Name()).find("mimic") != std::string::npos ||
        (file && lowered(file).find("mimic") != std::string::npos))
      return child;
    if (const Element* const inner = mimicPlugin(*child)) return inner;
  }
  return nullptr;
}

/// Returns whether this is a xacro file that was not expanded; if so, reports a fault. Without the
/// fault, the macros would be ignored as unknown elements.
bool isXacro(XmlFile& file, const Element& element) {
  for (const Element* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    if (std::string_view(child->Name()).starts_with("xacro:")) {
      file.fault(child->GetLineNum(), "<" + std::string(child->Name()) +
                                          ">: this is a xacro file; expand it first: xacro FILE "
                                          "> robot.urdf");
      return true;
    }
    if (isXacro(file, *child)) return true;
  }
  return false;
}

/// Returns whether this is an SRDF instead of a URDF; if so, reports a fault.
bool isSrdf(XmlFile& file, const Element& root) {
  if (root.FirstChildElement("link")) return false;
  for (const char* const kind : {"group", "group_state", "virtual_joint", "disable_collisions"})
    if (root.FirstChildElement(kind)) {
      file.fault(root.GetLineNum(), "the robot has no <link>; it seems to be an SRDF, not a URDF");
      return true;
    }
  return false;
}

using Lines = std::unordered_map<std::string, int>;

/// Appends `named` to `all`, unless the name of `named` is missing or already taken. Reports a
/// fault for a name that is taken.
/// @param lines the line of each name so far.
/// @returns whether `named` was appended.
template <class Named>
bool addUnique(Named named, const char* kind, std::vector<Named>& all, Lines& lines,
               XmlFile& file) {
  if (named.name.empty()) return false;
  const auto [first, isNew] = lines.emplace(named.name, named.line);
  if (!isNew) {
    file.fault(named.line, owned(kind, named.name) + " is already defined on line " +
                               std::to_string(first->second) + "; names must be unique");
    return false;
  }
  all.push_back(std::move(named));
  return true;
}

/// Returns a count for a message: "1 link is", "3 links are".
std::string counted(const std::vector<std::string>& names, const std::string& what) {
  return std::to_string(names.size()) + " " + what + (names.size() == 1 ? " is" : "s are");
}

/// Reports a fault for each kind of element (links, joints, shapes) of which there are too many.
/// @returns whether a fault was reported.
bool isTooLarge(XmlFile& file, const UrdfRules& rules, const Element& root) {
  constexpr std::size_t mostLinks = 10'000, mostShapes = 100'000;
  std::size_t links = 0, joints = 0, shapes = 0;
  for (const Element* element = root.FirstChildElement(); element;
       element = element->NextSiblingElement()) {
    const std::string_view kind = element->Name();
    links += kind == "link";
    joints += kind == "joint";
    if (kind != "link") continue;
    const char* const shapeName =
        rules.visualsCollide && !element->FirstChildElement("collision") ? "visual" : "collision";
    for (const Element* shape = element->FirstChildElement(shapeName); shape;
         shape = shape->NextSiblingElement(shapeName))
      ++shapes;
  }
  const std::size_t before = file.faultCount();
  const auto require = [&](std::size_t count, const char* what, std::size_t most) {
    if (count > most)
      file.fault(root.GetLineNum(), "the robot has " + std::to_string(count) + " " + what +
                                        "; at most " + std::to_string(most) + " are read");
  };
  require(links, "<link>", mostLinks);
  require(joints, "<joint>", mostLinks);
  require(shapes, "<collision>", mostShapes);
  return file.faultCount() != before;
}

/// Reports a fault if all shapes together have too many triangles. A mesh counts once for each
/// shape that uses it: most of these shapes need a copy. @pre the file has no fault.
void checkTriangles(const UrdfOutline& outline, const MeshStore& meshes, XmlFile& file) {
  std::size_t triangles = 0;
  for (const UrdfLink& link : outline.links)
    for (const UrdfCollision& collision : link.collisions) {
      if (collision.mesh.empty()) continue;
      triangles += meshes.get(collision.mesh)->mesh.triangles.size();
      if (triangles > kMaxMeshElements)
        return file.fault(collision.line, owned("link", link.name) +
                                              ": the shapes up to this one have more than " +
                                              std::to_string(kMaxMeshElements) +
                                              " triangles in all; use coarser meshes");
    }
}

}  // namespace

UrdfOutline readUrdfOutline(XmlFile& file, const UrdfRules& rules, MeshStore& meshes,
                            std::vector<Note>& notes) {
  UrdfOutline outline;
  Element& root = *file.root();
  if (isXacro(file, root) || isSrdf(file, root) || isTooLarge(file, rules, root)) return outline;
  Lines links, joints;
  std::vector<std::string> visible, soft;  // names for the notes
  ControlOfJoints control;
  outline.name = file.text(root, "name", "").value_or("");
  file.checkAttributes(root, {"name", "version"}, owned("robot", outline.name), notes);
  const std::string version = root.Attribute("version") ? root.Attribute("version") : "";
  if (!version.empty() && version != "1" && !version.starts_with("1."))
    file.fault(root.GetLineNum(), "URDF of version " + quotedWord(version) +
                                      " is not known; versions 1.0 to 1.2 are read");
  file.checkChildren(root, {"link", "joint"},
                     {"material", "transmission", "gazebo", "sensor", "ros2_control"},
                     owned("robot", outline.name), notes);
  for (Element* element = root.FirstChildElement(); element;
       element = element->NextSiblingElement()) {
    const std::string_view kind = element->Name();
    if (kind == "link")
      outline.complete &= addUnique(readLink(file, *element, rules, meshes, visible, notes), "link",
                                    outline.links, links, file);
    else if (kind == "joint")
      outline.complete &= addUnique(readJoint(file, *element, rules, soft, notes), "joint",
                                    outline.joints, joints, file);
    else if (kind == "ros2_control")
      control.find(*element);
    else if (kind == "gazebo" && !control.mimic)
      control.mimic = mimicPlugin(*element);
  }
  const auto lineOf = [&](const std::vector<std::string>& names, const Lines& lines) {
    const auto first = lines.find(names.front());  // an element without a name has no entry
    return first == lines.end() ? root.GetLineNum() : first->second;
  };
  if (!visible.empty())
    notes.push_back({file.at(lineOf(visible, links),
                             counted(visible, "link") +
                                 " not tested, having a <visual> and no <collision> (visuals: "
                                 "collide in robot.yaml uses the visuals): " +
                                 joinedFirst(visible)),
                     NoteWeight::coverage});
  if (!soft.empty())
    notes.push_back({file.at(lineOf(soft, joints),
                             counted(soft, "joint") +
                                 " used without the soft limits, which are narrower (limits: soft "
                                 "in robot.yaml applies them): " +
                                 joinedFirst(soft)),
                     NoteWeight::motion});
  if (control.mimic)
    notes.push_back({file.at(control.mimic->GetLineNum(),
                             "a joint mimics another in <ros2_control> or <gazebo>, which is not "
                             "used: only <mimic> in its <joint> is"),
                     NoteWeight::motion});
  if (control.limits)
    notes.push_back({file.at(control.limits->GetLineNum(),
                             "limits of joints in <ros2_control> are not used, only those of "
                             "their <limit>"),
                     NoteWeight::motion});
  if (!root.FirstChildElement("link"))
    file.fault(root.GetLineNum(), "the robot has no <link>; at least one is needed");
  if (file.sound()) checkTriangles(outline, meshes, file);
  return outline;
}

}  // namespace corridor
