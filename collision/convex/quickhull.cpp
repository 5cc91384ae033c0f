#include "collision/convex/quickhull.h"

#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/convex_surface.h"

namespace corridor {
namespace {

constexpr std::uint32_t kNone = ConvexSurface::kNone;

/// The list of points that a face sees. Each point is in the list of one face only.
struct Outside {
  std::uint32_t first = kNone;
  std::uint32_t farthest = kNone;  ///< up to rounding
  double height = 0;           ///< of the farthest point above the plane, times |normal|; rounded
  Vec3 normal = Vec3::Zero();  ///< rounded
};

class HullBuilder {
 public:
  explicit HullBuilder(std::span<const Vec3> points)
      : points_(points), next_(points.size(), kNone) {}

  std::vector<std::array<std::uint32_t, 3>> run() {
    const auto start = findTetrahedron(points_);
    if (!start) return {};
    surface_.begin(points_, *start);
    prepare();
    for (std::uint32_t p = 0; p < points_.size(); ++p) give(p);
    take();
    while (!open_.empty()) {
      const std::uint32_t f = open_.back();
      open_.pop_back();
      if (surface_.faces()[f].alive && outside_[f].first != kNone) add(f);
    }
    std::vector<std::array<std::uint32_t, 3>> result;
    for (const ConvexSurface::Face& face : surface_.faces())
      if (face.alive) result.push_back(face.corner);
    return result;
  }

 private:
  /// Prepares the lists of the new faces.
  void prepare() {
    outside_.resize(surface_.faces().size());
    for (const std::uint32_t f : surface_.added()) {
      const auto& [a, b, c] = surface_.faces()[f].corner;
      outside_[f] = {.normal = (points_[b] - points_[a]).cross(points_[c] - points_[a])};
    }
  }

  /// Adds a point to the list of the first new face that sees the point. If no new face sees it,
  /// does nothing.
  void give(std::uint32_t p) {
    for (const std::uint32_t f : surface_.added()) {
      const ConvexSurface::Face& face = surface_.faces()[f];
      if (!ConvexSurface::sees(points_, face, points_[p])) continue;
      Outside& list = outside_[f];
      next_[p] = list.first;
      list.first = p;
      const double height = list.normal.dot(points_[p] - points_[face.corner[0]]);
      if (list.farthest == kNone || height > list.height) list.farthest = p, list.height = height;
      return;
    }
  }

  /// Appends the new faces that see points to `open_`.
  void take() {
    for (const std::uint32_t f : surface_.added())
      if (outside_[f].first != kNone) open_.push_back(f);
  }

  /// Adds the farthest point that face f sees to the surface, and distributes the points of the
  /// removed faces.
  void add(std::uint32_t f) {
    const std::uint32_t p = outside_[f].farthest;
    surface_.add(points_, f, p);
    // The heads of the lists of removed faces are copied before the call of `prepare`, which may
    // overwrite them.
    lists_.clear();
    for (const std::uint32_t gone : surface_.removed()) lists_.push_back(outside_[gone].first);
    prepare();
    // If a point outside the new hull was seen by a removed face, a new face sees the point. The
    // reason is that at some edge of the horizon, the point is above the removed face and the
    // remaining face, and so above the new face between them.
    for (std::uint32_t q : lists_)
      while (q != kNone) {
        const std::uint32_t after = next_[q];
        if (q != p) give(q);
        q = after;
      }
    take();
  }

  std::span<const Vec3> points_;
  ConvexSurface surface_;
  std::vector<Outside> outside_;     ///< of each face
  std::vector<std::uint32_t> next_;  ///< for each point: the next point in the same list
  std::vector<std::uint32_t> open_, lists_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> quickhull(std::span<const Vec3> points) {
  return HullBuilder(points).run();
}

}  // namespace corridor
