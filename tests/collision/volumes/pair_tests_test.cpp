#include "collision/volumes/pair_tests.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/predicates/triangle_contact.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/support/floating_point.h"
#include "tests/support/reference_distance.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Two point clouds on opposite sides of a plane. They meet in one point of the plane, or their
/// closest points there are `gap` apart.
struct Meeting {
  std::vector<Triangle> a, b;
  Transform X_AB;
  /// The distance of the two points that meet or are `gap` apart, rounded up. The distance of the
  /// clouds is not larger.
  double distance = 0;
};

/// Returns a random normal of the plane, or a normal for which a face of some volume lies in the
/// plane. In the latter case, a margin that is too small makes the test fail.
Vec3 normalOf(std::mt19937_64& random, int n) {
  if (n % 3 == 0) return test::anyPose(random, 1).m.col(0);
  Vec3 v(n % 5 - 2, n % 7 - 3, n / 7 % 3 - 1);
  v = v.cwiseMax(-1).cwiseMin(1);
  return v.norm() > 0 ? Vec3(v.normalized()) : Vec3::UnitX();
}

/// Returns two clouds that meet, or are `gap` apart. @param offset the scale of the distance of the
/// clouds from the origin. @param defect the approximate difference of the map from a rotation; 0:
/// only rounding.
Meeting meeting(std::mt19937_64& random, int n, double gap, double offset, double defect = 0) {
  std::uniform_real_distribution<double> real(-1, 1);
  const Vec3 normal = normalOf(random, n);
  const Vec3 where = offset * Vec3(real(random), real(random), real(random));
  Meeting m;
  m.X_AB = test::anyPose(random, offset);
  if (n % 4 == 0) m.X_AB.m = Mat3::Identity();
  if (n % 4 == 1) m.X_AB.m += 1e-9 * test::anyPose(random, 1).m;
  if (defect > 0) {
    const Mat3 bent = defect * test::anyPose(random, 1).m;
    m.X_AB.m += n % 7 == 2 ? Mat3(Vec3(bent.row(0)).asDiagonal()) : bent;
  }
  const Mat3 inverse = m.X_AB.m.inverse();
  // Clouds are flat, or extend behind the plane.
  const double depth = n % 2 ? 0 : std::pow(10.0, -(n % 9));
  const auto cloud = [&](double side) {
    std::vector<Vec3> points = {where + (side > 0 ? gap : 0) * normal};
    // A segment along the normal: even a sphere around it meets the plane in one point only.
    if (n % 6 == 5) {
      points.resize(12, points[0] + side * normal);
      return points;
    }
    for (int i = 0; i < 11; ++i) {
      Vec3 d(real(random), real(random), real(random));
      d -= normal * normal.dot(d);
      points.push_back(points[0] + d + side * depth * std::abs(real(random)) * normal);
    }
    return points;
  };
  const auto triangles = [](const std::vector<Vec3>& p) {
    std::vector<Triangle> all;
    for (std::size_t i = 0; i + 2 < p.size(); i += 3) all.push_back({p[i], p[i + 1], p[i + 2]});
    return all;
  };
  std::vector<Vec3> inB = cloud(1);
  for (Vec3& p : inB) p = inverse * (p - m.X_AB.t);
  m.a = triangles(cloud(-1));
  m.b = triangles(inB);
  const Triangle point = {m.b[0][0], m.b[0][0], m.b[0][0]};
  m.distance = roundedUp(test::referenceDistance(m.a[0][0], point, m.X_AB));
  return m;
}

template <class Volume>
struct Fitted {
  Volume volume;
  VolumeBounds bounds;
  explicit Fitted(const std::vector<Triangle>& content)
      : volume(Volume::around(
            enclosingObb(content, Volume::kOriented ? fitFrame(content, ObbFit::triangles).axes
                                                    : Mat3(Mat3::Identity())),
            content)),
        bounds{volume.axisDefect(), volume.centerReach(), 0} {
    for (const Triangle& t : content)
      for (const Vec3& p : t) bounds.reach = std::max(bounds.reach, roundedUp(p.stableNorm()));
  }
};

