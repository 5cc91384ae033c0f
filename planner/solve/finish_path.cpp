#include "planner/solve/finish_path.h"

#include <cmath>
#include <numbers>

#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>

#include "planner/checker/rigid_state_space.h"

namespace corridor {

namespace og = ompl::geometric;

namespace {

/// OMPL's simplifier looks at no clock within a call: few attempts a call keep time-outs strict.
constexpr unsigned kAttempts = 10;
/// Rounds of attempts in a row that change nothing, after which more are not worth their time.
constexpr int kEmptyRounds = 8;
/// No path needed more; shortening never ends by itself, as it always finds another last digit.
constexpr int kRounds = 60;

bool sameState(RigidSpace space, const RigidState& a, const RigidState& b) { return distance(space, 1, a, b) == 0; }

}  // namespace

Path readPath(RigidSpace space, const og::PathGeometric& path) {
  Path states;
  for (const ompl::base::State* state : const_cast<og::PathGeometric&>(path).getStates())
    states.push_back(readState(space, state));
  return states;
}

std::vector<Path> simplifiedVersions(const std::shared_ptr<ompl::base::SpaceInformation>& si, RigidSpace space,
                                     og::PathGeometric& path, const std::function<bool()>& stop) {
  std::vector<Path> versions{readPath(space, path)};
  og::PathSimplifier simplifier(si);
  const auto repeat = [&](auto attempt) {
    for (int round = 0, empty = 0; round < kRounds && empty < kEmptyRounds && !stop(); ++round) {
      const double before = path.length();
      const std::size_t states = path.getStateCount();
      attempt();
      const bool better = path.getStateCount() < states || path.length() < before * (1 - 1e-3);
      empty = better ? 0 : empty + 1;
      if (better) versions.push_back(readPath(space, path));
    }
  };
  for (int pass = 0; pass < 2 && path.getStateCount() > 2; ++pass) {
    repeat([&] { simplifier.reduceVertices(path, kAttempts, kAttempts); });
    repeat([&] { simplifier.shortcutPath(path, kAttempts, kAttempts); });
  }
  repeat([&] { simplifier.collapseCloseVertices(path, kAttempts, kAttempts); });
  return versions;
}

Path withShortTurns(RigidSpace space, const Path& path) {
  Path states;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) {
      if (sameState(space, path[i - 1], path[i]) && i + 1 < path.size()) continue;
      const double angle = rotationAngle(space, path[i - 1], path[i]);
      const int parts = static_cast<int>(angle / (std::numbers::pi / 2)) + 1;
      for (int k = 1; k < parts; ++k) states.push_back(interpolate(space, path[i - 1], path[i], double(k) / parts));
    }
    states.push_back(path[i]);
  }
  return states;
}

bool certifiedPath(const RigidChecker& checker, const Path& path) {
  if (path.empty() || !checker.certifiedState(path.front())) return false;
  for (std::size_t i = 1; i < path.size(); ++i)
    if (!checker.certifiedEdge(path[i - 1], path[i])) return false;
  return true;
}

PathLength lengthOf(RigidSpace space, const Path& path) {
  PathLength length;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length.metres += (path[i].pose.p - path[i - 1].pose.p).norm();
    length.radians += rotationAngle(space, path[i - 1], path[i]);
  }
  return length;
}

}  // namespace corridor
