#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/course/dobkin_kirkpatrick.h"

namespace corridor {

/// The outer hierarchy of a convex polytope Q. Q_0 is Q. Q_j is the intersection of the half-spaces
/// that remain after an independent set of half-spaces is removed from Q_{j−1}. Each removed
/// half-space has at most 8 neighbours. The last Q_j has four half-spaces. So all of Q_0 ⊂ Q_1 ⊂ …
/// contain Q, while Q contains the polytopes of the inner hierarchy (`DobkinKirkpatrick`). Height
/// O(log n), memory O(n).
///
/// The vertices of Q_j are not representable as doubles, so Q_j is stored as half-spaces. The outer
/// hierarchy is the hierarchy of Dobkin and Kirkpatrick of the polar polytope. The polar polytope
/// has a vertex y for each half-space y·(x − o) ≤ 1 of Q, where o is a point inside Q, called the
/// center. |y| is the reciprocal of the distance of the half-space's plane from o. Each y is
/// rounded, and is off by a few units in the last place of |y|. Coplanar triangles of Q give one
/// half-space. Because of this rounding, the hierarchy only guides searches. The answers of these
/// searches must be proved with the vertices of Q.
///
/// Building: the hierarchy takes O(n), but the hull of the rounded points is computed anew, in
/// O(n log n) on usual polytopes.
///
/// Source: L. Barba, S. Langerman, Optimal detection of intersections between convex polyhedra
/// (SODA 2015).
class OuterHierarchy {
 public:
  /// @param inner  the inner hierarchy of the same polytope, which must outlive this object.
  explicit OuterHierarchy(const DobkinKirkpatrick& inner);

  const DobkinKirkpatrick& inner() const { return *inner_; }
  /// The hierarchy of the polar polytope; null if rounding leaves no polar polytope, because Q is
  /// nearly flat in double, or has huge or tiny coordinates.
  const DobkinKirkpatrick* polar() const { return polar_ ? &*polar_ : nullptr; }
  /// The point o.
  const Vec3& center() const { return center_; }
  /// Vertices of Q whose hull contains the center, up to rounding: at most 10.
  std::span<const std::uint32_t> core() const { return core_; }
  /// The vertices of the face of Q on the plane of half-space k (a vertex of the polar),
  /// counterclockwise from outside.
  std::span<const std::uint32_t> face(std::uint32_t k) const {
    const std::size_t f = polar_->polytope().source(k);
    return std::span(faceVertex_).subspan(start_[f], start_[f + 1] - start_[f]);
  }
  /// The number of faces of Q; coplanar triangles count as one face.
  std::size_t faceCount() const { return start_.size() - 1; }
  std::size_t bytes() const;

  /// Checks the hierarchy of the polar polytope, and that the faces are those of Q: the vertices of
  /// each face are on one plane, no vertex of Q is above this plane, and all faces together have as
  /// many triangles as Q. Returns what is wrong, or nothing. Exact, O(n²).
  std::optional<std::string> check() const;

 private:
  void findFaces();
  void findCenter();

  const DobkinKirkpatrick* inner_;
  Vec3 center_ = Vec3::Zero();
  std::vector<std::uint32_t> core_;
  std::vector<std::uint32_t> start_, faceVertex_;
  std::optional<DobkinKirkpatrick> polar_;
};

}  // namespace corridor
