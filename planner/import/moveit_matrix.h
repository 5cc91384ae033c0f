#pragma once

#include "planner/model/model.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// If a scene has an allowed collision matrix with names, excludes the pairs of bodies that the
/// matrix allows to touch. As in MoveIt, the matrix then replaces the SRDF's pairs. Pairs that
/// robot.yaml allows stay excluded, unless the matrix has false for them; a note names those. The
/// default entries of the matrix are not read, so pairs that only a default entry allows are
/// tested.
void applyAllowedMatrix(const YamlMap& scene, Model& model);

}  // namespace corridor
