#include "collision/queries/hull_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/hierarchy/box_tree.h"
#include "collision/predicates/triangle.h"

namespace corridor {
namespace {

constexpr std::size_t kMostPieces = 1'000'000;
constexpr int kMostCuts = 1000;
constexpr std::uint32_t kNoTriangle = ~std::uint32_t{0};

/// Returns the distance of p from a point of the segment. Up to rounding, this is the point closest
/// to p.
double toSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = ab.dot(p - a) / ab.squaredNorm();
  return (p - (a + (t > 0 ? std::min(t, 1.0) : 0.0) * ab)).norm();  // also if t is not a number
}

/// Returns the distance of p from a point of the triangle. Up to rounding, this is the point
/// closest to p. Even if the search for this point is inaccurate, the point found is in the
/// triangle. The result is therefore less than the true distance by at most the rounding of the
/// coordinates.
double toTriangle(const Vec3& p, const Triangle& t) {
  double least =
      std::min({toSegment(p, t[0], t[1]), toSegment(p, t[1], t[2]), toSegment(p, t[2], t[0])});
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], n = ab.cross(ac), ap = p - t[0];
  const double square = n.squaredNorm();
  const double v = ap.cross(ac).dot(n) / square, w = ab.cross(ap).dot(n) / square;
  if (v >= 0 && w >= 0 && v + w <= 1)
    least = std::min(least, (p - (t[0] + v * ab + w * ac)).norm());
  return least;
}

double toBox(const Vec3& p, const BoundingBox& box) {
  return (box.lower - p).cwiseMax(p - box.upper).cwiseMax(Vec3::Zero()).norm();
}

/// A part of a face of the hull. `guess` is the triangle of the mesh that gave the best bound for
/// the larger piece from which this one was cut; it is tried first.
struct Piece {
  Triangle corners;
  std::uint32_t guess = kNoTriangle;
  int depth = 0;  ///< the number of cuts that led from the face to this piece
};

/// The triangles of a mesh in a tree of their boxes, to find the triangle nearest to some points.
class Search {
 public:
  explicit Search(const TriangleMesh& mesh) {
    std::vector<BoundingBox> boxes;
    for (const auto& t : mesh.triangles) {
      const Triangle triangle{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
      BoundingBox& box = boxes.emplace_back();
      for (const Vec3& p : triangle) {
        box.lower = box.lower.cwiseMin(p);
        box.upper = box.upper.cwiseMax(p);
        largest_ = std::max(largest_, p.cwiseAbs().maxCoeff());
      }
      triangles_.push_back(triangle);
    }
    tree_ = BoxTree(boxes);
  }

  /// Finds the triangle for which the largest distance from the points is least. Returns this
  /// distance, and sets `guess` to this triangle. The distances from boxes are off by less than
  /// `rounding()`. This error can only change which of several nearly equal triangles is found.
  double fromOneTriangle(std::span<const Vec3> points, std::uint32_t& guess) const {
    const auto farthest = [&](const auto& distance) {
      double most = 0;
      for (const Vec3& p : points) most = std::max(most, distance(p));
      return most;
    };
    const auto from = [&](std::uint32_t i) {
      return farthest([&](const Vec3& p) { return toTriangle(p, triangles_[i]); });
    };
    double best = guess == kNoTriangle ? std::numeric_limits<double>::infinity() : from(guess);
    tree_.walk(
        [&](const BoundingBox& box) {
          return farthest([&](const Vec3& p) { return toBox(p, box); });
        },
        best,
        [&](std::size_t item) {
          const auto i = static_cast<std::uint32_t>(item);
          if (const double value = from(i); value < best) {
            best = value;
            guess = i;
          }
          return false;
        });
    return best;
  }

  /// Upper bound of the rounding of a distance, metres. Each coordinate of a candidate point is a
  /// sum of at most three terms below 4·largest, with weights in [0, 1]: 8 roundings of at most
  /// 4u·largest. A corner of a piece comes from up to `kMostCuts` cuts, each with three roundings
  /// of terms below 4·largest: 12u·largest for each. Three coordinates: less than 2^15·u·largest.
  /// The norm adds 3u of itself, which is below 16·largest. Squares below 2^-1022 vanish, and so do
  /// lengths below 2^-511.
  double rounding() const { return 0x1p15 * kUnit * largest_ + 0x1p-500; }
  const Triangle& triangle(std::uint32_t i) const { return triangles_[i]; }

 private:
  std::vector<Triangle> triangles_;
  BoxTree tree_;
  double largest_ = 0;
};

/// Halves a piece at its longest side.
std::array<Piece, 2> halves(const Piece& piece) {
  std::size_t k = 0;
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = (piece.corners[(i + 1) % 3] - piece.corners[i]).squaredNorm();
    if (length > longest) longest = length, k = i;
  }
  const Vec3 &a = piece.corners[k], &b = piece.corners[(k + 1) % 3],
             &c = piece.corners[(k + 2) % 3];
  const Vec3 middle = 0.5 * a + 0.5 * b;
  const int depth = piece.depth + 1;
  return {Piece{{a, middle, c}, piece.guess, depth}, Piece{{middle, b, c}, piece.guess, depth}};
}

