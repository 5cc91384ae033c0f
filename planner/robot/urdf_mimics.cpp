#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/robot/angles.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/urdf_outline.h"

namespace corridor {
namespace {

struct JointRange {
  double lower = 0, upper = 0;
  std::string text() const { return "[" + shortest(lower) + ", " + shortest(upper) + "]"; }
};

/// Returns the joint's own range. A limit that is not given is 0, as in urdfdom.
JointRange rangeOf(const UrdfJoint& joint) {
  if (!joint.limit) return {};
  return {joint.limit->lower.value_or(0), joint.limit->upper.value_or(0)};
}

bool hasRange(const UrdfJoint& joint) {
  return joint.type == JointType::revolute || joint.type == JointType::prismatic;
}

class Mimics {
 public:
  Mimics(const UrdfOutline& outline, RobotFaults& faults, std::vector<Note>& notes)
      : joints_(outline.joints),
        faults_(faults),
        notes_(notes),
        leader_(joints_.size(), kNoIndex),
        walk_(joints_.size(), kNoIndex),
        rules_(joints_.size()) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      indices_[joints_[j].name] = j;
      names_.push_back(joints_[j].name);
    }
  }

  std::vector<std::optional<Mimic>> resolve() {
    for (std::size_t j = 0; j < joints_.size(); ++j) findLeader(j);
    for (std::size_t j = 0; j < joints_.size(); ++j) resolve(j);
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (leader_[j] == kNoIndex) checkRange(joints_[j]);
      if (rules_[j]) noteFollower(joints_[j], *rules_[j]);
    }
    return std::move(rules_);
  }

 private:
  void findLeader(std::size_t j) {
    const UrdfJoint& joint = joints_[j];
    // The <mimic> of a fixed joint is ignored, as in other readers of URDF.
    if (!joint.mimic || !joint.type || joint.type == JointType::fixed) return;
    const int line = joint.mimic->line;
    const std::string owner = owned("joint", joint.name);
    if (isPoseJoint(*joint.type))
      return faults_.fault(line, owner + " is " + nameOf(*joint.type) +
                                     ", and only a joint of one variable can mimic another");
    if (joint.mimic->joint == joint.name) return faults_.fault(line, owner + " mimics itself");
    const auto found = indices_.find(joint.mimic->joint);
    if (found == indices_.end())
      return addLost(joint, "not a joint of this robot",
                     hints_-- > 0 ? didYouMean(joint.mimic->joint, names_) : "");
    const UrdfJoint& leader = joints_[found->second];
    if (!leader.type) return;
    if (leader.type == JointType::fixed || isPoseJoint(*leader.type))
      return addLost(joint, nameOf(*leader.type) + ", not a joint of one variable", "");
    leader_[j] = found->second;
  }

  /// Handles a joint whose <mimic> names an unusable joint: a joint that is not in the robot, or
  /// that is not of one variable. The mimicking joint is then used as a joint of its own, within
  /// its own limits. Reports a fault if the mimicking joint needs limits and has none.
  void addLost(const UrdfJoint& joint, const std::string& why, const std::string& hint) {
    const std::string text = owned("joint", joint.name) + " mimics " +
                             quotedWord(joint.mimic->joint) + ", which is " + why;
    const bool needed = hasRange(joint);
    if (needed && (!joint.limit || (!joint.limit->lower && !joint.limit->upper)))
      faults_.fault(joint.mimic->line,
                    text + hint +
                        "; and it has no lower or upper limit with which it could be used "
                        "as a joint of its own");
    else
      notes_.push_back({faults_.at(joint.mimic->line,
                                   text +
                                       (needed && rangeOf(joint).lower == rangeOf(joint).upper
                                            ? "; it can't move, since its own limits are equal"
                                            : "; it is used as a joint of its own") +
                                       hint),
                        NoteWeight::motion});
  }

  /// Makes the rules of a joint and of all joints that it follows. Reports a fault if these joints
  /// form a cycle.
  void resolve(std::size_t start) {
    std::vector<std::size_t> chain;
    std::size_t j = start;
    for (; leader_[j] != kNoIndex && !rules_[j] && walk_[j] == kNoIndex; j = leader_[j]) {
      walk_[j] = start;
      chain.push_back(j);
    }
    if (leader_[j] != kNoIndex &&
        !rules_[j]) {  // a cycle, which is reported by the first walk that meets it
      if (walk_[j] == start && !chain.empty()) faultCycle(j);
      return;
    }
    for (; !chain.empty(); chain.pop_back()) {
      const std::size_t k = chain.back();
      const UrdfMimic& mimic = *joints_[k].mimic;
      Mimic rule{leader_[k], mimic.multiplier, mimic.offset};
      if (const auto& above = rules_[leader_[k]])
        rule = {above->joint, mimic.multiplier * above->multiplier,
                mimic.multiplier * above->offset + mimic.offset};
      rules_[k] = rule;
      checkRule(joints_[k], rule);
    }
  }

  void faultCycle(std::size_t first) {
    std::vector<std::string> names{joints_[first].name};
    for (std::size_t j = leader_[first]; j != first; j = leader_[j])
      names.push_back(joints_[j].name);
    names.push_back(joints_[first].name);
    faults_.fault(joints_[first].mimic->line,
                  "the joints " + joinedFirst(names) + " mimic each other in a cycle");
  }

  void checkRule(const UrdfJoint& joint, const Mimic& rule) {
    const int line = joint.mimic->line;
    const UrdfJoint& leader = joints_[rule.joint];
    if (!std::isfinite(rule.multiplier) || !std::isfinite(rule.offset))
      return faults_.fault(line, owned("joint", joint.name) + " mimics " + quotedWord(leader.name) +
                                     " by a multiplier of " + shortest(rule.multiplier) +
                                     " and an offset of " + shortest(rule.offset) +
                                     ", which is out of the range of doubles");
    if (leader.type != JointType::continuous || rule.multiplier == 0) return;
    if (joint.type == JointType::prismatic)
      faults_.fault(
          line, owned("joint", joint.name) + " is prismatic and mimics " + quotedWord(leader.name) +
                    ", which is continuous and repeats after a full turn; change the type "
                    "of one of them");
    else if (rule.multiplier != std::round(rule.multiplier))
      faults_.fault(line, owned("joint", joint.name) + " mimics " + quotedWord(leader.name) +
                              ", which is continuous and repeats after a full turn, by the "
                              "multiplier " +
                              shortest(rule.multiplier) +
                              "; use a whole multiplier or a revolute " + quotedWord(leader.name));
  }

  /// Checks the range of a joint that mimics no other joint.
  void checkRange(const UrdfJoint& joint) {
    if (!hasRange(joint)) return;
    const std::string owner = owned("joint", joint.name);
    if (!joint.limit) {
      if (!joint.mimic)  // else addLost() has reported it
        faults_.fault(joint.line, owner + ": <limit lower=\"…\" upper=\"…\"/> is missing" +
                                      (joint.type == JointType::revolute
                                           ? "; a joint without limits is of type continuous"
                                           : ""));
      return;
    }
    const auto& lower = joint.limit->lower;
    const auto& upper = joint.limit->upper;
    const int line = joint.limit->line;
    const JointRange range = rangeOf(joint);
    // A joint of several turns has limits of at most 30 rad; degrees are at most a few hundred.
    constexpr double mostRadians = 30, mostDegrees = 1000;
    const double largest = std::max(std::abs(range.lower), std::abs(range.upper));
    const bool isRevolute = joint.type == JointType::revolute;
    if (isRevolute && largest > mostDegrees)
      notes_.push_back({faults_.at(line, owner + ": its limits, " + range.text() +
                                             ", are in radians; a joint without limits is of type "
                                             "continuous"),
                        NoteWeight::motion});
    else if (isRevolute &&
             (largest > mostRadians || seemsDegrees(range.lower) || seemsDegrees(range.upper)))
      notes_.push_back({faults_.at(line, owner + ": its limits, " + range.text() +
                                             ", are in radians, as URDF requires; are these "
                                             "degrees?"),
                        NoteWeight::motion});
    if (std::isinf(range.upper - range.lower))
      faults_.fault(line, owner + ": the range from " + shortest(range.lower) + " to " +
                              shortest(range.upper) + " is larger than any double");
    if (range.lower > range.upper)
      faults_.fault(line, owner + ": the lower limit " + shortest(range.lower) +
                              " is above the upper limit " + shortest(range.upper));
    if (!lower && !upper && !joint.mimic)
      notes_.push_back(
          {faults_.at(line, owner + ": <limit> has neither lower nor upper, so both are 0, and the "
                                    "joint cannot move"),
           NoteWeight::motion});
    else if (!lower != !upper)
      notes_.push_back({faults_.at(line, owner + ": <limit> has no " + (lower ? "upper" : "lower") +
                                             ", so it is 0"),
                        NoteWeight::motion});
  }

  /// Adds a note if a follower leaves its own limits while its leader stays within the leader's
  /// limits.
  void noteFollower(const UrdfJoint& follower, const Mimic& rule) {
    if (!hasRange(follower) || !follower.limit) return;
    if (!follower.limit->lower && !follower.limit->upper) return;
    const UrdfJoint& leader = joints_[rule.joint];
    const JointRange own = rangeOf(follower);
    const std::string text = owned("joint", follower.name) + ": its limits, " + own.text() +
                             ", are ignored: it mimics " + quotedWord(leader.name) + ", which ";
    const bool stands = rule.multiplier == 0;
    if (!stands && !hasRange(leader))
      return notes_.push_back(
          {faults_.at(follower.mimic->line, text + "is continuous, without limits"),
           NoteWeight::motion});
    const JointRange limits = rangeOf(leader);
    const double a = stands ? rule.offset : rule.multiplier * limits.lower + rule.offset;
    const double b = stands ? rule.offset : rule.multiplier * limits.upper + rule.offset;
    const JointRange range{std::min(a, b), std::max(a, b)};
    // The slack allows for rounding: ranges that differ only by two roundings at each end agree.
    const double slack =
        0x1p-50 * (std::abs(rule.offset) + std::abs(own.lower) + std::abs(own.upper));
    if (range.lower >= own.lower - slack && range.upper <= own.upper + slack) return;
    notes_.push_back({faults_.at(follower.mimic->line, text + "moves it in " + range.text()),
                      NoteWeight::motion});
  }

  const std::vector<UrdfJoint>& joints_;
  RobotFaults& faults_;
  std::vector<Note>& notes_;
  std::unordered_map<std::string, std::size_t> indices_;
  std::vector<std::string> names_;
  std::vector<std::size_t> leader_;  // for each joint: the joint that it mimics
  std::vector<std::size_t> walk_;  // for each joint: the start of the walk in `resolve` that met it
  std::vector<std::optional<Mimic>> rules_;
  int hints_ = 10;  // number of searches for similar names still allowed; each visits all names
};

}  // namespace

std::vector<std::optional<Mimic>> resolveMimics(const UrdfOutline& outline, RobotFaults& faults,
                                                std::vector<Note>& notes) {
  return Mimics(outline, faults, notes).resolve();
}

}  // namespace corridor
