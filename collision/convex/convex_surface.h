#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// The triangulated boundary of the convex hull of a growing set of points, with exact predicates.
/// Both quickhull (quickhull.h) and the expanding polytope algorithm (penetration.h) use it. No
/// point that was added is ever outside the plane of a face.
class ConvexSurface {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Face {
    std::array<std::uint32_t, 3> corner;  ///< counterclockwise as seen from outside
    std::array<std::uint32_t, 3> across;  ///< the face beyond the edge from corner k to k + 1
    bool alive = true;  ///< false: the face was removed, and its index may be used again
  };

  /// Begins with a tetrahedron of four of the points, in any order. Later calls may pass a longer
  /// list of points, if it begins with the points of this list.
  /// @pre the four points are not on one plane.
  void begin(std::span<const Vec3> points, std::array<std::uint32_t, 4> tetrahedron);

  /// Adds point p, which face f sees: replaces all faces that see p by a fan from p to the boundary
  /// of these faces, the horizon. The indices of removed faces are used again only by the next
  /// `add`.
  void add(std::span<const Vec3> points, std::uint32_t f, std::uint32_t p);

  /// Reports whether a face sees point p, which means that p is outside the plane of the face.
  /// Exact.
  static bool sees(std::span<const Vec3> points, const Face& face, const Vec3& p);

  std::span<const Face> faces() const { return faces_; }
  /// The faces that the latest `begin` or `add` added, and those that it removed.
  std::span<const std::uint32_t> added() const { return fan_; }
  std::span<const std::uint32_t> removed() const { return seen_; }

 private:
  struct HorizonEdge {
    std::uint32_t from, to, outer;
  };
  struct Step {
    std::uint32_t face;
    int edge, left;
  };

  std::uint32_t newFace(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void findHorizon(std::span<const Vec3> points, std::uint32_t f, const Vec3& p);

  std::vector<Face> faces_;
  std::vector<std::uint32_t> free_, seen_, fan_;
  std::vector<HorizonEdge> horizon_;
  std::vector<Step> steps_;
};

/// Returns the indices of four points that are not on one plane. They are far apart if a search in
/// double finds such points; otherwise they are the first such four in the order of the points.
/// Returns nothing if all points are on one plane. Exact.
std::optional<std::array<std::uint32_t, 4>> findTetrahedron(std::span<const Vec3> points);

}  // namespace corridor
