// Regression tests: contacts that 4-wide OBB trees missed because a margin lacked a term, and a
// distance that was wrong. Each of these tests fails without its fix.
#include <cmath>
#include <random>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;

class Obb4Margins : public test::EveryTarget {};
INSTANTIATE_TEST_SUITE_P(Simd, Obb4Margins, testing::ValuesIn(test::simdTargets()),
                         &test::targetName);

/// A leaf has small triangles in a long flat row. The floats of the leaf are off by 2^-24 times the
/// length of the row, not times the size of a triangle. Each triangle of the row in turn is touched
/// in one corner by a triangle in the plane x + z = const, whose other points are farther out. The
/// floats of this second triangle are relative to a corner that does not touch, because relative to
/// the touching corner, both triangles would be rounded alike.
TEST_P(Obb4Margins, SmallTrianglesInARow) {
  QueryContext context;
  const double s = 1e-4;  // not a multiple of the spacing of floats of the row's length
  TriangleMesh row;
  for (int i = 0; i < 15; ++i) {
    const Vec3 p(1.1 * i, 0, 0);
    add(row, p, p + Vec3(s, s, 0), p + Vec3(s, -s, 0));
  }
  const Obb4Tree a(row);
  for (std::size_t i = 0; i < row.triangles.size(); ++i) {
    const Vec3& p = row.corner(i, 0);
    TriangleMesh one;
    add(one, p + Vec3(-s, s, s), p, p + Vec3(-s, -s, s));
    const Obb4Tree b(one);
    EXPECT_TRUE(interference(Posed(a), Posed(b), context)) << i;
    EXPECT_TRUE(interference(Posed(b), Posed(a), context)) << i;
    EXPECT_EQ(distance(Posed(b), Posed(a), {}, context).distance, 0) << i;
    EXPECT_TRUE(closerThan(Posed(b), Posed(a), 0x1p-60, context)) << i;
  }
}

/// Two meshes of up to 2^1023 m. A triangle of one mesh touches one corner of a small triangle of
/// the other, if rounding permits (`touch`). The relative pose has no rotation, a random rotation,
/// or a rotation by at most 2^-23 rad.
struct FarCorner {
  TriangleMesh a, b;
  Transform X;
  bool touch = false;

  FarCorner(std::mt19937_64& random, int exponent, int n) {
    std::uniform_real_distribution real(-1.0, 1.0);
    const auto any = [&](double size) {
      const double x = real(random), y = real(random), z = real(random);
      return Vec3(size * x, size * y, size * z);
    };
    const double S = std::ldexp(0.9, exponent), s = std::ldexp(S, -20 - n % 28);
    for (int i = 0; i < 4; ++i) {
      const Vec3 c(i & 1 ? S : -S, i & 2 ? S : -S, i == 1 || i == 2 ? S : -S);
      const Vec3 d(0.01 * S, 0, 0), e(0, 0.01 * S, 0);
      add(a, c, c + d, c + e);
      if (n % 3 == 0) add(b, 0.9 * c, 0.9 * c + d, 0.9 * c + e);
    }
    const Vec3 p = any(0.7 * S), u = any(s), v = any(s), normal = (u / s).cross(v / s);
    add(a, p, p + u, p + v);
    a.triangles.resize(a.triangles.size() + 4,
                       a.triangles.back());  // repeated: too many for a leaf
    const double angle = n % 4 == 1 ? 3 : std::ldexp(1.0, -23 - n % 5 * 3);
    const Vec3 axis = any(1).normalized();
    if (n % 2) X.m = Eigen::AngleAxisd(angle * real(random), axis).toRotationMatrix();
    const Vec3 q = X.m.transpose() * p;
    const auto above = [&] {
      const Vec3 d = any(s);
      return Vec3(q + X.m.transpose() * (d.dot(normal) < 0 ? Vec3(-d) : d));
    };
    const Vec3 r = above(), t = above();
    add(b, q - X.m.transpose() * (1e-3 * s * normal), r, t);
    b.triangles.resize(b.triangles.size() + 4, b.triangles.back());
    touch = test::bruteForceTouch(a, {}, b, X);
  }
};

/// For meshes of 2^1000 m and more, coordinates in units of the tree are not below 1.
TEST_P(Obb4Margins, LargestMeshes) {
  std::mt19937_64 random(test::testSeed(61));
  int touching = 0;
  for (const int exponent : {955, 960, 1000, 1010, 1022})
    for (int n = 0; n < 100 / test::kSlowdown; ++n) {
      const FarCorner c(random, exponent, n);
      if (!c.touch) continue;
      ++touching;
      const Obb4Tree a(c.a), b(c.b);
      QueryContext context;
      EXPECT_TRUE(interference(Posed(a), Posed(b, c.X), context)) << exponent << " " << n;
      EXPECT_TRUE(interference(Posed(b, c.X), Posed(a), context)) << exponent << " " << n;
      EXPECT_TRUE(closerThan(Posed(a), Posed(b, c.X), 1, context)) << exponent << " " << n;
    }
  EXPECT_GT(touching, 150 / test::kSlowdown);
}