template <class Volume>
class PairTests : public testing::Test {};
TYPED_TEST_SUITE(PairTests, test::Volumes, test::VolumeNames);

/// No bound may exceed the distance of two points of the volumes' contents, not even in the last
/// bit.
TYPED_TEST(PairTests, NeverFartherThanTwoPointsThatMeet) {
  std::mt19937_64 random(test::testSeed(41));
  int positiveBounds = 0;
  for (int n = 0; n < 20'000; ++n) {
    const double gap = n % 3 ? std::pow(10.0, -(n % 16)) : 0, offset = n % 5 == 0 ? 1e6 : 1;
    const Meeting m = meeting(random, n, gap, offset);
    const Fitted<TypeParam> a(m.a), b(m.b);
    const PairTest<TypeParam> test(a.bounds, b.bounds, m.X_AB, 0);
    const double bound = test.distanceBound(a.volume, b.volume);
    ASSERT_LE(bound, m.distance) << n;
    ASSERT_FALSE(test.separated(a.volume, b.volume, m.distance)) << n;
    positiveBounds += bound > 0;
  }
  EXPECT_GT(positiveBounds, 100) << "no bound was positive: the test tested nothing";
}

/// Maps that are far from rigid: they scale, shear, mirror, or flatten nearly to a plane. No bound
/// may exceed the distance of two points of the contents.
TYPED_TEST(PairTests, NoFalseSeparationUnderMapsFarFromRigid) {
  std::mt19937_64 random(test::testSeed(44));
  for (int n = 0; n < 20'000; ++n) {
    const double defect = std::pow(10.0, std::uniform_real_distribution(-3.0, 1.0)(random));
    const double gap = n % 3 ? std::pow(10.0, -(n % 16)) : 0;
    const Meeting m = meeting(random, n, gap, n % 5 == 0 ? 1e6 : 1, defect);
    // The inverse of a nearly flat map may overflow; then the case is dropped.
    if (!(m.distance < HUGE_VAL)) continue;
    const Fitted<TypeParam> a(m.a), b(m.b);
    const PairTest<TypeParam> test(a.bounds, b.bounds, m.X_AB, 0);
    ASSERT_LE(test.distanceBound(a.volume, b.volume), m.distance) << n << ", defect " << defect;
    ASSERT_FALSE(test.separated(a.volume, b.volume, m.distance)) << n << ", defect " << defect;
    if constexpr (std::is_same_v<TypeParam, Obb>) {
      const auto& [u, v] = std::pair(a.volume, b.volume);
      ASSERT_FALSE((PairTest<Obb, Gjk>(a.bounds, b.bounds, m.X_AB, 0).separated(u, v, m.distance)))
          << n << ", defect " << defect;
      ASSERT_FALSE(
          (PairTest<Obb, LinearProgram>(a.bounds, b.bounds, m.X_AB, 0).separated(u, v, m.distance)))
          << n << ", defect " << defect;
      ASSERT_FALSE(
          (PairTest<Obb, EdgeFace>(a.bounds, b.bounds, m.X_AB, 0).separated(u, v, m.distance)))
          << n << ", defect " << defect;
    }
  }
}

