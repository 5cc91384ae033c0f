#include "collision/hierarchy/check_part.h"

#include <cmath>
#include <stdexcept>

namespace corridor {

void requireValid(const ConvexPart& part, const std::string& place) {
  if (part.points.empty()) throw std::invalid_argument(place + " has no points");
  if (part.flatEnds && part.points.size() != 2)
    throw std::invalid_argument(place + ": a cylinder needs exactly two points");
  if (!(std::isfinite(part.radius) && part.radius >= 0))
    throw std::invalid_argument(place + ": the radius must be finite and not negative");
  for (const Vec3& q : part.points)
    if (!q.allFinite()) throw std::invalid_argument(place + " has a point that is not finite");
}

}  // namespace corridor
