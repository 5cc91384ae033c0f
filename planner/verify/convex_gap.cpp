#include "planner/verify/convex_gap.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace corridor::verify {
namespace {

constexpr int kMostSteps = 200;
/// The search ends when upper and lower bound differ by less than this fraction of the norms of the
/// farthest points. The rounding of the bounds is nearly as large as this difference.
constexpr Real kFine = 0x1p-58L;

/// A corner of the difference B − A, and the two points whose difference it is.
struct Corner {
  RealVec onA, onB;
  RealVec difference() const { return onB - onA; }
};

struct Nearest {
  Real square = std::numeric_limits<Real>::infinity();
  std::array<Real, 4> weights{};
};

/// Finds the point of least norm in the affine hull (point, line, plane) of the chosen corners. If
/// all its weights are positive, this point is also the point of least norm in the convex hull of
/// the chosen corners. The point then replaces `best` if it has a smaller norm. The subset of all
/// four corners must be tried last.
void trySubset(const std::vector<Corner>& corners, unsigned subset, Real size, Nearest& best) {
  std::array<std::size_t, 4> chosen{};
  int count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (subset >> i & 1u) chosen[static_cast<std::size_t>(count++)] = i;
  const RealVec p0 = corners[chosen[0]].difference();
  Eigen::Matrix<Real, 3, 1> rest = RealVec::Zero();
  if (count > 1) {
    // Find λ_k such that p0 + Σ λ_k e_k is orthogonal to every e_k: the normal equations, by
    // Cramer's rule.
    RealMat gram = RealMat::Identity();
    RealVec right = RealVec::Zero();
    for (int k = 1; k < count; ++k) {
      const RealVec ek = corners[chosen[static_cast<std::size_t>(k)]].difference() - p0;
      right[k - 1] = -ek.dot(p0);
      for (int l = 1; l < count; ++l)
        gram(k - 1, l - 1) = ek.dot(corners[chosen[static_cast<std::size_t>(l)]].difference() - p0);
    }
    const Real determinant = gram.determinant();
    if (!(determinant > 0)) return;
    for (int k = 0; k < 3; ++k) {
      RealMat replaced = gram;
      replaced.col(k) = right;
      rest[k] = replaced.determinant() / determinant;
    }
  }
  Nearest found;
  found.weights[chosen[0]] = 1 - rest.head(std::max(count - 1, 0)).sum();
  if (!(found.weights[chosen[0]] > 0)) return;
  for (int k = 1; k < count; ++k) {
    if (!(rest[k - 1] > 0)) return;
    found.weights[chosen[static_cast<std::size_t>(k)]] = rest[k - 1];
  }
  RealVec point = RealVec::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    point += found.weights[i] * corners[i].difference();
  found.square = point.squaredNorm();
  // If four corners are around the origin, the origin is a point of their hull, up to rounding. If
  // the hull is almost flat, rounding may give this result wrongly. But then the computed point is
  // not nearer than the faces.
  if (count == 4 && !(std::sqrt(found.square) <= 0x1p-30L * size && 4 * found.square < best.square))
    return;
  if (found.square < best.square) best = found;
}

}  // namespace

RealVec ConvexSet::farthest(const RealVec& direction) const {
  const RealVec* best = points.data();
  Real most = direction.dot(*best);
  for (const RealVec& point : points)
    if (const Real along = direction.dot(point); along > most) most = along, best = &point;
  if (!flatEnds) return *best;
  // The component across the axis may consist only of rounding errors, in an arbitrary direction.
  // So it is made orthogonal a second time. If the result is unusable, the component is ignored;
  // the error is as small as rounding.
  const auto acrossAxis = [&](const RealVec& v) { return RealVec(v - axis * axis.dot(v)); };
  RealVec across = acrossAxis(direction);
  if (!(across.norm() > 0)) return *best;
  across = acrossAxis(across.normalized());
  return across.norm() > 0.5L ? RealVec(*best + across.normalized() * radius) : *best;
}

ConvexSet placed(const ConvexPart& part, const Placement& placement) {
  ConvexSet set;
  set.radius = part.radius;
  set.flatEnds = part.flatEnds;
  for (const Vec3& point : part.points)
    set.points.push_back(placement.rotation * point.cast<Real>() + placement.position);
  if (part.flatEnds)
    set.axis = placement.rotation *
               (part.points[1].cast<Real>() - part.points[0].cast<Real>()).normalized();
  return set;
}

DistanceBounds convexGap(const ConvexSet& a, const ConvexSet& b, const RealVec& guess,
                         Real enough) {
  RealVec onA = a.farthest(guess), onB = b.farthest(-guess);
  std::vector<Corner> corners{{onA, onB}};
  Real lower = -std::numeric_limits<Real>::infinity();
  const Real radii = a.sweptRadius() + b.sweptRadius();
  bool meet = false;
  for (int step = 0; step < kMostSteps; ++step) {
    const RealVec v = onB - onA;
    const Real length = v.norm();
    if (!(length > 0)) {
      meet = true;
      break;
    }
    const Corner corner{a.farthest(v), b.farthest(-v)};
    const Real slab = v.dot(corner.difference()) / length;
    lower = std::max(lower, slab);
    const Real size = corner.onA.norm() + corner.onB.norm();
    if (length - lower <= kFine * size || lower - radii >= enough) break;
    if (std::any_of(corners.begin(), corners.end(), [&](const Corner& old) {
          return old.onA == corner.onA && old.onB == corner.onB;
        }))
      break;  // no progress is possible
    corners.push_back(corner);
    // If a point of the new hull is nearer to the origin than the nearest point so far, it has a
    // positive weight at the new corner. So only subsets with the new corner are tried.
    Nearest best;
    best.square = length * length;
    const unsigned newest = 1u << (corners.size() - 1);
    for (unsigned others = 0; others < newest; ++others)
      trySubset(corners, newest | others, size, best);
    if (!(best.square < length * length)) break;  // only rounding is left
    std::vector<Corner> kept;
    onA = onB = RealVec::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (best.weights[i] == 0) continue;
      kept.push_back(corners[i]);
      onA += best.weights[i] * corners[i].onA;
      onB += best.weights[i] * corners[i].onB;
    }
    corners = std::move(kept);
    if (corners.size() == 4) {  // the origin is inside
      meet = true;
      break;
    }
  }
  DistanceBounds gap;
  const RealVec v = onB - onA;
  const Real length = v.norm();
  if (!meet && length > radii) {
    gap.upper = length - radii;
    gap.lower = std::max<Real>(0, lower - radii);
    gap.onA = onA + v * (a.sweptRadius() / length);
    gap.onB = onB - v * (b.sweptRadius() / length);
  } else {
    gap.upper = gap.lower = 0;
    gap.onA = gap.onB = meet ? onA : RealVec(onA + v * (radii > 0 ? a.sweptRadius() / radii : 0));
  }
  return gap;
}

}  // namespace corridor::verify
