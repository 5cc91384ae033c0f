#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "collision/geometry/mesh_text.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/predicates/orientation.h"

/// Cuts the polygons of mesh files into triangles.
namespace corridor {

/// A face of a mesh with more than three corners, stored as a fan: triangle k of the fan has the
/// corners 0, k + 1 and k + 2.
struct PolygonFan {
  std::uint32_t firstTriangle = 0;
  std::uint32_t triangles = 0;  ///< the number of corners - 2
  std::uint32_t face = 0;       ///< the number of the face in the file, from 1; 0: not known
  int line = 0;                 ///< 0: the format has no lines
};

/// Replaces the triangles of each fan by triangles that cover the polygon, as many as before. Their
/// corners are the polygon's. A convex polygon stays a fan. The polygon may be concave, may have
/// straight corners and repeated ones, and may touch itself, as a polygon with a hole does whose
/// boundary is one loop.
///
/// The decisions are exact (`lineSide`), in the projection along the axis that is nearest to the
/// polygon's normal. So a flat polygon is covered exactly, apart from the rounding of its own
/// corners. Adds a note if there are polygons that are not flat, with the largest deviation, and a
/// note if polygons stay fans although they cross themselves: those narrower than 1e-5 of their
/// length, which the digits of a file may let cross, and those with corners farther than 1 % of
/// their size from a plane, of which no surface is the right one.
///
/// @throws InputError: another polygon crosses or overlaps itself; or the polygons that are not
/// convex have too many corners: the sum of the squares of these numbers exceeds
/// `kMostPolygonWork`.
void cutPolygons(TriangleMesh& mesh, std::span<const PolygonFan> fans, MeshFaults& faults,
                 std::vector<std::string>& notes);

/// Cuts a counterclockwise polygon into n - 2 triangles, given by the indices of their corners,
/// counterclockwise. Some of the triangles may be flat, where corners are straight or repeated. The
/// interiors of the others are disjoint, and they cover all points about which the boundary winds.
/// Exact. O(n) for convex polygons, O(n^2) for most others.
///
/// Method: ears are cut off (G. H. Meisters, Polygons have ears, 1975). An ear is a corner whose
/// triangle no other edge enters. The result is checked: triangles of the same boundary are right
/// if and only if they do not overlap.
/// @returns nothing if the boundary does not wind about each point once or not at all: it crosses
/// itself, goes around twice, or is clockwise. Also nothing for some boundaries that do, but run
/// along an edge three times or cross themselves without area.
/// @pre n >= 3, and all coordinates are finite.
std::vector<std::array<std::uint32_t, 3>> trianglesOfPolygon(std::span<const Vec2> corners);

}  // namespace corridor
