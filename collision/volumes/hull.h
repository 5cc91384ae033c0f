#pragma once

#include <span>
#include <vector>

#include "collision/volumes/obb.h"

namespace corridor {

/// A convex hull swept by a sphere: the points at most `size` from the hull of `vertices`. For
/// triangles `size` is 0, and the set is exactly their hull. Metres.
struct Hull {
  /// The content's extreme points, maybe also a few of its other points.
  std::vector<Vec3> vertices;
  double size = 0;                     ///< the largest radius of the content's spheres
  Vec3 boundingCenter = Vec3::Zero();  ///< centre of a sphere that contains the volume
  double boundingRadius = 0;           ///< its radius, rounded up

  static constexpr bool kOriented = false;
  static Hull around(const Obb& box, const Content& content);
  /// Returns a hull around both hulls, as tight as one fitted to the contents of both.
  static Hull merged(const Hull& a, const Hull& b);
  Mat3 frameAxes() const { return Mat3::Identity(); }
  double axisDefect() const { return 0; }
  /// The largest |x|₂ of the vertices and of `boundingCenter`, rounded up.
  double centerReach() const;
  double radius() const { return boundingRadius; }
  const Vec3& ballCenter() const { return boundingCenter; }
  /// Returns the bytes of heap memory that the vertices take.
  std::size_t extraBytes() const { return vertices.capacity() * sizeof(Vec3); }
};

/// Returns a subset of the points that has exactly the same convex hull. The points may be on one
/// plane, on one line, or equal. The subset contains all extreme points, and maybe a few others on
/// the boundary of the hull. O(n log n) on usual points.
/// @pre the points are finite; there are at least one and at most 2^28 of them.
std::vector<Vec3> hullVertices(std::vector<Vec3> points);

}  // namespace corridor
