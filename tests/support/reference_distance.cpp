#include "tests/support/reference_distance.h"

#include <algorithm>

namespace corridor::test {
namespace {

using P = std::array<Digits, 3>;

P minus(const P& a, const P& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Digits dot(const P& a, const P& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
P along(const P& a, const P& d, const Digits& s) {
  return {a[0] + s * d[0], a[1] + s * d[1], a[2] + s * d[2]};
}
Digits square(const P& d) {
  return dot(d, d);
}

P mapped(const Transform& X, const Vec3& p) {
  P q;
  for (int i = 0; i < 3; ++i)
    q[i] = Digits(X.m(i, 0)) * p[0] + Digits(X.m(i, 1)) * p[1] + Digits(X.m(i, 2)) * p[2] + X.t[i];
  return q;
}

Digits toSegment(const P& p, const P& a, const P& b) {
  const P d = minus(b, a);
  Digits s = square(d) > 0 ? Digits(dot(minus(p, a), d) / square(d)) : Digits(0);
  s = std::clamp<Digits>(s, 0, 1);
  return square(minus(p, along(a, d, s)));
}

Digits toTriangle(const P& p, const std::array<P, 3>& t) {
  Digits best =
      std::min({toSegment(p, t[0], t[1]), toSegment(p, t[1], t[2]), toSegment(p, t[2], t[0])});
  const P u = minus(t[1], t[0]), v = minus(t[2], t[0]), w = minus(p, t[0]);
  const P n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  if (square(n) == 0) return best;
  const auto inside = [&](const P& e, const P& q) {  // left of an edge
    const P c = {e[1] * q[2] - e[2] * q[1], e[2] * q[0] - e[0] * q[2], e[0] * q[1] - e[1] * q[0]};
    return dot(c, n) >= 0;
  };
  if (inside(u, w) && inside(minus(t[2], t[1]), minus(p, t[1])) &&
      inside(minus(t[0], t[2]), minus(p, t[2])))
    best = std::min<Digits>(best, dot(n, w) * dot(n, w) / square(n));
  return best;
}

/// Inner points of both edges; their ends are left to `toTriangle`.
Digits edges(const P& p, const P& p1, const P& q, const P& q1, const Digits& best) {
  const P d = minus(p1, p), e = minus(q1, q), r = minus(q, p);
  const Digits a = square(d), b = dot(d, e), c = square(e), det = a * c - b * b;
  if (det <= 0) return best;
  const Digits s = (dot(d, r) * c - dot(e, r) * b) / det, t = (dot(d, r) * b - dot(e, r) * a) / det;
  if (s < 0 || s > 1 || t < 0 || t > 1) return best;
  return std::min<Digits>(best, square(minus(along(p, d, s), along(q, e, t))));
}

}  // namespace

Digits referenceDistance(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB) {
  std::array<P, 3> s, t;
  for (int i = 0; i < 3; ++i) s[i] = mapped(X_WA, a[i]), t[i] = mapped(X_WB, b[i]);
  Digits best = toTriangle(s[0], t);
  for (int i = 0; i < 3; ++i) {
    best = std::min({best, toTriangle(s[i], t), toTriangle(t[i], s)});
    for (int k = 0; k < 3; ++k) best = edges(s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3], best);
  }
  return sqrt(best);
}

Digits referenceDistance(const Vec3& p_W, const Triangle& t, const Transform& X_WT) {
  return sqrt(
      toTriangle(mapped({}, p_W), {mapped(X_WT, t[0]), mapped(X_WT, t[1]), mapped(X_WT, t[2])}));
}

}  // namespace corridor::test
