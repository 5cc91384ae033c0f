#pragma once

#include <cstddef>

namespace corridor {

/// The maximum number of vertices, and of triangles, that are read from one file. A mesh with so
/// many vertices and triangles takes 4 GB, and its tree some 8 GB.
constexpr std::size_t kMaxMeshElements = 100'000'000;

/// The maximum of the sum of squares of the numbers of corners, over the polygons of a file that
/// are not convex: one of 10,000 corners, or 10^5 of 30. To cut a polygon takes up to 0.2 µs times
/// this square.
constexpr double kMostPolygonWork = 1e8;

/// The note on a mesh file with lines or points.
constexpr const char* kNoteOnLines = "lines and points have no volume, and are not read";

}  // namespace corridor
