#include "planner/solve/replan_on_target.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include "planner/checker/problem_state_space.h"
#include "planner/solve/simplify_path.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

/// The longest edge of a search, as a fraction of the distance between its ends; but at least
/// kLeastRange, in the space's distance.
constexpr double kRange = 0.25, kLeastRange = 0.2;
/// A search may use states through which the path is longer than allowed, up to this factor: it is
/// shortened afterwards.
constexpr double kLonger = 1.2;

/// The number of searches for the same stretch: each finds another path.
constexpr int kSearches = 3;
/// If one found a stretch that is too long by less than this factor, there are more of them.
constexpr double kNearlyShort = 1.25;
constexpr int kMoreSearches = 12;
/// Edges that each search may test at first. If none succeeds, it is multiplied by four.
constexpr std::uint64_t kEdges = 600;
/// Rounds of a search that count as an edge. (In many, both ends of the edge are out of the
/// ellipse.)
constexpr std::uint64_t kRoundsOfEdge = 100;

/// The states through which a path from one state to another may be short enough.
class Ellipse {
 public:
  Ellipse(const ConfigurationSpace& space, const Configuration& from, const Configuration& to,
          double longest)
      : space_(space), from_(from), to_(to), longest_(longest) {}
  bool contains(const Configuration& q) const {
    return space_.inBounds(q) && space_.distance(from_, q) + space_.distance(q, to_) <= longest_;
  }

 private:
  const ConfigurationSpace& space_;
  const Configuration &from_, &to_;
  double longest_;
};

/// A motion is valid if it keeps all targets, and both ends are in the ellipse.
class TargetValidator final : public ob::MotionValidator {
 public:
  TargetValidator(const ob::SpaceInformationPtr& si, const ClearanceTargets& targets,
                  const Ellipse& ellipse)
      : ob::MotionValidator(si), targets_(targets), ellipse_(ellipse) {}

  bool checkMotion(const ob::State* s1, const ob::State* s2) const override {
    const Configuration from = configurationOf(*si_, s1), to = configurationOf(*si_, s2);
    if (!ellipse_.contains(from) || !ellipse_.contains(to)) return false;
    ++tested_;
    return targets_.areKept(from, to);
  }
  bool checkMotion(const ob::State* s1, const ob::State* s2,
                   std::pair<ob::State*, double>& lastValid) const override {
    if (checkMotion(s1, s2)) return true;
    lastValid.second = 0;
    if (lastValid.first) si_->copyState(lastValid.first, s1);
    return false;
  }
  std::uint64_t tested() const { return tested_; }

 private:
  const ClearanceTargets& targets_;
  const Ellipse& ellipse_;
  mutable std::uint64_t tested_ = 0;
};

class Replanner {
 public:
  Replanner(const std::shared_ptr<ProblemStateSpace>& space, const ClearanceTargets& targets,
            EdgeMemory& free, EdgeMemory& onTarget, const ReplanLimits& limits)
      : space_(space),
        configurations_(space->configurations()),
        targets_(targets),
        free_(free),
        onTarget_(onTarget),
        limits_(limits) {}

  ReplannedPath run(Path path) {
    WhyOffTarget why = WhyOffTarget::unknown;
    // Where the search failed, the edges stay; the next ones are behind them.
    for (std::size_t edge = 0; edge + 1 < path.size() && !isStopped_;) {
      if (isKept(path, edge)) {
        ++edge;
        continue;
      }
      std::size_t first = edge, last = edge + 1;
      while (first > 0 && !isOnTarget(path[first])) --first;
      while (last + 1 < path.size() && !(isOnTarget(path[last]) && isKept(path, last))) ++last;
      const std::size_t behind = path.size() - last;
      foundLonger_ = false;
      if (replaceWider(path, first, last)) {
        edge = 0;
        continue;
      }
      if (foundLonger_ || why == WhyOffTarget::unknown)
        why = foundLonger_ ? WhyOffTarget::detour : WhyOffTarget::notFound;
      edge = path.size() - behind;
    }
    return {std::move(path), isStopped_ ? WhyOffTarget::time : why};
  }

 private:
  bool isKept(const Path& path, std::size_t edge) {
    return onTarget_.isFree(path[edge], path[edge + 1]);
  }
  bool isOnTarget(const Configuration& q) { return onTarget_.isFree(q, q); }

