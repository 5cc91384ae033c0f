#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/robot/robot_model.h"

namespace corridor {

/// Where the `package://NAME/…` of a URDF are: folders by package name. A name that isn't there is
/// looked for as NAME/… beside the URDF.
using PackageMap = std::map<std::string, std::filesystem::path>;

/// Reads a URDF with its collision geometry (visuals are not looked at), by urdfdom, and checks
/// what urdfdom lets through. Every fault goes to `faults` with file and line, all of them at once;
/// nullopt where there is any. `files` gets the URDF and every mesh file, in the order in which
/// they are first named.
std::optional<RobotModel> readUrdf(const std::filesystem::path& file, const PackageMap& packages,
                                   std::vector<Fault>& faults,
                                   std::vector<std::filesystem::path>& files);

/// Reads an SRDF into `model`: groups (joints, links, chains, subgroups), named states,
/// disable_collisions with their reasons. What names things that the model doesn't have is a fault
/// (but virtual joints and end effectors are not looked at).
void readSrdf(const std::filesystem::path& file, RobotModel& model, std::vector<Fault>& faults);

}  // namespace corridor
