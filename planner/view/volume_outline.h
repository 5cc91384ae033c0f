#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/volumes/pair_tests.h"

/// The shapes of bounding volumes, for pictures only: rounded, without any guarantee. A new kind of
/// volume needs a function `outline` here.
namespace corridor::view {

/// Returns a convex part with the shape of a volume: the hull of points, swept by a sphere.
/// Ellipsoids and shells become polyhedra with their corners on the surface of the volume. The
/// faces of these polyhedra are inside the volume, by up to 4 % of the radius.
ConvexPart outline(const Obb& box);
ConvexPart outline(const Aabb& box);
ConvexPart outline(const BoundingSphere& sphere);
ConvexPart outline(const Rss& rss);
template <int K>
ConvexPart outline(const Kdop<K>& kdop);
ConvexPart outline(const Ellipsoid& ellipsoid);
ConvexPart outline(const Hull& hull);
/// Returns the convex hull of the shell: its concave side becomes flat.
ConvexPart outline(const Shell& shell);

}  // namespace corridor::view
