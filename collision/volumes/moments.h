#pragma once

#include <span>

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// Mean and covariance of a point distribution; `weight` 0 where there is none.
struct Moments {
  double weight = 0;
  Vec3 mean = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
};

/// Of the triangles' corners, each as often as it occurs.
Moments vertexMoments(std::span<const Triangle> triangles);

/// Of the triangles' surface: with areas A_i, centroids c_i, A = ΣA_i, corners p, q, r:
/// μ = ΣA_i c_i/A, C = (1/12A) Σ A_i (9 c_i c_iᵀ + ppᵀ + qqᵀ + rrᵀ) − μμᵀ, about a local origin.
/// Weight 0 if all areas are.
Moments surfaceMoments(std::span<const Triangle> triangles);

/// Of the surface of their convex hull (by Qhull); weight 0 where the hull is flat or Qhull
/// refuses.
Moments hullMoments(std::span<const Triangle> triangles);

}  // namespace corridor
