#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "collision/core/spelling.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/urdf_outline.h"

namespace corridor {
namespace {

class Tree {
 public:
  Tree(const UrdfOutline& outline, RobotFaults& faults)
      : outline_(outline),
        links_(outline.links),
        joints_(outline.joints),
        faults_(faults),
        parentJoint_(links_.size(), kNoIndex),
        children_(links_.size()) {
    for (std::size_t i = 0; i < links_.size(); ++i) linkIndex_[links_[i].name] = i;
  }

  std::vector<std::size_t> check() {
    bool joined = outline_.complete;
    for (std::size_t j = 0; j < joints_.size(); ++j) joined &= join(j);
    // If a joint names a misspelt link, or was left out, its child has no parent. `checkShape`
    // would then also report the child as a second root.
    if (joined) checkShape();
    return faults_.sound() ? order() : std::vector<std::size_t>();
  }

 private:
  /// Joins two links. @returns false if a fault was reported.
  bool join(std::size_t j) {
    const UrdfJoint& joint = joints_[j];
    const std::string owner = owned("joint", joint.name);
    bool known = true;
    for (const auto& [what, name] :
         {std::pair{"parent", joint.parent}, std::pair{"child", joint.child}}) {
      if (!name.empty() && !linkIndex_.contains(name))
        faults_.fault(joint.line, owner + ": its " + what + " " + quotedWord(name) +
                                      " is not a link of this robot" + hint(name));
      known &= linkIndex_.contains(name);
    }
    if (!known) return false;
    if (joint.parent == joint.child) {
      faults_.fault(joint.line, owner + ": its parent and its child are the same link " +
                                    quotedWord(joint.child));
      return false;
    }
    const std::size_t child = linkIndex_.at(joint.child);
    if (const std::size_t first = parentJoint_[child]; first != kNoIndex) {
      faults_.fault(joint.line, owner + ": its child " + quotedWord(joint.child) +
                                    " is already the child of joint " +
                                    quotedWord(joints_[first].name) + onLine(joints_[first].line) +
                                    "; a link can have only one parent");
      return false;
    }
    parentJoint_[child] = j;
    children_[linkIndex_.at(joint.parent)].push_back(j);
    return true;
  }

  /// " (did you mean …?)" with the nearest link, or empty.
  std::string hint(const std::string& name) const {
    if (!faults_.hints()) return "";
    std::vector<std::string> names;
    for (const UrdfLink& link : links_) names.push_back(link.name);
    return didYouMean(name, names);
  }

  std::size_t parentOf(std::size_t link) const {
    return parentJoint_[link] == kNoIndex ? kNoIndex
                                          : linkIndex_.at(joints_[parentJoint_[link]].parent);
  }

  void checkShape() {
    std::size_t root = kNoIndex;
    for (std::size_t link = 0; link < links_.size(); ++link) {
      if (parentJoint_[link] != kNoIndex) continue;
      if (root == kNoIndex)
        root = link;
      else
        faults_.fault(links_[link].line, owned("link", links_[link].name) +
                                             " is not a child of any joint, and neither is " +
                                             quotedWord(links_[root].name) +
                                             onLine(links_[root].line) +
                                             "; a robot can have only one root");
    }
    // Every link has at most one parent. So a link that is not below a root is in a cycle, or below
    // a cycle.
    std::vector<int> walk(links_.size(), 0);
    for (std::size_t start = 0; start < links_.size(); ++start) {
      std::size_t link = start;
      for (; link != kNoIndex && walk[link] == 0; link = parentOf(link))
        walk[link] = static_cast<int>(start) + 1;
      if (link != kNoIndex && walk[link] == static_cast<int>(start) + 1) faultCycle(link);
    }
  }

  void faultCycle(std::size_t link) {
    std::vector<std::string> names{links_[link].name};
    int line = joints_[parentJoint_[link]].line;
    for (std::size_t other = parentOf(link); other != link; other = parentOf(other)) {
      names.push_back(links_[other].name);
      line = std::min(line, joints_[parentJoint_[other]].line);
    }
    names.push_back(links_[link].name);
    std::reverse(names.begin(), names.end());
    faults_.fault(line, "the links " + joinedFirst(names) + " form a cycle; a tree is needed");
  }

  std::vector<std::size_t> order() const {
    std::vector<std::size_t> ordered, open;
    const auto push = [&](std::size_t link) {
      open.insert(open.end(), children_[link].rbegin(), children_[link].rend());
    };
    for (std::size_t link = 0; link < links_.size(); ++link)
      if (parentJoint_[link] == kNoIndex) push(link);
    while (!open.empty()) {
      const std::size_t j = open.back();
      open.pop_back();
      ordered.push_back(j);
      push(linkIndex_.at(joints_[j].child));
    }
    return ordered;
  }

  const UrdfOutline& outline_;
  const std::vector<UrdfLink>& links_;
  const std::vector<UrdfJoint>& joints_;
  RobotFaults& faults_;
  std::unordered_map<std::string, std::size_t> linkIndex_;
  std::vector<std::size_t> parentJoint_;            // for each link: the joint whose child it is
  std::vector<std::vector<std::size_t>> children_;  // for each link: the joints whose parent it is
};

}  // namespace

std::vector<std::size_t> checkUrdfTree(const UrdfOutline& outline, RobotFaults& faults) {
  return Tree(outline, faults).check();
}

Vec3 scaledAxis(const Vec3& axis) {
  const int exponent = std::ilogb(axis.cwiseAbs().maxCoeff());
  return {std::scalbn(axis.x(), -exponent), std::scalbn(axis.y(), -exponent),
          std::scalbn(axis.z(), -exponent)};
}

void finishRobot(const std::vector<std::size_t>& order,
                 const std::vector<std::optional<Mimic>>& mimics, RobotDescription& model) {
  std::vector<bool> hasParent(model.links.size(), false);
  std::vector<std::size_t> place(order.size());  // for each outline joint, its index in the model
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = k;
  for (std::size_t k = 0; k < order.size(); ++k) {
    JointModel& joint = model.joints[k];
    if (const auto& rule = mimics[order[k]])
      joint.mimic = Mimic{place[rule->joint], rule->multiplier, rule->offset};
    hasParent[joint.child] = true;
    // Two links that are joined by a planar or floating joint can collide, so this pair is tested.
    if (!isPoseJoint(joint.type))
      model.allowed.push_back(
          {model.links[joint.parent].name, model.links[joint.child].name, "adjacent"});
  }
  model.root = static_cast<std::size_t>(std::find(hasParent.begin(), hasParent.end(), false) -
                                        hasParent.begin());
}

}  // namespace corridor
