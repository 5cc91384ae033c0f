#pragma once

#include <string>

#include "collision/geometry/convex_part.h"

namespace corridor {

/// Throws std::invalid_argument if a convex part cannot be the content of a body or tree: if it has
/// no point, if a number is not finite, if the radius is negative, or if it has flat ends and not
/// exactly two points. (Bounds of parts are maxima, which may drop a NaN.)
/// @param place the beginning of the message, such as "body cup".
void requireValid(const ConvexPart& part, const std::string& place);

}  // namespace corridor
