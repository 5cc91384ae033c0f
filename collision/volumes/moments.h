#pragma once

#include <span>

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// Mean and covariance of a distribution of points. The covariance is in the square of an internal
/// unit of length, since only its axes are used. A `weight` of 0 means that there is no
/// distribution.
struct Moments {
  double weight = 0;
  Vec3 mean = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};

/// Returns the moments of the triangles' corners, each counted as often as it occurs.
Moments vertexMoments(std::span<const Triangle> triangles);

/// Returns the area-weighted moments of the triangles' surface. Let A_i be the areas, c_i the
/// centroids, p, q, r the corners of triangle i about a local origin, and A = ΣA_i. Then the mean μ
/// and the covariance C are
///   μ = ΣA_i c_i/A,  C = 1/(12A) Σ A_i (9 c_i c_iᵀ + ppᵀ + qqᵀ + rrᵀ) − μμᵀ.
/// The weight is 0 if all areas are 0.
Moments surfaceMoments(std::span<const Triangle> triangles);

/// Returns the moments of the surface of the triangles' convex hull. The weight is 0 if
/// all corners are on one plane, or there are more than 2^28 corners.
Moments hullMoments(std::span<const Triangle> triangles);

}  // namespace corridor
