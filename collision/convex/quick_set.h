#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"
#include "collision/core/rounding.h"

namespace corridor {

/// A posed convex set, as `quickContact` uses it, with the bounds that the proofs of `quickContact`
/// need. If the set's eight points are the corners of a box, this object also has the edges of the
/// box. The posed set must outlive this object.
///
/// Let u = 2^-53, F = ‖M‖_F, and ρ ≥ |p| + ball + disc for all points p. `size` ≥ Fρ + |t|, metres.
///
/// Rounding of the bounds. Each bound takes at most 16 roundings of positive terms, which
/// `roundedUp` covers. The code uses (F² + 3)/(2√3) as an upper bound of F (the mean of F² and 3 is
/// at least √3·F). For rotations this bound equals F. 0.28868 > 1/(2√3).
///
/// Box. Let e_k be the computed edges at point 0, and p'_i = p_0 + Σ e_k over the bits k of i. Each
/// e_k is off by 2uρ, and each difference that `findEdges` tests by 4uρ. So with r = `residual`,
/// the largest of these differences, |p_i − p'_i| ≤ 2√3·(r + 6uρ) for all i. Along m, the farthest
/// p'_i is the one whose index i has the bits k with e_k·m > 0. A wrong sign costs at most
/// 2·3.1u|m||e_k|, with |e_k| ≤ 2ρ, so three wrong signs cost below 38uρ|m|. The stored point p_i
/// with the same i is therefore below the highest stored point by at most |m|(4√3·(r + 6uρ) + 38uρ)
/// < |m|(7r + 80uρ). For m = Mᵀn and N = |n|, |m| ≤ 1.001·FN. `boxError` is this bound for N = 1.
struct QuickSet {
  explicit QuickSet(const PosedSet& set)
      : posed(set),
        points(set.set().points.data()),
        count(static_cast<std::uint32_t>(set.set().points.size())),
        M(set.pose().m),
        t(set.pose().t),
        ball(set.set().ball),
        flatEnds(set.set().disc > 0) {
    const double square = M.squaredNorm(), map = 0.28868 * (square + 3);
    isNearlyRigid = std::abs(square - 3) <= 0x1p-10;
    Vec3 reach;  // coordinates of points are at most reach + 8·residual in magnitude
    // NaN if a point is not finite. The maxima below may drop a NaN, but `size` must be NaN, too.
    double nothing;
    if (count == 8 && findEdges()) {
      box = true;
      middle = 0.5 * (points[0] + points[7]);
      reach =
          middle.cwiseAbs() + 0.5 * (edge[0].cwiseAbs() + edge[1].cwiseAbs() + edge[2].cwiseAbs());
      nothing = 0 * (points[3] + points[5] + points[6]).sum();  // `reach` has the other points
    } else {
      middle = points[0];
      reach = middle.cwiseAbs();
      for (std::uint32_t i = 1; i < count; ++i) {
        middle += points[i];
        reach = reach.cwiseMax(points[i].cwiseAbs());
      }
      nothing = 0 * middle.sum();
      if (count > 1) middle *= 1.0 / count;
    }
    const double local = reach.sum() + 8 * residual + ball + set.set().disc + nothing;
    size = roundedUp(map * local + t.cwiseAbs().sum());
    if (box) boxError = roundedUp(map * (8 * residual + 90 * kUnit * local));
  }

  Vec3 image(const Vec3& p) const {
    return {M(0, 0) * p[0] + M(0, 1) * p[1] + M(0, 2) * p[2] + t[0],
            M(1, 0) * p[0] + M(1, 1) * p[1] + M(1, 2) * p[2] + t[1],
            M(2, 0) * p[0] + M(2, 1) * p[1] + M(2, 2) * p[2] + t[2]};
  }
  /// Returns Mᵀn.
  Vec3 local(const Vec3& n) const { return {M.col(0).dot(n), M.col(1).dot(n), M.col(2).dot(n)}; }

  /// Returns the image of the core's point that is farthest along m; m is in the set's own frame.
  /// If m is nearly parallel to the axis of the disc, the disc is omitted, and an upper bound of
  /// its reach along m is added to `missed`.
  Vec3 farthest(const Vec3& m, double& missed) const {
    if (box)
      return image(points[unsigned{m.dot(edge[0]) > 0} | unsigned{m.dot(edge[1]) > 0} << 1 |
                          unsigned{m.dot(edge[2]) > 0} << 2]);
    std::uint32_t best = 0;
    double highest = m.dot(points[0]);
    for (std::uint32_t i = 1; i < count; ++i) {
      const double along = m.dot(points[i]);
      if (along > highest) highest = along, best = i;
    }
    return flatEnds ? image(points[best] + radial(m, missed)) : image(points[best]);
  }

  const PosedSet& posed;
  const Vec3* points;
  std::uint32_t count;
  const Mat3& M;
  const Vec3& t;
  double ball;
  bool flatEnds, box = false;
  bool isNearlyRigid = false;  ///< F² is 3 up to 2^-10; so `size` is not far above the coordinates
  Vec3 middle;
  std::array<Vec3, 3> edge;
  double residual = 0;  ///< the largest difference of two parallel edges, per coordinate
  double size, boxError = 0;

 private:
  /// Returns the vector from the centre of the disc to its point that is farthest along m. If m is
  /// nearly parallel to the axis, returns 0, and adds an upper bound of the disc's reach along m to
  /// `missed`.
  ///
  /// The component of m across the axis is off by 19u|m| (axis 2·6u, rounding 7u). The second
  /// projection removes what rounding has left along the axis, so that m·unit is this component up
  /// to 30u|m|. The point is rounded by 5uρ.
  Vec3 radial(const Vec3& m, double& missed) const {
    const Vec3& axis = posed.set().axis;
    const double disc = posed.set().disc, square = m.squaredNorm();
    const Vec3 across = m - axis * m.dot(axis);
    const double part = across.squaredNorm();
    if (!(part > 0x1p-40 * square)) {
      missed += disc * (std::sqrt(part) + 0x1p-47 * std::sqrt(square));
      return Vec3::Zero();
    }
    const Vec3 unit = across / std::sqrt(part);
    return (unit - axis * unit.dot(axis)) * disc;
  }
  bool findEdges() {
    for (std::size_t k = 0; k < 3; ++k) edge[k] = points[1 << k] - points[0];
    const Vec3 d = (points[3] - points[2] - edge[0])
                       .cwiseAbs()
                       .cwiseMax((points[5] - points[4] - edge[0]).cwiseAbs())
                       .cwiseMax((points[6] - points[4] - edge[1]).cwiseAbs())
                       .cwiseMax((points[7] - points[6] - edge[0]).cwiseAbs());
    residual = d.maxCoeff();
    const double far = points[0].cwiseAbs().maxCoeff() + points[7].cwiseAbs().maxCoeff();
    if (residual <= 0x1p-50 * far) return true;
    residual = 0;
    return false;
  }
};

}  // namespace corridor
