#include "tests/support/sturm_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "tests/support/polynomial.h"
#include "tests/support/rational_contact.h"

namespace corridor::test {
namespace {

constexpr int kBracketBits = 60;

/// Doubles as integers, in units of a power of two. The unit is the largest one of which all these
/// doubles, and 1, are whole multiples.
class IntegerGrid {
 public:
  IntegerGrid(std::initializer_list<double> values) {
    for (const double x : values) include(x);
  }
  void include(double x) {
    for (double unit = std::ldexp(x, -exponent_); unit != std::trunc(unit); unit *= 2) --exponent_;
  }
  void include(const Vec3& p) {
    for (const double x : p) include(x);
  }
  Integer operator()(double x) const {
    int e = 0;
    const double digits = std::ldexp(std::frexp(x, &e), 53);
    const int shift = e - 53 - exponent_;
    const Integer n = static_cast<std::int64_t>(digits);
    return shift < 0 ? n >> -shift : n << shift;  // a right shift drops zero bits only
  }
  int exponent() const { return exponent_; }

 private:
  int exponent_ = 0;
};

Polynomial constant(const Integer& c) {
  return Polynomial({c});
}

using Vector = std::array<Polynomial, 3>;

Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector operator*(const Polynomial& a, const Vector& b) {
  return {a * b[0], a * b[1], a * b[2]};
}
Polynomial dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns n·2^exponent. @throws std::invalid_argument if n is not a double. @pre the result is in
/// the range of doubles.
double exactly(const Integer& n, int exponent) {
  const double x = n.convert_to<double>();
  if (Integer(x) != n) throw std::invalid_argument("not exact in doubles");
  return std::ldexp(x, exponent);
}

/// The quaternion (1, s·m)·q, linear in s, in units of 2^exponent.
struct PolynomialQuaternion {
  Polynomial w, x, y, z;
  int exponent;

  PolynomialQuaternion(const Eigen::Quaterniond& q, const Vec3& m) {
    IntegerGrid grid{q.w(), q.x(), q.y(), q.z()};
    grid.include(m);
    const Integer one = grid(1), qw = grid(q.w()), qx = grid(q.x()), qy = grid(q.y()),
                  qz = grid(q.z()), mx = grid(m.x()), my = grid(m.y()), mz = grid(m.z());
    w = Polynomial({one * qw, -mx * qx - my * qy - mz * qz});
    x = Polynomial({one * qx, mx * qw + my * qz - mz * qy});
    y = Polynomial({one * qy, my * qw + mz * qx - mx * qz});
    z = Polynomial({one * qz, mz * qw + mx * qy - my * qx});
    exponent = 2 * grid.exponent();
  }
};

/// A pose as a function of s: x(s) = (M p + c)/W, W > 0. p is in units of a grid of points. M and W
/// are in units of 2^exponent, and c in the product of both units.
struct PolynomialPose {
  std::array<Vector, 3> M;  // rows
  Vector c;
  Polynomial W;
  int exponent;

  PolynomialPose(const RationalMotion& motion, const IntegerGrid& points) {
    const PolynomialQuaternion q(motion.from().q, motion.m());
    const Polynomial &w = q.w, &x = q.x, &y = q.y, &z = q.z, two = constant(2);
    M = {Vector{w * w + x * x - y * y - z * z, two * (x * y - w * z), two * (x * z + w * y)},
         Vector{two * (x * y + w * z), w * w - x * x + y * y - z * z, two * (y * z - w * x)},
         Vector{two * (x * z - w * y), two * (y * z + w * x), w * w - x * x - y * y + z * z}};
    W = w * w + x * x + y * y + z * z;
    for (int i = 0; i < 3; ++i) {
      const Integer from = points(motion.from().p[i]), to = points(motion.to().p[i]);
      c[i] = W * Polynomial({from, to - from});
    }
    exponent = 2 * q.exponent;
  }
};

/// A pair of triangles. All corners are multiplied by W, the denominator of the pose.
class Pair {
 public:
  Pair(const Triangle& fixed, const Triangle& moving, const RationalMotion& motion) {
    IntegerGrid points{};
    for (int i = 0; i < 3; ++i) {
      points.include(fixed[i]);
      points.include(moving[i]);
    }
    points.include(motion.from().p);
    points.include(motion.to().p);
    const PolynomialPose pose(motion, points);
    divisor_ = pose.W.primitive();
    const auto vector = [&](const Vec3& p) {
      return Vector{constant(points(p[0])), constant(points(p[1])), constant(points(p[2]))};
    };
    for (int i = 0; i < 3; ++i) {
      fixed_.corners[i] = pose.W * vector(fixed[i]);
      const Vector p = vector(moving[i]);
      for (int k = 0; k < 3; ++k) moving_.corners[i][k] = dot(pose.M[k], p) + pose.c[k];
    }
    for (Face* face : {&fixed_, &moving_}) {
      for (int i = 0; i < 3; ++i)
        face->edges[i] = reduced(face->corners[(i + 1) % 3] - face->corners[i]);
      face->normal = reduced(cross(face->edges[0], face->edges[1]));
      for (int i = 0; i < 3; ++i) face->inward[i] = reduced(cross(face->normal, face->edges[i]));
    }
  }

  FirstContact first() {
    for (int i = 0; i < 3; ++i) {
      cornerInFace(moving_.corners[i], fixed_);
      cornerInFace(fixed_.corners[i], moving_);
      for (int j = 0; j < 3; ++j) edgesCross(i, j);
    }
    return first_;
  }

 private:
  struct Face {
    std::array<Vector, 3> corners, edges, inward;
    Vector normal;
  };

