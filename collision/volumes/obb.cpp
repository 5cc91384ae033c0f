#include "collision/volumes/obb.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/volumes/moments.h"
#include "collision/volumes/principal_axes.h"

namespace corridor {
namespace {

Moments moments(std::span<const Triangle> triangles, ObbFit fit) {
  Moments m;
  if (fit == ObbFit::hull) m = hullMoments(triangles);
  if (m.weight == 0 && fit != ObbFit::vertices) m = surfaceMoments(triangles);
  if (m.weight == 0) m = vertexMoments(triangles);  // the triangles have no area
  return m;
}

}  // namespace

double orthonormalityDefect(const Mat3& m) {
  double worst = 0, longest = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      const double dot = m(0, i) * m(0, j) + m(1, i) * m(1, j) + m(2, i) * m(2, j);
      worst = std::max(worst, std::abs(dot - (i == j)));
      if (i == j) longest = std::max(longest, dot);
    }
  // An entry takes three products, two sums and a difference, whose rounding is at most
  // 4u·(Σ|m_ki||m_kj| + 1). The sum is at most the longest column's square (Cauchy). `std::max` may
  // drop a NaN, but the term 0·Σm keeps it: this term is NaN if an entry is NaN or infinite.
  return roundedUp(worst + 8 * kUnit * (1 + longest)) + 0 * m.sum();
}

double Obb::axisDefect() const {
  return orthonormalityDefect(axes);
}

double Obb::centerReach() const {
  return roundedUp(center.stableNorm());
}

double Obb::radius() const {
  return roundedUp(half.stableNorm() * (1 + 3 * axisDefect()));
}

std::optional<ObbFit> obbFitNamed(std::string_view name) {
  if (name == "vertices") return ObbFit::vertices;
  if (name == "triangles") return ObbFit::triangles;
  if (name == "hull") return ObbFit::hull;
  return std::nullopt;
}

ObbFrame fitFrame(const Content& content, ObbFit fit) {
  std::vector<Triangle> points;  // spheres count as points: triangles of three equal corners
  for (const Ball& b : content.balls) points.push_back({b.center, b.center, b.center});
  const Moments m = moments(points.empty() ? content.triangles : points, fit);
  return {m.mean, principalAxes(m.covariance)};
}

ObbFrame alignedFrame(const Content& content) {
  const Vec3& origin = content.anyPoint();
  Vec3 sum = Vec3::Zero();
  double count = 0;
  content.forEach([&](const Vec3& p, double) {
    sum += p - origin;
    ++count;
  });
  return {origin + sum / count, Mat3::Identity()};
}

Obb enclosingObb(const Content& content, const Mat3& axes) {
  Obb box;
  box.axes = axes;
  // Coordinates are relative to one of the points, so that a small mesh far from the origin keeps
  // its digits.
  const Vec3& origin = content.anyPoint();
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  content.forEach([&](const Vec3& p, double r) {
    const Vec3 y = axes.transpose() * (p - origin);
    low = low.cwiseMin((y.array() - r).matrix());
    high = high.cwiseMax((y.array() + r).matrix());
  });
  box.center = origin + axes * (low + 0.5 * (high - low));
  Vec3 reach = Vec3::Zero();
  double total = 0;  // not finite after an overflow, also if `cwiseMax` drops a NaN
  content.forEach([&](const Vec3& p, double r) {
    const Vec3 y = (axes.transpose() * (p - box.center)).cwiseAbs();
    reach = reach.cwiseMax((y.array() + r).matrix());
    total += y.sum();
  });
  // The box must contain x = U⁻¹d with d = p − center, in real arithmetic. The code computes y ≈
  // Uᵀd.
  // * Defect of the axes: with E = UᵀU − I and |E| ≤ η, Uᵀd = (I + E)x. So |x − Uᵀd| ≤ η·Σ|x_k| per
  //   component, and Σ|x_k| ≤ Σ|y_k|/(1 − 3η).
  // * Rounding of y: u·|d| for the difference and γ3·Σ|u_k||d_k| ≤ 3.1u·‖d‖ for the product.
  //   Together they are at most 5u·‖d‖ ≤ 5.1u·Σ|y_k|.
  // * Twice the sum of both errors, the pad 2·(η + 6u)·Σ|y_k|, covers the second-order terms.
  // * A sphere reaches r|g_i|, where g_i is a row of U⁻¹ and |g_i| ≤ 1 + 6η + 16u (part_obb.cpp).
  //   The pad covers this, too, since every |y_k| includes r.
  const double pad = 2 * (orthonormalityDefect(axes) + 6 * kUnit) * reach.sum();
  for (int i = 0; i < 3; ++i) box.half[i] = roundedUp(reach[i] + pad);
  if (!(total < HUGE_VAL)) box.half.fill(HUGE_VAL);
  return box;
}

}  // namespace corridor