/// This shear keeps the lengths of all three axes, and only changes the angles between them. It
/// tilts b, which is a needle whose end touches a. The needle's box has width 0 along one of its
/// own face normals, and the shear tilts this normal, too.
TYPED_TEST(PairTests, ShearsAreNoRotations) {
  std::mt19937_64 random(test::testSeed(45));
  for (int n = 0; n < 2'000; ++n) {
    const double shear = std::pow(10.0, std::uniform_real_distribution(-10.0, -3.6)(random));
    Mat3 S = Mat3::Identity();
    S.col(1) = Vec3(shear, std::sqrt(1 - shear * shear), 0);
    const Mat3 inB = test::anyPose(random, 1).m, inA = test::anyPose(random, 1).m;
    const Transform X_AB{inA * S * inB.transpose(), test::anyPose(random, 1).t};
    const Vec3 end = inB.col(1), met = X_AB * end;
    const std::vector<Triangle> contentA = {{met, met, met}}, contentB = {{Vec3(-end), end, end}};
    const Triangle tip = {end, end, end};
    const double distance = roundedUp(test::referenceDistance(met, tip, X_AB));
    const Fitted<TypeParam> a(contentA), b(contentB);
    const PairTest<TypeParam> test(a.bounds, b.bounds, X_AB, 0);
    ASSERT_LE(test.distanceBound(a.volume, b.volume), distance) << n << ", shear " << shear;
    ASSERT_FALSE(test.separated(a.volume, b.volume, distance)) << n << ", shear " << shear;
  }
}

/// Scales a pair by 2^exponent.
Meeting scaled(Meeting m, int exponent) {
  const auto scale = [&](double x) { return std::ldexp(x, exponent); };
  for (std::vector<Triangle>* side : {&m.a, &m.b})
    for (Triangle& t : *side)
      for (Vec3& p : t) p = p.unaryExpr(scale);
  m.X_AB.t = m.X_AB.t.unaryExpr(scale);
  // Subnormal coordinates are rounded by 2^-1075 at most.
  m.distance = scale(m.distance) + 0x1p-1070;
  return m;
}

/// Squares of lengths underflow or overflow at these scales. No bound may exceed the distance of
/// two points of the volumes' contents, even if the processor flushes subnormal numbers to zero.
TYPED_TEST(PairTests, NoFalseSeparationAtExtremeScales) {
  std::mt19937_64 random(test::testSeed(46));
  for (int n = 0; n < 150; ++n) {
    const double gap = n % 3 ? std::pow(10.0, -(n % 16)) : 0;
    const Meeting unit = meeting(random, n, gap, 1);
    for (const int exponent : {-990, -800, -520, 700}) {
      const Meeting m = scaled(unit, exponent);
      for (const bool flush : {false, true}) {
        bool separated = false, tooFar = false;
        {
          const test::WithFloatingPoint mode({.name = "", .flushToZero = flush});
          const Fitted<TypeParam> a(m.a), b(m.b);
          const PairTest<TypeParam> test(a.bounds, b.bounds, m.X_AB, 0);
          separated = test.separated(a.volume, b.volume, m.distance);
          tooFar = test.distanceBound(a.volume, b.volume) > m.distance;
        }
        ASSERT_FALSE(separated) << n << ", 2^" << exponent << ", flush to zero: " << flush;
        ASSERT_FALSE(tooFar) << n << ", 2^" << exponent << ", flush to zero: " << flush;
      }
    }
  }
}

bool touch(const std::vector<Triangle>& a, const std::vector<Triangle>& b, const Transform& X_AB) {
  for (const Triangle& s : a)
    for (const Triangle& t : b)
      if (trianglesTouch(s, {}, t, X_AB)) return true;
  return false;
}

/// A mesh and a shifted copy of the mesh that share points, at scales from huge to subnormal
/// coordinates.
TYPED_TEST(PairTests, OverlappingCopiesAreNotSeparatedAtAnyScale) {
  for (int exponent = -1070; exponent <= 1000; exponent += 10) {
    const double s = std::ldexp(1.0, exponent);
    const Vec3 p(-s, -s, -s), q(s, -s, s), r(-s, s, s), t(s, s, -s);
    const std::vector<Triangle> mesh = {{p, q, r}, {t, q, r}, {t, p, r}};
    const Transform X_AB{Mat3::Identity(), Vec3(0.5, 0.25, 0.125) * s};
    ASSERT_TRUE(touch(mesh, mesh, X_AB)) << "2^" << exponent;
    for (const bool flush : {false, true}) {
      bool separated = false;
      double bound = 0;
      {
        const test::WithFloatingPoint mode({.name = "", .flushToZero = flush});
        const Fitted<TypeParam> fitted(mesh);
        const PairTest<TypeParam> test(fitted.bounds, fitted.bounds, X_AB, 0);
        separated = test.separated(fitted.volume, fitted.volume, 0);
        bound = test.distanceBound(fitted.volume, fitted.volume);
      }
      ASSERT_FALSE(separated) << "2^" << exponent << ", flush to zero: " << flush;
      ASSERT_EQ(bound, 0) << "2^" << exponent << ", flush to zero: " << flush;
    }
  }
}