  // Removes all factors W: only signs matter, and W is positive everywhere.
  Polynomial reduced(Polynomial p) const {
    if (divisor_.degree() == 2)
      while (const std::optional<Polynomial> q = p.isZero() ? std::nullopt : quotient(p, divisor_))
        p = *q;
    return p.primitive();
  }
  Vector reduced(Vector v) const {
    if (divisor_.degree() < 2 || (v[0].isZero() && v[1].isZero() && v[2].isZero())) return v;
    for (;;) {
      Vector q;
      for (int i = 0; i < 3; ++i) {
        std::optional<Polynomial> whole = quotient(v[i], divisor_);
        if (!whole) return v;
        q[i] = std::move(*whole);
      }
      v = std::move(q);
    }
  }

  /// Finds the earliest root of p at which `meet` is true. Records this root as the first contact,
  /// unless an earlier contact is known.
  template <class Meet>
  void tryRoots(const Polynomial& p, const Meet& meet) {
    if (p.isZero()) return;
    for (Root& root : rootsInUnitInterval(p)) {
      if (first_.contact && lowEnd(root) > first_.high) return;
      if (!meet(root)) continue;
      root.narrow(kBracketBits);
      const long double low = lowEnd(root), high = low + std::ldexp(1.0L, -kBracketBits);
      if (!first_.contact || low < first_.low) first_ = {true, low, high};
      return;
    }
  }
  /// Returns the lower end of the root's interval, rounded down to kBracketBits.
  static long double lowEnd(const Root& root) {
    const int k = static_cast<int>(root.k()), more = std::max(k - kBracketBits, 0);
    return std::ldexp(Integer(root.n() >> more).convert_to<long double>(), more - k);
  }

  void cornerInFace(const Vector& corner, const Face& face) {
    const auto above = [&](const Vector& direction, int i) {
      return reduced(dot(direction, corner - face.corners[i]));
    };
    const auto inside = [&](Root& root) {
      for (int i = 0; i < 3; ++i)
        if (root.signOf(above(face.inward[i], i)) < 0) return false;
      return true;
    };
    const Polynomial height = above(face.normal, 0);
    if (!height.isZero()) {
      tryRoots(height, inside);
    } else {  // the corner stays in the plane, and enters the face across an edge
      for (int i = 0; i < 3; ++i) tryRoots(above(face.inward[i], i), inside);
    }
  }

  /// Finds when two edges cross. Edges that stay in one plane, or that are parallel when they begin
  /// to meet, meet first at an end of one of them: `cornerInFace` finds these contacts.
  void edgesCross(int i, int j) {
    const Vector &e = moving_.edges[i], &f = fixed_.edges[j];
    const Vector &a = moving_.corners[i], &a1 = moving_.corners[(i + 1) % 3],
                 &b = fixed_.corners[j], &b1 = fixed_.corners[(j + 1) % 3];
    const Vector normal = reduced(cross(e, f));
    tryRoots(reduced(dot(normal, b - a)), [&](Root& root) {
      // Returns 1 or −1 for the side of an edge's line on which an end of the other edge is, and 0
      // for an end on the line. Returns 0 for all ends if the edges are parallel.
      const auto side = [&](const Vector& offset, const Vector& edge) {
        return root.signOf(dot(normal, reduced(cross(offset, edge))));
      };
      const int first = side(b - a, e), second = side(b1 - a, e);
      if (first * second > 0 || (first == 0 && second == 0)) return false;
      return side(a - b, f) * side(a1 - b, f) <= 0;
    });
  }

  Polynomial divisor_;  // W without constant factors
  Face fixed_, moving_;
  FirstContact first_;
};

}  // namespace

RationalMotion RationalMotion::line(const RigidPose& from, const Vec3& p) {
  RationalMotion motion;
  motion.from_ = from;
  motion.to_ = {p, from.q};
  return motion;
}

RationalMotion RationalMotion::turn(const RigidPose& from, const Vec3& m) {
  if (m.isZero(0)) throw std::invalid_argument("the axis of a rotation must not be zero");
  RationalMotion motion;
  motion.from_ = motion.to_ = from;
  motion.m_ = m;
  const PolynomialQuaternion q(from.q, m);
  const auto last = [&](const Polynomial& p) { return exactly(p.scaledValue(1, 0), q.exponent); };
  motion.to_.q = Eigen::Quaterniond(last(q.w), last(q.x), last(q.y), last(q.z));
  return motion;
}

long double RationalMotion::time(long double s) const {
  const long double m = m_.cast<long double>().norm();
  return m == 0 ? s : std::atan(s * m) / std::atan(m);
}

RationalMotion::Scaled RationalMotion::at(double s) const {
  IntegerGrid points{}, parameters{s};
  points.include(from_.p);
  points.include(to_.p);
  const PolynomialPose pose(*this, points);
  const int k = -parameters.exponent();
  const auto value = [&](const Polynomial& p, int exponent) {
    return exactly(p.scaledValue(parameters(s), k),
                   exponent + pose.exponent - k * std::max(p.degree(), 0));
  };
  Scaled result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.X.m(i, j) = value(pose.M[i][j], 0);
    result.X.t[i] = value(pose.c[i], points.exponent());
  }
  result.weight = value(pose.W, 0);
  return result;
}

FirstContact sturmContact(const Triangle& fixed, const Triangle& moving,
                          const RationalMotion& motion) {
  if (touchesAt(fixed, moving, motion, 0)) return {true, 0, 0};
  return Pair(fixed, moving, motion).first();
}

bool touchesAt(const Triangle& fixed, const Triangle& moving, const RationalMotion& motion,
               double s) {
  const RationalMotion::Scaled pose = motion.at(s);
  return rationalContact(fixed, {pose.weight * Mat3::Identity(), Vec3::Zero()}, moving, pose.X);
}

}  // namespace corridor::test
