#include "collision/geometry/cut_polygons.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Geometry>

#include "collision/core/shortest.h"
#include "collision/geometry/mesh_limits.h"

namespace corridor {
namespace {

using Index = std::uint32_t;
using Indices3 = std::array<Index, 3>;

bool isLeftOf(const Vec2& p, const Vec2& q) {
  return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
}

/// Returns whether a counterclockwise polygon is convex: no corner turns right or back, and the
/// boundary goes around once, from left to right and back.
bool isConvexPolygon(std::span<const Vec2> points) {
  std::vector<Vec2> p(points.begin(), points.end());
  p.erase(std::unique(p.begin(), p.end()), p.end());
  const std::size_t n = p.size() > 1 && p.front() == p.back() ? p.size() - 1 : p.size();
  if (n < 3) return false;
  int turns = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
    const bool turnsBack = isLeftOf(a, b) != isLeftOf(b, c);
    const int side = lineSide(a, b, c);
    if (side < 0 || (side == 0 && turnsBack)) return false;
    turns += turnsBack;
  }
  return turns == 2;
}

/// Returns whether all points of the second list are on the line through p and q, or right of it.
bool isRightOf(const Vec2& p, const Vec2& q, std::initializer_list<const Vec2*> points) {
  return std::all_of(points.begin(), points.end(),
                     [&](const Vec2* r) { return lineSide(p, q, *r) <= 0; });
}

/// A counterclockwise triangle, with the box around it.
struct CutTriangle {
  const Vec2 &a, &b, &c;
  Vec2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);

  bool isApart(const Vec2& otherLow, const Vec2& otherHigh) const {
    return otherHigh.x() <= low.x() || otherLow.x() >= high.x() || otherHigh.y() <= low.y() ||
           otherLow.y() >= high.y();
  }
  /// Returns whether the line of one of the edges has these points on its other side.
  bool isSeparatedFrom(std::initializer_list<const Vec2*> points) const {
    return isRightOf(a, b, points) || isRightOf(b, c, points) || isRightOf(c, a, points);
  }
  /// Returns whether the edge from p to q enters the triangle's interior. If two convex sets of the
  /// plane do not meet, a line along an edge of one of them is between them.
  bool isEnteredBy(const Vec2& p, const Vec2& q) const {
    return !isApart(p.cwiseMin(q), p.cwiseMax(q)) && !isSeparatedFrom({&p, &q}) &&
           !isRightOf(p, q, {&a, &b, &c}) && !isRightOf(q, p, {&a, &b, &c});
  }
  bool overlaps(const CutTriangle& o) const {
    return !isApart(o.low, o.high) && !isSeparatedFrom({&o.a, &o.b, &o.c}) &&
           !o.isSeparatedFrom({&a, &b, &c});
  }
};

class EarCutter {
 public:
  explicit EarCutter(std::span<const Vec2> points) : p_(points), left_(points.size()) {
    next_.resize(left_);
    previous_.resize(left_);
    inTheWay_.resize(left_);
    for (Index i = 0; i < left_; ++i) {
      next_[i] = i + 1 < left_ ? i + 1 : 0;
      previous_[next_[i]] = i;
    }
  }

  std::vector<Indices3> run() {
    for (Index i = 0; i < p_.size() && left_ > 3; ++i)
      if (!isCut(i)) cutFolds(i);
    while (left_ > 3) {
      if (!cutOne([this](Index i) { return isEar(i); }) &&
          !cutOne([this](Index i) { return side(i) == 0; }))
        return {};
    }
    if (side(at_) < 0) return {};
    triangles_.push_back({previous_[at_], at_, next_[at_]});
    return overlap() ? std::vector<Indices3>() : std::move(triangles_);
  }

 private:
  int side(Index i) const { return lineSide(p_[previous_[i]], p_[i], p_[next_[i]]); }

