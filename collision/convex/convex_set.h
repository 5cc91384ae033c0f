#pragma once

#include <cstdint>
#include <span>

#include "collision/core/transform.h"
#include "collision/geometry/convex_part.h"
#include "collision/predicates/triangle.h"

namespace corridor {

class PointColumns;
class Polytope;

/// A structure that finds the farthest vertex of a polytope along a direction: the hierarchy of
/// Dobkin and Kirkpatrick (course/dobkin_kirkpatrick.h).
class VertexSearch {
 public:
  virtual ~VertexSearch() = default;
  /// Returns a vertex that is farthest along a finite direction, exactly.
  virtual std::uint32_t farthest(const Vec3& direction) const = 0;

 protected:
  VertexSearch() = default;
  VertexSearch(const VertexSearch&) = default;
  VertexSearch& operator=(const VertexSearch&) = default;
};

/// A view of a convex part, a triangle or a polytope: a *core* swept by a sphere of radius `ball`.
/// The core is the hull of `points`, or a cylinder, which is the segment between two points swept
/// by a disc. The viewed object must outlive the view. Lengths in metres.
///
/// Queries need the point that is farthest along a direction. For a part or a triangle they test
/// all n points, in O(n); for `PointColumns` several at once. For a `Polytope` they climb along
/// edges, in some O(√n), or use its `VertexSearch`, if there is one. The choice changes no answer
/// by more than the promised error.
struct ConvexSet {
  ConvexSet(const ConvexPart& part)  // NOLINT: a part is a convex set
      : points(part.points), ball(part.radius) {
    if (part.flatEnds) sweepDisc();
  }
  ConvexSet(const Triangle& triangle);  // NOLINT: a triangle is a convex set
  ConvexSet(const Polytope& polytope);  // NOLINT: a polytope is a convex set
  /// `search` belongs to the same polytope.
  ConvexSet(const Polytope& polytope, const VertexSearch& search);
  explicit ConvexSet(const PointColumns& columns);  ///< the hull of the points

  static constexpr std::uint32_t kCold = ~std::uint32_t{0};

  /// Returns the index of a point that is farthest along m. For polytopes the answer is exact,
  /// unless m has overflowed. For other sets it is the point whose rounded product with m is the
  /// largest.
  /// @param start  a vertex that is likely near the answer, to save time; `kCold` if no such vertex
  /// is known.
  std::uint32_t farthest(const Vec3& m, std::uint32_t start = kCold) const {
    if (columns) return farthestOfColumns(m);
    if (polytope) return farthestVertex(m, start);
    std::uint32_t best = 0;
    double highest = m.dot(points[0]);
    for (std::uint32_t i = 1; i < points.size(); ++i) {
      const double along = m.dot(points[i]);
      if (along > highest) highest = along, best = i;
    }
    return best;
  }

  std::span<const Vec3> points;
  double ball = 0;                        ///< radius of the sphere; 0: none
  double disc = 0;                        ///< radius of the disc; 0: none
  Vec3 axis = Vec3::Zero();               ///< normal of the disc: unit, rounded
  const Polytope* polytope = nullptr;     ///< null for parts and triangles
  const VertexSearch* search = nullptr;   ///< null: by hill climbing
  const PointColumns* columns = nullptr;  ///< `points` for SIMD kernels; null: not in columns

 private:
  void sweepDisc();  ///< turns a capsule into a cylinder
  std::uint32_t farthestVertex(const Vec3& m, std::uint32_t start) const;
  std::uint32_t farthestOfColumns(const Vec3& m) const;
};

/// A convex set under an affine map x ↦ M x + t, with *certified* projections. Each projection has
/// a proved error bound, in real arithmetic on the given doubles, for any direction and any finite
/// map. The projection of M x onto n is the projection of x onto Mᵀn, so M need not be orthogonal.
///
/// Error of a projection. Let u = 2^-53, F = ‖M‖_F, |n|₂ ≤ 1 + 5u and ρ ≥ |p| + ball + disc for all
/// points p. γ3 = 3u/(1 − 3u) bounds the relative error of three roundings.
/// * Mᵀn has three roundings per component, so it is off by at most γ3·‖|M|‖₂·|n| < 3.1uF. This
///   changes the product with p by 3.1uFρ.
/// * The rounding of the product with p: γ3·|Mᵀn||p| < 3.1uFρ. That of the product n·t: 3.1u|t|.
/// * The sum of these two products and of the sphere's or the disc's term: 2u(Fρ + |t|).
/// * The sphere's term ball·|Mᵀn|, per unit of `ball`: 3.1uF from Mᵀn, 4uF from the norm.
/// * The disc's term disc·|Mᵀn × axis|, per unit of `disc`: 3.1uF from Mᵀn. The axis is off by 1u
///   (difference of the points) + 5u (norm and quotient), which gives 6uF. Cross product and norm:
///   2√2·1.1uF + 4uF. Together < 17uF.
///
/// Total: the error from the points is below 6.2uF|p|, the error from the sphere below 7.1uF·ball,
/// and the error from the disc below 17uF·disc. As |p| + ball + disc ≤ ρ, these three errors
/// together are below 17uFρ. With the sum and n·t the total is below u(20Fρ + 6|t|).
///
/// Sizes and coordinates should be 0 or within 2^±440 m. Outside this range, squares overflow or
/// vanish. Then contact queries may report a contact that does not exist, and distances may be too
/// small. Even then, no contact is missed, and no distance is too large.
///
/// The first call of `error`, `localReach` or `reach` computes all three. So threads must not share
/// a `PosedSet`.
class PosedSet {
 public:
  PosedSet(const ConvexSet& set, const Transform& X) : set_(set), X_(X) {}

  /// Returns max n·x over all points x of the image, off by at most `error()`; metres.
  /// @pre |n| ≤ 1 + 5u.
  /// @param start  as for `ConvexSet::farthest`.
  double highest(const Vec3& n, std::uint32_t start = ConvexSet::kCold) const;
  double error() const { return found(), error_; }

  /// Returns max m·p over the points p of the core; m and p are in the set's own frame. Rounded.
  double coreHighest(const Vec3& m, std::uint32_t start = ConvexSet::kCold) const;

  /// Returns whether all numbers of the set and of its map are finite. (Queries need no such test:
  /// a set with NaN or infinities has NaN or infinity as its bounds, and is never separated.)
  bool isFinite() const;
  /// True if the map takes the sphere to a sphere, up to 3·2^-48 of its radius.
  bool keepsBall() const;

  const ConvexSet& set() const { return set_; }
  const Transform& pose() const { return X_; }
  /// Returns the largest |p| + ball + disc over the points p in the set's own frame; rounded up.
  /// Metres.
  double localReach() const { return found(), localReach_; }
  /// Returns ‖M‖_F·`localReach()`, rounded up: an upper bound of the distance of the image's points
  /// from t. Metres.
  double reach() const { return found(), reach_; }

 private:
  void found() const {
    if (!(error_ >= 0)) findBounds();
  }
  void findBounds() const;

  ConvexSet set_;
  Transform X_;
  mutable double localReach_ = 0, reach_ = 0, error_ = -1;  // found when first needed
};

}  // namespace corridor
