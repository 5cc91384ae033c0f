#pragma once

#include <cmath>
#include <limits>

#include "collision/volumes/obb.h"

namespace corridor {

/// A spherical shell (Krishnan, Pattekar, Lin, Manocha, "Spherical shell: a higher order bounding
/// volume for fast proximity queries", 1998), swept by a sphere. The shell is the set of the points
/// at most `size` from the core
///
///   {center + d : inner ≤ |d| ≤ outer, |d × axis| ≤ slope·(d·axis)}
///
/// which is bounded by two concentric spheres and a cone. If there is no cone (`hasCone()` is
/// false), the condition with `slope` is dropped. For triangles `size` is 0. Metres.
///
/// The shell is the only volume that is not convex: it contains each triangle, but not the hull of
/// the triangles. A shell follows a curved surface, whose hull is thicker. Convex parts, which are
/// solid, are in a convex subset of the shell: the points center + d with d·axis ≥ inner·|axis|,
/// swept by the sphere.
struct Shell {
  Vec3 center = Vec3::Zero();  ///< of the spheres: often outside of the content
  Vec3 axis = Vec3::UnitZ();   ///< of the cone: unit, rounded. Only its direction matters.
  double slope = kNoCone;      ///< tangent of the cone's half angle, which is below 90°
  double inner = 0, outer = 0;
  double size = 0;  ///< radius of the swept sphere: the largest radius of a sphere of the content
  /// A sphere that contains the volume: its centre, and its radius rounded up.
  Vec3 boundingCenter = Vec3::Zero();
  double boundingRadius = 0;

  static constexpr double kNoCone = std::numeric_limits<double>::infinity();
  bool hasCone() const { return slope < kNoCone; }
  /// 1/√(1 + slope²), rounded: the cosine of the half angle.
  double cosine() const { return 1 / std::sqrt(1 + slope * slope); }

  static constexpr bool kOriented = false;
  /// Returns the shell of least volume among four centres:
  /// - the centre of the sphere that fits all points best (least squares);
  /// - two far centres on the line through the content along its shortest extent: good for flat
  ///   contents;
  /// - the centre of a bounding sphere: good for contents all around it.
  static Shell around(const Obb& box, const Content& content);
  Mat3 frameAxes() const { return Mat3::Identity(); }
  double axisDefect() const { return 0; }
  /// The larger of |center|₂ and |boundingCenter|₂, rounded up.
  double centerReach() const;
  double radius() const { return boundingRadius; }
  const Vec3& ballCenter() const { return boundingCenter; }
};

/// Returns the direction from the origin to the closest point of a triangle, scaled so that its
/// largest entry is ±1. (Any direction n proves that the distance is at least min n·corner/|n|.)
/// NaN if the closest point is the origin.
Vec3 towardsTriangle(const Vec3& p, const Vec3& q, const Vec3& r);

}  // namespace corridor
