#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// Counts, bounds and defects of a mesh. No defect is an error: any soup is legal.
///
/// Corners are identified by exact position, not by index. The counts of degenerate and sliver
/// triangles are for reports only; no verdict depends on them.
struct MeshHealth {
  std::size_t triangles = 0;
  /// Triangles with the same three corners, in any order, count once.
  std::size_t distinctTriangles = 0;
  std::size_t degenerateTriangles = 0;
  std::size_t sliverTriangles = 0;
  std::size_t boundaryEdges = 0;  ///< edges of exactly one distinct triangle that is not degenerate
  std::size_t nonManifoldEdges = 0;  ///< edges of three or more such triangles
  /// Edges of exactly two triangles that use the edge in the same direction: so one of the two
  /// triangles faces outwards, and the other faces inwards. Triangles with two equal corners do not
  /// count.
  std::size_t misorientedEdges = 0;
  /// Sets of triangles connected through shared corners. (`findComponents` requires shared edges.)
  std::size_t components = 0;
  /// True if the mesh has edges, and each edge is used by exactly two triangles, in opposite
  /// directions. Triangles with two equal corners do not count.
  bool watertight = false;
  std::string whyNotWatertight;  ///< the first reason, for messages; "" if watertight
  /// The volume in m³, rounded; negative if the triangles face inwards. Set only if the mesh is
  /// watertight and its volume is in the range of doubles.
  std::optional<double> volume;
  Vec3 min = Vec3::Zero();  ///< bounds of the corners of triangles, metres
  Vec3 max = Vec3::Zero();
};

/// Computes the health of a mesh. @pre `checkMesh` reports nothing.
MeshHealth inspectMesh(const TriangleMesh& mesh);

/// *degenerate*: two corners are equal, or the area is at most 1e-12 of the squared diagonal of the
/// mesh's bounds. *sliver*: not degenerate, and the height over the longest edge is under 1e-3 of
/// that edge.
enum class TriangleQuality { fair, sliver, degenerate };
/// Returns the quality of each triangle. @pre `checkMesh` reports nothing.
std::vector<TriangleQuality> triangleQualities(const TriangleMesh& mesh);

/// Checks a mesh. Returns the first fault that makes the mesh illegal (a vertex that is not finite,
/// an index out of range), or nullopt if the mesh is legal. A mesh without triangles is legal, but
/// no tree can be built over it.
std::optional<std::string> checkMesh(const TriangleMesh& mesh);

}  // namespace corridor
