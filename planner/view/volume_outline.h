#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/volumes/pair_tests.h"

/// The surfaces of bounding volumes, for pictures only: rounded, without any guarantee. A new
/// volume adds its function `outline` here.
namespace corridor::view {

/// Returns a convex part with the shape of a volume: points whose hull is swept by a sphere.
/// Ellipsoids and shells are drawn as polyhedra with their corners on the surface, so their faces
/// are inside by up to 4 % of the radius.
ConvexPart outline(const Obb& box);
ConvexPart outline(const Aabb& box);
ConvexPart outline(const BoundingSphere& sphere);
ConvexPart outline(const Rss& rss);
template <int K>
ConvexPart outline(const Kdop<K>& kdop);
ConvexPart outline(const Ellipsoid& ellipsoid);
ConvexPart outline(const Hull& hull);
/// Returns the hull of the shell: its concave side is drawn flat.
ConvexPart outline(const Shell& shell);

}  // namespace corridor::view
