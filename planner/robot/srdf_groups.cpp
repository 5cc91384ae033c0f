#include "planner/robot/srdf_groups.h"

#include <algorithm>
#include <map>
#include <set>

#include "collision/core/spelling.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

using Element = XmlFile::Element;
using Joints = std::set<std::size_t>;  // indices of joints, ascending: the model's order

struct Group {
  Element* element = nullptr;
  Joints joints;
  std::vector<std::size_t> subgroups;
  UnknownNames missing;                 ///< members that the URDF lacks
  std::set<std::string> virtualJoints;  ///< members that are planar or floating virtual joints
  std::string unusable;  ///< the reason why the group can't be made, with file and line, or ""
};

/// Reads the groups and named states of an SRDF into a model.
class GroupReader {
 public:
  GroupReader(XmlFile& file, SrdfNames& names, RobotDescription& model)
      : file_(file), names_(names), model_(model), parentJoint_(model.links.size(), kNoIndex) {
    for (std::size_t j = 0; j < model.joints.size(); ++j) parentJoint_[model.joints[j].child] = j;
  }

  void read() {
    readGroups();
    readStates();
    names_.note(unknownMembers_, "member of a group is left out, because the URDF lacks ",
                "members of groups are left out, because the URDF lacks ", model_.notes);
    names_.note(unknownValues_, "value of a state is left out, because the URDF lacks ",
                "values of states are left out, because the URDF lacks ", model_.notes);
  }

 private:
  void note(const Element& element, const std::string& text) {
    model_.notes.push_back({file_.at(element.GetLineNum(), text)});
  }
  /// Turns the faults that were reported since the last call into notes. Returns the text of the
  /// first of these faults, or "".
  std::string noteFaults() {
    const std::vector<Fault> faults = file_.takeFaults();
    for (const Fault& fault : faults) model_.notes.push_back({fault.str()});
    return faults.empty() ? "" : faults.front().str();
  }

  void readGroups() {
    forEach(*file_.root(), "group", [&](Element& element) {
      const auto name = file_.text(element, "name", "");
      noteFaults();
      if (!name) return;
      if (const auto first = groupNames_.find(*name))
        return note(element, owned("group", *name) + " is already defined on line " +
                                 std::to_string(groups_[*first].element->GetLineNum()) +
                                 "; this definition is ignored");
      groups_.push_back({&element, {}, {}, {}, {}, ""});
      groupNames_.add(*name);
    });
    for (std::size_t i = 0; i < groups_.size(); ++i) readMembers(i);
    for (std::size_t i = 0; i < groups_.size(); ++i) checkCircle(i);
    for (std::size_t i = 0; i < groups_.size(); ++i) model_.groups[groupNames_[i]] = made(i);
    for (const Group& group : groups_) unknownMembers_.add(group.missing);
  }

  void readMembers(std::size_t index) {
    Group& group = groups_[index];
    const std::string owner = owned("group", groupNames_[index]);
    file_.checkChildren(*group.element, {"joint", "link", "chain", "group"}, {}, owner,
                        model_.notes);
    forEach(*group.element, "joint", [&](Element& element) {
      if (const auto joint = names_.findJoint(element, "name", owner, group.missing))
        group.joints.insert(*joint);
      if (const char* name = element.Attribute("name"); name && names_.isMovingVirtual(name))
        group.virtualJoints.insert(name);
    });
    forEach(*group.element, "link", [&](Element& element) {
      const auto link = names_.findLink(element, "name", owner, group.missing);
      if (link && parentJoint_[*link] != kNoIndex) group.joints.insert(parentJoint_[*link]);
    });
    forEach(*group.element, "chain", [&](Element& element) { addChain(element, owner, group); });
    forEach(*group.element, "group", [&](Element& element) {
      const auto name = file_.text(element, "name", owner);
      if (!name) return;
      if (const auto inner = groupNames_.find(*name))
        group.subgroups.push_back(*inner);
      else if (group.unusable.empty())
        group.unusable =
            file_.at(element.GetLineNum(), owner + ": there is no " + owned("group", *name) +
                                               " in the SRDF" + similarGroup(*name));
    });
    if (const std::string fault = noteFaults(); !fault.empty()) group.unusable = fault;
  }

