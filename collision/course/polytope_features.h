#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/convex/convex_set.h"
#include "collision/convex/polytope.h"

namespace corridor {

/// A vertex, an edge or a face of a polytope.
struct Feature {
  enum class Kind : std::uint8_t { vertex, edge, face };
  Kind kind = Kind::vertex;
  /// Vertex: its index in `Polytope::vertices()`. Face: its index in `Polytope::faces()`. Edge: the
  /// index of one of its two half-edges (`PolytopeFeatures`).
  std::uint32_t index = 0;

  friend bool operator==(const Feature&, const Feature&) = default;
};

/// The adjacency of a polytope's features, for V-Clip (vclip.h). Each edge consists of two
/// half-edges. A half-edge goes from its tail to its head, counterclockwise along the face on its
/// left.
///
/// The polytope must outlive this object. Memory: about 140 bytes for each vertex. Building takes
/// O(n log n).
class PolytopeFeatures {
 public:
  /// @param set  the view of a `Polytope` or a `DobkinKirkpatrick`.
  /// @throws std::invalid_argument if the set has no polytope.
  explicit PolytopeFeatures(const ConvexSet& set);

  const ConvexSet& set() const { return set_; }
  const Polytope& polytope() const { return *set_.polytope; }
  const Vec3& vertex(std::uint32_t v) const { return set_.points[v]; }

  std::size_t halfEdges() const { return tail_.size(); }
  std::uint32_t tail(std::uint32_t h) const { return tail_[h]; }
  std::uint32_t head(std::uint32_t h) const { return tail_[twin_[h]]; }
  std::uint32_t twin(std::uint32_t h) const { return twin_[h]; }
  std::uint32_t leftFace(std::uint32_t h) const { return left_[h]; }
  /// The half-edges that leave vertex v are `first(v)` to `first(v + 1) - 1`.
  std::uint32_t first(std::uint32_t v) const { return first_[v]; }
  /// The half-edges of a face, in the order of its corners.
  const std::array<std::uint32_t, 3>& sides(std::uint32_t f) const { return sides_[f]; }
  /// The outward normal of a face: unit, rounded.
  const Vec3& normal(std::uint32_t f) const { return normals_[f]; }

  /// Reports whether the feature is one of this polytope's.
  bool has(const Feature& feature) const;
  /// Returns the vertices of a feature: one, two or three. The result may refer to `memory`.
  std::span<const std::uint32_t> corners(const Feature& feature,
                                         std::array<std::uint32_t, 3>& memory) const;
  /// Returns the feature that has exactly these vertices. If there is none, returns the first of
  /// the vertices as a feature.
  Feature withCorners(std::span<const std::uint32_t> vertices) const;

 private:
  ConvexSet set_;
  std::vector<std::uint32_t> first_, tail_, twin_, left_;
  std::vector<std::array<std::uint32_t, 3>> sides_;
  std::vector<Vec3> normals_;
};

}  // namespace corridor
