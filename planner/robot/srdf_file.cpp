#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <unordered_map>

#include "collision/core/spelling.h"
#include "planner/robot/urdf_file.h"
#include "planner/robot/xml_file.h"

namespace corridor {
namespace {

using Element = XmlFile::Element;

/// Reads groups and states as MoveIt does (srdfdom). Elements that srdfdom skips because they are
/// wrong are faults.
class SrdfReader {
 public:
  SrdfReader(XmlFile& file, RobotModel& model) : file_(file), model_(model) {
    for (const LinkModel& link : model.links) links_.add(link.name);
    for (const JointModel& joint : model.joints) joints_.add(joint.name);
    parentJoint_.assign(links_.size(), none);
    for (std::size_t j = 0; j < model.joints.size(); ++j) parentJoint_[model.joints[j].child] = j;
  }

  void read() {
    Element& root = *file_.root();
    if (isTooLarge(root)) return;
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

  /// Unique names with their indices.
  class Names {
   public:
    void add(const std::string& name) {
      indices_.emplace(name, names_.size());
      names_.push_back(name);
    }
    /// nullopt: unknown name.
    std::optional<std::size_t> find(const std::string& name) const {
      const auto found = indices_.find(name);
      return found == indices_.end() ? std::nullopt : std::optional(found->second);
    }
    const std::vector<std::string>& all() const { return names_; }
    const std::string& operator[](std::size_t i) const { return names_[i]; }
    std::size_t size() const { return names_.size(); }

   private:
    std::vector<std::string> names_;
    std::unordered_map<std::string, std::size_t> indices_;
  };

  /// Reports each count of elements above its limit. @returns whether there is such a count.
  bool isTooLarge(const Element& root) {
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
    const std::size_t before = file_.faultCount();
    const auto require = [&](std::size_t count, const std::string& what, std::size_t most) {
      if (count > most)
        file_.fault(root.GetLineNum(), "has " + std::to_string(count) + " " + what + "; at most " +
                                           std::to_string(most) + " are read");
    };
    for (const char* const pairs : {"disable_collisions", "enable_collisions"})
      require(counts[pairs], "<" + std::string(pairs) + ">", mostPairs);
    require(counts["disable_default_collisions"] * links_.size(),
            "pairs of links by <disable_default_collisions>", mostPairs);
    require(counts["group"], "<group>", 1000);
    require(counts["group_state"], "<group_state>", 10'000);
    require(members, "members of groups", 100'000);
    require(chains, "<chain>", 1000);
    return file_.faultCount() != before;
  }
  static constexpr std::size_t mostPairs = 1'000'000;

  using Joints = std::set<std::size_t>;  // indices, so in the model's order

  static void forEach(Element& parent, const char* name,
                      const std::function<void(Element&)>& read) {
    for (Element* child = parent.FirstChildElement(name); child;
         child = child->NextSiblingElement(name))
      read(*child);
  }

  void note(const Element& element, const std::string& text) {
    model_.notes.push_back(file_.at(element.GetLineNum(), text));
  }

  /// Returns the index, in `known`, of the name that an attribute contains. nullopt: a fault was
  /// reported.
  std::optional<std::size_t> find(const Element& element, const char* attribute,
                                  const std::string& owner, const char* kind, const Names& known) {
    const auto name = file_.text(element, attribute, owner);
    if (!name) return std::nullopt;
    if (const auto found = known.find(*name)) return found;
    file_.fault(element.FindAttribute(attribute)->GetLineNum(),
                (owner.empty() ? "" : owner + ": ") + "the robot has no " + owned(kind, *name) +
                    hint(*name, known));
    return std::nullopt;
  }
  std::string hint(const std::string& name, const Names& known) const {
    return file_.hints() ? didYouMean(name, known.all()) : "";
  }
  std::optional<std::size_t> findLink(const Element& element, const char* attribute,
                                      const std::string& owner) {
    return find(element, attribute, owner, "link", links_);
  }
  /// Returns nullopt without a fault for virtual joints. They are ignored, because the problem file
  /// places the robot in the world.
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

  /// Adds the joints between two links: those above exactly one of the two.
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
        return file_.fault(element.GetLineNum(), owned("group", *name) +
                                                     " is already defined on line " +
                                                     std::to_string(first->element->GetLineNum()) +
                                                     "; names must be unique");
      groups_.push_back({*name, &element, {}, {}});
      groupNames_.add(*name);
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
    const auto found = groupNames_.find(name);
    return found ? &groups_[*found] : nullptr;
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
                                              " in this file" + hint(*name, groupNames_));
    });
    if (file_.faultCount() != before) faulty_.insert(group.name);
  }

  /// Returns the joints of a group and of all groups in it, at any depth. Reports a group that
  /// contains itself.
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
    // `collect` finds the circle from each of its groups. Only the group with the smallest name
    // reports it.
    if (*std::min_element(names.begin(), names.end()) != names.front()) return;
    names.push_back(names.front());
    std::reverse(names.begin(), names.end());
    file_.fault(groups_[root].element->GetLineNum(),
                "the groups " + joinedFirst(names) + " contain each other in a circle");
  }

  struct State {
    std::string name, group;  ///< group: empty if none is named
    int line = 0;
    std::map<std::string, double> values;
  };

  void readStates(Element& root) {
    std::vector<State> states;
    std::map<std::pair<std::string, std::string>, int> lines;  // line of each name in each group
    std::map<std::string, int> count;                          // number of states with each name
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
                          hint(group, groupNames_));
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
      const auto [first, isNew] = lines.emplace(std::pair{state.name, state.group}, state.line);
      if (!isNew)
        return file_.fault(state.line, owner + " is already defined on line " +
                                           std::to_string(first->second) +
                                           "; names must be unique in a group");
      ++count[state.name];
      states.push_back(std::move(state));
    });
    for (State& state : states) {
      const bool shared = count[state.name] > 1;
      // Two groups may both have a "home".
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
      for (const std::string& other : links_.all())
        if (other != links_[*link] && !enabled.contains(pairOf(links_[*link], other)))
          allow(links_[*link], other, "SRDF: disable_default_collisions");
    });
  }

  XmlFile& file_;
  RobotModel& model_;
  Names links_, joints_, groupNames_;
  std::vector<std::size_t> parentJoint_;  // for each link
  std::set<std::string> virtualJoints_;
  std::vector<Group> groups_;
  std::set<std::string> faulty_;  // groups with unknown names in them
};

}  // namespace

void readSrdf(const std::filesystem::path& file, RobotModel& model, std::vector<Fault>& faults) {
  XmlFile xml(file, "a robot's groups and pairs (SRDF)");
  if (xml.root()) SrdfReader(xml, model).read();
  for (Fault& fault : xml.takeFaults()) faults.push_back(std::move(fault));
}

}  // namespace corridor
