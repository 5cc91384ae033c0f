#include "planner/verify/exact_contact.h"

#include <algorithm>

#include <boost/multiprecision/cpp_int.hpp>

namespace corridor::verify {
namespace {

namespace mp = boost::multiprecision;
using Rational = mp::number<mp::cpp_rational::backend_type, mp::et_off>;
using Point = std::array<Rational, 3>;
using Triangle = std::array<Point, 3>;

Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Rational dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool isZero(const Point& a) {
  return a[0] == 0 && a[1] == 0 && a[2] == 0;
}

Point along(const Point& p, const Point& direction, const Rational& t) {
  return {p[0] + t * direction[0], p[1] + t * direction[1], p[2] + t * direction[2]};
}

/// Returns a common point of the closed segments pq and rs. Either segment may be a single point.
std::optional<Point> segmentsMeet(const Point& p, const Point& q, const Point& r, const Point& s) {
  const Point d1 = q - p, d2 = s - r, w = r - p, normal = cross(d1, d2);
  if (!isZero(normal)) {
    if (dot(w, normal) != 0) return std::nullopt;  // skew lines
    const Rational square = dot(normal, normal);
    const Rational t = dot(cross(w, d2), normal), u = dot(cross(w, d1), normal);
    if (t < 0 || t > square || u < 0 || u > square) return std::nullopt;
    return along(p, d1, t / square);
  }
  const Point& d = isZero(d1) ? d2 : d1;
  if (isZero(d)) return isZero(w) ? std::optional(p) : std::nullopt;  // two points
  if (!isZero(cross(w, d))) return std::nullopt;                      // parallel lines
  // Collinear segments: the larger of the two lower ends is a common point, unless it is beyond an
  // upper end.
  const auto before = [&](const Point& a, const Point& b) { return dot(a - b, d) < 0; };
  const auto [low1, high1] = before(q, p) ? std::pair(q, p) : std::pair(p, q);
  const auto [low2, high2] = before(s, r) ? std::pair(s, r) : std::pair(r, s);
  const Point& low = before(low1, low2) ? low2 : low1;
  if (before(high1, low) || before(high2, low)) return std::nullopt;
  return low;
}

std::optional<Point> segmentMeetsAnEdge(const Point& p, const Point& q, const Triangle& t) {
  for (int i = 0; i < 3; ++i) {
    if (auto point = segmentsMeet(p, q, t[i], t[(i + 1) % 3])) return point;
  }
  return std::nullopt;
}

/// @pre `x` is in the plane of `t`, whose normal is not zero.
bool inTriangle(const Point& x, const Triangle& t, const Point& normal) {
  for (int i = 0; i < 3; ++i) {
    if (dot(normal, cross(t[(i + 1) % 3] - t[i], x - t[i])) < 0) return false;
  }
  return true;
}

std::optional<Point> segmentMeetsTriangle(const Point& p, const Point& q, const Triangle& t) {
  const Point normal = cross(t[1] - t[0], t[2] - t[0]);
  if (isZero(normal)) return segmentMeetsAnEdge(p, q, t);  // the triangle is the union of its edges
  const Rational sideP = dot(normal, p - t[0]), sideQ = dot(normal, q - t[0]);
  if ((sideP > 0 && sideQ > 0) || (sideP < 0 && sideQ < 0)) return std::nullopt;
  if (sideP == 0 && inTriangle(p, t, normal)) return p;
  if (sideQ == 0 && inTriangle(q, t, normal)) return q;
  if (sideP == sideQ) return segmentMeetsAnEdge(p, q, t);  // both zero: the segment is in the plane
  const Point crossing = along(p, q - p, sideP / (sideP - sideQ));
  return inTriangle(crossing, t, normal) ? std::optional(crossing) : std::nullopt;
}

Point exact(const Vec3& v) {
  return {Rational(v.x()), Rational(v.y()), Rational(v.z())};
}

}  // namespace

std::optional<Vec3> exactContact(const RigidPose& pose, const Corners& moving,
                                 const Corners& fixed) {
  const Rational w(pose.q.w()), x(pose.q.x()), y(pose.q.y()), z(pose.q.z());
  // All coordinates are multiplied by |q|², which avoids divisions.
  const Rational scale = w * w + x * x + y * y + z * z;
  const Point rows[3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                         {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                         {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
  const Point p = exact(pose.p);
  Triangle a, b;
  for (int corner = 0; corner < 3; ++corner) {
    const Point body = exact(moving[corner]), world = exact(fixed[corner]);
    for (int i = 0; i < 3; ++i) {
      a[corner][i] = dot(rows[i], body) + scale * p[i];
      b[corner][i] = scale * world[i];
    }
  }
  // Two triangles meet if and only if an edge of one of them meets the other triangle. This holds
  // for degenerate triangles, too.
  std::optional<Point> common;
  for (int i = 0; i < 3 && !common; ++i) {
    common = segmentMeetsTriangle(a[i], a[(i + 1) % 3], b);
    if (!common) common = segmentMeetsTriangle(b[i], b[(i + 1) % 3], a);
  }
  if (!common) return std::nullopt;
  Vec3 rounded;
  for (int i = 0; i < 3; ++i) rounded[i] = Rational((*common)[i] / scale).convert_to<double>();
  return rounded;
}

}  // namespace corridor::verify
