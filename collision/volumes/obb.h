#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "collision/core/transform.h"
#include "collision/volumes/content.h"

namespace corridor {

/// An oriented box: the set {center + axes·x : |x_i| ≤ half_i}, in real arithmetic on the doubles
/// stored. `axes` is orthonormal up to 2^-40, and mostly to a few ulp. The defect of `axes` is
/// accounted for in two places: `half` is so large that the box contains its content, and the
/// margins of `obbsSeparated` include the defect. Metres.
struct Obb {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  Vec3 half = Vec3::Zero();

  // The members that the concept `BoundingVolume` (volumes/volume.h) requires.
  static constexpr bool kOriented = true;
  static Obb around(const Obb& box, const Content&) { return box; }
  const Mat3& frameAxes() const { return axes; }
  double axisDefect() const;
  double centerReach() const;
  double radius() const;
  const Vec3& ballCenter() const { return center; }
};

/// The distribution of points whose covariance gives a box its axes (Gottschalk, Lin, Manocha 1996,
/// section 4).
enum class ObbFit {
  vertices,   ///< the triangles' corners: quick, but sensitive to uneven tessellation
  triangles,  ///< area-weighted moments of the triangles
  /// Area-weighted moments of the surface of the triangles' convex hull: independent of inner
  /// geometry.
  hull,
};
/// Returns the fit of this name, or nullopt if there is none.
std::optional<ObbFit> obbFitNamed(std::string_view name);

/// Mean and principal axes of a content.
struct ObbFrame {
  Vec3 mean = Vec3::Zero();
  /// The axes are the columns, the axis of the largest variance first; right-handed, orthonormal up
  /// to 2^-40, and mostly to a few ulp.
  Mat3 axes = Mat3::Identity();
};
/// Returns the frame of a content by `fit`. Spheres count as points at their centres. If the hull
/// has no volume, the triangles are used instead; if these have no area, their corners are used.
ObbFrame fitFrame(const Content& content, ObbFit fit);
/// Returns the mean of all corners or sphere centres, with the identity as axes.
ObbFrame alignedFrame(const Content& content);

/// Returns the smallest box with these axes around the content, rounded outward. The box contains
/// the content in real arithmetic.
Obb enclosingObb(const Content& content, const Mat3& axes);

/// Returns ‖MᵀM − I‖_max, rounded up: the defect of M from an orthonormal matrix.
double orthonormalityDefect(const Mat3& m);

}  // namespace corridor
