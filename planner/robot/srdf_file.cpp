#include <algorithm>
#include <functional>
#include <set>

#include "collision/core/nearest.h"
#include "planner/robot/urdf_file.h"
#include "planner/robot/xml_file.h"

namespace corridor {
namespace {

using Element = XmlFile::Element;

/// Groups and states as MoveIt reads them (srdfdom), but what it passes over is a fault.
class SrdfReader {
 public:
  SrdfReader(XmlFile& file, RobotModel& model) : file_(file), model_(model) {
    for (const LinkModel& link : model.links) links_.push_back(link.name);
    for (const JointModel& joint : model.joints) joints_.push_back(joint.name);
    parentJoint_.assign(links_.size(), none);
    for (std::size_t j = 0; j < model.joints.size(); ++j) parentJoint_[model.joints[j].child] = j;
  }

  void read() {
    Element& root = *file_.root();
    const char* const name = root.Attribute("name");
    if (name && name != model_.name)
      note(root,
           "is for robot " + quotedWord(name) + ", and is used for " + quotedWord(model_.name));
    file_.checkChildren(root,
                        {"group", "group_state", "virtual_joint", "passive_joint",
                         "disable_collisions", "enable_collisions", "disable_default_collisions"},
                        {"end_effector", "joint_property", "link_sphere_approximation"},
                        owned("robot", model_.name), model_.notes);
    forEach(root, "virtual_joint", [&](Element& element) {
      if (const char* joint = element.Attribute("name")) virtualJoints_.insert(joint);
    });
    readGroups(root);
    readStates(root);
    forEach(root, "passive_joint", [&](Element& element) { findJoint(element, "name", ""); });
    readPairs(root);
  }

 private:
  static constexpr std::size_t none = SIZE_MAX;
  using Joints = std::set<std::size_t>;  // the model's order

  static void forEach(Element& parent, const char* name,
                      const std::function<void(Element&)>& read) {
    for (Element* child = parent.FirstChildElement(name); child;
         child = child->NextSiblingElement(name))
      read(*child);
  }

  void note(const Element& element, const std::string& text) {
    model_.notes.push_back(file_.at(element.GetLineNum(), text));
  }

  /// The index of what an attribute names. nullopt: faulted.
  std::optional<std::size_t> find(const Element& element, const char* attribute,
                                  const std::string& owner, const char* kind,
                                  const std::vector<std::string>& known) {
    const auto name = file_.text(element, attribute, owner);
    if (!name) return std::nullopt;
    const auto found = std::find(known.begin(), known.end(), *name);
    if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
    file_.fault(element.FindAttribute(attribute)->GetLineNum(),
                (owner.empty() ? "" : owner + ": ") + "the robot has no " + owned(kind, *name) +
                    didYouMean(*name, known));
    return std::nullopt;
  }
  std::optional<std::size_t> findLink(const Element& element, const char* attribute,
                                      const std::string& owner) {
    return find(element, attribute, owner, "link", links_);
  }
  /// nullopt also for virtual joints: a problem says itself how a robot stands in the world.
  std::optional<std::size_t> findJoint(const Element& element, const char* attribute,
                                       const std::string& owner) {
    const char* const name = element.Attribute(attribute);
    if (name && virtualJoints_.contains(name)) return std::nullopt;
    return find(element, attribute, owner, "joint", joints_);
  }

  Joints jointsAbove(std::size_t link) const {
    Joints above;
    for (std::size_t j = parentJoint_[link]; j != none; j = parentJoint_[model_.joints[j].parent])
      above.insert(j);
    return above;
  }

  /// The joints between two links: those above one of them, and not above both.
  void addChain(Element& element, const std::string& owner, Joints& joints) {
    const auto base = findLink(element, "base_link", owner);
    const auto tip = findLink(element, "tip_link", owner);
    if (!base || !tip) return;
    const Joints aboveBase = jointsAbove(*base), aboveTip = jointsAbove(*tip);
    if (aboveTip.size() < aboveBase.size() &&
        std::includes(aboveBase.begin(), aboveBase.end(), aboveTip.begin(), aboveTip.end()))
      return file_.fault(element.GetLineNum(),
                         owner + ": the chain is upside down: its base_link " +
                             quotedWord(links_[*base]) + " hangs from its tip_link " +
                             quotedWord(links_[*tip]) + "; swap them");
    std::set_symmetric_difference(aboveBase.begin(), aboveBase.end(), aboveTip.begin(),
                                  aboveTip.end(), std::inserter(joints, joints.end()));
  }

