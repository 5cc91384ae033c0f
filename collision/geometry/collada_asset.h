#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/mesh_text.h"

namespace corridor {

/// Checks the `<unit meter="…">` and the `<up_axis>` of a Collada file. assimp checks neither: it
/// replaces an unknown unit by 1 m and an unknown axis by y, scales the mesh to a point if the unit
/// is 0, and mirrors the mesh if the unit is negative. Both elements are optional. Elements in
/// comments and CDATA do not count.
/// Adds a note if the unit has the name of another length.
/// @returns the up-axis, 'x', 'y' or 'z'. Without `<up_axis>` it is y, by Collada's specification.
/// @throws InputError if the unit is not a number above 0, or the axis is not X_UP, Y_UP or Z_UP.
char checkColladaAsset(std::string_view text, MeshFaults& faults, std::vector<std::string>& notes);

}  // namespace corridor
