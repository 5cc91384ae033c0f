#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `bounds` into a problem. Bounds limit the positions of rigid robots and of planar and
/// floating joints, and narrow the limits of single joints. Planar and floating joints need bounds.
/// Rigid robots need none; `setDefaultBounds`, which is called later, sets their bounds. Faults are
/// added to the file's list.
/// @pre The problem's model is set.
void readBounds(const YamlMap& file, Problem& problem);

/// Sets the bounds of rigid robots without bounds to the bounding box of the obstacles, enlarged to
/// contain start and goals, and adds a note. Adds a fault instead if the problem has no obstacles,
/// or if the enlarged box is flat.
/// @pre The problem's obstacles, start and goals are set.
void setDefaultBounds(Problem& problem, YamlSource& source);

}  // namespace corridor
