#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/volumes/content.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// The leaf primitives of a tree, in leaf order: triangles or convex parts.
struct TreePrimitives {
  std::vector<Triangle> triangles;
  std::vector<ConvexPart> parts;
  std::vector<std::uint32_t> numbers;  ///< each leaf primitive's number in the input

  explicit TreePrimitives(const TriangleMesh& mesh);
  explicit TreePrimitives(std::vector<ConvexPart> convexParts);

  std::uint32_t size() const { return static_cast<std::uint32_t>(numbers.size()); }
  void swap(std::uint32_t i, std::uint32_t k);
  /// Reorders the leaf primitives: the one at index order[i] moves to index i.
  void reorder(std::span<const std::uint32_t> order);

  /// Returns three times the signed distance of leaf primitive i's centroid from the plane through
  /// `mean` with the unit normal `normal`. For a convex part, the centroid is that of its points.
  double side(std::uint32_t i, const Vec3& mean, const Vec3& normal) const;
  /// Calls f with the `Content` of the leaf primitives [first, first + count).
  template <class F>
  decltype(auto) withContent(std::uint32_t first, std::uint32_t count, F&& f) const {
    if (parts.empty()) return f(Content(std::span(triangles).subspan(first, count)));
    const std::vector<Ball> balls = ballsOfParts(first, count);
    return f(Content(balls));
  }

 private:
  std::vector<Ball> ballsOfParts(std::uint32_t first, std::uint32_t count) const;
};

}  // namespace corridor
