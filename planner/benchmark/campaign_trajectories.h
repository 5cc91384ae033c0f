#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "planner/benchmark/trajectory_run.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// One set of limits. A campaign makes each of its trajectories once with each set.
struct CampaignLimits {
  std::string name;                    ///< a prefix of columns; "" if there is only one set
  std::vector<JointLimits> ofProblem;  ///< one entry for each problem of the campaign
};

/// The trajectories that a campaign makes along each returned path.
struct CampaignTrajectories {
  std::vector<TrajectoryMaker> makers;  ///< empty: no trajectories
  std::vector<CampaignLimits> limits;   ///< at least one if there are makers
};

/// Returns one set of limits, without a name: each problem's own.
CampaignLimits ownLimits(const std::vector<Problem>& problems);

/// Adds notes on the problems' own limits, such as accelerations that are assumed.
void addOwnNotes(const std::vector<Problem>& problems, std::vector<std::string>& notes);

/// Returns the makers that have these names. @param place the key or option with the names, for
/// messages.
/// @throws InputError for a name that is unknown or repeated.
std::vector<TrajectoryMaker> trajectoryMakersNamed(const std::vector<std::string>& names,
                                                   const std::string& place);

/// Reads the key `trajectories` of a campaign file: a list of makers, or a map of `makers` and
/// `limits`. The value of `limits` is a map of named sets. A set maps the names of robots to their
/// limits, which have the form of the limits in problem files. A robot without limits in a set
/// keeps the limits of its problem. Faults: an unknown maker; a set whose name is not a letter
/// followed by at most 39 letters, digits, `_` or `-`; a robot that no problem has; and all faults
/// that the limits of a problem file can have.
/// @param folder the folder of the campaign's file. @param notes receives a note on each value that
/// is assumed, such as an acceleration.
CampaignTrajectories readTrajectories(const YamlMap& campaign, const std::filesystem::path& folder,
                                      const std::vector<Problem>& problems,
                                      std::vector<std::string>& notes);

/// Adds the legal keys of the maps under `trajectories` (like problemKeys).
void addTrajectoryKeys(std::map<std::string, MapKeys>& keys);

}  // namespace corridor
