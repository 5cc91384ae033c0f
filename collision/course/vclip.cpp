#include "collision/course/vclip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "collision/convex/simplex.h"
#include "collision/course/exact_contact.h"

/// Terms are those of the paper (vclip.h), sections 3 and 4. A plane of a Voronoi region separates
/// the regions of two neighbouring features, which are a vertex and an edge, or an edge and a face.
/// Every test of a plane uses the same formula, so two neighbouring regions never both exclude a
/// point.
namespace corridor {
namespace {

using Kind = Feature::Kind;

/// One of the two polytopes in the walk.
struct PosedFeatures {
  const PolytopeFeatures& shape;
  Mat3 toOther;  ///< x ↦ toOther·x + shift maps this body's frame to the other body's
  Vec3 shift;
  Feature at;

  Vec3 inOther(std::uint32_t v) const { return toOther * shape.vertex(v) + shift; }
  void goToVertex(std::uint32_t v) { at = {Kind::vertex, v}; }
  void goToEdge(std::uint32_t h) { at = {Kind::edge, h}; }
  void goToFace(std::uint32_t f) { at = {Kind::face, f}; }

  /// Returns a number above 0 if p is on the edge's side of the plane between the regions of vertex
  /// `tail(h)` and of the edge of h.
  double alongEdge(std::uint32_t h, const Vec3& p) const {
    const Vec3& v = shape.vertex(shape.tail(h));
    return (p - v).dot(shape.vertex(shape.head(h)) - v);
  }
  /// Returns a number above 0 if p is on the face's side of the plane between the regions of the
  /// edge of h and of the face on the left of h.
  double ontoFace(std::uint32_t h, const Vec3& p) const {
    const Vec3& v = shape.vertex(shape.tail(h));
    return shape.normal(shape.leftFace(h)).cross(shape.vertex(shape.head(h)) - v).dot(p - v);
  }
  /// Returns the height of p over the plane of a face.
  double height(std::uint32_t f, const Vec3& p) const {
    return shape.normal(f).dot(p - shape.vertex(shape.polytope().faces()[f][0]));
  }
};

/// The part of a segment that is on the inner side of some planes of a Voronoi region.
class Clip {
 public:
  /// Keeps the part of the segment on which a linear function is at least 0. Returns false if
  /// nothing is left.
  /// @param atTail, atHead  the values of this function at the ends of the segment.
  /// @param neighbour  the half-edge or face beyond the plane.
  bool keep(double atTail, double atHead, std::uint32_t neighbour) {
    const double atLow = atTail + low * (atHead - atTail),
                 atHigh = atTail + high * (atHead - atTail);
    if (atLow < 0 && atHigh < 0) {
      excluded = true;
      beyondLow = beyondHigh = neighbour;
    } else if (atLow < 0) {
      const double crossing = atTail / (atTail - atHead);
      if (crossing > low) low = crossing, beyondLow = neighbour;
    } else if (atHigh < 0) {
      const double crossing = atTail / (atTail - atHead);
      if (crossing < high) high = crossing, beyondHigh = neighbour;
    }
    return !excluded && low <= high;
  }

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  double low = 0, high = 1;
  std::uint32_t beyondLow = kNone, beyondHigh = kNone;
  bool excluded = false;  ///< the whole segment is beyond the plane of `beyondLow`
};

/// The result of a step. `trapped`: the polytopes overlap at these features, or the pair is a local
/// minimum of the distance that is not the global one, with a feature on the far side of the other
/// polytope.
enum class Step { moved, closest, trapped };

class Walk {
 public:
  Walk(PosedFeatures& a, PosedFeatures& b) : a_(a), b_(b) {}

  Step step() {
    const bool swap = a_.at.kind > b_.at.kind;
    PosedFeatures &x = swap ? b_ : a_, &y = swap ? a_ : b_;  // x has the feature of lower dimension
    if (x.at.kind == Kind::face) return lowered(x);
    if (x.at.kind == Kind::edge) return y.at.kind == Kind::edge ? edgeEdge() : edgeFace(x, y);
    if (y.at.kind == Kind::vertex) return vertexVertex();
    return y.at.kind == Kind::edge ? vertexEdge(x, y) : vertexFace(x, y);
  }

