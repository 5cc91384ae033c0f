#pragma once

#include <cstdint>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/predicates/triangle.h"
#include "collision/volumes/aabb.h"
#include "collision/volumes/volume.h"

namespace corridor {

struct OctreeParams {
  std::uint32_t leafTriangles = 8;  ///< cells with more are divided, …
  std::uint32_t depth = 10;  ///< … down to this level, unless the children list far more in all
};

/// A tree over space, for comparison with trees over objects: a cube around the mesh, divided into
/// eight where it holds many triangles. A leaf lists all triangles whose box meets its closed cell.
/// So large triangles are listed often, and cells don't follow the surface of the body.
///
/// Each point of a triangle is in a cell that lists the triangle. So two bodies touch only in cells
/// that are not separated. Immutable.
class Octree {
 public:
  struct Node {
    Aabb box;  ///< contains the cell
    double radius = 0;
    std::uint32_t first = 0, count = 0;          ///< leaf only: its range of `triangles()`
    std::uint32_t firstChild = 0, children = 0;  ///< cells without triangles are left out
    bool isLeaf() const { return children == 0; }
  };

  /// @pre the mesh has a triangle, finite coordinates, and indices in range (`checkMesh`).
  explicit Octree(const TriangleMesh& mesh, const OctreeParams& params = {});

  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  template <class F>
  void forEachChildBackwards(std::uint32_t i, F&& f) const {
    const Node& node = nodes_[i];
    for (std::uint32_t c = node.children; c-- > 0;) f(node.firstChild + c);
  }
  /// Triangles by leaf, each as often as it is listed; and the number of each in the mesh.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return numbers_[i]; }
  const ConvexPart* part(std::uint32_t = 0) const { return nullptr; }

  const VolumeBounds& bounds() const { return bounds_; }
  /// Largest |x|₂ of all points, rounded up.
  double reach() const { return bounds_.reach; }
  std::size_t bytes() const;

 private:
  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> numbers_;
  VolumeBounds bounds_;
};

}  // namespace corridor
