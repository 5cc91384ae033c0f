// Bodies that just meet, or are a known distance apart. The bodies are boxes made of triangles,
// which fill their oriented bounding boxes completely. Therefore, if any term were missing in the
// trees' margins, some proof of separation would be wrong, also for maps far from rigid.
#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::addBox;
using test::anyPose;
using Random = std::mt19937_64;

double real(Random& random, double low = -1, double high = 1) {
  return std::uniform_real_distribution(low, high)(random);
}
Vec3 anyVector(Random& random, double size) {
  const double x = real(random), y = real(random), z = real(random);
  return size * Vec3(x, y, z);
}

/// Returns a mesh of a few boxes. `apartBy` uses the first box, which has the first 12 triangles
/// and 8 vertices.
TriangleMesh boxes(Random& random, double size, const Vec3& place) {
  TriangleMesh mesh;
  for (auto more = random() % 3; mesh.triangles.empty() || more-- > 0;) {
    // Very small boxes are made only near the origin, because elsewhere rounding would change their
    // shape.
    const double s = std::pow(10.0, real(random, random() % 2 || !place.isZero() ? -3 : -10, 0));
    const Vec3 half = s * (Vec3::Constant(0.55) + anyVector(random, 0.45));
    const Mat3 turn = random() % 4 ? anyPose(random, 0).m : Mat3::Identity();
    const Vec3 center = anyVector(random, 2);
    const auto first = mesh.vertices.size();
    addBox(mesh, -half, half, turn);
    for (std::size_t i = first; i < mesh.vertices.size(); ++i)
      mesh.vertices[i] = size * (mesh.vertices[i] + center) + place;
  }
  return mesh;
}

/// Returns a matrix that differs from a rotation by up to `defect`.
Mat3 nearRotation(Random& random, double defect) {
  Mat3 strain;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k <= i; ++k) strain(i, k) = strain(k, i) = random() % 2 ? defect : -defect;
  return anyPose(random, 0).m * (Mat3::Identity() + 0.49 * strain);
}

struct Placed {
  TriangleMesh a, b;
  Transform X_WA, X_WB;
  double size = 0;  ///< S of distance.h
};

/// Places two bodies so that a corner of a is `gap` away from a face of b, or an edge of a is `gap`
/// away from an edge of b. All other points are farther apart. The bodies are then moved together
/// by `deeper`·u·S.
Placed apartBy(Random& random, int n, double gap, double deeper = 0) {
  constexpr double kDefects[] = {0, 1e-12, 1e-7, 1e-5, 1e-3, 0.015};
  Placed p;
  const double size = std::ldexp(1.0, static_cast<int>(random() % 25) - 12);
  const double place = n % 3 ? 0 : std::pow(10.0, real(random, 0, 9));
  p.a = boxes(random, 1, anyVector(random, place));
  p.b = boxes(random, size, anyVector(random, place));
  p.X_WA.m = nearRotation(random, kDefects[random() % 6]);
  p.X_WB.m = nearRotation(random, kDefects[random() % 6]);
  p.X_WA.t = anyVector(random, place);
  const auto cornerA = [&](int i) { return Vec3(p.X_WA.m * p.a.vertices[i] + p.X_WA.t); };
  const auto cornerB = [&](int i) { return Vec3(p.X_WB.m * p.b.vertices[i]); };
  // The edges of both boxes, along their axes: from vertex i to vertex i ^ bit.
  const auto edgeA = [&](int i, int bit) { return Vec3(cornerA(i ^ bit) - cornerA(i)); };
  const auto edgeB = [&](int i, int bit) { return Vec3(cornerB(i ^ bit) - cornerB(i)); };
  const auto outward = [](const Vec3& v, const Vec3& inner) {
    return Vec3((v.dot(inner) > 0 ? -v : v).normalized());
  };
  Vec3 normal, pointA, pointB;  // the normal points out of b
  if (n % 2) {
    const int i = static_cast<int>(random() % 8), axis = static_cast<int>(random() % 3);
    const Vec3 u = edgeB(i, 1 << axis), v = edgeB(i, 1 << (axis + 1) % 3);
    normal = outward(u.cross(v), edgeB(i, 1 << (axis + 2) % 3));
    int best = 0;
    for (int k = 1; k < 8; ++k)
      if (normal.dot(cornerA(k)) < normal.dot(cornerA(best))) best = k;
    pointA = cornerA(best);
    pointB = cornerB(i) + real(random, 0.05, 0.95) * u + real(random, 0.05, 0.95) * v;
  } else {
    while (true) {
      const int i = static_cast<int>(random() % 8), axisA = static_cast<int>(random() % 3),
                k = static_cast<int>(random() % 8), axisB = static_cast<int>(random() % 3);
      const Vec3 u = edgeA(i, 1 << axisA), v = edgeB(k, 1 << axisB);
      normal = u.cross(v).normalized();
      const double a1 = normal.dot(edgeA(i, 1 << (axisA + 1) % 3)),
                   a2 = normal.dot(edgeA(i, 1 << (axisA + 2) % 3)),
                   b1 = normal.dot(edgeB(k, 1 << (axisB + 1) % 3)),
                   b2 = normal.dot(edgeB(k, 1 << (axisB + 2) % 3));
      const double sign = a1 > 0 ? 1 : -1;
      if (!(sign * a2 > 0 && sign * b1 < 0 && sign * b2 < 0)) continue;
      normal *= sign;
      pointA = cornerA(i) + real(random, 0.05, 0.95) * u;
      pointB = cornerB(k) + real(random, 0.05, 0.95) * v;
      break;
    }
  }
  p.X_WB.t = pointA - pointB;
  p.size = std::max(test::errorScale(p.a, p.X_WA), test::errorScale(p.b, p.X_WB)) + gap;
  p.X_WB.t -= (gap - deeper * kUnit * p.size) * normal;
  return p;
}

