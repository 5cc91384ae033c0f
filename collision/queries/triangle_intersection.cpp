#include "collision/queries/triangle_intersection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "collision/convex/double_double.h"

namespace corridor {
namespace {

using Double2 = DoubleDouble;
struct Vector2 {
  std::array<Double2, 3> c;
  const Double2& operator[](int i) const { return c[static_cast<std::size_t>(i)]; }
  Double2& operator[](int i) { return c[static_cast<std::size_t>(i)]; }
  friend Vector2 operator-(const Vector2& a, const Vector2& b) {
    return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
  }
};

Double2 determinant(const Vector2& a, const Vector2& b, const Vector2& c) {
  return c[0] * (a[1] * b[2] - a[2] * b[1]) + c[1] * (a[2] * b[0] - a[0] * b[2]) +
         c[2] * (a[0] * b[1] - a[1] * b[0]);
}

/// Two triangles in general position, in double-double.
///
/// Error bound, with v = 2^-106 and S the largest Σ|m||x| + |t| of the corners x: a mapped
/// coordinate (three exact products, three additions of relative error 3v) is off by at most
/// 10·v·S, a difference by e = 26·v·S. Let D be the largest difference, D ≤ 2.1·S. These errors
/// move a determinant by at most 18·e·D². Its evaluation (six terms, each with two products of 7v
/// and three sums of 3v) loses at most 6·23·v·D³ ≤ 290·v·S·D². The sum is below 2^10·v·S·D²; twice
/// that is the bound B.
class TriangleCrossing {
 public:
  TriangleCrossing(const Triangle& a0, const Transform& X_WA, const Triangle& b0,
                   const Transform& X_WB) {
    for (std::size_t i = 0; i < 3; ++i) {
      a_[i] = mapped(X_WA, a0[i]);
      b_[i] = mapped(X_WB, b0[i]);
    }
    for (int k = 0; k < 3; ++k) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const auto* t : {&a_, &b_})
        for (const Vector2& p : *t) {
          low = std::min(low, p[k].hi);
          high = std::max(high, p[k].hi);
        }
      D_ = std::max(D_, high - low);
    }
    D_ *= 1 + 0x1p-40;
    bound_ = 0x1p-95 * S_ * D_ * D_;
  }

  /// Returns the common segment, or nullopt if this arithmetic can't decide.
  std::optional<Segment> segment() const {
    // Within these limits, products of three differences, and their errors, neither overflow nor
    // underflow.
    if (!(D_ > 0x1p-200 && S_ < 0x1p200)) return std::nullopt;
    std::array<Vector2, 4> ends;
    if (!crossings(a_, b_, &ends[0]) || !crossings(b_, a_, &ends[2])) return std::nullopt;
    // All four points lie on one line. The segment between the first two belongs to one triangle,
    // the segment between the last two to the other. The triangles touch, so the two points in the
    // middle are the ends of the common segment. The points are sorted along the axis of their
    // largest spread. This order is right except for points whose distance is below their error.
    int axis = 0;
    double spread = -1;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax({ends[0][k].hi, ends[1][k].hi, ends[2][k].hi, ends[3][k].hi});
      if (high - low > spread) {
        spread = high - low;
        axis = k;
      }
    }
    std::sort(ends.begin(), ends.end(),
              [&](const Vector2& p, const Vector2& q) { return p[axis] < q[axis]; });
    Segment s;
    for (int k = 0; k < 3; ++k) {
      s.p[k] = ends[1][k].hi;
      s.q[k] = ends[2][k].hi;
    }
    // A segment this short may be a single point: integers decide.
    if ((s.q - s.p).cwiseAbs().maxCoeff() < 0x1p-48 * S_) return std::nullopt;
    return s;
  }

 private:
  using Corners = std::array<Vector2, 3>;

  Vector2 mapped(const Transform& X, const Vec3& p) {
    Vector2 to;
    for (int i = 0; i < 3; ++i) {
      to[i] = Double2::product(X.m(i, 0), p[0]) + Double2::product(X.m(i, 1), p[1]) +
              Double2::product(X.m(i, 2), p[2]) + Double2(X.t[i]);
      S_ = std::max(S_, std::abs(X.m(i, 0) * p[0]) + std::abs(X.m(i, 1) * p[1]) +
                            std::abs(X.m(i, 2) * p[2]) + std::abs(X.t[i]));
    }
    return to;
  }

  /// Computes where two edges of t cross the plane of `plane`. Returns false if they don't, or if
  /// double-double can't decide or is not precise enough.
  bool crossings(const Corners& t, const Corners& plane, Vector2* to) const {
    const Vector2 u = plane[1] - plane[0], v = plane[2] - plane[0];
    std::array<Double2, 3> side;
    std::array<bool, 3> above;
    for (std::size_t i = 0; i < 3; ++i) {
      side[i] = determinant(u, v, t[i] - plane[0]);
      if (!(std::abs(side[i].hi) > bound_)) return false;
      above[i] = side[i].hi > 0;
    }
    const std::size_t alone = above[0] == above[1] ? 2 : above[0] == above[2] ? 1 : 0;
    for (const std::size_t step : {1u, 2u}) {
      const std::size_t other = (alone + step) % 3;
      if (above[alone] == above[other]) return false;
      // The point is p + (q − p)·t with t = x/(x + y), where x, y > 0 are the magnitudes of the
      // determinants of p and q, each off by B. Then t is off by less than 2·B/(x + y), and the
      // point by D times that.
      const Double2 whole = side[alone] - side[other];
      if (!(D_ * bound_ <= 0x1p-56 * S_ * std::abs(whole.hi))) return false;
      const Double2 share = side[alone] / whole;
      for (int k = 0; k < 3; ++k)
        to[step - 1][k] = t[alone][k] + (t[other][k] - t[alone][k]) * share;
    }
    return true;
  }

  Corners a_, b_;
  double S_ = 0, D_ = 0, bound_ = 0;
};

}  // namespace

Segment triangleIntersection(const Triangle& a, const Transform& X_WA, const Triangle& b,
                             const Transform& X_WB) {
  if (const auto segment = TriangleCrossing(a, X_WA, b, X_WB).segment()) return *segment;
  return triangleIntersectionExact(a, X_WA, b, X_WB);
}

}  // namespace corridor
