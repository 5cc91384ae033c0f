#include "collision/course/outer_hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "collision/predicates/orientation.h"

namespace corridor {

OuterHierarchy::OuterHierarchy(const DobkinKirkpatrick& inner) : inner_(&inner) {
  findFaces();
  findCenter();
  const std::span<const Vec3> points = inner.polytope().vertices();
  std::vector<Vec3> polar;
  polar.reserve(faceCount());
  for (std::size_t f = 0; f < faceCount(); ++f) {
    // The normal is computed from three vertices that are far apart, for a small error:
    // neighbouring vertices of a face of many edges are close together.
    const std::size_t size = start_[f + 1] - start_[f], first = start_[f];
    const Vec3 &a = points[faceVertex_[first]], &b = points[faceVertex_[first + size / 3]],
               &c = points[faceVertex_[first + size * 2 / 3]];
    const Vec3 normal = (b - a).cross(c - a);
    const Vec3 y = normal / normal.dot(a - center_);
    // This test fails if the center is on the plane or outside of it, which only rounding can
    // cause. Then there is no polar polytope.
    if (!(y.allFinite() && normal.dot(a - center_) > 0)) return;
    polar.push_back(y);
  }
  try {
    polar_.emplace(Polytope(polar));
  } catch (const std::invalid_argument&) {  // the polar points are all on one plane
  }
}

void OuterHierarchy::findFaces() {
  const std::span<const Polytope::Face> triangles = inner_->polytope().faces();
  const std::span<const Vec3> points = inner_->polytope().vertices();
  const auto across = facesAcross(triangles, points.size());
  std::vector<bool> taken(triangles.size(), false);
  // Returns whether edge k of triangle t is inside a face, which means that the triangles on both
  // sides of the edge are coplanar.
  const auto isInside = [&](std::uint32_t t, int k) {
    const std::uint32_t beyond = across[t][k];
    const std::uint32_t from = triangles[t][k], to = triangles[t][(k + 1) % 3];
    for (const std::uint32_t v : triangles[beyond])
      if (v != from && v != to)
        return planeSide(points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]],
                         points[v]) == 0;
    return false;
  };
  const auto cornerOf = [&](std::uint32_t t, std::uint32_t v) {
    return triangles[t][0] == v ? 0 : triangles[t][1] == v ? 1 : 2;
  };
  std::vector<std::uint32_t> stack;
  start_.assign(1, 0);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (taken[t]) continue;
    taken[t] = true;
    stack.assign(1, t);
    std::uint32_t edgeOf = t;
    int edge = -1;
    while (!stack.empty()) {
      const std::uint32_t u = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        if (!isInside(u, k)) {
          edgeOf = u, edge = k;
        } else if (!taken[across[u][k]]) {
          taken[across[u][k]] = true;
          stack.push_back(across[u][k]);
        }
      }
    }
    // Goes around the union of the coplanar triangles. The next boundary edge begins at the end of
    // the present one. At that vertex, edges inside the face are skipped.
    std::uint32_t u = edgeOf;
    int k = edge;
    do {
      faceVertex_.push_back(triangles[u][k]);
      k = (k + 1) % 3;
      while (isInside(u, k)) {
        const std::uint32_t from = triangles[u][k];
        u = across[u][k];
        k = cornerOf(u, from);
      }
    } while (u != edgeOf || k != edge);
    start_.push_back(static_cast<std::uint32_t>(faceVertex_.size()));
  }
}

void OuterHierarchy::findCenter() {
  const auto simplex = inner_->simplex();
  core_.assign(simplex.begin(), simplex.end());
  for (int k = 0; k < 3; ++k)
    for (const double s : {1.0, -1.0}) core_.push_back(inner_->extreme(s * Vec3::Unit(k)));
  std::sort(core_.begin(), core_.end());
  core_.erase(std::unique(core_.begin(), core_.end()), core_.end());
  const std::span<const Vec3> points = inner_->polytope().vertices();
  // Each vertex is divided first, so that the sum does not overflow.
  for (const std::uint32_t v : core_) center_ += points[v] / static_cast<double>(core_.size());
}

std::size_t OuterHierarchy::bytes() const {
  std::size_t polar = 0;
  if (polar_)
    polar = polar_->bytes() + polar_->polytope().vertices().size_bytes() +
            polar_->polytope().faces().size_bytes();
  return polar + (start_.size() + faceVertex_.size() + core_.size()) * sizeof(std::uint32_t);
}

std::optional<std::string> OuterHierarchy::check() const {
  const std::span<const Vec3> points = inner_->polytope().vertices();
  std::size_t triangles = 0;
  for (std::size_t f = 0; f < faceCount(); ++f) {
    const auto face = std::span(faceVertex_).subspan(start_[f], start_[f + 1] - start_[f]);
    const std::string where = "face " + std::to_string(f) + ": ";
    if (face.size() < 3) return where + "too few vertices";
    triangles += face.size() - 2;
    for (std::size_t i = 0; i < face.size(); ++i)
      for (std::size_t k = i + 1; k < face.size(); ++k)
        if (face[i] == face[k]) return where + "a vertex twice";
    for (const std::uint32_t v : face)
      if (planeSide(points[face[0]], points[face[1]], points[face[2]], points[v]) != 0)
        return where + "not on a plane";
    for (const Vec3& p : points)
      if (planeSide(points[face[0]], points[face[1]], points[face[2]], p) > 0)
        return where + "a vertex of the polytope is outside";
  }
  if (triangles != inner_->polytope().faces().size()) return "faces are missing";
  return polar_ ? polar_->check() : std::nullopt;
}

}  // namespace corridor
