#pragma once

#include "planner/model/settings.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads the key `trajectory` of a problem into `settings`. Members whose keys are absent do not
/// change.
void readTrajectoryKeys(const YamlMap& problem, TrajectorySettings& settings);

}  // namespace corridor