#ifdef __SSE2__
/// Makes the processor flush results that underflow to zero, and read subnormals as zero. A linked
/// library may have set this mode.
class Flushing {
 public:
  Flushing() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~Flushing() { _mm_setcsr(before_); }
  Flushing(const Flushing&) = delete;
  Flushing& operator=(const Flushing&) = delete;

 private:
  unsigned before_;
};

/// The square of the small mesh's radius is flushed to 0, but the radius itself is not negligible
/// beside a mesh of 2^-476 m.
TEST_P(Obb4Margins, RadiusWhoseSquareIsFlushed) {
  TriangleMesh small, large;
  const double r = 0.9 * 0x1p-511, R = 0x1p-476;
  add(small, Vec3(-r, 0, 0), Vec3(r, 0, 0), Vec3(0, 0, 0));
  add(large, Vec3(-R, 0, 0), Vec3(R, 0, 0), Vec3(0, 0, 0));
  Transform X;
  X.t[0] = R + 0.9 * r;
  ASSERT_TRUE(trianglesTouchExact(test::corners(small, 0), {}, test::corners(large, 0), X));
  const Flushing flushing;
  const Obb4Tree a(small), b(large);
  QueryContext context;
  EXPECT_TRUE(interference(Posed(a), Posed(b, X), context));
  EXPECT_TRUE(interference(Posed(b, X), Posed(a), context));
}

/// Small entries of a rotation matrix are flushed to 0. Their effect is not negligible, because
/// they are multiplied by the unit of length of a large mesh.
TEST_P(Obb4Margins, EntriesThatAreFlushed) {
  std::mt19937_64 random(test::testSeed(62));
  int touching = 0;
  for (const int exponent : {960, 985, 995, 999, 1022})
    for (int n = 3; n < 600; n += 12) {  // the cases with small rotations of two large meshes
      const FarCorner c(random, exponent, n);
      if (!c.touch) continue;
      ++touching;
      const Flushing flushing;
      const Obb4Tree a(c.a), b(c.b);
      QueryContext context;
      EXPECT_TRUE(interference(Posed(a), Posed(b, c.X), context)) << exponent << " " << n;
      EXPECT_TRUE(interference(Posed(b, c.X), Posed(a), context)) << exponent << " " << n;
    }
  EXPECT_GT(touching, 80);
}