/// Cuts a piece along a line: the orthogonal projection, onto the plane of the piece, of the line
/// through an edge of `t`. Chooses the edge for which the smaller of the two sides reaches farthest
/// from the line. Returns false if no edge leaves corners farther than `least` from its line on
/// both sides. The parts cover the piece up to the rounding of their corners, wherever the line is.
bool cutAlongEdge(const Piece& piece, const Triangle& t, double least, std::vector<Piece>& parts) {
  const auto& c = piece.corners;
  const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
  std::array<double, 3> side{};
  double best = least;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 across = normal.cross(t[(k + 1) % 3] - t[k]).stableNormalized();
    std::array<double, 3> at{};
    for (std::size_t i = 0; i < 3; ++i) at[i] = across.dot(c[i] - t[k]);
    const double both = std::min(*std::ranges::max_element(at), -*std::ranges::min_element(at));
    if (both > best) best = both, side = at;
  }
  if (!(best > least)) return false;
  // c[k] is the only corner on its side of the line. The two edges at c[k] cross the line at x and
  // y.
  std::size_t k = 0;
  while ((side[k] > 0) == (side[(k + 1) % 3] > 0) || (side[k] > 0) == (side[(k + 2) % 3] > 0)) ++k;
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  const auto meet = [&](std::size_t other) {
    const double s = std::clamp(side[k] / (side[k] - side[other]), 0.0, 1.0);
    return Vec3((1 - s) * c[k] + s * c[other]);
  };
  const Vec3 x = meet(i), y = meet(j);
  const int depth = piece.depth + 1;
  parts.push_back({{c[k], x, y}, piece.guess, depth});
  parts.push_back({{x, c[i], c[j]}, piece.guess, depth});
  parts.push_back({{x, c[j], y}, piece.guess, depth});
  return true;
}

}  // namespace

HullDeviation hullDeviation(const Polytope& hull, const TriangleMesh& mesh, double limit) {
  const Search search(mesh);
  const double slack = search.rounding();
  HullDeviation result;
  std::vector<Piece> open;
  for (const Polytope::Face& face : hull.faces())
    open.push_back(
        {{hull.vertices()[face[0]], hull.vertices()[face[1]], hull.vertices()[face[2]]}});
  for (std::size_t count = 0; !open.empty(); ++count) {
    Piece piece = open.back();
    open.pop_back();
    const double bound = roundedUp(search.fromOneTriangle(piece.corners, piece.guess) + slack);
    if (bound <= limit) {
      result.upper = std::max(result.upper, bound);
      continue;
    }
    for (const Vec3& corner : piece.corners) {
      std::uint32_t guess = piece.guess;
      const double distance = search.fromOneTriangle({&corner, 1}, guess);
      if (distance > result.found) {
        result.found = distance;
        result.at = corner;
      }
    }
    if (result.found > limit || piece.depth == kMostCuts || count == kMostPieces) return result;
    // A cut makes too little progress if on one side the piece reaches at most half of the limit
    // from the line.
    if (piece.guess != kNoTriangle &&
        cutAlongEdge(piece, search.triangle(piece.guess), limit / 2, open))
      continue;
    for (const Piece& half : halves(piece)) open.push_back(half);
  }
  result.within = true;
  return result;
}

}  // namespace corridor