 private:
  /// Replaces the first face by one of its corners if the walk starts with two faces. V-Clip does
  /// not have such a state.
  static Step lowered(PosedFeatures& x) {
    x.goToVertex(x.shape.polytope().faces()[x.at.index][0]);
    return Step::moved;
  }

  Step vertexVertex() {
    for (const bool ofA : {true, false}) {
      PosedFeatures &x = ofA ? a_ : b_, &y = ofA ? b_ : a_;
      const Vec3 p = y.inOther(y.at.index);
      // If several edges lead closer, takes the edge along which the distance decreases fastest.
      std::uint32_t best = Clip::kNone;
      double most = 0;
      for (std::uint32_t h = first(x); h < last(x); ++h) {
        const double along = x.alongEdge(h, p);
        if (!(along > 0)) continue;
        const double rate = along * along / edge(x, h).squaredNorm();
        if (rate > most || best == Clip::kNone) most = rate, best = h;
      }
      if (best == Clip::kNone) continue;
      x.goToEdge(best);
      return Step::moved;
    }
    return Step::closest;
  }

  static Step vertexEdge(PosedFeatures& x, PosedFeatures& y) {
    const Vec3 p = x.inOther(x.at.index);
    const std::uint32_t h = y.at.index, back = y.shape.twin(h);
    for (const std::uint32_t each : {h, back}) {
      if (!(y.alongEdge(each, p) < 0)) continue;
      y.goToVertex(y.shape.tail(each));
      return Step::moved;
    }
    for (const std::uint32_t each : {h, back}) {
      if (!(y.ontoFace(each, p) > 0)) continue;
      y.goToFace(y.shape.leftFace(each));
      return Step::moved;
    }
    // Between coplanar faces, the region of an edge contains points below the faces, too.
    if (y.height(y.shape.leftFace(h), p) < 0 && y.height(y.shape.leftFace(back), p) < 0)
      return Step::trapped;
    // Clips the edge of y to the region of the vertex of x.
    const Vec3 tail = y.inOther(y.shape.tail(h)), head = y.inOther(y.shape.head(h));
    Clip clip;
    for (std::uint32_t each = first(x); each < last(x); ++each)
      if (!clip.keep(-x.alongEdge(each, tail), -x.alongEdge(each, head), each)) break;
    const Vec3 v = x.shape.vertex(x.at.index);
    const std::uint32_t to = beyond(clip, [&](double at, std::uint32_t) {
      return (head - tail).dot(tail + at * (head - tail) - v);
    });
    if (to == Clip::kNone) return Step::closest;
    x.goToEdge(to);
    return Step::moved;
  }

  Step edgeEdge() {
    for (const bool ofA : {true, false}) {
      PosedFeatures &x = ofA ? a_ : b_, &y = ofA ? b_ : a_;
      const std::uint32_t h = x.at.index, back = x.shape.twin(h);
      const Vec3 tail = y.inOther(y.shape.tail(y.at.index)),
                 head = y.inOther(y.shape.head(y.at.index)), u = head - tail;
      Clip clip;
      for (const std::uint32_t each : {h, back})
        if (!clip.keep(x.alongEdge(each, tail), x.alongEdge(each, head), each)) break;
      const std::uint32_t end = beyond(clip, [&](double at, std::uint32_t each) {
        return u.dot(tail + at * u - x.shape.vertex(x.shape.tail(each)));
      });
      if (end != Clip::kNone) {
        x.goToVertex(x.shape.tail(end));
        return Step::moved;
      }
      // The closest point of the other edge is between the planes of the ends.
      clip.beyondLow = clip.beyondHigh = Clip::kNone;
      for (const std::uint32_t each : {h, back})
        if (!clip.keep(-x.ontoFace(each, tail), -x.ontoFace(each, head), each)) break;
      bool below = false;
      const std::uint32_t side = beyond(clip, [&](double at, std::uint32_t each) {
        const std::uint32_t f = x.shape.leftFace(each);
        const double slope = x.shape.normal(f).dot(u);
        if (!(x.height(f, tail + at * u) < 0)) return slope;
        below = true;
        return -slope;
      });
      if (side != Clip::kNone) {
        x.goToFace(x.shape.leftFace(side));
        return Step::moved;
      }
      // At a point where a plane of the region crosses the other edge, the distance to the face
      // equals the distance to the edge only if the point is above the face. Below the face, the
      // slopes do not prove that the pair is closest.
      if (below || clip.low > clip.high) return Step::trapped;
    }
    return Step::closest;
  }

