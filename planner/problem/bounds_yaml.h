#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `bounds` into a problem. Bounds limit the positions of rigid robots and of planar and
/// floating joints, and narrow the limits of single joints. Planar and floating joints need bounds.
/// Rigid robots may have none; `setDefaultBounds`, called later, sets them. Faults are added to the
/// file's list.
/// @pre the problem's model is set.
void readBounds(const YamlMap& file, Problem& problem);

/// Sets the bounds of rigid robots without bounds to the bounding box of the world, enlarged to
/// contain start and goals. Adds a fault if the problem has no obstacles, or if the box is flat.
/// @pre obstacles, start and goals of the problem are set.
void setDefaultBounds(Problem& problem, YamlSource& source);

}  // namespace corridor
