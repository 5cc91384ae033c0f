#include "planner/checker/left_out.h"

#include <algorithm>
#include <utility>

#include "collision/core/spelling.h"
#include "planner/checker/fixed_pairs.h"
#include "planner/problem/problem.h"

namespace corridor {
namespace {

constexpr std::string_view kAllow = "allow", kSceneAllows = "allowed_collision_matrix";

bool isOfOneRobot(const Model& model, std::size_t a, std::size_t b) {
  return model.bodies[a].robot && model.bodies[a].robot == model.bodies[b].robot;
}

/// Returns everything except the pairs that touch at rest.
LeftOut leftOutByFilter(const Model& model, const Required& need) {
  LeftOut leftOut;
  forEachPair(model, need, [&](std::size_t a, std::size_t b, std::string_view why) {
    if (why.empty() || why == kTestedAtRest) {
      ++(why.empty() ? leftOut.tested : leftOut.testedAtRest);
      return;
    }
    ++leftOut.reasons[std::string(why)];
    if (why == kAllow) leftOut.except.push_back({a, b, LeftOutReason::allowed});
    if (isOfOneRobot(model, a, b)) return;
    if (why == kSceneAllows) leftOut.except.push_back({a, b, LeftOutReason::allowedInTheScene});
  });
  return leftOut;
}

void addFixedPairs(const Checker& checker, LeftOut& leftOut) {
  for (const FixedPair& pair : closeFixedPairs(checker, zeroConfiguration(checker.space())))
    leftOut.except.push_back(
        {pair.a, pair.b,
         pair.touches ? LeftOutReason::touchesAtRest : LeftOutReason::isCloseAtRest});
  std::sort(leftOut.except.begin(), leftOut.except.end(),
            [](const LeftOutPair& x, const LeftOutPair& y) {
              return std::pair(x.a, x.b) < std::pair(y.a, y.b);
            });
}

}  // namespace

const char* nameOf(LeftOutReason reason) {
  switch (reason) {
    case LeftOutReason::touchesAtRest:
      return "touch at rest";
    case LeftOutReason::isCloseAtRest:
      return "within the margin at rest";
    case LeftOutReason::allowed:
      return kAllow.data();
    case LeftOutReason::allowedInTheScene:
      return kSceneAllows.data();
  }
  return "";
}

LeftOut leftOutOf(const Checker& checker) {
  LeftOut leftOut = leftOutByFilter(checker.model(), checker.required());
  addFixedPairs(checker, leftOut);
  return leftOut;
}

LeftOut leftOutOf(const Problem& problem) {
  LeftOut leftOut = leftOutByFilter(problem.model, requiredBy(problem.task));
  if (hasFixedPairs(problem.model)) addFixedPairs(Checker(problem), leftOut);
  return leftOut;
}

std::string exceptText(const Model& model, const LeftOut& leftOut) {
  if (leftOut.except.empty()) return "";
  constexpr std::size_t kShown = 4;
  std::vector<std::string> names;
  bool isOneClose = false;
  for (const LeftOutPair& pair : leftOut.except) {
    names.push_back(model.bodies[pair.a].name + " ~ " + model.bodies[pair.b].name);
    isOneClose = isOneClose || pair.reason == LeftOutReason::isCloseAtRest;
  }
  const bool isOne = names.size() == 1;
  const std::string is = isOne ? "is" : "are";
  return ", except " + std::to_string(names.size()) +
         (isOne ? " pair that touches" : " pairs that touch") +
         (isOneClose ? " or " + is + " within the margin at rest, or " : " at rest or ") + is +
         " allowed to: " + joinedFirst(names, kShown);
}

std::map<std::string, std::size_t> reasonGroups(const LeftOut& leftOut) {
  constexpr std::string_view robot = "robot.yaml: ";
  std::map<std::string, std::size_t> groups;
  for (const auto& [reason, count] : leftOut.reasons)
    groups[reason.starts_with("SRDF")  ? "SRDF"
           : reason.starts_with(robot) ? reason.substr(robot.size())
                                       : reason] += count;
  return groups;
}

std::string notTestedText(const LeftOut& leftOut) {
  const std::map<std::string, std::size_t> groups = reasonGroups(leftOut);
  std::vector<std::pair<std::string, std::size_t>> bySize(groups.begin(), groups.end());
  std::stable_sort(bySize.begin(), bySize.end(),
                   [](const auto& x, const auto& y) { return x.second > y.second; });
  std::size_t sum = 0;
  std::vector<std::string> texts;
  for (const auto& [reason, count] : bySize) {
    sum += count;
    texts.push_back(std::to_string(count) + " " + reason +
                    (reason == "never_in_contact" ? " (proved)" : ""));
  }
  if (sum == 0) return "no pair";
  return std::to_string(sum) + (sum == 1 ? " pair: " : " pairs: ") + joined(texts);
}

}  // namespace corridor