  /// Returns whether the boundary turns back at a corner, or repeats it: the corner can go.
  bool isFold(Index i) const {
    const Vec2 &a = p_[previous_[i]], &b = p_[i], &c = p_[next_[i]];
    return a == b || b == c || (side(i) == 0 && isLeftOf(a, b) == isLeftOf(c, b));
  }

  bool isCut(Index i) const { return next_[previous_[i]] != i; }

  bool isEar(Index i) {
    if (side(i) <= 0) return false;
    const CutTriangle triangle{p_[previous_[i]], p_[i], p_[next_[i]]};
    const auto enters = [&](Index k) { return triangle.isEnteredBy(p_[k], p_[next_[k]]); };
    // The edge that was in the way the last time most often still is.
    if (!isCut(inTheWay_[i]) && enters(inTheWay_[i])) return false;
    for (Index k = next_[i]; k != previous_[i]; k = next_[k])
      if (enters(k)) return inTheWay_[i] = k, false;
    return true;
  }

  void cut(Index i) {
    triangles_.push_back({previous_[i], i, next_[i]});
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    at_ = next_[i];
    --left_;
  }

  /// Cuts off folds at a corner, and those that this causes at its neighbours.
  void cutFolds(Index i) {
    for (std::vector<Index> open{i}; !open.empty() && left_ > 3;) {
      const Index k = open.back();
      open.pop_back();
      if (isCut(k) || !isFold(k)) continue;
      open.insert(open.end(), {previous_[k], next_[k]});
      cut(k);
    }
  }

  /// Cuts off the first corner that fulfils a condition, from `at_` on. @returns false: none does
  template <class Condition>
  bool cutOne(const Condition& condition) {
    Index i = at_;
    for (std::size_t k = 0; k < left_; ++k, i = next_[i]) {
      if (!condition(i)) continue;
      const Index before = previous_[i], after = next_[i];
      cut(i);
      at_ = next_[after];  // not the neighbour: fans of thin triangles would result
      cutFolds(before);
      cutFolds(after);
      return true;
    }
    return false;
  }

  /// Returns whether two triangles overlap. The boundaries of the triangles add up to the
  /// polygon's, so each point is in as many triangles as the number of times that the boundary
  /// winds about it.
  bool overlap() const {
    std::vector<CutTriangle> sorted;
    for (const Indices3& t : triangles_)
      if (lineSide(p_[t[0]], p_[t[1]], p_[t[2]]) > 0)
        sorted.push_back({p_[t[0]], p_[t[1]], p_[t[2]]});
    std::vector<Index> order(sorted.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](Index i, Index j) { return sorted[i].low.x() < sorted[j].low.x(); });
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1;
           j < order.size() && sorted[order[j]].low.x() < sorted[order[i]].high.x(); ++j)
        if (sorted[order[i]].overlaps(sorted[order[j]])) return true;
    return false;
  }

  std::span<const Vec2> p_;
  std::size_t left_;
  std::vector<Index> next_, previous_;
  std::vector<Index> inTheWay_;  // of each corner, an edge that entered its triangle; else any edge
  Index at_ = 0;
  std::vector<Indices3> triangles_;
};

/// A polygon of a file, and the plane that fits it: through the mean of its corners, with the
/// normal of M. Newell (the sum of the cross products of neighbouring corners), or that of a wide
/// triangle of corners, whichever is nearer to the corners. (Where a boundary encloses little area,
/// rounding turns Newell's normal.)
struct FilePolygon {
  std::vector<Index> vertices;
  double extent = 0;          ///< the largest distance from the first corner, in units of the file
  std::vector<Vec3> corners;  ///< from the first one, divided by `extent`
  Vec3 normal = Vec3::Zero();
  double deviation = 0;  ///< the largest distance of a corner from the plane, divided by `extent`
  double width = 0;      ///< of a strip around all corners, divided by `extent`; an upper bound

