#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "collision/core/spelling.h"
#include "planner/robot/urdf_file.h"
#include "planner/robot/xml_file.h"

namespace corridor {
namespace {

using Element = XmlFile::Element;

/// Names in one kind of element that the URDF lacks.
struct UnknownNames {
  int line = 0;                    ///< of the first such element
  std::size_t count = 0;           ///< number of such elements, which the caller counts
  std::vector<std::string> names;  ///< each once
  std::unordered_set<std::string> seen;

  void add(int at, const std::string& name) {
    if (line == 0) line = at;
    if (seen.insert(name).second) names.push_back(name);
  }
  void add(const UnknownNames& other) {
    for (const std::string& name : other.names) add(other.line, name);
    count += other.count;
  }
  /// Formats the names. Of more than three, it formats two and the number of the others.
  std::string text() const {
    if (names.size() <= 3) return joined(names);
    return names[0] + ", " + names[1] + " and " + std::to_string(names.size() - 2) + " more";
  }
};

/// Reads groups and states as MoveIt does (srdfdom). What it can't read is a note, because an SRDF
/// only adds to what the URDF says: a group or state is needed only if the problem names it.
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
    const std::size_t before = model_.notes.size();
    readAll(root);
    noteUnknown(root, before);
    for (const Fault& fault : file_.takeFaults()) model_.notes.push_back(fault.str());
  }

 private:
  void readAll(Element& root) {
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
    forEach(root, "passive_joint", [&](Element& element) {
      const bool known = findJoint(element, "name", "", unknownPassive_).has_value();
      unknownPassive_.count += !known && !isVirtual(element.Attribute("name"));
    });
    readPairs(root);
  }

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

  /// Adds a note for each kind of element with unknown names. @param first index of the first note
  /// of this file
  void noteUnknown(const Element& root, std::size_t first) {
    const bool foreign = !unknownNames_.empty() && 2 * unknownNames_.size() >= usedNames_.size();
    std::vector<std::string> known = links_.all();
    known.insert(known.end(), joints_.all().begin(), joints_.all().end());
    const auto add = [&](const UnknownNames& unknown, const std::string& one,
                         const std::string& many, const std::string& rest) {
      if (unknown.names.empty()) return;
      std::string text =
          (unknown.count == 1 ? "1 " + one : std::to_string(unknown.count) + " " + many) + rest +
          unknown.text();
      if (unknown.names.size() == 1 && !foreign) text += didYouMean(unknown.names[0], known);
      model_.notes.push_back(file_.at(unknown.line, text));
    };
    add(unknownMembers_, "member of a group is", "members of groups are",
        " left out, because the URDF lacks ");
    add(unknownValues_, "value of a state is", "values of states are",
        " left out, because the URDF lacks ");
    add(unknownPassive_, "passive joint is", "passive joints are", " not in the URDF: ");
    add(unknownPairs_, "pair names", "pairs name", " links that the URDF lacks: ");
    if (foreign)
      model_.notes.insert(
          model_.notes.begin() + static_cast<std::ptrdiff_t>(first),
          file_.at(root.GetLineNum(), std::to_string(unknownNames_.size()) + " of the " +
                                          std::to_string(usedNames_.size()) +
                                          " links and joints that it names are not in the URDF; "
                                          "it seems to be the SRDF of another robot"));
  }

  /// Returns the index, in `known`, of the name that an attribute contains. nullopt: the attribute
  /// is missing, or the name was added to `unknown`.
  std::optional<std::size_t> find(const Element& element, const char* attribute,
                                  const std::string& owner, const Names& known,
                                  UnknownNames& unknown) {
    const auto name = file_.text(element, attribute, owner);
    if (!name) return std::nullopt;
    usedNames_.insert(*name);
    const auto found = known.find(*name);
    if (found) return found;
    unknownNames_.insert(*name);
    unknown.add(element.GetLineNum(), *name);
    return std::nullopt;
  }
  std::optional<std::size_t> findLink(const Element& element, const char* attribute,
                                      const std::string& owner, UnknownNames& unknown) {
    return find(element, attribute, owner, links_, unknown);
  }
  bool isVirtual(const char* joint) const { return joint && virtualJoints_.contains(joint); }
  /// Virtual joints are not found, and are not unknown either. They are ignored, because the
  /// problem file places the robot in the world.
  std::optional<std::size_t> findJoint(const Element& element, const char* attribute,
                                       const std::string& owner, UnknownNames& unknown) {
    if (isVirtual(element.Attribute(attribute))) return std::nullopt;
    return find(element, attribute, owner, joints_, unknown);
  }

  Joints jointsAbove(std::size_t link) const {
    Joints above;
    for (std::size_t j = parentJoint_[link]; j != none; j = parentJoint_[model_.joints[j].parent])
      above.insert(j);
    return above;
  }

  struct Group {
    std::string name;
    Element* element = nullptr;
    Joints joints;
    std::vector<std::size_t> subgroups;
    UnknownNames missing;  ///< members that the URDF lacks
    std::string unusable;  ///< the reason why the group can't be made, or ""
  };

