#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `bounds` into a problem that has its model. They bound the positions of rigid robots and
/// of planar and floating joints, and narrow the limits of single joints. Planar and floating
/// joints need them; rigid robots without bounds get theirs by `setDefaultBounds`. Faults go to the
/// file's list.
void readBounds(const YamlMap& file, Problem& problem);

/// Gives rigid robots without bounds the bounding box of the world, enlarged to contain start and
/// goals. Adds a fault if the problem has no obstacles, or if the box is flat. @pre the problem has
/// its obstacles, start and goals.
void setDefaultBounds(Problem& problem, YamlSource& source);

}  // namespace corridor
