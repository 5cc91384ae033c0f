#include "collision/hierarchy/obb4_tree.h"

#include <stdexcept>
#include <utility>

#include "collision/core/parallel.h"
#include "collision/core/rounding.h"
#include "collision/geometry/mesh_health.h"
#include "collision/hierarchy/check_part.h"
#include "collision/hierarchy/obb4_build.h"

namespace corridor {
namespace {

constexpr std::size_t kMostItems = (std::size_t{1} << 29) - 1;

}  // namespace

Obb4Tree::Obb4Tree(const TriangleMesh& mesh, ObbFit fit, unsigned threads)
    : vertices_(mesh.vertices) {
  requireStandardFloatingPoint();
  const std::size_t n = mesh.triangles.size();
  if (n == 0) throw std::invalid_argument("a tree needs at least one triangle");
  if (const auto complaint = checkMesh(mesh)) throw std::invalid_argument(*complaint);
  if (n >= kMostItems) throw std::length_error("a tree must have fewer than 2^29 - 1 triangles");
  take(layOutObb4(mesh, fit, threads));
  takeTriangles(mesh, threads);
}

Obb4Tree::Obb4Tree(const TriangleMesh& mesh, Obb4Layout layout) : vertices_(mesh.vertices) {
  requireStandardFloatingPoint();
  take(std::move(layout));
  takeTriangles(mesh, 1);
}

Obb4Tree::Obb4Tree(std::shared_ptr<const std::vector<ConvexPart>> parts, unsigned threads)
    : parts_(std::move(parts)) {
  requireStandardFloatingPoint();
  if (!parts_ || parts_->empty()) throw std::invalid_argument("a tree needs at least one part");
  if (parts_->size() >= kMostItems)
    throw std::length_error("a tree must have fewer than 2^29 - 1 parts");
  for (const ConvexPart& part : *parts_) requireValid(part, "a part of a tree");
  take(parts_->size() == 1 ? layOutObb4(parts_->front()) : layOutObb4(*parts_, threads));
}

void Obb4Tree::take(Obb4Layout layout) {
  root_ = layout.root;
  nodes_ = std::move(layout.nodes);
  meshTriangle_ = std::move(layout.order);
  take(layout.frame);
}

void Obb4Tree::takeTriangles(const TriangleMesh& mesh, unsigned threads) {
  const std::size_t n = meshTriangle_.size();
  triangles_.resize(n);
  inParts(threads, n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) triangles_[i] = mesh.triangles[meshTriangle_[i]];
  });
}

Obb4Layout Obb4Tree::layout() const {
  return {root_, nodes_, meshTriangle_, {origin_, length_, radius_}};
}

void Obb4Tree::take(const Obb4Frame& frame) {
  origin_ = frame.origin;
  length_ = frame.length;
  radius_ = frame.radius;
  reach_ = roundedUp(origin_.stableNorm() + radius_);
}

void Obb4Tree::refit(const TriangleMesh& moved) {
  requireStandardFloatingPoint();
  if (hasParts()) throw std::invalid_argument("a tree of convex parts can't be refitted");
  if (moved.triangles.size() != triangleCount())
    throw std::invalid_argument(
        "a tree can only be refitted to a mesh of the same number of triangles: " +
        std::to_string(triangleCount()) + ", not " + std::to_string(moved.triangles.size()));
  if (const auto complaint = checkMesh(moved)) throw std::invalid_argument(*complaint);
  std::vector<Vec3> vertices = moved.vertices;
  take(refitObb4(moved, meshTriangle_, root_, nodes_));
  vertices_ = std::move(vertices);
  takeTriangles(moved, 1);
}

std::size_t Obb4Tree::bytes() const {
  std::size_t parts = 0;
  if (parts_)
    for (const ConvexPart& part : *parts_)
      parts += sizeof(part) + part.points.capacity() * sizeof(Vec3);
  return sizeof(*this) + nodes_.capacity() * sizeof(Node) + vertices_.capacity() * sizeof(Vec3) +
         triangles_.capacity() * sizeof(triangles_[0]) +
         meshTriangle_.capacity() * sizeof(std::uint32_t) + parts;
}

}  // namespace corridor
