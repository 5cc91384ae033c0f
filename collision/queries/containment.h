#pragma once

#include <optional>

#include "collision/core/query_context.h"
#include "collision/geometry/mesh_components.h"
#include "collision/hierarchy/body.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/queries/interference.h"

namespace corridor {

/// A mesh as a solid, or as what may be in one.
struct MeshBody {
  const ObbTree& tree;
  const MeshComponents& components;  ///< of the tree's mesh
};

/// The number of a triangle of a watertight component of `solid` that has the point inside, or
/// none. A component has inside what a ray from it crosses the component an odd number of times on
/// its way out, whichever way the component faces; a point in several, or in the hollow of a shell,
/// is inside. Exact under both maps in real arithmetic; a point on the surface itself may be called
/// either.
/// @pre finite maps.
std::optional<std::uint32_t> containing(const MeshBody& solid, const Transform& X_WS, const Vec3& p,
                                        const Transform& X_WP, QueryContext& context);

/// Is a component of `inner` inside `solid`? For bodies whose surfaces don't touch
/// (`interference`): then one point tells where a component is. The pair of triangles: of the
/// component around, and of the one inside.
std::optional<TrianglePair> enclosed(const MeshBody& solid, const Transform& X_WS,
                                     const MeshBody& inner, const Transform& X_WI,
                                     QueryContext& context);
/// A convex part, likewise; `b` is 0.
std::optional<TrianglePair> enclosed(const MeshBody& solid, const Transform& X_WS,
                                     const ConvexPart& inner, const Transform& X_WI,
                                     QueryContext& context);
/// Is a component of the body `inner` inside the body `solid`, a solid mesh? Nothing is inside
/// other bodies: what is inside a convex part touches it. @pre surfaces that don't touch.
std::optional<TrianglePair> enclosed(const Body& solid, const Transform& X_WS, const Body& inner,
                                     const Transform& X_WI, QueryContext& context);
/// Is one of two bodies, or a component of it, inside the other? The pair is (of a, of b).
/// @pre surfaces that don't touch.
/// @throws std::invalid_argument for a pose that is not finite.
std::optional<TrianglePair> insideEachOther(const Body& a, const Transform& X_WA, const Body& b,
                                            const Transform& X_WB, QueryContext& context);

}  // namespace corridor
