#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/robot/robot_model.h"

namespace corridor {

/// Folders by package name, for names such as `package://NAME/…` in a URDF. If a package is not
/// listed, the reader tries the folder NAME beside the URDF, then each folder called NAME above the
/// URDF.
using PackageMap = std::map<std::string, std::filesystem::path>;

/// Reads a URDF with its collision geometry, by urdfdom, and checks what urdfdom doesn't. Visuals
/// are ignored.
///
/// All faults are appended to `faults`, with file and line. The result is nullopt if the URDF has a
/// fault. `files` receives the URDF and every mesh file, in the order in which they are first
/// named.
std::optional<RobotModel> readUrdf(const std::filesystem::path& file, const PackageMap& packages,
                                   std::vector<Fault>& faults,
                                   std::vector<std::filesystem::path>& files);

/// Reads an SRDF into `model`: groups (joints, links, chains, subgroups), named states, and
/// disabled collisions with their reasons. Virtual joints and end effectors are ignored.
///
/// Only a file that can't be read at all is a fault. Names that the model lacks and elements that
/// make no sense are notes, as for other readers of SRDF. A group without its unknown members is
/// made from the others (`RobotModel::missingMembers`). What can't be made is listed in
/// `RobotModel::unusable`; it is a fault only for a problem that names it.
void readSrdf(const std::filesystem::path& file, RobotModel& model, std::vector<Fault>& faults);

}  // namespace corridor