  /// Returns a suggestion for the name of a group: a similar name, or a longer name, such as lf_leg
  /// for lf.
  std::string similarGroup(const std::string& name) const {
    std::string hint = didYouMean(name, groupNames_.all());
    if (!hint.empty()) return hint;
    for (const std::string& longer : groupNames_.all())
      if (longer.starts_with(name)) return " (did you mean " + quotedWord(longer) + "?)";
    return "";
  }

  Joints jointsAbove(std::size_t link) const {
    Joints above;
    for (std::size_t j = parentJoint_[link]; j != kNoIndex;
         j = parentJoint_[model_.joints[j].parent])
      above.insert(j);
    return above;
  }

  /// Adds the joints between two links to the group. These are the joints that are above exactly
  /// one of the two links.
  void addChain(Element& element, const std::string& owner, Group& group) {
    const auto base = names_.findLink(element, "base_link", owner, group.missing);
    const auto tip = names_.findLink(element, "tip_link", owner, group.missing);
    if (!base || !tip) return;
    const Joints aboveBase = jointsAbove(*base), aboveTip = jointsAbove(*tip);
    std::set_symmetric_difference(aboveBase.begin(), aboveBase.end(), aboveTip.begin(),
                                  aboveTip.end(), std::inserter(group.joints, group.joints.end()));
  }

  /// Marks the group as unusable if it contains itself.
  void checkCircle(std::size_t root) {
    std::vector<std::size_t> above(groups_.size(), kNoIndex), open{root};
    for (std::size_t k = 0; k < open.size(); ++k)
      for (const std::size_t inner : groups_[open[k]].subgroups) {
        if (inner == root) {
          groups_[root].unusable =
              file_.at(groups_[root].element->GetLineNum(),
                       owned("group", groupNames_[root]) +
                           " contains itself: " + circleText(root, open[k], above));
          return;
        }
        if (above[inner] != kNoIndex) continue;
        above[inner] = open[k];
        open.push_back(inner);
      }
  }

  std::string circleText(std::size_t root, std::size_t last,
                         const std::vector<std::size_t>& above) const {
    std::vector<std::string> names{groupNames_[root]};
    for (std::size_t i = last; i != root; i = above[i]) names.push_back(groupNames_[i]);
    names.push_back(names.front());
    std::reverse(names.begin(), names.end());
    return joinedFirst(names);
  }

  /// Returns the reason why a group has no joint, as the end of a message that begins with the
  /// group's name.
  static std::string whyNoJoint(const JointGroup& group) {
    if (!group.missing.empty())
      return " has no joint of this robot: the URDF lacks " + joinedFirst(group.missing);
    if (!group.virtualJoints.empty())
      return " has no joint of the URDF; virtual joints are not used: " +
             joinedFirst(group.virtualJoints);
    return " has no joint";
  }

