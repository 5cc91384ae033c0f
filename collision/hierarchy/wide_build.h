#pragma once

#include "collision/hierarchy/wide_obb_tree.h"

namespace corridor {

/// What building finds out about a mesh: all of a `WideObbTree` but the mesh itself.
struct WideLayout {
  Obb1 root;
  std::vector<WideObbTree::Node> nodes;
  std::vector<std::uint32_t> order;  ///< the mesh's triangles in leaf order
  Vec3 origin = Vec3::Zero();
  double length = 1;  ///< of the unit, metres
  double radius = 0;
};

/// The same for any number of threads and any instruction set.
WideLayout layOutWide(const TriangleMesh& mesh, ObbFit fit, unsigned threads);

}  // namespace corridor
