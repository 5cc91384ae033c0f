#include "planner/solve/finish_path.h"

#include <cmath>
#include <numbers>

#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>

#include "planner/checker/group_difference.h"
#include "planner/checker/problem_state_space.h"
#include "planner/robot/difference.h"

namespace corridor {

namespace og = ompl::geometric;

Path configurationsOf(const og::PathGeometric& path) {
  Path states;
  for (const ompl::base::State* state : const_cast<og::PathGeometric&>(path).getStates())
    states.push_back(configurationOf(*path.getSpaceInformation(), state));
  return states;
}

void simplifyByOmpl(const std::shared_ptr<ompl::base::SpaceInformation>& si,
                    og::PathGeometric& path, const std::function<bool()>& stop) {
  og::PathSimplifier(si).simplify(path, ompl::base::PlannerTerminationCondition(stop));
}

Path withShortTurns(const ConfigurationSpace& space, const Path& path) {
  Path states;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) {
      if (space.distance(path[i - 1], path[i]) == 0 && i + 1 < path.size()) continue;
      const double angle = space.largestTurn(path[i - 1], path[i]);
      const int parts = static_cast<int>(angle / (std::numbers::pi / 2)) + 1;
      for (int k = 1; k < parts; ++k)
        states.push_back(space.interpolate(path[i - 1], path[i], double(k) / parts));
    }
    states.push_back(path[i]);
  }
  return states;
}

bool isCertified(const Checker& checker, const Path& path, const EdgeMemory* proved) {
  if (path.empty() || !checker.isProvedFree(path.front())) return false;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const bool known = proved && proved->knowsFree(path[i - 1], path[i]);
    if (known ? !checker.inBounds(path[i]) : !checker.isProvedFree(path[i - 1], path[i]))
      return false;
  }
  return true;
}

PathLength lengthOf(const ConfigurationSpace& space, const Path& path) {
  PathLength length;
  for (std::size_t i = 1; i < path.size(); ++i)
    for (const CoordinateGroup& group : space.groups()) {
      if (group.kind != CoordinateGroup::Kind::joints) {
        length.metres += positionDifference(space, group, path[i - 1], path[i]);
        length.radians += rotationDifference(space, group, path[i - 1], path[i]);
        continue;
      }
      for (const std::size_t c : group.coordinates) {
        const Coordinate& joint = space.coordinates()[c];
        const bool turns = joint.angular || joint.kind == Coordinate::Kind::circle;
        (turns ? length.radians : length.metres) += differenceOf(joint, path[i - 1], path[i]);
      }
    }
  return length;
}

double distanceAlong(const ConfigurationSpace& space, const Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += space.distance(path[i - 1], path[i]);
  return length;
}

std::string summands(const ConfigurationSpace& space) {
  std::size_t joints = 0, bodies = 0;
  for (const CoordinateGroup& group : space.groups())
    if (group.kind == CoordinateGroup::Kind::joints)
      joints += group.coordinates.size();
    else
      ++bodies;
  if (joints + bodies < 2) return "";
  return bodies == 0   ? "sum over the joints"
         : joints == 0 ? "sum over the bodies"
                       : "sum over joints and bodies";
}

}  // namespace corridor