  FilePolygon(const TriangleMesh& mesh, const PolygonFan& fan) {
    const Indices3* const triangles = mesh.triangles.data() + fan.firstTriangle;
    vertices.reserve(fan.triangles + 2);
    vertices = {triangles[0][0], triangles[0][1]};
    for (Index k = 0; k < fan.triangles; ++k) vertices.push_back(triangles[k][2]);
    corners.reserve(vertices.size());
    double quarter = 0;  // quarters, so that differences do not overflow
    for (const Index v : vertices) {
      corners.emplace_back(mesh.vertices[v] / 4 - mesh.vertices[vertices[0]] / 4);
      quarter = std::max(quarter, corners.back().stableNorm());
    }
    extent = 4 * quarter;
    if (quarter == 0) return;  // all corners are equal
    Vec3 mean = Vec3::Zero();
    for (Vec3& corner : corners) {
      corner /= quarter;
      mean += corner / static_cast<double>(vertices.size());
    }
    Vec3 newell = Vec3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i)
      newell += (corners[i] - mean).cross(corners[(i + 1) % corners.size()] - mean);
    Vec3 widest = widestTriangle();
    width = 2 * widest.norm();
    if (widest.dot(newell) < 0) widest = -widest;
    const double byNewell = deviationFrom(newell, mean), byWidest = deviationFrom(widest, mean);
    const bool isNewell = byNewell <= byWidest && !newell.isZero(0);
    normal = isNewell ? newell : widest;
    deviation = isNewell ? byNewell : byWidest;
  }

  /// Returns the corners in the projection along the axis that is nearest to the normal. They are
  /// the file's coordinates, without rounding. They are counterclockwise for `isFront`, unless the
  /// area is small.
  std::vector<Vec2> projected(const TriangleMesh& mesh, bool isFront) const {
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    Eigen::Index u = (axis + 1) % 3, v = (axis + 2) % 3;
    if ((normal[axis] > 0) != isFront) std::swap(u, v);
    std::vector<Vec2> result;
    result.reserve(vertices.size());
    for (const Index i : vertices) result.emplace_back(mesh.vertices[i][u], mesh.vertices[i][v]);
    return result;
  }

 private:
  double deviationFrom(const Vec3& direction, const Vec3& mean) const {
    const Vec3 unit = direction.stableNormalized();
    double largest = 0;
    for (const Vec3& p : corners) largest = std::max(largest, std::abs(unit.dot(p - mean)));
    return largest;
  }

  /// Returns the normal of a wide triangle of corners, with twice its area as its length: that of
  /// the first corner, the corner farthest from it, and the one farthest from their line.
  Vec3 widestTriangle() const {
    Vec3 side = Vec3::Zero(), widest = Vec3::Zero();
    for (const Vec3& p : corners)
      if (p.squaredNorm() > side.squaredNorm()) side = p;
    for (const Vec3& p : corners)
      if (const Vec3 other = side.cross(p); other.squaredNorm() > widest.squaredNorm())
        widest = other;
    return widest;
  }
};

/// A polygon counts as flat up to this part of its extent: the note on others is for people. Digits
/// of the file are mostly finer.
constexpr double kFlat = 1e-5;
/// A narrower polygon, in parts of its extent, may cross itself by the rounding of its corners to
/// six digits or floats.
constexpr double kThin = 1e-5;
/// A polygon that is farther from its plane, in parts of its extent, has a projection in no plane
/// that is more than a choice.
constexpr double kBent = 0.01;

std::string textOf(const Vec3& corner) {
  return '(' + shortest(corner.x()) + ", " + shortest(corner.y()) + ", " + shortest(corner.z()) +
         ')';
}

std::string nameOfPolygon(const PolygonFan& fan, const Vec3& corner) {
  const std::string polygon = "a polygon of " + std::to_string(fan.triangles + 2) + " corners";
  if (fan.face > 0) return "face " + std::to_string(fan.face) + ", " + polygon + ',';
  return polygon + " with a corner at " + textOf(corner);
}

/// Polygons of one kind, for a note.
struct NotedPolygons {
  std::size_t count = 0;
  std::string first;  ///< the place of the first, or worst, of them

  std::string text() const {
    return count == 1 ? "1 polygon" : std::to_string(count) + " polygons";
  }
};

