#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/robot/robot_model.h"

namespace corridor {

/// Joint types by the names that URDF gives them; nullopt for an unknown name.
std::string nameOf(JointType type);
std::optional<JointType> jointType(std::string_view name);
std::vector<std::string> jointTypeNames();

}  // namespace corridor
