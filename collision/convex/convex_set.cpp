#include "collision/convex/convex_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "collision/convex/point_columns.h"
#include "collision/convex/polytope.h"
#include "collision/core/rounding.h"

namespace corridor {

void ConvexSet::sweepDisc() {
  const Vec3 d = points[1] - points[0];
  const double square = d.squaredNorm();
  // If the axis cannot be normalised, the set becomes the capsule, which contains the cylinder.
  if (!(square > 0x1p-900 && square < 0x1p900)) return;
  axis = d / std::sqrt(square);
  std::swap(ball, disc);
}

ConvexSet::ConvexSet(const Triangle& triangle) : points(triangle) {}

ConvexSet::ConvexSet(const Polytope& p) : points(p.vertices()), polytope(&p) {}

ConvexSet::ConvexSet(const Polytope& p, const VertexSearch& s)
    : points(p.vertices()), polytope(&p), search(&s) {}

ConvexSet::ConvexSet(const PointColumns& c) : points(c.points()), columns(&c) {}

std::uint32_t ConvexSet::farthestOfColumns(const Vec3& m) const {
  return m.allFinite() ? columns->farthest(m) : 0;
}

std::uint32_t ConvexSet::farthestVertex(const Vec3& m, std::uint32_t start) const {
  const bool cold = start == kCold;
  // After an overflow no bound holds, and callers test for it.
  if (!m.allFinite()) return cold ? 0 : start;
  if (!search) return polytope->climb(cold ? 0 : start, m);
  // From a vertex nearby, a few steps along edges are cheaper than a search.
  constexpr int kFewSteps = 4;
  if (!cold)
    if (const auto top = polytope->climb(start, m, kFewSteps)) return *top;
  return search->farthest(m);
}

void PosedSet::findBounds() const {
  double farthest = set_.polytope  ? set_.polytope->reachSquared()
                    : set_.columns ? set_.columns->reachSquared()
                                   : 0;
  double sum = farthest;
  if (!set_.polytope && !set_.columns)
    for (const Vec3& p : set_.points) {
      const double square = p.squaredNorm();
      farthest = std::max(farthest, square);
      sum += square;
    }
  // Squares below 2^-1022 vanish, and with them lengths below 2^-511. 2^-500 covers this for
  // points, and 2^-440 for ‖M‖ and for the length of Mᵀn: 20u·2^-440 > 2^-511.
  localReach_ = roundedUp(std::sqrt(farthest) + set_.ball + set_.disc + 0x1p-500);
  // The maximum may drop a NaN; the sum does not. With NaN as its bounds, a set is never separated.
  if (std::isnan(sum) || !(localReach_ > 0)) localReach_ = std::numeric_limits<double>::quiet_NaN();
  reach_ = roundedUp(std::max(0x1p-440, X_.m.norm()) * localReach_);
  error_ = roundedUp(kUnit * (20 * reach_ + 6 * X_.t.norm()));
}

bool PosedSet::isFinite() const {
  return X_.isFinite() && std::isfinite(set_.ball) && std::isfinite(set_.disc) &&
         std::all_of(set_.points.begin(), set_.points.end(),
                     [](const Vec3& p) { return p.allFinite(); });
}

bool PosedSet::keepsBall() const {
  return set_.ball == 0 ||
         (X_.m.transpose() * X_.m - Mat3::Identity()).cwiseAbs().maxCoeff() <= 0x1p-48;
}

double PosedSet::coreHighest(const Vec3& m, std::uint32_t start) const {
  if (set_.polytope || set_.columns) return m.dot(set_.points[set_.farthest(m, start)]);
  double highest = -std::numeric_limits<double>::infinity();
  for (const Vec3& p : set_.points) {
    const double along = m.dot(p);
    if (!(along <= highest) && !std::isnan(highest)) highest = along;  // NaN stays
  }
  return set_.disc > 0 ? highest + set_.disc * m.cross(set_.axis).norm() : highest;
}

double PosedSet::highest(const Vec3& n, std::uint32_t start) const {
  const Vec3 m = X_.m.transpose() * n;
  return n.dot(X_.t) + (coreHighest(m, start) + set_.ball * m.norm());
}

}  // namespace corridor
