#pragma once

#include <optional>

#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/geometry/mesh_components.h"
#include "collision/hierarchy/body.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/queries/interference.h"

namespace corridor {

/// A mesh in a containment query: the solid, or the mesh that may be inside it.
struct MeshWithComponents {
  const ObbTree& tree;
  const MeshComponents& components;  ///< components of the tree's mesh
};

/// Tests whether the point `p`, in the coordinates of a frame P, is inside a watertight component
/// of `solid`. If the point is inside, returns the number (in the mesh) of a triangle of this
/// component; otherwise nullopt.
///
/// A point is inside a component if a ray from it crosses the component an odd number of times,
/// whichever way the component's triangles face. Each component is tested separately, so a point
/// inside several components, or in the hollow of a shell, is inside. The answer is exact under
/// both maps in real arithmetic, with two exceptions. A point on the surface itself may be reported
/// as inside or not. If all of 64 rays meet an edge or lie in the plane of a triangle, the point
/// counts as inside.
/// @pre The maps are finite, and standardFloatingPoint() holds (asserted in debug builds).
std::optional<std::uint32_t> containing(const Posed<MeshWithComponents>& solid, const Vec3& p,
                                        const Transform& X_WP, QueryContext& context);

/// Returns a pair of triangles if a component of `inner` is inside `solid`, else nullopt. Triangle
/// `a` belongs to the component of `solid`, `b` to the component inside it.
/// @pre The surfaces don't touch (`interference`). One point of a component then decides for the
/// whole component.
std::optional<PrimitivePair> findEnclosed(const Posed<MeshWithComponents>& solid,
                                          const Posed<MeshWithComponents>& inner,
                                          QueryContext& context);
/// The same test with a convex part as `inner`; `b` of the result is 0. The precondition is the
/// same.
std::optional<PrimitivePair> findEnclosed(const Posed<MeshWithComponents>& solid,
                                          const Posed<ConvexPart>& inner, QueryContext& context);
/// The same test for two bodies. Returns nullopt unless `solid` is a solid mesh: a body inside a
/// convex part touches the part, so `interference` reports it. The precondition is the same.
std::optional<PrimitivePair> findEnclosed(const Posed<Body>& solid, const Posed<Body>& inner,
                                          QueryContext& context);
/// Returns a pair if a component of one body is inside the other body, else nullopt. The first
/// number belongs to `a`, the second to `b`.
/// @pre The surfaces don't touch.
/// @throws std::invalid_argument for a pose that is not finite.
std::optional<PrimitivePair> findOneInsideOther(const Posed<Body>& a, const Posed<Body>& b,
                                                QueryContext& context);

}  // namespace corridor
