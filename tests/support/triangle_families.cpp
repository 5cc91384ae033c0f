#include "tests/support/triangle_families.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace corridor::test {
namespace {

using Random = std::mt19937_64;

int integer(Random& random, int low, int high) {
  return std::uniform_int_distribution(low, high)(random);
}
double real(Random& random, double low = -1, double high = 1) {
  return std::uniform_real_distribution(low, high)(random);
}
/// Returns integer coordinates of magnitude at most `most`.
Vec3 grid(Random& random, int most) {
  const int x = integer(random, -most, most), y = integer(random, -most, most),
            z = integer(random, -most, most);
  return Vec3(x, y, z);
}
/// Returns a random size of grid. Coarse grids often give degenerate positions; fine grids need
/// many bits.
int anySize(Random& random) {
  constexpr int kSizes[] = {2, 5, 100, 1 << 20};
  return kSizes[integer(random, 0, 3)];
}
/// Shuffles the corners of both triangles, and swaps the triangles with probability 1/2. With
/// probability 1/3, also moves one triangle by at most one step per coordinate. The comments of the
/// families below describe the triangles before `finish`.
void finish(Random& random, Triangle& a, Triangle& b) {
  std::shuffle(a.begin(), a.end(), random);
  std::shuffle(b.begin(), b.end(), random);
  if (integer(random, 0, 2) == 0) {
    const Vec3 step = grid(random, 1);
    for (Vec3& p : a) p += step;
  }
  if (random() % 2) std::swap(a, b);
}
/// Returns a direction that does not point below the plane with this normal.
Vec3 above(Random& random, const Vec3& normal, int size) {
  const Vec3 d = grid(random, size);
  return d.dot(normal) < 0 ? Vec3(-d) : d;
}

void anyOnAGrid(Random& random, Triangle& a, Triangle& b) {
  const int size = anySize(random);
  for (Triangle* t : {&a, &b})
    for (Vec3& p : *t) p = grid(random, size);
}

/// Each triangle is a segment with a third corner at most one step off the segment. Both segments
/// pass through a common point.
void slivers(Random& random, Triangle& a, Triangle& b) {
  const Vec3 common = grid(random, 100);
  for (Triangle* t : {&a, &b}) {
    const Vec3 v = grid(random, 1 << 8);
    const int length = 1 << integer(random, 0, 10);
    const Vec3 start = common - integer(random, 0, length) * v;
    *t = {start, start + length * v, start + integer(random, 0, length) * v + grid(random, 1)};
  }
  finish(random, a, b);
}

/// Triangle b has zero area: it is a point or a segment. Triangle a is an ordinary triangle, a
/// segment or a point.
void zeroArea(Random& random, Triangle& a, Triangle& b) {
  const int size = anySize(random) / 2;
  const Vec3 p = grid(random, size), u = grid(random, size), v = grid(random, size);
  switch (integer(random, 0, 2)) {
    case 0:
      a = {p, p + 4 * u, p + 4 * v};
      break;
    case 1:
      a = {p, p + 4 * u, p + integer(random, -4, 8) * u};
      break;
    default:
      a = {p, p, p};
  }
  const int i = integer(random, 0, 4), j = integer(random, 0, 4 - i);
  const Vec3 q = p + i * u + j * v, w = grid(random, size);
  if (integer(random, 0, 2) == 0)
    b = {q, q, q};
  else
    b = {q - integer(random, 0, 3) * w, q + integer(random, 0, 3) * w, q};
  finish(random, a, b);
}

/// Triangles in one plane. With probability 1/4, one corner then leaves the plane by at most a
/// step.
void coplanar(Random& random, Triangle& a, Triangle& b) {
  const int size = anySize(random);
  const Vec3 p = grid(random, size), u = grid(random, size), v = grid(random, size);
  for (Triangle* t : {&a, &b})
    for (Vec3& q : *t) q = p + integer(random, -3, 3) * u + integer(random, -3, 3) * v;
  if (integer(random, 0, 3) == 0) a[0] += grid(random, 1);
}

void sharedCorner(Random& random, Triangle& a, Triangle& b) {
  anyOnAGrid(random, a, b);
  b[0] = a[0];
  finish(random, a, b);
}

/// The triangles share an edge, or an edge of b contains an edge of a as one half.
void sharedEdge(Random& random, Triangle& a, Triangle& b) {
  anyOnAGrid(random, a, b);
  b[0] = a[0];
  b[1] = random() % 2 ? a[1] : Vec3(2 * a[1] - a[0]);
  finish(random, a, b);
}

/// A corner of a is in b's face, or on its boundary. All other points of a are on one side of b's
/// plane, or in it.
void cornerOnFace(Random& random, Triangle& a, Triangle& b) {
  const int size = anySize(random);
  const Vec3 p = grid(random, size), u = grid(random, size), v = grid(random, size);
  b = {p, p + 4 * u, p + 4 * v};
  const int i = integer(random, 0, 4), j = integer(random, 0, 4 - i);
  const Vec3 q = p + i * u + j * v;
  a = {q, q + above(random, u.cross(v), size), q + above(random, u.cross(v), size)};
  finish(random, a, b);
}

/// An edge of a lies in b's plane: inside b's face, across it, or beside it.
void edgeOnFace(Random& random, Triangle& a, Triangle& b) {
  const int size = anySize(random) / 2;
  const Vec3 p = grid(random, size), u = grid(random, size), v = grid(random, size);
  b = {p, p + 4 * u, p + 4 * v};
  const Vec3 q = p + integer(random, -2, 5) * u + integer(random, -2, 5) * v,
             r = p + integer(random, -2, 5) * u + integer(random, -2, 5) * v;
  a = {q, r, q + above(random, u.cross(v), size)};
  finish(random, a, b);
}

/// An edge of a and an edge of b share a point, where they cross or end. The third corners of a and
/// b are on different sides of the plane of both edges, or in this plane.
void edgeOnEdge(Random& random, Triangle& a, Triangle& b) {
  const int size = anySize(random) / 2;
  const Vec3 p = grid(random, size), u = grid(random, size), v = grid(random, size);
  const Vec3 n = u.cross(v);
  a = {p - integer(random, 0, 3) * u, p + integer(random, 0, 3) * u, p + above(random, n, size)};
  b = {p - integer(random, 0, 3) * v, p + integer(random, 0, 3) * v, p - above(random, n, size)};
  finish(random, a, b);
}

// ---- placings ----

template <class Map>
PlacedPair baked(const Triangle& a, const Triangle& b, Map&& map) {
  PlacedPair pair{a, b, {}, {}};
  for (Triangle* t : {&pair.a, &pair.b})
    for (Vec3& p : *t) p = map(p);
  return pair;
}
Mat3 rotation(Random& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}
Vec3 anyOffset(Random& random) {
  const double size = std::pow(10.0, integer(random, 6, 12));
  const double x = real(random), y = real(random), z = real(random);
  return (size * Vec3(x, y, z)).array().round();
}

PlacedPair asIs(Random&, const Triangle& a, const Triangle& b) {
  return {a, b, {}, {}};
}
PlacedPair byExactRotation(Random& random, const Triangle& a, const Triangle& b) {
  PlacedPair pair{a, b, {}, {}};
  pair.X_WA = pair.X_WB = {exactRotation(random), anyOffset(random)};
  if (random() % 2) {  // b's corners in a rotated and translated frame of their own
    const Transform X_BN{exactRotation(random), anyOffset(random)};
    for (Vec3& p : pair.b) p = X_BN.m.transpose() * (p - X_BN.t);
    pair.X_WB = pair.X_WB * X_BN;
  }
  return pair;
}
/// Rotates the pair by a rational (Pythagorean) rotation times its denominator. This map takes
/// integers to integers. Without the denominator as a factor, doubles hold only 24 rotation
/// matrices exactly, the signed permutations: a row of doubles is (x, y, z)/2^k with integers x, y
/// and z, and x² + y² + z² = 4^k. If k > 0, the sum of their squares is a multiple of 4, which
/// requires that all three integers are even. So the fraction can be reduced until k = 0.
PlacedPair byRationalRotation(Random& random, const Triangle& a, const Triangle& b) {
  const double w = integer(random, -5, 5), x = integer(random, -5, 5), y = integer(random, -5, 5),
               z = integer(random, 1, 5);
  Mat3 m;
  m << w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
      w * w - x * x + y * y - z * z, 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
      w * w - x * x - y * y + z * z;
  const Vec3 shift = random() % 2 ? anyOffset(random) : Vec3(0, 0, 0);
  if (random() % 2) return baked(a, b, [&](const Vec3& p) { return Vec3(m * p + shift); });
  return {a, b, {m, shift}, {m, shift}};
}
PlacedPair farAway(Random& random, const Triangle& a, const Triangle& b) {
  const Vec3 shift = anyOffset(random);
  return baked(a, b, [&](const Vec3& p) { return Vec3(p + shift); });
}
/// Gives both triangles the same map, so contacts remain. The map is rigid up to rounding, or
/// differs from a rigid one by 10^-3 to 10^-12.
PlacedPair movedTogether(Random& random, const Triangle& a, const Triangle& b) {
  PlacedPair pair{a, b, {}, {}};
  pair.X_WA.m = rotation(random);
  if (random() % 2) pair.X_WA.m += std::pow(10.0, -integer(random, 3, 12)) * rotation(random);
  pair.X_WA.t = real(random) * anyOffset(random);
  pair.X_WB = pair.X_WA;
  return pair;
}
/// Stores the corners of b, and sometimes those of a, in a rotated frame of their own. This rounds
/// them, so triangles that touched may no longer touch.
PlacedPair inOwnFrames(Random& random, const Triangle& a, const Triangle& b) {
  PlacedPair pair{a, b, {}, {}};
  pair.X_WB = {rotation(random), random() % 2 ? anyOffset(random) : grid(random, 10)};
  for (Vec3& p : pair.b) p = pair.X_WB.m.transpose() * (p - pair.X_WB.t);
  if (random() % 2) {
    pair.X_WA.m = rotation(random);
    for (Vec3& p : pair.a) p = pair.X_WA.m.transpose() * p;
  }
  return pair;
}
PlacedPair scaledByTwos(Random& random, const Triangle& a, const Triangle& b) {
  const int exponent = integer(random, -332, 332);  // 10^±100
  return baked(a, b, [&](const Vec3& p) { return Vec3(p * std::ldexp(1.0, exponent)); });
}
/// Scales the pair by a factor for which each product is rounded.
PlacedPair scaledByTens(Random& random, const Triangle& a, const Triangle& b) {
  const double scale = std::pow(10.0, integer(random, -100, 100)) / 3;
  return baked(a, b, [&](const Vec3& p) { return Vec3(p * scale); });
}
/// Scales each axis by a different power of two, so that coordinates have very different
/// magnitudes: a common grid for all of them needs hundreds or thousands of bits.
PlacedPair stretched(Random& random, const Triangle& a, const Triangle& b) {
  const Vec3 scale(std::ldexp(1.0, integer(random, -400, 400)), 1,
                   std::ldexp(1.0, integer(random, -40, 40)));
  return baked(a, b, [&](const Vec3& p) { return Vec3(p.cwiseProduct(scale)); });
}
PlacedPair denormal(Random& random, const Triangle& a, const Triangle& b) {
  const int exponent = -1074 + (random() % 2 ? 0 : integer(random, 0, 60));
  return baked(a, b, [&](const Vec3& p) {
    return Vec3(p.unaryExpr([&](double x) { return std::ldexp(x, exponent); }));
  });
}
/// Changes some coordinates to the next double, up or down.
PlacedPair jittered(Random& random, const Triangle& a, const Triangle& b) {
  return baked(a, b, [&](Vec3 p) {
    for (double& x : p)
      if (random() % 4 == 0) x = std::nextafter(x, random() % 2 ? HUGE_VAL : -HUGE_VAL);
    return p;
  });
}

}  // namespace