  static Step edgeFace(PosedFeatures& x, PosedFeatures& y) {
    const std::uint32_t f = y.at.index, h = x.at.index;
    const Vec3 tail = x.inOther(x.shape.tail(h)), head = x.inOther(x.shape.head(h));
    Clip clip;
    bool within = true;
    for (const std::uint32_t each : y.shape.sides(f))
      within = within && clip.keep(y.ontoFace(each, tail), y.ontoFace(each, head), each);
    if (!within) {
      // The edge passes beside the face, so the boundary of the face is closer.
      double least = HUGE_VAL;
      std::uint32_t nearest = y.shape.sides(f)[0];
      for (const std::uint32_t each : y.shape.sides(f)) {
        const Vec3 &p = y.shape.vertex(y.shape.tail(each)), &q = y.shape.vertex(y.shape.head(each));
        const auto [s, t] = closestParameters(tail, head, p, q);
        const double square = (tail + s * (head - tail) - p - t * (q - p)).squaredNorm();
        if (square < least) least = square, nearest = each;
      }
      y.goToEdge(nearest);
      return Step::moved;
    }
    const double atTail = y.height(f, tail), atHead = y.height(f, head);
    const double atLow = atTail + clip.low * (atHead - atTail),
                 atHigh = atTail + clip.high * (atHead - atTail);
    if (!((atLow > 0 && atHigh > 0) || (atLow < 0 && atHigh < 0))) return Step::trapped;
    const bool toLow = atLow > 0 ? atHead >= atTail : atHead <= atTail;
    const std::uint32_t side = toLow ? clip.beyondLow : clip.beyondHigh;
    if (side != Clip::kNone)
      y.goToEdge(side);
    else
      x.goToVertex(toLow ? x.shape.tail(h) : x.shape.head(h));
    return Step::moved;
  }

  static Step vertexFace(PosedFeatures& x, PosedFeatures& y) {
    const std::uint32_t f = y.at.index;
    const Vec3 p = x.inOther(x.at.index);
    // The edge whose plane the vertex violates most contains the closest point of the face.
    double most = 0;
    std::uint32_t side = Clip::kNone;
    for (const std::uint32_t each : y.shape.sides(f)) {
      const double outside = -y.ontoFace(each, p);
      if (!(outside > 0)) continue;
      const double distance = outside / edge(y, each).norm();
      if (distance > most || side == Clip::kNone) most = distance, side = each;
    }
    if (side != Clip::kNone) {
      y.goToEdge(side);
      return Step::moved;
    }
    const double height = y.height(f, p);
    if (height == 0) return Step::trapped;
    const Vec3 n = x.toOther.transpose() * y.shape.normal(f) * (height > 0 ? 1 : -1);
    double steepest = 0;
    std::uint32_t down = Clip::kNone;
    for (std::uint32_t h = first(x); h < last(x); ++h) {
      const double slope = n.dot(edge(x, h));
      if (slope < steepest) steepest = slope, down = h;
    }
    if (down != Clip::kNone) {
      x.goToEdge(down);
      return Step::moved;
    }
    return height > 0 ? Step::closest : Step::trapped;
  }

  /// If the closest point of a clipped segment is beyond the plane of a neighbour, returns this
  /// neighbour; otherwise `kNone`.
  /// @param slope  called as slope(at, neighbour): returns a number with the sign of the distance's
  /// derivative along the segment, at the fraction `at` of the segment's length.
  template <class Slope>
  static std::uint32_t beyond(const Clip& clip, const Slope& slope) {
    if (clip.excluded) return clip.beyondLow;
    if (clip.beyondLow != Clip::kNone && slope(clip.low, clip.beyondLow) > 0) return clip.beyondLow;
    if (clip.beyondHigh != Clip::kNone && slope(clip.high, clip.beyondHigh) < 0)
      return clip.beyondHigh;
    return Clip::kNone;
  }

