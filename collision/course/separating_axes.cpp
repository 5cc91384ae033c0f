#include "collision/course/separating_axes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "collision/core/rounding.h"
#include "collision/predicates/orientation.h"

/// Signs of determinants of three vectors u, v, w, each a difference of two mapped points. Let the
/// entries of u be below D_u in magnitude, before and after rounding, and let their errors be at
/// most e_u. D_v, e_v, D_w and e_w are the corresponding bounds for v and w. A determinant has six
/// terms of three factors. So rounding of the entries changes it by at most 6(e_u D_v D_w + D_u e_v
/// D_w + D_u D_v e_w), and its evaluation adds less than 40u D_u D_v D_w (as in
/// predicates/orientation.cpp).
///
/// The Gauss map. Let l and r be the outward normals of the faces on the left and on the right of a
/// half-edge u. Then l × r is a positive multiple of u. Take the arc (l, r) of an edge u of a, and
/// the arc (−l', −r') of an edge v of b. The arcs cross if l' and r' are on different sides of the
/// plane normal to u, l and r are on different sides of the plane normal to v, and both arcs meet
/// the intersection line of these two planes on the same half. The last condition is that l·v and
/// l'·u have the same sign. Then u × v = (l·v) r − (r·v) l, up to a positive factor, so the common
/// normal is u × v if l·v > 0, else its negative.
namespace corridor {
namespace {

using Kind = Feature::Kind;

/// A difference of two mapped points.
struct Edge {
  Vec3 d;
  double size, error;  ///< D and e
  MappedEdge exact;
};

/// A plane that is parallel to two vectors u and v: its normal is u × v.
struct EdgePlane {
  Edge u, v;
  Vec3 n;
  double size, error;  ///< D_u D_v, and e_u D_v + D_u e_v
};

class MappedPolytope {
 public:
  MappedPolytope(const PolytopeFeatures& polytope, const Transform& X) : shape(polytope), X_(X) {
    // The determinant is that of a matrix with norm 1, so no scale overflows or vanishes. A norm of
    // 0 gives NaN, which is refused. (Eigen 3.4.0 asserts wrongly in stableNorm of a matrix that is
    // no vector.)
    if (!X.t.allFinite() || !(Mat3(X.m / X.m.reshaped().stableNorm()).determinant() > 0x1p-40))
      throw std::invalid_argument(
          "a map is not finite, or it mirrors or nearly flattens; use convexHullsTouch");
    const auto vertices = shape.set().points;
    points_.reserve(vertices.size());
    double largest = 0;
    for (const Vec3& p : vertices) {
      points_.push_back(X * p);
      largest = std::max(largest, p.cwiseAbs().maxCoeff());
    }
    // A sum of three products and a translation has four roundings on its longest path.
    error_ = roundedUp(
        4.1 * kUnit *
        (X.m.cwiseAbs().rowwise().sum().maxCoeff() * largest + X.t.cwiseAbs().maxCoeff()));
  }

  std::size_t faces() const { return shape.polytope().faces().size(); }
  std::size_t vertices() const { return points_.size(); }

  Edge edge(std::uint32_t h) const { return between(*this, shape.tail(h), *this, shape.head(h)); }
  EdgePlane plane(std::uint32_t f) const {
    const Polytope::Face& c = shape.polytope().faces()[f];
    return planeOf(between(*this, c[0], *this, c[1]), between(*this, c[0], *this, c[2]));
  }

  /// Returns the difference from a vertex of one polytope to a vertex of the same or the other one.
  static Edge between(const MappedPolytope& a, std::uint32_t v, const MappedPolytope& b,
                      std::uint32_t w) {
    const Vec3 d = b.points_[w] - a.points_[v];
    const double largest = d.cwiseAbs().maxCoeff();
    const double error = roundedUp(a.error_ + b.error_ + kUnit * largest);
    return {d,
            roundedUp(largest + error),
            error,
            {{a.X_, a.shape.vertex(v)}, {b.X_, b.shape.vertex(w)}}};
  }
  static EdgePlane planeOf(const Edge& u, const Edge& v) {
    return {u, v, u.d.cross(v.d), u.size * v.size, u.error * v.size + u.size * v.error};
  }

  const PolytopeFeatures& shape;

 private:
  const Transform& X_;
  std::vector<Vec3> points_;
  double error_ = 0;
};

/// Returns the sign of det(u, v, w), where u and v are the vectors of `plane`.
int side(const EdgePlane& plane, const Edge& w) {
  // Within this range no product overflows or vanishes.
  const auto usual = [](const Edge& edge) { return edge.size > 0x1p-250 && edge.size < 0x1p250; };
  if (usual(plane.u) && usual(plane.v) && usual(w)) {
    const double size = plane.size * w.size;
    const double det = plane.n.dot(w.d);
    const double bound =
        1.01 * (6 * (plane.error * w.size + plane.size * w.error) + 40 * kUnit * size);
    if (det > bound) return 1;
    if (det < -bound) return -1;
  }
  return exactDeterminantSign(plane.u.exact, plane.v.exact, w.exact);
}

class Axes {
 public:
  Axes(const PolytopeFeatures& a, const Transform& X_WA, const PolytopeFeatures& b,
       const Transform& X_WB)
      : a_(a, X_WA), b_(b, X_WB) {}