  /// Returns the group with its own members, and those of all groups in it, at any depth.
  JointGroup made(std::size_t root) {
    JointGroup result;
    Joints joints;
    UnknownNames missing;
    std::set<std::string> virtualJoints;
    std::vector<bool> seen(groups_.size(), false);
    std::vector<std::size_t> open{root};
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Group& group = groups_[open[k]];
      joints.insert(group.joints.begin(), group.joints.end());
      missing.add(group.missing);
      virtualJoints.insert(group.virtualJoints.begin(), group.virtualJoints.end());
      expanded_ += group.joints.size() + group.missing.names().size() + group.virtualJoints.size();
      if (result.unusable.empty()) result.unusable = group.unusable;
      if (expanded_ > mostExpanded) {
        result.unusable = file_.at(groups_[root].element->GetLineNum(),
                                   "the groups up to this one have more than " +
                                       std::to_string(mostExpanded) + " members in all");
        return result;
      }
      for (const std::size_t inner : group.subgroups) {
        if (!seen[inner]) open.push_back(inner);
        seen[inner] = true;
      }
    }
    result.missing = missing.names();
    result.virtualJoints.assign(virtualJoints.begin(), virtualJoints.end());
    if (result.unusable.empty() && joints.empty())
      result.unusable = file_.at(groups_[root].element->GetLineNum(),
                                 owned("group", groupNames_[root]) + whyNoJoint(result));
    if (result.unusable.empty())
      for (const std::size_t j : joints) result.joints.push_back(names_.joints()[j]);
    return result;
  }

  struct State {
    std::string name;
    int line = 0;
    NamedState made;
  };

  void readStates() {
    std::vector<State> states;
    std::map<std::pair<std::string, std::string>, std::size_t> indices;  // by name and group
    std::map<std::string, int> count;  // for each name, the number of states with this name
    forEach(*file_.root(), "group_state", [&](Element& element) {
      const auto name = file_.text(element, "name", "");
      noteFaults();
      if (!name) return;
      State state{*name, element.GetLineNum(), readState(element, owned("state", *name))};
      const auto [first, isNew] =
          indices.emplace(std::pair{state.name, state.made.group}, states.size());
      if (isNew) {
        ++count[state.name];
        states.push_back(std::move(state));
        return;
      }
      State& before = states[first->second];  // as in MoveIt, the last definition counts
      note(element, owned("state", *name) + " is already defined on line " +
                        std::to_string(before.line) +
                        "; this definition replaces it, as in MoveIt");
      before = std::move(state);
    });
    for (State& state : states) {
      std::string& group = state.made.group;
      // Two groups may both have a "home".
      const std::string name =
          count[state.name] > 1 && !group.empty() ? group + "/" + state.name : state.name;
      if (!group.empty() && !groupNames_.find(group)) group.clear();
      if (!model_.states.emplace(name, std::move(state.made)).second)
        model_.notes.push_back({file_.at(state.line, "there is already a " + owned("state", name) +
                                                         "; this definition is ignored")});
    }
  }

  NamedState readState(Element& element, const std::string& owner) {
    NamedState state;
    file_.checkChildren(element, {"joint"}, {}, owner, model_.notes);
    if (const char* group = element.Attribute("group")) state.group = group;
    if (state.group.empty())
      note(element, owner + " names no group; its values are taken as they are");
    else if (!groupNames_.find(state.group))
      note(element, owner + " names the group " + quotedWord(state.group) +
                        ", which the SRDF lacks; its values are taken as they are");
    std::vector<std::string> ignored;
    UnknownNames unknown;
    bool hasVirtual = false;
    forEach(element, "joint", [&](Element& joint) {
      const char* const name = joint.Attribute("name");
      hasVirtual |= name && names_.isVirtual(name);
      readValue(joint, owner, unknown, state, ignored);
    });
    if (!ignored.empty())
      note(element,
           owner + ": the values of fixed joints and mimics are ignored: " + joined(ignored));
    unknownValues_.add(unknown);
    state.unusable = noteFaults();
    if (state.values.empty() && ignored.empty() && state.unusable.empty())
      state.unusable =
          file_.at(element.GetLineNum(),
                   owner + (!unknown.names().empty()
                                ? " gives no joint of this robot a value: the URDF lacks " +
                                      joinedFirst(unknown.names())
                            : hasVirtual ? " has values of virtual joints only, which are not used"
                                         : " has no value"));
    return state;
  }

  void readValue(Element& element, const std::string& owner, UnknownNames& unknown,
                 NamedState& state, std::vector<std::string>& ignored) {
    const auto index = names_.findJoint(element, "name", owner, unknown);
    if (!index) return;
    const JointModel& joint = model_.joints[*index];
    if (!hasOwnValue(joint)) return ignored.push_back(joint.name);
    const std::vector<const char*> parts =
        joint.type == JointType::planar ? std::vector{"/x", "/y", "/yaw"}
        : joint.type == JointType::floating
            ? std::vector{"/x", "/y", "/z", "/qx", "/qy", "/qz", "/qw"}
            : std::vector{""};
    const std::string of = owner + ": " + owned("joint", joint.name);
    file_.require(element, "value", of);
    const auto numbers = file_.numbers(element, "value", parts.size(), of);
    file_.checkLeaf(element, {"name", "value"}, of, model_.notes);
    if (numbers && state.values.contains(joint.name + parts[0]))
      file_.fault(element.GetLineNum(), of + " is given twice");
    for (std::size_t i = 0; numbers && i < parts.size(); ++i)
      state.values[joint.name + parts[i]] = (*numbers)[i];
  }

  XmlFile& file_;
  SrdfNames& names_;
  RobotDescription& model_;
  std::vector<std::size_t> parentJoint_;  // for each link
  NameIndex groupNames_;
  std::vector<Group> groups_;
  static constexpr std::size_t mostExpanded = 1'000'000;
  std::size_t expanded_ = 0;  // number of members of all groups, with those of their subgroups
  UnknownNames unknownMembers_, unknownValues_;
};

}  // namespace

void readSrdfGroups(XmlFile& file, SrdfNames& names, RobotDescription& model) {
  GroupReader(file, names, model).read();
}

}  // namespace corridor