  static std::uint32_t first(const PosedFeatures& x) { return x.shape.first(x.at.index); }
  static std::uint32_t last(const PosedFeatures& x) { return x.shape.first(x.at.index + 1); }
  static Vec3 edge(const PosedFeatures& x, std::uint32_t h) {
    return x.shape.vertex(x.shape.head(h)) - x.shape.vertex(x.shape.tail(h));
  }

 public:
  /// Returns the closest points of two segments. Each point is given as a fraction, 0 to 1, of the
  /// length of its segment; rounded.
  static std::pair<double, double> closestParameters(const Vec3& p0, const Vec3& p1, const Vec3& q0,
                                                     const Vec3& q1) {
    const Vec3 u = p1 - p0, v = q1 - q0, r = p0 - q0;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r),
                 vr = v.dot(r), det = uu * vv - uv * uv;
    double s = det > 0 ? std::clamp((uv * vr - vv * ur) / det, 0.0, 1.0) : 0.0;
    double t = (uv * s + vr) / vv;
    if (!(t >= 0 && t <= 1)) {
      t = t > 1 ? 1.0 : 0.0;
      s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
    }
    return {s, t};
  }

 private:
  PosedFeatures &a_, &b_;
};

/// Returns the GJK simplex of at most three corners that contains the closest points of a pair.
ConvexCache simplexOf(const PosedFeatures& a, const PosedFeatures& b) {
  std::array<std::uint32_t, 3> memoryA{}, memoryB{};
  const auto p = a.shape.corners(a.at, memoryA), q = b.shape.corners(b.at, memoryB);
  ConvexCache cache;
  const auto add = [&](std::uint32_t v, std::uint32_t w) {
    cache.corner[static_cast<std::size_t>(cache.count++)] = {v, w, Vec3::Zero()};
  };
  if (p.size() == 2 && q.size() == 2) {
    // The differences of the points of two edges form a parallelogram; the closest point is in one
    // of its two triangles.
    const auto [s, t] = Walk::closestParameters(a.shape.vertex(p[0]), a.shape.vertex(p[1]),
                                                b.inOther(q[0]), b.inOther(q[1]));
    add(p[1], q[0]);
    add(p[0], q[1]);
    const std::size_t corner = s + t > 1 ? 1 : 0;
    add(p[corner], q[corner]);
    return cache;
  }
  // The other pairs are a vertex and another feature, or an edge that passes through a face. For an
  // edge and a face, any corners are a legal start.
  for (std::size_t i = 0; i < std::max(p.size(), q.size()); ++i)
    add(p[std::min(i, p.size() - 1)], q[std::min(i, q.size() - 1)]);
  return cache;
}

/// Returns the distance of a pair's features, computed in double from their simplex. The
/// computation is in the world frame, because the maps need not be rotations to the last digit.
double distanceOf(const ConvexCache& simplex, const PosedSet& a, const PosedSet& b) {
  std::array<gjk::Vector<double>, 3> w;
  for (std::size_t i = 0; i < 3; ++i) {
    const ConvexCache::Corner& c = simplex.corner[i];
    w[i] = gjk::Vector<double>(
        Vec3(b.pose() * b.set().points[c.pointB] - a.pose() * a.set().points[c.pointA]));
  }
  return std::sqrt(simplex.count == 1   ? gjk::nearest(w[0]).squared
                   : simplex.count == 2 ? gjk::nearest(w[0], w[1]).squared
                                        : gjk::nearest(w[0], w[1], w[2]).squared);
}

/// Sets `at` of both bodies to the features that contain the closest points of a GJK simplex.
void goTo(const ConvexCache& simplex, PosedFeatures& a, PosedFeatures& b) {
  const auto take = [&](PosedFeatures& body, auto member) {
    std::array<std::uint32_t, 4> corners{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i) {
      const std::uint32_t v = simplex.corner[i].*member;
      const auto end = corners.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::find(corners.begin(), end, v) == end) corners[count++] = v;
    }
    if (count > 0) body.at = body.shape.withCorners(std::span(corners).first(count));
  };
  take(a, &ConvexCache::Corner::pointA);
  take(b, &ConvexCache::Corner::pointB);
}

