#pragma once

#include <span>

#include "collision/core/transform.h"
#include "collision/geometry/convex_part.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// A look at a convex part, or at a triangle, the hull of its corners: a *core* (the hull of the
/// points, or a cylinder: the segment between two of them swept by a disc) swept by a ball. What it
/// looks at must stay.
struct ConvexSet {
  ConvexSet(const ConvexPart& part);    // NOLINT: a part is one
  ConvexSet(const Triangle& triangle);  // NOLINT: a triangle is one

  std::span<const Vec3> points;
  double ball = 0;           ///< radius
  double disc = 0;           ///< radius; 0: none
  Vec3 axis = Vec3::Zero();  ///< of the disc: unit, rounded
};

/// A convex set under a map, with *certified* projections: whatever direction anyone comes up with,
/// what is proved along it holds in real arithmetic for the doubles given, any finite map included.
/// An image's projection onto n is that of the set onto Mᵀn, so no orthogonality is used.
///
/// Error. Let F = ‖M‖_F, |n|₂ ≤ 1 + 4u, ρ = `reach` ≥ |p| + ball + disc. Mᵀn: three roundings a
/// component, so off by at most γ3·‖|M|‖₂·|n| < 3.1uF; times |p|: 3.1uFρ. The product with p:
/// γ3·|Mᵀn||p| < 3.1uFρ; n·t: 3.1u|t|; adding these two and the ball's or the disc's share: 2u(Fρ +
/// |t|). The ball's share |Mᵀn|: 3.1uF and 4uF. The disc's |Mᵀn × axis|: 3.1uF; the axis is off by
/// 1u (difference of the points) + 5u (norm and quotient), 6uF; cross product and norm: 2√2·1.1uF +
/// 4uF: together < 17uF. Points and discs share ρ: all in all below u(20Fρ + 6|t|).
///
/// Sizes and coordinates are taken to be within 2^±440 m, or 0. Beyond, squares overflow or vanish:
/// contact queries and distances may then tell contact, or less than there is, never more.
class PosedSet {
 public:
  PosedSet(const ConvexSet& set, const Transform& X);

  /// max n·x over all points of the image, rounded: off by at most `error()`. |n| ≤ 1 + 4u.
  double highest(const Vec3& n) const;
  double error() const { return error_; }

  /// max m·p over the core in the set's own frame.
  double coreHighest(const Vec3& m) const;

  /// Does the map leave the ball one, but for 3·2^-48 of its radius?
  bool keepsBall() const;

  const ConvexSet& set() const { return set_; }
  const Transform& pose() const { return X_; }
  /// |p| + ball + disc for all points, in the set's own frame, times ‖M‖_F (at least 1); rounded
  /// up. Metres.
  double reach() const { return reach_; }

 private:
  ConvexSet set_;
  Transform X_;
  double reach_ = 0, error_ = 0;
};

}  // namespace corridor