  SeparatingAxis test(const SeparatingAxis* first) {
    if ((first && testAgain(*first)) || testFaces(a_, b_, true) || testFaces(b_, a_, false) ||
        testEdges())
      answer_.separated = true;
    return answer_;
  }

 private:
  bool testAgain(const SeparatingAxis& first) {
    if (!first.separated || !a_.shape.has(first.a) || !b_.shape.has(first.b)) return false;
    if (first.a.kind == Kind::face) return testFace(a_, b_, first.a.index, true);
    if (first.b.kind == Kind::face) return testFace(b_, a_, first.b.index, false);
    if (first.a.kind != Kind::edge || first.b.kind != Kind::edge) return false;
    const Edge v = b_.edge(first.b.index);
    const auto sideA = [&](std::uint32_t f) { return side(a_.plane(f), v); };
    return testEdgePair(first.a.index, first.b.index, v, sideA(a_.shape.leftFace(first.a.index)),
                        sideA(a_.shape.leftFace(a_.shape.twin(first.a.index))));
  }

  bool testFaces(const MappedPolytope& x, const MappedPolytope& y, bool ofA) {
    guess_ = 0;
    for (std::uint32_t f = 0; f < x.faces(); ++f)
      if (testFace(x, y, f, ofA)) return true;
    return false;
  }

  /// Tests whether all of y is beyond the plane of a face of x. Begins with the vertex that was not
  /// beyond the previous plane. If all of y is beyond the plane, stores this axis in the answer and
  /// returns true.
  bool testFace(const MappedPolytope& x, const MappedPolytope& y, std::uint32_t f, bool ofA) {
    ++answer_.faces;
    const EdgePlane plane = x.plane(f);
    const std::uint32_t corner = x.shape.polytope().faces()[f][0];
    const auto isBeyond = [&](std::uint32_t v) {
      return side(plane, MappedPolytope::between(x, corner, y, v)) > 0;
    };
    if (!isBeyond(guess_)) return false;
    for (std::uint32_t v = 0; v < y.vertices(); ++v)
      if (!isBeyond(v)) {
        guess_ = v;
        return false;
      }
    const Vec3 n = plane.n.stableNormalized();
    const Feature face{Kind::face, f}, nearest{Kind::vertex, lowest(x, y, corner, n)};
    answer_.a = ofA ? face : nearest;
    answer_.b = ofA ? nearest : face;
    answer_.normal_W = ofA ? n : Vec3(-n);
    return true;
  }

  /// Returns the vertex of y that is lowest along n, up to rounding.
  static std::uint32_t lowest(const MappedPolytope& x, const MappedPolytope& y,
                              std::uint32_t corner, const Vec3& n) {
    std::uint32_t best = 0;
    double least = HUGE_VAL;
    for (std::uint32_t v = 0; v < y.vertices(); ++v) {
      const double height = n.dot(MappedPolytope::between(x, corner, y, v).d);
      if (height < least) least = height, best = v;
    }
    return best;
  }

  bool testEdges() {
    std::vector<EdgePlane> planesA;
    for (std::uint32_t f = 0; f < a_.faces(); ++f) planesA.push_back(a_.plane(f));
    std::vector<signed char> sideA(a_.faces());
    for (std::uint32_t k = 0; k < b_.shape.halfEdges(); ++k) {
      if (k > b_.shape.twin(k)) continue;
      const Edge v = b_.edge(k);
      for (std::uint32_t f = 0; f < a_.faces(); ++f)
        sideA[f] = static_cast<signed char>(side(planesA[f], v));
      for (std::uint32_t h = 0; h < a_.shape.halfEdges(); ++h) {
        const std::uint32_t back = a_.shape.twin(h);
        if (h < back &&
            testEdgePair(h, k, v, sideA[a_.shape.leftFace(h)], sideA[a_.shape.leftFace(back)]))
          return true;
      }
    }
    return false;
  }

  /// Tests the axis of half-edge h of a and half-edge k of b, if their arcs cross. If this axis
  /// separates the polytopes, stores the axis in the answer.
  /// @param leftA, rightA  the signs of l·v and r·v.
  bool testEdgePair(std::uint32_t h, std::uint32_t k, const Edge& v, int leftA, int rightA) {
    if (leftA * rightA >= 0) return false;
    const Edge u = a_.edge(h);
    if (side(b_.plane(b_.shape.leftFace(k)), u) != leftA) return false;
    if (side(b_.plane(b_.shape.leftFace(b_.shape.twin(k))), u) != -leftA) return false;
    ++answer_.edgePairs;
    const EdgePlane plane = MappedPolytope::planeOf(u, v);
    const Edge w = MappedPolytope::between(a_, a_.shape.tail(h), b_, b_.shape.tail(k));
    if (side(plane, w) != leftA) return false;
    answer_.a = {Kind::edge, h};
    answer_.b = {Kind::edge, k};
    answer_.normal_W = leftA * plane.n.stableNormalized();
    return true;
  }

  MappedPolytope a_, b_;
  std::uint32_t guess_ = 0;
  SeparatingAxis answer_;
};

}  // namespace

SeparatingAxis separatingAxis(const PolytopeFeatures& a, const Transform& X_WA,
                              const PolytopeFeatures& b, const Transform& X_WB,
                              const SeparatingAxis* first) {
  return Axes(a, X_WA, b, X_WB).test(first);
}

}  // namespace corridor
