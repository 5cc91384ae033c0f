#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/model/settings.h"

namespace ompl::base {
class Planner;
class SpaceInformation;
}  // namespace ompl::base

namespace corridor {

class Checker;

/// Properties of one of OMPL's planners.
struct PlannerInfo {
  std::string name;   ///< OMPL's name of the planner
  std::string about;  ///< a description in a few words
  /// Whether the same seed gives the same path if the time does not run out. This holds for
  /// planners that use neither threads nor a clock of their own.
  bool repeatable = true;
  /// Whether the planner uses all its time for better paths, unless it is set to stop at the first
  /// path.
  bool optimises = false;
  /// Whether the planner starts its searches again itself (planner.restart).
  bool restarts = false;
};

/// Returns all planners that `makePlanner` accepts, in the order in which messages list them. To
/// add a planner, add a line to planner_factory.cpp.
const std::vector<PlannerInfo>& knownPlanners();

/// Returns a message that lists the known planners if `name` is not one of them, else nullopt.
std::optional<std::string> unknownPlanner(const std::string& name);

/// A parameter by OMPL's own name, and the place where a user wrote it (empty: unknown).
struct PlannerParameter {
  std::string key, value;
  std::string file = {};
  int line = 0;
};

/// Creates a planner and sets its parameters. A parameter that the planner does not have, but `si`
/// has, is set in `si`.
/// @param checker for planners that use distances; null if the tests of `si` are not its tests
/// @param nameAt the place where the name was written, for messages; its key and value are ignored.
/// @throws InputError if the planner's name is unknown. If it is known, but parameters have faults
/// (unknown names, values of the wrong type or range), throws InputError with all of these faults;
/// a fault of an unknown name lists the planner's parameters.
std::shared_ptr<ompl::base::Planner> makePlanner(
    const std::shared_ptr<ompl::base::SpaceInformation>& si, const Checker* checker,
    const std::string& name, const std::vector<PlannerParameter>& parameters,
    const PlannerParameter& nameAt = {});

/// Sets the sampler of valid states.
void setValidStateSampler(ompl::base::SpaceInformation& si, ValidSampler sampler);

}  // namespace corridor
