#pragma once

#include <array>

#include "collision/core/transform.h"

namespace corridor {

/// The corners of a closed triangle: the convex hull of three points, which may be collinear or
/// coincide.
using Triangle = std::array<Vec3, 3>;

}  // namespace corridor
