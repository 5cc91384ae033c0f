#pragma once

#include <span>
#include <vector>

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// An oriented box: the set {center + axes·x : |x_i| ≤ half_i} for the doubles stored. `axes` is
/// orthonormal to a few ulp; its defect is in `half` (containment) and in the margins of
/// `obbsSeparated`. Metres.
struct Obb {
  Vec3 center = Vec3::Zero();
  Mat3 axes = Mat3::Identity();
  Vec3 half = Vec3::Zero();
};

/// Which points' covariance gives a box its axes (Gottschalk, Lin, Manocha 1996, section 4).
enum class ObbFit {
  vertices,   ///< of the corners: quick, misled by uneven tessellation
  triangles,  ///< area-weighted moments of the triangles
  hull,  ///< area-weighted moments of the surface of their convex hull: no inner geometry misleads
         ///< it
};

/// Axes and mean of a set of triangles.
struct ObbFrame {
  Vec3 mean = Vec3::Zero();
  Mat3 axes =
      Mat3::Identity();  ///< columns, longest spread first; right-handed, orthonormal to a few ulp
};
ObbFrame fitFrame(std::span<const Triangle> triangles, ObbFit fit);

/// The smallest box with these axes around the triangles, rounded outward: contains them in real
/// arithmetic.
Obb enclosingObb(std::span<const Triangle> triangles, const Mat3& axes);

/// ‖MᵀM − I‖_max, rounded up: how far M is from orthonormal.
double orthonormalityDefect(const Mat3& m);

}  // namespace corridor