  /// Adds the joints between two links: those above exactly one of the two.
  bool addChain(Element& element, const std::string& owner, Group& group) {
    const auto base = findLink(element, "base_link", owner, group.missing);
    const auto tip = findLink(element, "tip_link", owner, group.missing);
    if (!base || !tip) return false;
    const Joints aboveBase = jointsAbove(*base), aboveTip = jointsAbove(*tip);
    std::set_symmetric_difference(aboveBase.begin(), aboveBase.end(), aboveTip.begin(),
                                  aboveTip.end(), std::inserter(group.joints, group.joints.end()));
    return true;
  }

  void readGroups(Element& root) {
    forEach(root, "group", [&](Element& element) {
      const auto name = file_.text(element, "name", "");
      if (!name) return;
      if (const Group* first = findGroup(*name))
        return note(element, owned("group", *name) + " is already defined on line " +
                                 std::to_string(first->element->GetLineNum()) +
                                 "; this definition is ignored");
      groups_.push_back({*name, &element, {}, {}, {}, ""});
      groupNames_.add(*name);
    });
    for (Group& group : groups_) readGroup(group);
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      Group& group = groups_[i];
      const Members members = membersOf(i);
      std::string unusable = members.unusable;
      if (members.joints.empty() && unusable.empty())
        unusable = "it has no joint that the URDF has";
      if (!unusable.empty()) {
        model_.unusable.groups[group.name] = file_.at(group.element->GetLineNum(), unusable);
        continue;
      }
      std::vector<std::string>& names = model_.groups[group.name];
      for (const std::size_t j : members.joints) names.push_back(joints_[j]);
      if (!members.missing.empty()) model_.missingMembers[group.name] = members.missing;
    }
    for (const Group& group : groups_) unknownMembers_.add(group.missing);
  }

  const Group* findGroup(const std::string& name) const {
    const auto found = groupNames_.find(name);
    return found ? &groups_[*found] : nullptr;
  }

  void readGroup(Group& group) {
    const std::string owner = owned("group", group.name);
    file_.checkChildren(*group.element, {"joint", "link", "chain", "group"}, {}, owner,
                        model_.notes);
    forEach(*group.element, "joint", [&](Element& element) {
      if (const auto joint = findJoint(element, "name", owner, group.missing))
        group.joints.insert(*joint);
      else if (!isVirtual(element.Attribute("name")))
        ++group.missing.count;
    });
    forEach(*group.element, "link", [&](Element& element) {
      const auto link = findLink(element, "name", owner, group.missing);
      group.missing.count += !link;
      if (link && parentJoint_[*link] != none) group.joints.insert(parentJoint_[*link]);
    });
    forEach(*group.element, "chain",
            [&](Element& element) { group.missing.count += !addChain(element, owner, group); });
    forEach(*group.element, "group", [&](Element& element) {
      const auto name = file_.text(element, "name", owner);
      if (!name) return;
      if (const Group* inner = findGroup(*name))
        group.subgroups.push_back(static_cast<std::size_t>(inner - groups_.data()));
      else if (group.unusable.empty())
        group.unusable = "there is no " + owned("group", *name) + " in the SRDF" +
                         didYouMean(*name, groupNames_.all());
    });
  }

  /// What a group contains, with all groups in it, at any depth.
  struct Members {
    Joints joints;
    std::vector<std::string> missing;  ///< names that the URDF lacks
    std::string unusable;              ///< the reason why the group can't be made, or ""
  };

  Members membersOf(std::size_t root) const {
    Members members;
    std::vector<std::size_t> above(groups_.size(), none), open{root};
    for (std::size_t k = 0; k < open.size(); ++k) {
      const Group& group = groups_[open[k]];
      members.joints.insert(group.joints.begin(), group.joints.end());
      for (const std::string& name : group.missing.names)  // messages name at most 30
        if (members.missing.size() < 31 && std::find(members.missing.begin(), members.missing.end(),
                                                     name) == members.missing.end())
          members.missing.push_back(name);
      if (members.unusable.empty()) members.unusable = group.unusable;
      for (const std::size_t inner : group.subgroups) {
        if (inner == root) {
          members.unusable = circleText(root, open[k], above);
          return members;
        }
        if (above[inner] != none) continue;
        above[inner] = open[k];
        open.push_back(inner);
      }
    }
    return members;
  }

  std::string circleText(std::size_t root, std::size_t last,
                         const std::vector<std::size_t>& above) const {
    std::vector<std::string> names{groupNames_[root]};
    for (std::size_t i = last; i != root; i = above[i]) names.push_back(groupNames_[i]);
    names.push_back(names.front());
    std::reverse(names.begin(), names.end());
    return "it contains itself: " + joinedFirst(names);
  }

  struct State {
    std::string name, group;  ///< group: empty if none is named
    int line = 0;
    std::map<std::string, double> values;
    std::string unusable;  ///< the reason why the state can't be made, or ""
  };

  void readStates(Element& root) {
    std::vector<State> states;
    std::map<std::pair<std::string, std::string>, std::size_t> indices;  // by name and group
    std::map<std::string, int> count;  // number of states with each name
    forEach(root, "group_state", [&](Element& element) {
      const auto name = file_.text(element, "name", "");
      if (!name) return;
      State state{*name, "", element.GetLineNum(), {}, ""};
      const std::string owner = owned("state", *name);
      file_.checkChildren(element, {"joint"}, {}, owner, model_.notes);
      if (const char* group = element.Attribute("group"))
        state.group = group;
      else
        note(element, owner + " names no group; its values are taken as they are");
      std::vector<std::string> fixed;
      forEach(element, "joint", [&](Element& joint) { readValue(joint, owner, state, fixed); });
      if (!fixed.empty())
        note(element, owner +
                          ": the values of joints that do not move by themselves are ignored: " +
                          joined(fixed));
      if (state.values.empty() && fixed.empty() && state.unusable.empty())
        state.unusable = "it has no value of a joint that the URDF has";
      const auto [first, isNew] =
          indices.emplace(std::pair{state.name, state.group}, states.size());
      if (isNew) {
        ++count[state.name];
        states.push_back(std::move(state));
        return;
      }
      State& before = states[first->second];  // as in MoveIt, the last one counts
      note(element, owner + " is already defined on line " + std::to_string(before.line) +
                        "; that definition is ignored");
      before = std::move(state);
    });
    for (State& state : states) {
      const bool shared = count[state.name] > 1;
      // Two groups may both have a "home".
      const std::string name =
          shared && !state.group.empty() ? state.group + "/" + state.name : state.name;
      if (!state.unusable.empty()) {
        model_.unusable.states[name] = file_.at(state.line, state.unusable);
        continue;
      }
      model_.states[name] = state.values;
      if (findGroup(state.group)) model_.stateGroup[name] = state.group;
    }
  }

  void readValue(Element& element, const std::string& owner, State& state,
                 std::vector<std::string>& ignored) {
    const auto index = findJoint(element, "name", owner, unknownValues_);
    if (!index) {
      unknownValues_.count += !isVirtual(element.Attribute("name"));
      return;
    }
    const JointModel& joint = model_.joints[*index];
    const bool planar = joint.type == JointType::planar;
    const std::vector<const char*> parts =
        planar ? std::vector{"/x", "/y", "/yaw"}
        : joint.type == JointType::floating
            ? std::vector{"/x", "/y", "/z", "/qx", "/qy", "/qz", "/qw"}
            : std::vector{""};
    if (joint.type == JointType::fixed || joint.mimic) return ignored.push_back(joint.name);
    file_.require(element, "value", owner);
    const auto numbers =
        file_.numbers(element, "value", parts.size(), owner + ": " + owned("joint", joint.name));
    if (!numbers) state.unusable = "its value of " + owned("joint", joint.name) + " is not sound";
    for (std::size_t i = 0; numbers && i < parts.size(); ++i)
      state.values[joint.name + parts[i]] = (*numbers)[i];
  }

  static std::pair<std::string, std::string> pairOf(const std::string& a, const std::string& b) {
    return std::minmax(a, b);
  }

  /// Returns the two links of a pair. nullopt: the URDF lacks one, or it isn't given.
  std::optional<std::pair<std::size_t, std::size_t>> findPair(const Element& element) {
    const auto a = findLink(element, "link1", "", unknownPairs_);
    const auto b = findLink(element, "link2", "", unknownPairs_);
    if (a && b) return std::pair{*a, *b};
    ++unknownPairs_.count;
    return std::nullopt;
  }

  void readPairs(Element& root) {
    std::set<std::pair<std::string, std::string>> allowed, enabled;
    for (const AllowedPair& pair : model_.allowed) allowed.insert(pairOf(pair.a, pair.b));
    const auto allow = [&](const std::string& a, const std::string& b, const std::string& reason) {
      if (allowed.insert(pairOf(a, b)).second) model_.allowed.push_back({a, b, reason});
    };
    forEach(root, "disable_collisions", [&](Element& element) {
      const auto pair = findPair(element);
      const char* const reason = element.Attribute("reason");
      if (pair)
        allow(links_[pair->first], links_[pair->second],
              reason ? "SRDF: " + std::string(reason) : "SRDF");
    });
    forEach(root, "enable_collisions", [&](Element& element) {
      if (const auto pair = findPair(element))
        enabled.insert(pairOf(links_[pair->first], links_[pair->second]));
    });
    forEach(root, "disable_default_collisions", [&](Element& element) {
      const auto link = findLink(element, "link", "", unknownPairs_);
      unknownPairs_.count += !link;
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
  UnknownNames unknownMembers_, unknownValues_, unknownPassive_, unknownPairs_;
  std::set<std::string> usedNames_, unknownNames_;  // of links and joints
};

}  // namespace

void readSrdf(const std::filesystem::path& file, RobotModel& model, std::vector<Fault>& faults) {
  XmlFile xml(file, "a robot's groups and pairs (SRDF)");
  if (xml.root()) SrdfReader(xml, model).read();
  for (Fault& fault : xml.takeFaults()) faults.push_back(std::move(fault));
}

}  // namespace corridor