/// Meshes of 2^-996 m whose triangles and translation are so small that differences are flushed.
TEST_P(Obb4Margins, DifferencesThatAreFlushed) {
  std::mt19937_64 random(test::testSeed(18));
  const auto any = [&](double size) {
    std::uniform_real_distribution real(-size, size);
    const double x = real(random), y = real(random), z = real(random);
    return Vec3(x, y, z);
  };
  const double s = 0x1p-996;
  int touching = 0;
  for (int n = 0; n < 20'000 / test::kSlowdown; ++n) {
    const double size = std::ldexp(s, -4 - n % 23);
    TriangleMesh a, b;
    add(a, Vec3::Constant(-s), Vec3::Constant(-s), Vec3::Constant(-s));
    add(a, Vec3::Constant(s), Vec3::Constant(s), Vec3::Constant(s));
    const Vec3 p = any(s / 2), u = any(size / 4), v = any(size / 4);
    add(a, p, p + u, p + v);
    Transform X;
    if (n % 2) X.t = any(s / 4);
    const Vec3 q = p - X.t, normal = (u / size).cross(v / size);
    const auto above = [&] {
      const Vec3 d = any(size);
      return Vec3(d.dot(normal) < 0 ? -d : d);
    };
    const Vec3 d = above(), e = above();
    add(b, q, q + d, q + e);
    if (!test::bruteForceTouch(a, {}, b, X)) continue;  // the corner is not shared to the last bit
    ++touching;
    const Flushing flushing;
    const Obb4Tree treeA(a), treeB(b);
    QueryContext context;
    ASSERT_TRUE(interference(Posed(treeA), Posed(treeB, X), context)) << n;
    ASSERT_TRUE(interference(Posed(treeB, X), Posed(treeA), context)) << n;
  }
  EXPECT_GT(touching, 5'000 / test::kSlowdown);
}

/// Edges of 2^-124 of the size of the mesh against edges of 2^14 of this size. Some products of
/// floats underflow and are flushed, others are not. The sum of the others is multiplied by the
/// large edge.
TEST_P(Obb4Margins, ProductsThatAreFlushed) {
  std::mt19937_64 random(test::testSeed(19));
  const auto sparse = [&](int exponent) {  // floats of very different sizes
    std::uniform_real_distribution real(-1.0F, 1.0F);
    Vec3 v;
    for (double& x : v)
      x = std::ldexp(static_cast<double>(real(random)),
                     exponent - (random() % 2 ? static_cast<int>(random() % 31) : 0));
    return v;
  };
  int touching = 0;
  for (int n = 0; n < 20'000 / test::kSlowdown; ++n) {
    TriangleMesh a, b;
    add(a, Vec3::Constant(-1), Vec3::Constant(-1), Vec3::Constant(-1));
    add(a, Vec3::Constant(1), Vec3::Constant(1), Vec3::Constant(1));
    const Triangle thin = {Vec3(0, 0, 0), sparse(-126 + n % 6), sparse(0)};
    const std::size_t r = random() % 3;
    add(a, thin[r], thin[(r + 1) % 3], thin[(r + 2) % 3]);
    const int k = 12 + n / 6 % 6;
    const Vec3 f = sparse(k), g = sparse(k), q = random() % 2 ? Vec3(0, 0, 0) : Vec3(-f);
    add(b, q, q + f, q + g);
    if (!test::bruteForceTouch(a, {}, b, {})) continue;
    ++touching;
    const Flushing flushing;
    const Obb4Tree treeA(a), treeB(b);
    QueryContext context;
    ASSERT_TRUE(interference(Posed(treeA), Posed(treeB), context)) << n;
    ASSERT_TRUE(interference(Posed(treeB), Posed(treeA), context)) << n;
  }
  EXPECT_GT(touching, 5'000 / test::kSlowdown);
}
#endif

/// Edges that are parallel up to the last bits. Their closest points were once computed from a
/// difference that consisted only of rounding errors: distances were off by 2.5 to 4.9 u·S, and
/// `closerThan` was wrong. Two edges cross far from their ends; the triangles are on opposite sides
/// of the crossing. The true distances are computed in quadruple precision.
TEST_P(Obb4Margins, NearlyParallelEdges) {
  struct Case {
    Triangle a, b;
    double distance;
  };
  const auto crossing = [](const Vec3& d, const Vec3& e, double height) {
    const Vec3 up(0, 0, height);
    return Case{{d, -d, Vec3(0, 0, -1)}, {up - e, up + e, Vec3(0, 0, 1)}, height};
  };
  for (const auto& [s, t, truth] :
       {crossing(Vec3(0x1.d57ce63fda966p-1, 0x1.327e29178339dp-1, 0),
                 Vec3(0x1.d57ce63fda965p-1, 0x1.327e2917833ap-1, 0), 0x1.edd7cf6317808p-58),
        crossing(Vec3(0x1.807471ca7a302p-1, 0x1.6ee1c05ab6662p-1, 0),
                 Vec3(0x1.807471ca7a2ffp-1, 0x1.6ee1c05ab6663p-1, 0), 0x1.0f04d705cdf41p-58),
        Case{{Vec3(-0x1.e7386756524e5p-1, -0x1.d4a7100552fa4p-1, -0x1.ebba409c77c6bp-1),
              Vec3(0x1.e7386756524e5p-1, 0x1.d4a7100552fa4p-1, 0x1.ebba409c77c6bp-1),
              Vec3(0x1.7667d41796f0fp-1, -0x1.7be31884105e8p-2, -0x1.7be31884105e8p-2)},
             {Vec3(-0x1.e7386756524e4p-1, -0x1.d4a7100552f9ep-1, -0x1.ebba409c77c6fp-1),
              Vec3(0x1.e7386756524e6p-1, 0x1.d4a7100552fa2p-1, 0x1.ebba409c77c6fp-1),
              Vec3(-0x1.7667d41796f0fp-1, 0x1.7be31884105e8p-2, 0x1.7be31884105e8p-2)},
             0x1.85cbe53e2ca88p-60}}) {
    for (int i = 0; i < 9; ++i) {  // with all orders of the corners
      TriangleMesh meshA, meshB;
      add(meshA, s[i % 3], s[(i + 1) % 3], s[(i + 2) % 3]);
      add(meshB, t[i / 3], t[(i / 3 + 1) % 3], t[(i / 3 + 2) % 3]);
      const Obb4Tree a(meshA), b(meshB);
      QueryContext context;
      const double above = truth * (1 + 1e-12);
      EXPECT_TRUE(closerThan(Posed(a), Posed(b), above, context)) << truth << " " << i;
      EXPECT_TRUE(closerThan(Posed(b), Posed(a), above, context)) << truth << " " << i;
      EXPECT_NEAR(distance(Posed(a), Posed(b), {}, context).distance, truth, 0.01 * kUnit) << i;
      EXPECT_NEAR(distance(Posed(b), Posed(a), {}, context).distance, truth, 0.01 * kUnit) << i;
    }
  }
}

}  // namespace
}  // namespace corridor
