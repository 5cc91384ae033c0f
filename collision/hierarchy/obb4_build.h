#pragma once

#include <span>

#include "collision/hierarchy/obb4_tree.h"

namespace corridor {

/// The frame and the unit of an `Obb4Tree`.
struct Obb4Frame {
  Vec3 origin = Vec3::Zero();
  double length = 1;  ///< length of the tree's unit, metres
  double radius = 0;  ///< largest distance of a point from `origin`, metres, rounded up
};

/// The result of building: all data of an `Obb4Tree` except the mesh or the parts.
struct Obb4Layout {
  Obb1 root;
  std::vector<Obb4Tree::Node> nodes;
  std::vector<std::uint32_t> order;  ///< the mesh's triangles, or the parts, in leaf order
  Obb4Frame frame;
};

/// Returns the layout of the tree over `mesh`. The layout is the same for any number of threads and
/// any instruction set.
Obb4Layout layOutObb4(const TriangleMesh& mesh, ObbFit fit, unsigned threads);
/// Returns the layout of the tree over convex parts. Each leaf holds one part. @pre `parts` is not
/// empty.
Obb4Layout layOutObb4(std::span<const ConvexPart> parts, unsigned threads);
/// Returns the layout of a tree of one box, which holds the part.
Obb4Layout layOutObb4(const ConvexPart& part);

/// Fits all boxes of a tree to triangles that have moved. Each box keeps its axes, and is as small
/// as these axes allow. Returns the tree's new frame and unit. If an exception is thrown, nothing
/// has changed.
/// @param order the mesh's triangles in leaf order.
/// @pre The mesh has as many triangles as `order`, and no fault (`checkMesh`).
Obb4Frame refitObb4(const TriangleMesh& moved, std::span<const std::uint32_t> order, Obb1& root,
                    std::span<Obb4Tree::Node> nodes);

}  // namespace corridor
