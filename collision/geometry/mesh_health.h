#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// What is worth knowing about a mesh before trusting it. None of it is an error: any soup is
/// legal.
///
/// Corners are identified by exact position, whatever their indices. Which triangles are degenerate
/// or slivers is for people: no verdict depends on it.
struct MeshHealth {
  std::size_t triangles = 0;
  std::size_t distinctTriangles =
      0;  ///< those with the same three corners, in any order, count once
  std::size_t degenerateTriangles = 0;
  std::size_t sliverTriangles = 0;
  std::size_t boundaryEdges = 0;     ///< used by one distinct triangle that is not degenerate
  std::size_t nonManifoldEdges = 0;  ///< used by three or more of them
  /// Used by two triangles in the same direction, so that one faces out and the other in (triangles
  /// with two equal corners aside).
  std::size_t turnedEdges = 0;
  std::size_t components = 0;  ///< sets of triangles that are connected through shared corners
  /// Every edge is used by exactly two triangles, in opposite directions (triangles with two equal
  /// corners aside).
  bool watertight = false;
  std::string whyNotWatertight;  ///< the first reason, for people; "" where it is
  /// m³, where watertight, and within the range of doubles; negative where the triangles face
  /// inwards. Rounded.
  std::optional<double> volume;
  Vec3 min = Vec3::Zero();  ///< of the corners of triangles, metres
  Vec3 max = Vec3::Zero();
};

/// @pre `checkMesh` has nothing to complain of.
MeshHealth inspectMesh(const TriangleMesh& mesh);

/// *degenerate*: two corners are equal, or the area is at most 1e-12 of the squared diagonal of the
/// mesh's bounds; *sliver*: not that, and the height over the longest edge is under 1e-3 of it.
enum class TriangleQuality { fair, sliver, degenerate };
/// Of each triangle. @pre as above.
std::vector<TriangleQuality> triangleQualities(const TriangleMesh& mesh);

/// For meshes made in memory: the first thing that makes the mesh illegal (a vertex that is not
/// finite, an index out of range), as a sentence; nullopt if it is sound. One without triangles is;
/// no tree can be made of it.
std::optional<std::string> checkMesh(const TriangleMesh& mesh);

}  // namespace corridor