  struct Group {
    std::string name;
    Element* element = nullptr;
    Joints joints;
    std::vector<std::size_t> subgroups;
  };

  void readGroups(Element& root) {
    forEach(root, "group", [&](Element& element) {
      const auto name = file_.text(element, "name", "");
      if (!name) return;
      if (const Group* first = findGroup(*name))
        return file_.fault(element.GetLineNum(),
                           owned("group", *name) + " is there already, on line " +
                               std::to_string(first->element->GetLineNum()) + "; names are unique");
      groups_.push_back({*name, &element, {}, {}});
      groupNames_.push_back(*name);
    });
    for (Group& group : groups_) readGroup(group);
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const Group& group = groups_[i];
      const std::size_t before = file_.faultCount();
      const Joints joints = collect(i);
      if (joints.empty() && file_.faultCount() == before && !faulty_.contains(group.name))
        file_.fault(group.element->GetLineNum(),
                    owned("group", group.name) +
                        " has no joint; it needs a <joint>, a <link>, a <chain> or a <group>");
      std::vector<std::string>& names = model_.groups[group.name];
      for (const std::size_t j : joints) names.push_back(joints_[j]);
    }
  }

  const Group* findGroup(const std::string& name) const {
    const auto found = std::find(groupNames_.begin(), groupNames_.end(), name);
    return found == groupNames_.end() ? nullptr : &groups_[found - groupNames_.begin()];
  }

  void readGroup(Group& group) {
    const std::string owner = owned("group", group.name);
    const std::size_t before = file_.faultCount();
    file_.checkChildren(*group.element, {"joint", "link", "chain", "group"}, {}, owner,
                        model_.notes);
    forEach(*group.element, "joint", [&](Element& element) {
      if (const auto joint = findJoint(element, "name", owner)) group.joints.insert(*joint);
    });
    forEach(*group.element, "link", [&](Element& element) {
      const auto link = findLink(element, "name", owner);
      if (link && parentJoint_[*link] != none) group.joints.insert(parentJoint_[*link]);
    });
    forEach(*group.element, "chain",
            [&](Element& element) { addChain(element, owner, group.joints); });
    forEach(*group.element, "group", [&](Element& element) {
      const auto name = file_.text(element, "name", owner);
      if (!name) return;
      if (const Group* inner = findGroup(*name))
        group.subgroups.push_back(static_cast<std::size_t>(inner - groups_.data()));
      else
        file_.fault(element.GetLineNum(), owner + ": there is no " + owned("group", *name) +
                                              " in this file" + didYouMean(*name, groupNames_));
    });
    if (file_.faultCount() != before) faulty_.insert(group.name);
  }

  /// The joints of a group and of those that are in it, at any depth.
  Joints collect(std::size_t root) {
    Joints joints;
    std::vector<std::size_t> above(groups_.size(), none), open{root};
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Group& group = groups_[open[k]];
      joints.insert(group.joints.begin(), group.joints.end());
      for (const std::size_t inner : group.subgroups) {
        if (inner == root) {
          faultCircle(root, open[k], above);
          return joints;
        }
        if (above[inner] != none) continue;
        above[inner] = open[k];
        open.push_back(inner);
      }
    }
    return joints;
  }

  void faultCircle(std::size_t root, std::size_t last, const std::vector<std::size_t>& above) {
    std::vector<std::string> names{groupNames_[root]};
    for (std::size_t i = last; i != root; i = above[i]) names.push_back(groupNames_[i]);
    // Told once, by the first of the circle.
    if (*std::min_element(names.begin(), names.end()) != names.front()) return;
    names.push_back(names.front());
    std::reverse(names.begin(), names.end());
    file_.fault(groups_[root].element->GetLineNum(),
                "the groups " + joinedFirst(names) + " are in each other in a circle");
  }

  struct State {
    std::string name, group;  ///< group "": none named
    int line = 0;
    std::map<std::string, double> values;
  };

