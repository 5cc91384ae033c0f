#include "collision/volumes/obb.h"

#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/volumes/moments.h"

namespace corridor {
namespace {

/// Eigenvectors of a covariance, largest eigenvalue first, made orthonormal again and right-handed.
Mat3 principalAxes(const Mat3& covariance) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance);
  if (solver.info() != Eigen::Success || !solver.eigenvectors().allFinite())
    return Mat3::Identity();
  Mat3 axes;
  const Vec3 x = solver.eigenvectors().col(2).normalized();
  Vec3 y = solver.eigenvectors().col(1);
  y = (y - x * x.dot(y)).normalized();
  axes << x, y, x.cross(y);
  return axes.allFinite() && orthonormalityDefect(axes) < 0x1p-40 ? axes : Mat3::Identity();
}

Moments moments(std::span<const Triangle> triangles, ObbFit fit) {
  Moments m;
  if (fit == ObbFit::hull) m = hullMoments(triangles);
  if (m.weight == 0 && fit != ObbFit::vertices) m = surfaceMoments(triangles);
  if (m.weight == 0) m = vertexMoments(triangles);  // no area at all
  return m;
}

}  // namespace

double orthonormalityDefect(const Mat3& m) {
  // Entries of MᵀM − I: three products, two sums and a difference, |terms| ≤ 1 for a matrix near a
  // rotation; 8u for the rounding.
  const double size = m.cwiseAbs().maxCoeff();
  return roundedUp((m.transpose() * m - Mat3::Identity()).cwiseAbs().maxCoeff() +
                   8 * kUnit * (1 + 3 * size * size));
}

ObbFrame fitFrame(std::span<const Triangle> triangles, ObbFit fit) {
  const Moments m = moments(triangles, fit);
  return {m.mean, principalAxes(m.covariance)};
}

Obb enclosingObb(std::span<const Triangle> triangles, const Mat3& axes) {
  Obb box;
  box.axes = axes;
  // About one of the points, so that a small mesh far from the origin keeps its digits.
  const Vec3 origin = triangles[0][0];
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (const Triangle& t : triangles)
    for (const Vec3& p : t) {
      const Vec3 y = axes.transpose() * (p - origin);
      low = low.cwiseMin(y);
      high = high.cwiseMax(y);
    }
  box.center = origin + axes * (low + 0.5 * (high - low));
  Vec3 reach = Vec3::Zero();
  for (const Triangle& t : triangles)
    for (const Vec3& p : t)
      reach = reach.cwiseMax((axes.transpose() * (p - box.center)).cwiseAbs());
  // What is wanted is x = U⁻¹d, d = p − center in real arithmetic; computed is y ≈ Uᵀd. With E =
  // UᵀU − I, |E| ≤ η: Uᵀd = (I + E)x, so |x − Uᵀd| ≤ η·Σ|x_k| per component, and Σ|x_k| ≤ Σ|y_k|/(1
  // − 3η). Computing y: u·|d| for the difference and γ3·Σ|u_k||d_k| ≤ 3.1u·‖d‖ for the product:
  // together at most 5u·‖d‖ ≤ 5.1u·Σ|y_k|. Twice the sum of both covers the second-order terms.
  const double pad = 2 * (orthonormalityDefect(axes) + 6 * kUnit) * reach.sum();
  for (int i = 0; i < 3; ++i) box.half[i] = roundedUp(reach[i] + pad);
  return box;
}

}  // namespace corridor
