#include <algorithm>
#include <cstdint>
#include <map>
#include <set>

#include "planner/problem/assembly.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/nothing_tested.h"

namespace corridor {
namespace {

constexpr const char* kNeverMove = "never move against each other";

/// Returns for each frame the nearest one that a variable moves, among the frame itself and those
/// above it, or else the world. Two frames move against each other if theirs differ.
std::vector<std::size_t> movers(const KinematicTree& tree) {
  std::vector<std::size_t> mover(tree.frames.size(), 0);
  for (std::size_t i = 1; i < tree.frames.size(); ++i)
    mover[i] =
        tree.frames[i].joint != Frame::Joint::none && tree.frames[i].variable != Frame::noVariable
            ? i
            : mover[tree.frames[i].parent];
  return mover;
}

using LinkPair = std::pair<std::string, std::string>;

LinkPair sorted(const std::string& a, const std::string& b) {
  return a < b ? LinkPair{a, b} : LinkPair{b, a};
}

/// Returns the pairs of a robot's links that are not tested, with the reasons: pairs that SRDF and
/// robot.yaml allow, and adjacent links. Links are adjacent if one is above the other in the tree
/// and no link between them has shapes. At most one joint between them is not fixed, and it is
/// neither planar nor floating: over two joints, or one of these, links can meet anywhere.
std::map<LinkPair, std::string> allowedLinks(const RobotModel& model,
                                             const std::set<std::string>& withShapes) {
  std::map<LinkPair, std::string> reasons;
  for (const AllowedPair& pair : model.allowed)
    reasons.emplace(sorted(pair.a, pair.b), pair.reason);
  std::vector<const JointModel*> above(model.links.size(), nullptr);
  for (const JointModel& joint : model.joints) above[joint.child] = &joint;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    int moving = 0;
    for (const JointModel* joint = above[link]; joint; joint = above[joint->parent]) {
      if (joint->type != JointType::fixed) moving += isWhole(joint->type) ? 2 : 1;
      if (moving > 1) break;
      const std::string& other = model.links[joint->parent].name;
      if (!withShapes.contains(other)) continue;
      reasons.emplace(sorted(model.links[link].name, other), "adjacent");
      break;
    }
  }
  return reasons;
}

/// Returns for example "a ~ b, c ~ d, e ~ f, g ~ h and 3 more".
std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, words.size()); ++i) text += (i ? ", " : "") + words[i];
  return words.size() <= most ? text
                              : text + " and " + std::to_string(words.size() - most) + " more";
}

/// Returns the name of the body's link without the robot's prefix.
std::string linkOf(const Problem& problem, const ProblemBody& body) {
  const ProblemRobot& robot = problem.robots[*body.robot];
  return robot.name.empty() || body.name == robot.name ? body.name
                                                       : body.name.substr(robot.name.size() + 1);
}

/// @throws InputError
void requireFewPairs(const Problem& problem) {
  constexpr double most = 1e7;  // takes some 500 MB
  const auto bodies = static_cast<double>(problem.bodies.size());
  const auto still = static_cast<double>(
      std::count_if(problem.bodies.begin(), problem.bodies.end(),
                    [](const ProblemBody& body) { return !body.robot.has_value(); }));
  const double pairs = (bodies * (bodies - 1) - still * (still - 1)) / 2;
  if (pairs > most)
    throw InputError(Fault{problem.file.string(), 0,
                           "has " + std::to_string(static_cast<std::uint64_t>(pairs)) +
                               " pairs of bodies, at most 10000000 are handled; join shapes that "
                               "do not move against each other into one body"});
}

}  // namespace

void setPairs(const AllowedBodies& allowed, Problem& problem) {
  requireFewPairs(problem);
  const std::vector<std::size_t> mover = movers(problem.tree);
  std::vector<std::map<LinkPair, std::string>> reasons;
  for (std::size_t r = 0; r < problem.robots.size(); ++r) {
    std::set<std::string> withShapes;
    for (const ProblemBody& body : problem.bodies)
      if (body.robot == r) withShapes.insert(linkOf(problem, body));
    reasons.push_back(allowedLinks(problem.robots[r].model, withShapes));
  }
  std::set<std::pair<std::size_t, std::size_t>> mayTouch;
  for (const auto& pair : allowed) mayTouch.insert(std::minmax(pair[0], pair[1]));
  const auto reasonOf = [&](std::size_t i, std::size_t j) -> std::string {
    const ProblemBody &a = problem.bodies[i], &b = problem.bodies[j];
    if (mayTouch.contains({i, j})) return "allow";
    if (a.robot && a.robot == b.robot) {
      const auto& links = reasons[*a.robot];
      const auto found = links.find(sorted(linkOf(problem, a), linkOf(problem, b)));
      if (found != links.end()) return found->second;
    }
    return mover[a.frame] == mover[b.frame] ? kNeverMove : "";
  };

  problem.pairs.clear();
  std::vector<std::string> still;
  std::vector<std::size_t> all(problem.bodies.size()), ofRobots;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = i;
    if (problem.bodies[i].robot) ofRobots.push_back(i);
  }
  for (const std::size_t i : all) {
    const ProblemBody& a = problem.bodies[i];
    const std::vector<std::size_t>& others = a.robot ? all : ofRobots;
    for (auto next = std::upper_bound(others.begin(), others.end(), i); next != others.end();
         ++next) {
      const std::size_t j = *next;
      const ProblemBody& b = problem.bodies[j];
      problem.pairs.push_back({i, j, reasonOf(i, j)});
      if (problem.pairs.back().skipped == kNeverMove && a.robot != b.robot)
        still.push_back(a.name + " ~ " + b.name);
    }
  }
  if (!still.empty())
    problem.notes.push_back("not tested, since they never move against each other: " +
                            listed(still));
  if (nothingIsTested(problem)) problem.notes.insert(problem.notes.begin(), kNothingTested);
}

}  // namespace corridor
