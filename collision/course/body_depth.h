#pragma once

#include <optional>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/hierarchy/body.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

struct DepthOptions {
  /// Directions along which b may leave a, in a's frame: not 0, finite, of any length. Empty: the
  /// direction of the deepest pair, the direction from the centre of a's bounding sphere to that of
  /// b, and the positive and negative axes of both frames.
  std::vector<Vec3> directions;
  /// Let L be the sum of the radii of both bounding spheres and the distance of their centres. The
  /// error of the depth along a direction is usually at most `accuracy`·L. `accuracy` must be from
  /// 2^-40 to 1/4.
  double accuracy = 0x1p-20;
};

/// Bounds of the penetration depth of two bodies that touch. The depth is the length of the
/// shortest translation of b that separates the bodies. Metres. If the bodies are apart, both
/// bounds are 0.
struct DepthBounds {
  /// No translation by less than `lower` separates the bodies. Each pair of primitives (triangles
  /// or convex parts) that touch has a depth; `lower` is a lower bound of the largest of these
  /// depths. If no primitives touch, because one body is inside a solid mesh, `lower` is a lower
  /// bound of the distance of the surfaces.
  double lower = 0;
  /// A translation by `upper` along `direction_A` separates the bodies, and so does every longer
  /// translation along `direction_A`. `upper` is the least bound over the directions that were
  /// tried. It is infinite if no bound could be proved.
  double upper = 0;
  Vec3 direction_A = Vec3::Zero();       ///< in a's frame; of unit length, rounded
  std::optional<PrimitivePair> deepest;  ///< the pair that gives `lower`, if primitives touch
};

/// Computes bounds of the penetration depth. Both bounds hold in real arithmetic on the given
/// doubles. The bound `lower` holds only if sizes and the magnitudes of coordinates are 0 or from
/// 2^-440 to 2^440 m, because `penetration` requires this.
///
/// The exact depth of bodies that are not convex is costly: it is a distance on the Minkowski sum,
/// which may have n⁶ faces. The lower bound comes from one pair of primitives at a time
/// (`penetration` in course/penetration.h). The upper bound comes from the first contact of b when
/// b approaches a from far away along a direction (`certifyMotion`). Therefore b may be deeper in a
/// than `lower`, and may leave a by a translation that is shorter than `upper`.
/// @param X_AB  the map from b's frame to a's.
/// @throws std::invalid_argument for a map that is not finite, or not within 2^-20 of a rotation;
/// for a direction that is 0 or not finite; and for an accuracy outside its limits.
DepthBounds depthBounds(const Body& a, const Body& b, const Transform& X_AB,
                        const DepthOptions& options, QueryContext& context);

}  // namespace corridor
