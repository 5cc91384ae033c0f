#pragma once

#include <cstddef>

namespace corridor {

/// The maximum number of vertices, and of triangles, that are read from one file. A mesh with so
/// many vertices and triangles takes 4 GB, and its tree some 8 GB.
constexpr std::size_t kMaxMeshElements = 100'000'000;

/// The maximum number of corners of a polygon that is not convex: to cut it takes time that grows
/// as their square.
constexpr std::size_t kMostPolygonCorners = 20'000;

/// The note on a mesh file with lines or points.
constexpr const char* kNoteOnLines = "lines and points have no volume, and are not read";

}  // namespace corridor
