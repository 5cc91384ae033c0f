#include "collision/course/polytope_features.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

namespace corridor {

PolytopeFeatures::PolytopeFeatures(const ConvexSet& set) : set_(set) {
  if (!set.polytope) throw std::invalid_argument("features need a convex set with a polytope");
  const Polytope& p = polytope();
  const auto count = static_cast<std::uint32_t>(p.vertices().size());
  first_.reserve(count + 1);
  // For each half-edge: its tail and head as one number, and its index.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> byEnds;
  const auto ends = [](std::uint64_t tail, std::uint64_t head) { return tail << 32 | head; };
  for (std::uint32_t v = 0; v < count; ++v) {
    first_.push_back(static_cast<std::uint32_t>(tail_.size()));
    for (const std::uint32_t w : p.neighbours(v)) {
      byEnds.emplace_back(ends(v, w), static_cast<std::uint32_t>(tail_.size()));
      tail_.push_back(v);
    }
  }
  first_.push_back(static_cast<std::uint32_t>(tail_.size()));
  std::sort(byEnds.begin(), byEnds.end());
  const auto between = [&](std::uint32_t tail, std::uint32_t head) {
    return std::lower_bound(byEnds.begin(), byEnds.end(), std::pair(ends(tail, head), 0U))->second;
  };
  twin_.resize(tail_.size());
  left_.resize(tail_.size());
  for (const auto& [key, h] : byEnds)
    twin_[h] = between(static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32));
  for (std::uint32_t f = 0; f < p.faces().size(); ++f) {
    const Polytope::Face& face = p.faces()[f];
    std::array<std::uint32_t, 3> sides;
    for (std::size_t k = 0; k < 3; ++k) {
      sides[k] = between(face[k], face[(k + 1) % 3]);
      left_[sides[k]] = f;
    }
    sides_.push_back(sides);
    // Both edges are normalised first, so that products neither overflow nor vanish.
    Vec3 u = vertex(face[1]) - vertex(face[0]), w = vertex(face[2]) - vertex(face[0]);
    u = u.stableNormalized();
    w = w.stableNormalized();
    normals_.push_back(u.cross(w).stableNormalized());
  }
}

bool PolytopeFeatures::has(const Feature& feature) const {
  switch (feature.kind) {
    case Feature::Kind::vertex:
      return feature.index < set_.points.size();
    case Feature::Kind::edge:
      return feature.index < halfEdges();
    default:
      return feature.index < sides_.size();
  }
}

std::span<const std::uint32_t> PolytopeFeatures::corners(
    const Feature& feature, std::array<std::uint32_t, 3>& memory) const {
  switch (feature.kind) {
    case Feature::Kind::vertex:
      memory[0] = feature.index;
      return std::span(memory).first(1);
    case Feature::Kind::edge:
      memory = {tail(feature.index), head(feature.index), 0};
      return std::span(memory).first(2);
    default:
      memory = polytope().faces()[feature.index];
      return memory;
  }
}

Feature PolytopeFeatures::withCorners(std::span<const std::uint32_t> vertices) const {
  const std::uint32_t v = vertices[0];
  const auto isCorner = [&](std::uint32_t w) {
    return std::find(vertices.begin(), vertices.end(), w) != vertices.end();
  };
  for (std::uint32_t h = first(v); vertices.size() > 1 && h < first(v + 1); ++h) {
    if (!isCorner(head(h))) continue;
    if (vertices.size() == 2) return {Feature::Kind::edge, h};
    const Polytope::Face& face = polytope().faces()[leftFace(h)];
    if (std::all_of(face.begin(), face.end(), isCorner)) return {Feature::Kind::face, leftFace(h)};
  }
  return {Feature::Kind::vertex, v};
}

}  // namespace corridor