std::span<const PairFamily> pairFamilies() {
  static constexpr PairFamily kAll[] = {
      {"any on a grid", &anyOnAGrid},    {"slivers", &slivers},
      {"zero area", &zeroArea},          {"coplanar", &coplanar},
      {"shared corner", &sharedCorner},  {"shared edge", &sharedEdge},
      {"corner on face", &cornerOnFace}, {"edge on face", &edgeOnFace},
      {"edge on edge", &edgeOnEdge}};
  return kAll;
}

std::span<const PairPlacing> pairPlacings() {
  static constexpr PairPlacing kAll[] = {{"as it is", true, &asIs},
                                         {"exact rotation", true, &byExactRotation},
                                         {"rational rotation", true, &byRationalRotation},
                                         {"far away", true, &farAway},
                                         {"moved together", true, &movedTogether},
                                         {"in own frames", false, &inOwnFrames},
                                         {"times 2^k", true, &scaledByTwos},
                                         {"times 10^k / 3", false, &scaledByTens},
                                         {"stretched", true, &stretched},
                                         {"denormal", true, &denormal},
                                         {"last bits", false, &jittered}};
  return kAll;
}

Mat3 exactRotation(Random& random) {
  std::array<int, 3> order = {0, 1, 2};
  std::shuffle(order.begin(), order.end(), random);
  Mat3 m = Mat3::Zero();
  for (int i = 0; i < 3; ++i) m(i, order[i]) = random() % 2 ? 1 : -1;
  if (m.determinant() < 0) m.row(0) *= -1;
  return m;
}

}  // namespace corridor::test