/// Volumes that are far apart must be separated, and the bound must be close to their distance.
TYPED_TEST(PairTests, SeparateVolumesThatAreClearlyApart) {
  std::mt19937_64 random(test::testSeed(42));
  for (int n = 0; n < 1'000; ++n) {
    const Meeting m = meeting(random, n, 100, 1);
    const Fitted<TypeParam> a(m.a), b(m.b);
    const PairTest<TypeParam> test(a.bounds, b.bounds, m.X_AB, 0);
    // The k-DOP has the weakest bound of all volumes, if the normal lies in the widest angle
    // between its slab directions: the least measured bound was 80.6, for distances of 97 and more.
    EXPECT_GT(test.distanceBound(a.volume, b.volume), 78) << n;
    // `separated` compares along single axes. The worst case is a normal along the space diagonal
    // of three face normals, where 100/√3 of the distance of 100 remain.
    EXPECT_TRUE(test.separated(a.volume, b.volume, 50)) << n;
    const PairTest<TypeParam> loose(a.bounds, b.bounds, m.X_AB, 60);
    EXPECT_FALSE(loose.separated(a.volume, b.volume, 50)) << "the error of the pose must count";
  }
}

/// Sums and differences of such coordinates overflow, and centres may be NaN.
TYPED_TEST(PairTests, OverflowDoesNotShrinkATree) {
  const double h = 1e308;
  TriangleMesh mesh;
  mesh.vertices = {{-h, -h, -h}, {h, -h, h}, {-h, h, h}, {h, h, -h}};
  mesh.triangles = {{0, 1, 2}, {3, 1, 2}};
  const VolumeTree<TypeParam> tree(mesh);
  // No sphere of a smaller radius contains two points that are 2h apart in each of two coordinates.
  EXPECT_GE(tree.node(0).radius, h);
  EXPECT_GE(tree.reach(), h);
  const PairTest<TypeParam> test(tree.bounds(), tree.bounds(), {}, 0);
  EXPECT_FALSE(test.separated(tree.node(0).box, tree.node(0).box, 0));
  EXPECT_EQ(test.distanceBound(tree.node(0).box, tree.node(0).box), 0);
}

TYPED_TEST(PairTests, NonFiniteVolumesAreNotSeparated) {
  std::mt19937_64 random(test::testSeed(43));
  const Meeting m = meeting(random, 1, 10, 1);
  const Fitted<TypeParam> a(m.a), b(m.b);
  for (const double bad : {HUGE_VAL, std::nan("")}) {
    Transform X = m.X_AB;
    X.t[1] = bad;
    const PairTest<TypeParam> test(a.bounds, b.bounds, X, 0);
    EXPECT_FALSE(test.separated(a.volume, b.volume, 0));
    EXPECT_EQ(test.distanceBound(a.volume, b.volume), 0);
    const PairTest<TypeParam> blind(a.bounds, b.bounds, m.X_AB, bad);
    EXPECT_FALSE(blind.separated(a.volume, b.volume, 0));
  }
  Transform huge = m.X_AB;
  huge.t *= 1e200;
  Fitted<TypeParam> big(m.a);
  const PairTest<TypeParam> test(big.bounds, b.bounds, huge, 1e201);
  EXPECT_FALSE(test.separated(big.volume, b.volume, 0)) << "squares overflow";
}

}  // namespace
}  // namespace corridor
