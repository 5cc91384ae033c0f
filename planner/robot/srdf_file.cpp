#include <map>
#include <set>

#include "collision/core/spelling.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/srdf_groups.h"
#include "planner/robot/srdf_names.h"
#include "planner/robot/urdf_file.h"
#include "planner/robot/xml_file.h"

namespace corridor {
namespace {

using Element = XmlFile::Element;
using Pair = std::pair<std::string, std::string>;

Pair pairOf(const std::string& a, const std::string& b) {
  return std::minmax(a, b);
}

constexpr std::size_t mostPairs = 1'000'000;

/// Adds a fault for each kind of element that occurs more often than its limit. Returns whether a
/// fault was added.
bool isTooLarge(XmlFile& file, std::size_t links) {
  const Element& root = *file.root();
  std::map<std::string_view, std::size_t> counts;  // number of elements with each name
  std::size_t members = 0, chains = 0;
  for (const Element* element = root.FirstChildElement(); element;
       element = element->NextSiblingElement()) {
    ++counts[element->Name()];
    if (std::string_view(element->Name()) != "group") continue;
    for (const Element* member = element->FirstChildElement(); member;
         member = member->NextSiblingElement()) {
      ++members;
      chains += std::string_view(member->Name()) == "chain";
    }
  }
  const std::size_t before = file.faultCount();
  const auto require = [&](std::size_t count, const std::string& what, std::size_t most) {
    if (count > most)
      file.fault(root.GetLineNum(), "has " + std::to_string(count) + " " + what + "; at most " +
                                        std::to_string(most) + " are read");
  };
  for (const char* const pairs : {"disable_collisions", "enable_collisions"})
    require(counts[pairs], "<" + std::string(pairs) + ">", mostPairs);
  require(counts["disable_default_collisions"] * links,
          "pairs of links by <disable_default_collisions>", mostPairs);
  require(counts["group"], "<group>", 1000);
  require(counts["virtual_joint"], "<virtual_joint>", 1000);
  require(counts["group_state"], "<group_state>", 10'000);
  require(members, "members of groups", 100'000);
  require(chains, "<chain>", 1000);
  return file.faultCount() != before;
}

/// Reads the pairs of links that are not tested. Every pair that <enable_collisions> names must be
/// tested, even if an element can't be read. So the elements <disable_default_collisions> are used
/// only if all <enable_collisions> can be read.
class PairReader {
 public:
  PairReader(XmlFile& file, SrdfNames& names, RobotDescription& model)
      : root_(*file.root()), file_(file), names_(names), model_(model) {
    for (const AllowedPair& pair : model.allowed) allowed_.insert(pairOf(pair.a, pair.b));
  }

  void read() {
    forEach(root_, "disable_collisions", [&](Element& element) {
      file_.checkLeaf(element, {"link1", "link2", "reason"}, "pair", model_.notes);
      const auto pair = findPair(element);
      const char* const reason = element.Attribute("reason");
      if (pair)
        allow(names_.links()[pair->first], names_.links()[pair->second],
              reason ? "SRDF: " + std::string(reason) : "SRDF");
    });
    std::set<Pair> enabled;
    bool allRead = !hasMisspeltEnable();
    forEach(root_, "enable_collisions", [&](Element& element) {
      const auto pair = findPair(element);
      allRead &= pair.has_value();
      if (pair) enabled.insert(pairOf(names_.links()[pair->first], names_.links()[pair->second]));
    });
    noteNotEnabled(enabled);
    if (allRead)
      disableDefaults(enabled);
    else if (const Element* first = root_.FirstChildElement("disable_default_collisions"))
      model_.notes.push_back(
          {file_.at(first->GetLineNum(),
                    "<disable_default_collisions> is ignored, because not every "
                    "<enable_collisions> can be read; all of its pairs are tested")});
    names_.note(unknown_, "pair names links that the URDF lacks: ",
                "pairs name links that the URDF lacks: ", model_.notes);
  }

 private:
  void allow(const std::string& a, const std::string& b, const std::string& reason) {
    if (allowed_.insert(pairOf(a, b)).second) model_.allowed.push_back({a, b, reason});
  }

  /// Returns the two links of a pair, or nullopt if a link is not given or not in the URDF.
  std::optional<std::pair<std::size_t, std::size_t>> findPair(const Element& element) {
    const auto a = names_.findLink(element, "link1", "", unknown_);
    const auto b = names_.findLink(element, "link2", "", unknown_);
    return a && b ? std::optional(std::pair{*a, *b}) : std::nullopt;
  }

  /// Adds a note on the pairs that are not tested although <enable_collisions> names them: adjacent
  /// links, and those of a <disable_collisions>.
  void noteNotEnabled(const std::set<Pair>& enabled) {
    std::vector<std::string> names;
    for (const AllowedPair& pair : model_.allowed)
      if (enabled.contains(pairOf(pair.a, pair.b)))
        names.push_back(pair.a + " ~ " + pair.b + " (" + pair.reason + ")");
    if (!names.empty())
      model_.notes.push_back(
          {file_.at(root_.FirstChildElement("enable_collisions")->GetLineNum(),
                    "not tested, although <enable_collisions> names them: " + joinedFirst(names)),
           NoteWeight::coverage});
  }

  bool hasMisspeltEnable() const {
    const std::vector<std::string> known{"enable_collisions", "disable_collisions",
                                         "disable_default_collisions"};
    for (const Element* element = root_.FirstChildElement(); element;
         element = element->NextSiblingElement())
      if (element->Name() != known[0] && mostSimilar(element->Name(), known) == known[0])
        return true;
    return false;
  }

  void disableDefaults(const std::set<Pair>& enabled) {
    forEach(root_, "disable_default_collisions", [&](Element& element) {
      const auto link = names_.findLink(element, "link", "", unknown_);
      if (!link) return;
      const std::string& name = names_.links()[*link];
      for (const std::string& other : names_.links().all())
        if (other != name && !enabled.contains(pairOf(name, other)))
          allow(name, other, "SRDF: disable_default_collisions");
    });
  }

  Element& root_;
  XmlFile& file_;
  SrdfNames& names_;
  RobotDescription& model_;
  std::set<Pair> allowed_;
  UnknownNames unknown_;
};

/// Reads the virtual joints. A note names each planar or floating virtual joint, unless the URDF
/// has such a joint above the same link.
void readVirtualJoints(XmlFile& file, SrdfNames& names, RobotDescription& model) {
  forEach(*file.root(), "virtual_joint", [&](Element& element) {
    const char* const name = element.Attribute("name");
    if (!name) return;
    const char* const typeName = element.Attribute("type");
    const auto type = jointType(typeName ? typeName : "");
    const bool moves = type && isPoseJoint(*type);
    if (!names.addVirtual(name, moves) || !moves) return;
    const char* const child = element.Attribute("child_link");
    const auto link = child ? names.links().find(child) : std::nullopt;
    for (const JointModel& joint : model.joints)
      if (link && joint.child == *link && isPoseJoint(joint.type)) return;
    model.notes.push_back(
        {file.at(element.GetLineNum(),
                 owned("virtual joint", name) + " (" + nameOf(*type) +
                     ") is not used: the robot stands still at the problem's base; for a base "
                     "that moves, add a " +
                     nameOf(*type) + " joint on an empty link to the URDF"),
         NoteWeight::motion});
  });
}

/// Reads the joint properties of MoveIt: whether a planar joint is a differential drive.
void readJointProperties(XmlFile& file, SrdfNames& names, RobotDescription& model) {
  UnknownNames unknown;
  forEach(*file.root(), "joint_property", [&](Element& element) {
    const auto is = [&](const char* attribute, std::string_view value) {
      const char* const text = element.Attribute(attribute);
      return text && text == value;
    };
    if (!is("property_name", "motion_model") || is("value", "holonomic")) return;
    const auto joint = names.findJoint(element, "joint_name", "", unknown);
    const char* const value = element.Attribute("value");
    if (joint && model.joints[*joint].type == JointType::planar)
      model.joints[*joint].whyNoSliding =
          file.at(element.GetLineNum(), std::string("<joint_property>: the motion_model is ") +
                                            (value ? quotedWord(value) : "not given"));
  });
  names.note(unknown, "joint_property is of no joint of the URDF: ",
             "joint_property is of no joints of the URDF: ", model.notes);
}

/// Reads the file. Elements that can't be read become notes, not faults, because an SRDF only adds
/// to the URDF: a group or state is needed only if the problem names it.
void readAll(XmlFile& file, RobotDescription& model) {
  Element& root = *file.root();
  if (isTooLarge(file, model.links.size())) return;
  const std::size_t before = model.notes.size();
  const char* const name = root.Attribute("name");
  if (name && name != model.name)
    model.notes.push_back(
        {file.at(root.GetLineNum(), "is for robot " + quotedWord(name) + ", and is used for " +
                                        quotedWord(model.name)),
         NoteWeight::coverage});
  file.checkChildren(root,
                     {"group", "group_state", "virtual_joint", "passive_joint",
                      "disable_collisions", "enable_collisions", "disable_default_collisions"},
                     {"end_effector", "joint_property", "link_sphere_approximation"},
                     owned("robot", model.name), model.notes);
  if (const Element* const link = root.FirstChildElement("link"))
    model.notes.push_back(
        {file.at(link->GetLineNum(), "it has <link> elements; it seems to be a URDF, not an SRDF"),
         NoteWeight::coverage});
  SrdfNames names(file, model);
  readVirtualJoints(file, names, model);
  readJointProperties(file, names, model);
  readSrdfGroups(file, names, model);
  UnknownNames passive;
  std::vector<std::string> passiveJoints;
  int firstPassive = 0;
  forEach(root, "passive_joint", [&](Element& element) {
    const auto joint = names.findJoint(element, "name", "", passive);
    if (!joint) return;
    if (passiveJoints.empty()) firstPassive = element.GetLineNum();
    model.joints[*joint].passive = true;
    passiveJoints.push_back(model.joints[*joint].name);
  });
  if (!passiveJoints.empty())
    model.notes.push_back(
        {file.at(firstPassive,
                 "<passive_joint>: these joints are held, unless joints names them or they mimic "
                 "others: " +
                     joinedFirst(passiveJoints)),
         NoteWeight::motion});
  names.note(passive, "passive joint is not in the URDF: ", "passive joints are not in the URDF: ",
             model.notes);
  PairReader(file, names, model).read();
  for (const Fault& fault : file.takeFaults()) model.notes.push_back({fault.str()});
  if (const auto other = names.noteOnOtherRobot())
    model.notes.insert(model.notes.begin() + static_cast<std::ptrdiff_t>(before),
                       Note{file.at(root.GetLineNum(), *other), NoteWeight::coverage});
}

}  // namespace

void readSrdf(const std::filesystem::path& file, RobotDescription& model,
              std::vector<Fault>& faults, const std::vector<std::string>& xacro) {
  XmlFile xml(file, "a robot's groups and pairs (SRDF)", xacro);
  if (!xml.expanded().empty()) model.expanded[file] = xml.expanded();
  if (xml.root()) readAll(xml, model);
  for (Fault& fault : xml.takeFaults()) faults.push_back(std::move(fault));
}

}  // namespace corridor
