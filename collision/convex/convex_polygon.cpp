#include "collision/convex/convex_polygon.h"

#include <algorithm>
#include <stdexcept>

#include "collision/predicates/along.h"
#include "collision/predicates/orientation.h"

namespace corridor {
namespace {

Vec3 lifted(const Vec2& p) {
  return {p.x(), p.y(), 0};
}

bool isBefore(const Vec2& p, const Vec2& q) {
  return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
}

/// Returns 1 if edge i, from vertex i to vertex i + 1, goes up along a direction, −1 if it goes
/// down, 0 if it is level. Exact.
int rise(const ConvexPolygon& polygon, std::size_t i, const Vec3& direction) {
  return alongSign(direction, lifted(polygon[i]), lifted(polygon[i + 1]));
}

}  // namespace

ConvexPolygon::ConvexPolygon(std::span<const Vec2> points) {
  if (!std::all_of(points.begin(), points.end(), [](const Vec2& p) { return p.allFinite(); }))
    throw std::invalid_argument("the points of a polygon must be finite");
  std::vector<Vec2> sorted(points.begin(), points.end());
  std::sort(sorted.begin(), sorted.end(), isBefore);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  // Appends the lower chain from left to right, then the upper chain from right to left.
  for (const bool lower : {true, false}) {
    const std::size_t begin = vertices_.size();
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const Vec2& p = lower ? sorted[i] : sorted[sorted.size() - 1 - i];
      while (vertices_.size() >= begin + 2 &&
             lineSide(vertices_[vertices_.size() - 2], vertices_.back(), p) <= 0)
        vertices_.pop_back();
      vertices_.push_back(p);
    }
    if (!vertices_.empty()) vertices_.pop_back();  // it is also the first vertex of the other chain
  }
  if (vertices_.size() < 3)
    throw std::invalid_argument("the points of a polygon must not all be on one line");
}

std::size_t ConvexPolygon::extreme(const Vec2& direction) const {
  // Along the boundary, all edges that go up come in one run, and all edges that go down in
  // another. The search looks for the top, where the first run ends. It keeps an edge `low` at or
  // before the last edge of this run, and an edge `high` after that last edge.
  const Vec3 d = lifted(direction);
  const std::size_t n = size();
  if (direction.isZero(0)) return 0;
  if (rise(*this, 0, d) <= 0 && rise(*this, n - 1, d) >= 0) return 0;  // 0 is a top
  // `low` and `high` count along the unrolled boundary, from vertex 0 to vertex n, which is vertex
  // 0 again.
  const bool firstUp = rise(*this, 0, d) > 0;
  std::size_t low = 0, high = n;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    const int up = rise(*this, middle, d);
    const int height = alongSign(d, lifted((*this)[0]), lifted((*this)[middle]));
    if (firstUp) {
      // From vertex 0 the boundary goes up to the top, down below vertex 0, and up again.
      if (up > 0 && height >= 0)
        low = middle;
      else
        high = middle;
    } else {
      // From vertex 0 the boundary goes down, and up beyond vertex 0 to the top, and down again.
      if (up > 0 || height < 0)
        low = middle;
      else
        high = middle;
    }
  }
  // Edge `low` is the last edge that goes up, so it ends at the top.
  return high % n;
}

std::optional<std::string> ConvexPolygon::check() const {
  std::size_t turns = 0;  // changes from leftwards to rightwards; a convex polygon has exactly one
  for (std::size_t i = 0; i < size(); ++i) {
    if (lineSide((*this)[i], (*this)[i + 1], (*this)[i + 2]) <= 0)
      return "the corner at vertex " + std::to_string((i + 1) % size()) + " is not convex";
    turns += !isBefore((*this)[i], (*this)[i + 1]) && isBefore((*this)[i + 1], (*this)[i + 2]);
  }
  return turns == 1 ? std::nullopt
                    : std::optional<std::string>("the boundary goes around more than once");
}

}  // namespace corridor