/// Walks until a pair is closest or trapped, a pair occurs again, or the walk has taken as many
/// steps as both polytopes together have half-edges. The next pair depends only on the present
/// pair, so a walk that comes back to a pair would never end. R. Brent's method (1980) notices such
/// a cycle: it stores the pair after 1, 2, 4, 8, … steps, and compares each pair with the pair
/// stored most recently.
Step walkFrom(PosedFeatures& a, PosedFeatures& b, int& steps) {
  Walk walk(a, b);
  const std::size_t most = a.shape.halfEdges() + b.shape.halfEdges();
  Feature keptA = a.at, keptB = b.at;
  for (std::size_t taken = 1, next = 1; taken <= most; ++taken) {
    ++steps;
    const Step step = walk.step();
    if (step != Step::moved) return step;
    if (a.at == keptA && b.at == keptB) break;
    if (taken == next) keptA = a.at, keptB = b.at, next *= 2;
  }
  return Step::moved;
}

bool isRotation(const Mat3& m) {
  return (m.transpose() * m - Mat3::Identity()).cwiseAbs().maxCoeff() <= 0x1p-30 &&
         m.determinant() > 0;
}

}  // namespace

ClosestFeatures closestFeatures(const PolytopeFeatures& a, const Transform& X_WA,
                                const PolytopeFeatures& b, const Transform& X_WB,
                                FeaturePair& pair) {
  ClosestFeatures result;
  const PosedSet setA(a.set(), X_WA), setB(b.set(), X_WB);
  if (const auto common = provedCommonPoint(setA, setB, pair.overlap)) {
    result.distance.p_WA = result.distance.p_WB = *common;
    return result;
  }
  const Mat3 m_AB = X_WA.m.transpose() * X_WB.m;
  const Vec3 t_AB = X_WA.m.transpose() * (X_WB.t - X_WA.t);
  PosedFeatures bodyA{a, m_AB.transpose(), -(m_AB.transpose() * t_AB), pair.a},
      bodyB{b, m_AB, t_AB, pair.b};
  const bool rigid = isRotation(X_WA.m) && isRotation(X_WB.m) && t_AB.allFinite();
  if (pair.cold || !a.has(pair.a) || !b.has(pair.b)) {
    const Vec3 toB = m_AB * b.polytope().center() + t_AB - a.polytope().center();
    bodyA.goToVertex(a.set().farthest(toB));
    bodyB.goToVertex(b.set().farthest(-(m_AB.transpose() * toB)));
  }
  const auto walk = [&] { return rigid && walkFrom(bodyA, bodyB, result.steps) == Step::closest; };
  // A walk among degenerate features may end at a pair that is not the closest. So the distance of
  // the pair is compared with the proved distance. `size` is below 9.5 times the largest
  // coordinate, so 2^-44·size is below 2^-40 of that coordinate. If coordinates are outside of
  // 2^±440 m, squares of distances vanish or overflow, and the comparison has no meaning.
  const auto isClosest = [&](const ConvexCache& simplex) {
    const double size = setA.reach() + X_WA.t.norm() + setB.reach() + X_WB.t.norm();
    return distanceOf(simplex, setA, setB) <=
           result.distance.distance * (1 + 1e-10) + 0x1p-44 * size;
  };
  const bool ended = walk();
  ConvexCache cache = simplexOf(bodyA, bodyB);
  const ConvexCache first = cache;
  result.distance = convexDistance(setA, setB, 0, 0, &cache);
  result.rounds = cache.rounds;
  if (result.distance.distance == 0 && !confirmContact(setA, setB, cache))
    result.distance = separatedDistance(setA, setB, cache);
  if (rigid && result.distance.distance > 0) {
    result.closest = ended && isClosest(first);
    if (!result.closest) {
      goTo(cache, bodyA, bodyB);
      result.closest = walk() && isClosest(simplexOf(bodyA, bodyB));
    }
  }
  pair = {false, bodyA.at, bodyB.at, {}};
  if (result.distance.distance == 0) pair.overlap = cache;
  return result;
}

}  // namespace corridor
