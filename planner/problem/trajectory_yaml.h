#pragma once

#include "planner/model/settings.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads the `trajectory` of a problem. Values that the file does not have stay as they are.
void readTrajectoryKeys(const YamlMap& problem, TrajectorySettings& settings);

}  // namespace corridor
