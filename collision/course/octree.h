#pragma once

#include <cstdint>
#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "collision/predicates/triangle.h"
#include "collision/volumes/aabb.h"
#include "collision/volumes/volume.h"

namespace corridor {

struct OctreeParams {
  /// A cell with more triangles than this is divided, unless its children together would list far
  /// more triangles than the cell.
  std::uint32_t leafTriangles = 8;
  std::uint32_t depth = 10;  ///< cells at this level are not divided
};

/// A tree over space, for comparison with trees over objects. The root is a cube around the mesh. A
/// cell with many triangles is divided into eight. A leaf lists all triangles whose bounding boxes
/// meet the leaf's closed cell. Large triangles are therefore listed often, and the cells don't
/// follow the surface of the body.
///
/// Each point of a triangle is in a cell that lists the triangle. Two bodies therefore touch only
/// in cells that are not separated. An octree is immutable.
class Octree {
 public:
  struct Node {
    Aabb box;  ///< contains the cell
    double radius = 0;
    std::uint32_t first = 0, count = 0;  ///< for a leaf: its range of `triangles()`
    /// For an inner node: its first child and the number of its children. Empty cells are omitted.
    std::uint32_t firstChild = 0, children = 0;
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
  /// The triangles of all leaves, leaf by leaf. A triangle occurs once for each leaf that lists it.
  /// `meshTriangle(i)` is the number of `triangles()[i]` in the mesh.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return numbers_[i]; }
  static constexpr bool hasParts() { return false; }

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
