#pragma once

#include <string_view>

#include "collision/geometry/mesh_text.h"

namespace corridor {

/// Of a Collada file: are the `<unit meter="…">` and the `<up_axis>` that it states ones that can
/// be? assimp takes what it doesn't understand for 1 m and for y, zero for a scale, and a negative
/// unit for a mirror. Both are optional; what is in comments is none.
/// @throws InputError where one is not.
void checkColladaAsset(std::string_view text, MeshFaults& faults);

}  // namespace corridor