std::string placeOf(const PolygonFan& fan, const Vec3& corner) {
  return fan.line > 0   ? "line " + std::to_string(fan.line)
         : fan.face > 0 ? "face " + std::to_string(fan.face)
                        : "the corner " + textOf(corner);
}

/// Returns two edges that cross at a point within both, as a text; "" if none of the first 1000 do.
std::string crossingOf(std::span<const Vec2> p) {
  const std::size_t n = std::min<std::size_t>(p.size(), 1000);  // finding them takes n^2 steps
  const auto after = [&](std::size_t i) { return p[(i + 1) % p.size()]; };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 2; k < n; ++k)
      if (lineSide(p[i], after(i), p[k]) * lineSide(p[i], after(i), after(k)) < 0 &&
          lineSide(p[k], after(k), p[i]) * lineSide(p[k], after(k), after(i)) < 0)
        return " (the edges behind its corners " + std::to_string(i + 1) + " and " +
               std::to_string(k + 1) + ")";
  return {};
}

}  // namespace

std::vector<Indices3> trianglesOfPolygon(std::span<const Vec2> corners) {
  if (!isConvexPolygon(corners)) return EarCutter(corners).run();
  std::vector<Indices3> fan;
  for (Index k = 2; k < corners.size(); ++k) fan.push_back({0, k - 1, k});
  return fan;
}

void cutPolygons(TriangleMesh& mesh, std::span<const PolygonFan> fans, MeshFaults& faults,
                 std::vector<std::string>& notes) {
  NotedPolygons bent, crossing;
  double largest = 0, work = 0;
  for (const PolygonFan& fan : fans) {
    const FilePolygon polygon(mesh, fan);
    const Vec3& corner = mesh.vertices[polygon.vertices[0]];
    if (polygon.deviation > kFlat) {
      ++bent.count;
      if (polygon.deviation * polygon.extent > largest) {
        largest = polygon.deviation * polygon.extent;
        bent.first = placeOf(fan, corner);
      }
    }
    const std::vector<Vec2> front = polygon.projected(mesh, true);
    if (isConvexPolygon(front)) continue;  // its fan is right
    work += static_cast<double>(front.size()) * static_cast<double>(front.size());
    if (work > kMostPolygonWork)
      faults.fail(fan.line, "the polygons that are not convex have too many corners (" +
                                nameOfPolygon(fan, corner) +
                                " is the first that is not cut); save the mesh as triangles");
    std::vector<Indices3> triangles = trianglesOfPolygon(front);
    if (triangles.empty()) triangles = trianglesOfPolygon(polygon.projected(mesh, false));
    if (triangles.empty() && (polygon.width <= kThin || polygon.deviation > kBent)) {
      if (crossing.count++ == 0) crossing.first = placeOf(fan, corner);
      continue;  // stays a fan
    }
    if (triangles.empty())
      faults.add(fan.line, nameOfPolygon(fan, corner) + " crosses or overlaps itself" +
                               crossingOf(front) +
                               "; split it into simple polygons, or into triangles");
    for (std::size_t k = 0; k < triangles.size(); ++k)
      for (std::size_t i = 0; i < 3; ++i)
        mesh.triangles[fan.firstTriangle + k][i] = polygon.vertices[triangles[k][i]];
  }
  faults.throwIfAny();
  if (bent.count > 0)
    notes.push_back(
        bent.text() + (bent.count == 1 ? " is" : " are") +
        " not flat, so the triangles into which a polygon is cut determine its surface; "
        "the largest deviation from a plane is " +
        withDigits(largest, 3) + " units of the file, at " + bent.first);
  if (crossing.count > 0)
    notes.push_back(crossing.text() + " that " +
                    (crossing.count == 1 ? "crosses itself is" : "cross themselves are") +
                    " so thin, or so far from flat, that a fan of triangles is used instead, which "
                    "may overlap; the first is at " +
                    crossing.first);
}

}  // namespace corridor
