#include "collision/hierarchy/body.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace corridor {
namespace {

using Real = long double;

/// Returns |v| in long double, without underflow or overflow of its squares.
Real lengthOf(const Vec3& v) {
  return std::hypot(Real(v[0]), Real(v[1]), Real(v[2]));
}

/// Expects that the bounds contain the points, and exceed the largest lengths only by rounding.
void expectTight(const Body& body, const std::vector<Vec3>& points) {
  Real far = 0, away = 0;
  for (const Vec3& p : points) {
    far = std::max(far, lengthOf(p));
    // The difference is exact in long double for these points, or off by 2^-64 of it.
    const Vec3& c = body.sphereCenter();
    away = std::max(away, std::hypot(Real(p[0]) - c[0], Real(p[1]) - c[1], Real(p[2]) - c[2]));
  }
  EXPECT_GE(body.radius(), far);
  EXPECT_LE(body.radius(), far * (1 + 0x1p-46L));
  EXPECT_GE(body.sphereRadius(), away);
  EXPECT_LE(body.sphereRadius(), away * (1 + 0x1p-46L) + far * 0x1p-52L);
}

Body bodyOf(const std::vector<Vec3>& points) {
  TriangleMesh mesh;
  mesh.vertices = points;
  for (std::uint32_t i = 0; i + 2 < points.size(); ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return {"body", std::move(mesh)};
}

/// Squares of these coordinates underflow or overflow, or are of very different sizes.
TEST(Body, BoundsContainPointsOfEverySize) {
  const unsigned seed = 20261130;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const int size : {-900, -600, -300, 0, 300, 500, 900}) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", size 2^" + std::to_string(size));
    for (int i = 0; i < 20; ++i) {
      std::vector<Vec3> points;
      for (int k = 0; k < 6; ++k)
        points.push_back(std::ldexp(1.0, size) * Vec3(unit(random), unit(random), unit(random)));
      expectTight(bodyOf(points), points);
    }
  }
}

/// A small body far from the origin in one coordinate: the squares of its own size vanish beside
/// the square of the largest coordinate.
TEST(Body, SphereOfATinyBodyFarAway) {
  for (const double tiny : {0x1p-600, 0x1p-700}) {
    const Body body = bodyOf({{1, tiny, 0}, {1, -tiny, 0}, {1, 0, tiny}, {1, 0, -tiny}});
    EXPECT_GE(body.sphereRadius(), tiny);
    EXPECT_LE(body.sphereRadius(), 0x1p-499);
  }
}

TEST(Body, RadiusOfParts) {
  const Body body("ball", ConvexPart{{{3, 0, 4}}, 0.5, false});
  EXPECT_GE(body.radius(), 5.5);
  EXPECT_NEAR(body.radius(), 5.5, 1e-12);
  EXPECT_NEAR(body.sphereRadius(), 0.5, 1e-12);
}

}  // namespace
}  // namespace corridor