  /// Replaces a stretch of the path, or wider and wider ones around it. @returns whether it did.
  bool replaceWider(Path& path, std::size_t first, std::size_t last) {
    const std::size_t end = path.size() - 1;
    for (std::uint64_t edges = kEdges;; edges *= 4)
      for (std::size_t a = first, b = last, wider = 1;; wider *= 2) {
        // An end of the path may miss a target: because of the tube, or a padding.
        if (!isOnTarget(path[a]) || !isOnTarget(path[b])) return false;
        isNearlyShort_ = false;
        for (int n = 0; n < (isNearlyShort_ ? kMoreSearches : kSearches); ++n) {
          if (tested_ >= limits_.mostEdges) return false;
          if (isStopped_ = isStopped_ || limits_.stop(); isStopped_) return false;
          if (replace(path, a, b, std::min(edges, limits_.mostEdges - tested_))) return true;
        }
        if (a == 0 && b == end) break;
        a -= std::min(a, wider);
        b = std::min(b + wider, end);
        while (a > 0 && !isOnTarget(path[a])) --a;
        while (b < end && !isOnTarget(path[b])) ++b;
      }
  }

  /// Replaces the states between two states by those of a path that keeps all targets. Returns
  /// whether one was found that is short enough.
  bool replace(Path& path, std::size_t first, std::size_t last, std::uint64_t edges) {
    const auto at = [&](std::size_t i) { return path.begin() + static_cast<std::ptrdiff_t>(i); };
    const double others = distanceAlong(configurations_, path) -
                          distanceAlong(configurations_, Path(at(first), at(last + 1)));
    const double longest = limits_.longest - others;
    const std::optional<Path> found = search(path[first], path[last], longest, edges);
    if (!found) return false;
    const Path shorter =
        simplifiedVersions(configurations_, *found, onTarget_, limits_.stop).back();
    if (distanceAlong(configurations_, shorter) > longest) {
      foundLonger_ = true;
      isNearlyShort_ =
          isNearlyShort_ || distanceAlong(configurations_, shorter) < kNearlyShort * longest;
      return false;
    }
    for (std::size_t i = 0; i + 1 < shorter.size(); ++i) {
      free_.addFree(shorter[i], shorter[i + 1]);
      onTarget_.addFree(shorter[i], shorter[i + 1]);
    }
    path.erase(at(first), at(last + 1));
    path.insert(at(first), shorter.begin(), shorter.end());
    return true;
  }

  /// Searches for a path that keeps all targets.
  std::optional<Path> search(const Configuration& from, const Configuration& to, double longest,
                             std::uint64_t edges) {
    const Ellipse ellipse(configurations_, from, to, kLonger * longest);
    const auto si = std::make_shared<ob::SpaceInformation>(space_);
    const auto validator = std::make_shared<TargetValidator>(si, targets_, ellipse);
    si->setStateValidityChecker([&](const ob::State* state) {
      const Configuration q = configurationOf(*si, state);
      return ellipse.contains(q) && targets_.areKept(q, q);
    });
    si->setMotionValidator(validator);
    si->setup();
    const auto definition = std::make_shared<ob::ProblemDefinition>(si);
    ob::ScopedState<> start(si), goal(si);
    space_->write(from, start.get());
    space_->write(to, goal.get());
    definition->setStartAndGoalStates(start, goal);
    og::RRTConnect planner(si);
    planner.setRange(std::min(std::max(kRange * configurations_.distance(from, to), kLeastRange),
                              limits_.range));
    planner.setProblemDefinition(definition);
    planner.setup();
    std::uint64_t rounds = 0;
    planner.solve(ob::PlannerTerminationCondition([&] {
      return validator->tested() >= edges || ++rounds > kRoundsOfEdge * edges || limits_.stop();
    }));
    tested_ += std::max(validator->tested(), rounds / kRoundsOfEdge + 1);
    if (!definition->hasExactSolution()) return std::nullopt;
    Path path = configurationsOf(*definition->getSolutionPath()->as<og::PathGeometric>());
    path.front() = from;
    path.back() = to;
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      if (!onTarget_.isFree(path[i], path[i + 1])) return std::nullopt;
    return path;
  }

  const std::shared_ptr<ProblemStateSpace>& space_;
  const ConfigurationSpace& configurations_;
  const ClearanceTargets& targets_;
  EdgeMemory &free_, &onTarget_;
  const ReplanLimits& limits_;
  std::uint64_t tested_ = 0;
  bool foundLonger_ = false;    // for the present stretch
  bool isNearlyShort_ = false;  // at the present width
  bool isStopped_ = false;
};

}  // namespace

ReplannedPath replannedOnTarget(const std::shared_ptr<ProblemStateSpace>& space,
                                const ClearanceTargets& targets, const Path& path, EdgeMemory& free,
                                EdgeMemory& onTarget, const ReplanLimits& limits) {
  return Replanner(space, targets, free, onTarget, limits).run(path);
}

}  // namespace corridor
