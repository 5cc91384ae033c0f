#include "collision/convex/simple_polygon.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "collision/convex/polygon_sweep.h"

namespace corridor {
namespace {

/// Returns whether two edges share a point that edges of a simple polygon must not share.
bool meet(const PolygonSweep& sweep, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t afterA = sweep.next(a), afterB = sweep.next(b);
  const auto overlapFrom = [&](std::uint32_t common, std::uint32_t p, std::uint32_t q) {
    return sweep.isBefore(p, common) == sweep.isBefore(q, common) && sweep.side(common, p, q) == 0;
  };
  if (afterA == b) return overlapFrom(b, a, afterB);
  if (afterB == a) return overlapFrom(a, b, afterA);
  const int b0 = sweep.side(a, afterA, b), b1 = sweep.side(a, afterA, afterB);
  if (b0 * b1 > 0) return false;
  if (b0 == 0 && b1 == 0)  // both edges are on one line
    return !sweep.isBefore(sweep.right(a), sweep.left(b)) &&
           !sweep.isBefore(sweep.right(b), sweep.left(a));
  return sweep.side(b, afterB, a) * sweep.side(b, afterB, afterA) <= 0;
}

using Status = std::set<std::uint32_t, PolygonSweep::Below>;

/// Returns two edges that meet, or nothing. Until the sweep line reaches the first point that edges
/// wrongly share, the order of edges along the line does not change. Just before that point, two
/// edges that share it are neighbours along the line, because only two edges end or begin at each
/// point of the polygon.
std::optional<std::pair<std::uint32_t, std::uint32_t>> findMeeting(const PolygonSweep& sweep) {
  Status status{PolygonSweep::Below{&sweep}};
  std::vector<Status::iterator> place(sweep.size(), status.end());
  std::optional<std::pair<std::uint32_t, std::uint32_t>> found;
  const auto test = [&](Status::iterator a, Status::iterator b) {
    if (!found && meet(sweep, *a, *b)) found = std::minmax(*a, *b);
  };
  for (const std::uint32_t v : sweep.order()) {
    const std::uint32_t edges[] = {sweep.previous(v), v};
    for (const std::uint32_t edge : edges) {
      if (sweep.right(edge) != v) continue;
      const auto after = status.erase(place[edge]);
      if (after != status.begin() && after != status.end()) test(std::prev(after), after);
    }
    for (const std::uint32_t edge : edges) {
      if (sweep.left(edge) != v) continue;
      const auto [it, isNew] = status.insert(edge);
      if (!isNew) return std::minmax(*it, edge);  // they overlap
      place[edge] = it;
      if (it != status.begin()) test(std::prev(it), it);
      if (std::next(it) != status.end()) test(it, std::next(it));
    }
    if (found) return found;
  }
  return found;
}

}  // namespace

std::optional<PolygonFault> checkSimple(std::span<const Vec2> points) {
  using Kind = PolygonFault::Kind;
  if (points.size() < 3) return PolygonFault{Kind::tooFewPoints};
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite()) return PolygonFault{Kind::notFinite, i};
  const PolygonSweep sweep(points);
  for (std::size_t k = 1; k < sweep.size(); ++k) {
    const std::uint32_t i = sweep.order()[k - 1], j = sweep.order()[k];
    if (sweep.point(i) == sweep.point(j)) return PolygonFault{Kind::repeatedPoint, i, j};
  }
  std::uint32_t k = 2;
  while (k < sweep.size() && sweep.side(0, 1, k) == 0) ++k;
  if (k == sweep.size()) return PolygonFault{Kind::noArea};
  if (const auto edges = findMeeting(sweep))
    return PolygonFault{Kind::edgesMeet, edges->first, edges->second};
  return std::nullopt;
}

}  // namespace corridor
