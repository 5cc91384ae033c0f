#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ompl::base {
class Planner;
class SpaceInformation;
}  // namespace ompl::base

namespace corridor {

/// What is known of a planner of OMPL before it runs.
struct PlannerInfo {
  std::string name;     ///< OMPL's
  std::string about;    ///< a few words
  bool repeats = true;  ///< the same seed gives the same path (no thread, no clock of its own), if
                        ///< the time doesn't run out
  bool optimises = false;  ///< uses its time for better paths, if not told to stop at the first
};

/// All that `makePlanner` knows, in the order in which help lists them. To add one: a line in
/// planner_factory.cpp.
const std::vector<PlannerInfo>& knownPlanners();

/// What is wrong with the name of a planner that there isn't: a line that lists those that there
/// are. nullopt: `makePlanner` knows it.
std::optional<std::string> unknownPlanner(const std::string& name);

/// A parameter by OMPL's own name, and where a user wrote it (empty: nowhere).
struct PlannerParameter {
  std::string key, value;
  std::string file = {};
  int line = 0;
};

/// @param nameAt where the name was written, for messages (its key and value are not looked at).
/// @throws InputError: unknown name, unknown parameter (lists what there is), a value that isn't of
/// the parameter's type; all faulty parameters at once.
std::shared_ptr<ompl::base::Planner> makePlanner(
    const std::shared_ptr<ompl::base::SpaceInformation>& si, const std::string& name,
    const std::vector<PlannerParameter>& parameters, const PlannerParameter& nameAt = {});

/// Valid-state samplers by OMPL's names; sets the allocator of `si`.
/// @throws InputError for an unknown name.
void setValidStateSampler(ompl::base::SpaceInformation& si, const std::string& name,
                          const PlannerParameter& nameAt = {});

}  // namespace corridor