  void readStates(Element& root) {
    std::vector<State> states;
    forEach(root, "group_state", [&](Element& element) {
      const auto name = file_.text(element, "name", "");
      if (!name) return;
      State state{*name, "", element.GetLineNum(), {}};
      const std::string owner = owned("state", *name);
      file_.checkChildren(element, {"joint"}, {}, owner, model_.notes);
      if (const char* group = element.Attribute("group")) {
        state.group = group;
        if (!findGroup(group))
          file_.fault(element.FindAttribute("group")->GetLineNum(),
                      owner + ": there is no " + owned("group", group) + " in this file" +
                          didYouMean(group, groupNames_));
      } else {
        note(element, owner + " names no group; its values are taken as they are");
      }
      std::vector<std::string> fixed;
      forEach(element, "joint",
              [&](Element& joint) { readValue(joint, owner, state.values, fixed); });
      if (!fixed.empty())
        note(element, owner +
                          ": the values of joints that do not move by themselves are ignored: " +
                          joined(fixed));
      for (const State& other : states)
        if (other.name == state.name && other.group == state.group)
          return file_.fault(state.line, owner + " is there already, on line " +
                                             std::to_string(other.line) +
                                             "; names are unique in a group");
      states.push_back(std::move(state));
    });
    for (State& state : states) {
      const bool shared = std::count_if(states.begin(), states.end(), [&](const State& other) {
                            return other.name == state.name;
                          }) > 1;
      // Two arms may both have a "home".
      const std::string name =
          shared && !state.group.empty() ? state.group + "/" + state.name : state.name;
      model_.states[name] = state.values;
      if (!state.group.empty()) model_.stateGroup[name] = state.group;
    }
  }

  void readValue(Element& element, const std::string& owner, std::map<std::string, double>& values,
                 std::vector<std::string>& ignored) {
    const auto index = findJoint(element, "name", owner);
    if (!index) return;
    const JointModel& joint = model_.joints[*index];
    const bool planar = joint.type == JointType::planar;
    const std::vector<const char*> parts =
        planar ? std::vector{"/x", "/y", "/yaw"}
        : joint.type == JointType::floating
            ? std::vector{"/x", "/y", "/z", "/qx", "/qy", "/qz", "/qw"}
            : std::vector{""};
    file_.require(element, "value", owner);
    const auto numbers =
        file_.numbers(element, "value", parts.size(), owner + ": " + owned("joint", joint.name));
    if (joint.type == JointType::fixed || joint.mimic) return ignored.push_back(joint.name);
    for (std::size_t i = 0; numbers && i < parts.size(); ++i)
      values[joint.name + parts[i]] = (*numbers)[i];
  }

  static std::pair<std::string, std::string> pairOf(const std::string& a, const std::string& b) {
    return std::minmax(a, b);
  }

  void readPairs(Element& root) {
    std::set<std::pair<std::string, std::string>> allowed, enabled;
    for (const AllowedPair& pair : model_.allowed) allowed.insert(pairOf(pair.a, pair.b));
    const auto allow = [&](const std::string& a, const std::string& b, const std::string& reason) {
      if (allowed.insert(pairOf(a, b)).second) model_.allowed.push_back({a, b, reason});
    };
    forEach(root, "disable_collisions", [&](Element& element) {
      const auto a = findLink(element, "link1", ""), b = findLink(element, "link2", "");
      const char* const reason = element.Attribute("reason");
      if (a && b) allow(links_[*a], links_[*b], reason ? "SRDF: " + std::string(reason) : "SRDF");
    });
    forEach(root, "enable_collisions", [&](Element& element) {
      const auto a = findLink(element, "link1", ""), b = findLink(element, "link2", "");
      if (a && b) enabled.insert(pairOf(links_[*a], links_[*b]));
    });
    forEach(root, "disable_default_collisions", [&](Element& element) {
      const auto link = findLink(element, "link", "");
      if (!link) return;
      for (const std::string& other : links_)
        if (other != links_[*link] && !enabled.contains(pairOf(links_[*link], other)))
          allow(links_[*link], other, "SRDF: disable_default_collisions");
    });
  }

  XmlFile& file_;
  RobotModel& model_;
  std::vector<std::string> links_, joints_, groupNames_;
  std::vector<std::size_t> parentJoint_;  // of each link
  std::set<std::string> virtualJoints_;
  std::vector<Group> groups_;
  std::set<std::string> faulty_;  // groups that name what isn't there
};

}  // namespace

void readSrdf(const std::filesystem::path& file, RobotModel& model, std::vector<Fault>& faults) {
  XmlFile xml(file, "a robot's groups and pairs (SRDF)");
  if (xml.root()) SrdfReader(xml, model).read();
  for (Fault& fault : xml.takeFaults()) faults.push_back(std::move(fault));
}

}  // namespace corridor
