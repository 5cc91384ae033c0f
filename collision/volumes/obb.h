#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "collision/core/transform.h"
#include "collision/volumes/content.h"

namespace corridor {

/// An oriented box: the set {center + axes·x : |x_i| ≤ half_i} for the doubles stored. `axes` is
/// orthonormal to a few ulp; its defect is in `half` (containment) and in the margins of
/// `obbsSeparated`. Metres.
struct Obb {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  Vec3 half = Vec3::Zero();

  // As a `BoundingVolume` (volumes/volume.h).
  static constexpr bool kOriented = true;
  static Obb around(const Obb& box, const Content&) { return box; }
  const Mat3& frameAxes() const { return axes; }
  double axisDefect() const;
  double centerReach() const;
  double radius() const;
  const Vec3& ballCenter() const { return center; }
};

/// Which points' covariance gives a box its axes (Gottschalk, Lin, Manocha 1996, section 4).
enum class ObbFit {
  vertices,   ///< of the corners: quick, misled by uneven tessellation
  triangles,  ///< area-weighted moments of the triangles
  hull,  ///< area-weighted moments of the surface of their convex hull: no inner geometry misleads
         ///< it
};
/// By its name here; nothing where there is no such fit.
std::optional<ObbFit> obbFitNamed(std::string_view name);

/// Axes and mean of a content.
struct ObbFrame {
  Vec3 mean = Vec3::Zero();
  Mat3 axes =
      Mat3::Identity();  ///< columns, longest spread first; right-handed, orthonormal to a few ulp
};
ObbFrame fitFrame(const Content& content, ObbFit fit);
/// The same with the frame's own axes: the identity, and the mean of all corners or balls.
ObbFrame alignedFrame(const Content& content);

/// The smallest box with these axes around the content, rounded outward: contains it in real
/// arithmetic.
Obb enclosingObb(const Content& content, const Mat3& axes);

/// ‖MᵀM − I‖_max, rounded up: how far M is from orthonormal.
double orthonormalityDefect(const Mat3& m);

}  // namespace corridor
