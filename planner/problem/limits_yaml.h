#pragma once

#include <filesystem>
#include <vector>

#include "planner/model/limits.h"
#include "planner/model/model.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads the key `limits` of a problem, and the file of MoveIt that `limits.file` names.
/// @param isComplete whether `model` has all robots. It is false if robots have faults; the keys
/// `joints` and `link_speed` are then not read, and the names in MoveIt's file are not checked.
/// @param files gets the file that `limits.file` names.
LimitSpec readLimits(const YamlMap& problem, const std::filesystem::path& folder,
                     const Model& model, bool isComplete,
                     std::vector<std::filesystem::path>& files);

/// Does the same as `readLimits`, for a map that is the value of the key `limits`.
LimitSpec readLimitMap(const YamlMap& limits, const std::filesystem::path& folder,
                       const Model& model, bool isComplete,
                       std::vector<std::filesystem::path>& files);

/// If the map has the key, sets `scale` to the key's value: a factor for limits, above 0 and at
/// most 1. Adds a fault for any other value.
void readScale(const YamlMap& map, const char* key, double& scale);

/// Reads a joint_limits.yaml of MoveIt into `spec`: the limits of joints, by the joints' names
/// without a robot's name, and the default scaling factors. If a joint's deceleration limit is
/// smaller than its acceleration limit, it replaces the acceleration limit. Adds notes on joints
/// that do not move in the model, and on limits of positions, which are not used. @param isComplete
/// see readLimits.
void readMoveitLimits(const std::filesystem::path& file, const Model& model, bool isComplete,
                      LimitSpec& spec, FaultList& faults, std::vector<Note>& notes);

}  // namespace corridor