class Obb4Grazing : public test::EveryTarget {};
INSTANTIATE_TEST_SUITE_P(Simd, Obb4Grazing, testing::ValuesIn(test::simdTargets()),
                         &test::targetName);

TEST_P(Obb4Grazing, BodiesThatJustMeetTouch) {
  Random random(test::testSeed(71));
  int touching = 0;
  for (int n = 0; n < 1'000 / test::kSlowdown; ++n) {
    const Placed p = apartBy(random, n, 0, real(random, 0, 8));
    const Obb4Tree a(p.a), b(p.b);
    QueryContext context, other;
    const bool touch = test::bruteForceTouch(p.a, p.X_WA, p.b, p.X_WB);
    touching += touch;
    ASSERT_EQ(interference(Posed(a, p.X_WA), Posed(b, p.X_WB), context).has_value(), touch) << n;
    ASSERT_EQ(interference(Posed(b, p.X_WB), Posed(a, p.X_WA), context).has_value(), touch) << n;
    if (!touch) continue;
    ASSERT_TRUE(closerThan(Posed(a, p.X_WA), Posed(b, p.X_WB), 1e-20 * p.size, other)) << n;
    ASSERT_TRUE(closerThan(Posed(b, p.X_WB), Posed(a, p.X_WA), 1e-20 * p.size, other)) << n;
  }
  EXPECT_GT(touching, 500 / test::kSlowdown);
}

TEST_P(Obb4Grazing, KnownDistancesAreNotExceeded) {
  Random random(test::testSeed(72));
  for (int n = 0; n < 1'000 / test::kSlowdown; ++n) {
    const double gap = std::pow(10.0, real(random, -6, 2));
    const Placed p = apartBy(random, n, gap);
    const Obb4Tree a(p.a), b(p.b);
    const double most = gap + 1e-12 * gap + 32 * kUnit * p.size;
    QueryContext context, other;
    ASSERT_TRUE(closerThan(Posed(a, p.X_WA), Posed(b, p.X_WB), most, context)) << n << " " << gap;
    ASSERT_TRUE(closerThan(Posed(b, p.X_WB), Posed(a, p.X_WA), most, context)) << n << " " << gap;
    const double d = distance(Posed(a, p.X_WA), Posed(b, p.X_WB), {}, context).distance,
                 e = distance(Posed(b, p.X_WB), Posed(a, p.X_WA), {}, other).distance;
    ASSERT_LE(d, most) << n << " " << gap;
    ASSERT_LE(e, most) << n << " " << gap;
    ASSERT_NEAR(d, e, 2e-12 * d + 8 * kUnit * p.size) << n;
  }
}

}  // namespace
}  // namespace corridor
