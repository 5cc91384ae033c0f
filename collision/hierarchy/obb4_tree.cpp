#include "collision/hierarchy/obb4_tree.h"

#include <stdexcept>

#include "collision/core/parallel.h"
#include "collision/core/rounding.h"
#include "collision/geometry/mesh_health.h"
#include "collision/hierarchy/obb4_build.h"

namespace corridor {

Obb4Tree::Obb4Tree(const TriangleMesh& mesh, ObbFit fit, unsigned threads)
    : vertices_(mesh.vertices) {
  requireStandardFloatingPoint();
  const std::size_t n = mesh.triangles.size();
  if (n == 0) throw std::invalid_argument("a tree needs at least one triangle");
  if (const auto complaint = checkMesh(mesh)) throw std::invalid_argument(*complaint);
  if (n >= (1U << 29) - 1)
    throw std::length_error("a tree must have fewer than 2^29 - 1 triangles");
  Obb4Layout layout = layOutObb4(mesh, fit, threads);
  root_ = layout.root;
  nodes_ = std::move(layout.nodes);
  meshTriangle_ = std::move(layout.order);
  triangles_.resize(n);
  inParts(threads, n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) triangles_[i] = mesh.triangles[meshTriangle_[i]];
  });
  origin_ = layout.origin;
  length_ = layout.length;
  radius_ = layout.radius;
  reach_ = roundedUp(origin_.stableNorm() + radius_);
}

std::size_t Obb4Tree::bytes() const {
  return sizeof(*this) + nodes_.capacity() * sizeof(Node) + vertices_.capacity() * sizeof(Vec3) +
         triangles_.capacity() * sizeof(triangles_[0]) +
         meshTriangle_.capacity() * sizeof(std::uint32_t);
}

}  // namespace corridor
