// Tests of shells, ellipsoids and hulls. Fits are compared with rationals and closed forms. Overlap
// tests are compared with sets that touch by construction, with sampled points, and with linear
// programs in rationals. Tests for all volumes are in pair_tests_test.cpp.
#include <array>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/volumes/direction_search.h"
#include "collision/volumes/pair_tests.h"
#include "tests/support/exact_hull.h"
#include "tests/support/exact_round_volumes.h"
#include "tests/support/rational_program.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using exact::ExactVolume;
using exact::row;
using Random = std::mt19937_64;

double real(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}
Vec3 anyVector(Random& random) {
  const double x = real(random, -1, 1), y = real(random, -1, 1);
  return {x, y, real(random, -1, 1)};
}
Vec3 anyDirection(Random& random) {
  return test::anyPose(random, 1).m.col(0);
}

/// Returns points in one of several shapes: solid, flat, nearly flat, nearly along a line, on a
/// part of a sphere, all around a sphere, or at one place.
std::vector<Vec3> cloud(Random& random, int family, std::size_t count) {
  const Mat3 turn = test::anyPose(random, 1).m;
  const double angle = std::pow(10.0, real(random, -3, 0)),
               thin = std::pow(10, real(random, -16, -2));
  std::vector<Vec3> points;
  while (points.size() < count) {
    Vec3 p = anyVector(random);
    if (family == 1) p[2] = 0;
    if (family == 2) p = Vec3(p[0], thin * p[1], thin * p[2]);
    if (family == 3) p = Vec3(angle * p[0], angle * p[1], 1).normalized();
    if (family == 4) p.normalize();
    if (family == 5) p = Vec3(0.3, -0.2, 0.1);
    if (family == 6) p[2] *= thin;
    points.push_back(family % 2 || family == 6 ? p : Vec3(turn * p));
  }
  return points;
}
constexpr int kFamilies = 7;

std::vector<Triangle> trianglesOf(const std::vector<Vec3>& p) {
  std::vector<Triangle> all;
  for (std::size_t i = 0; i + 2 < p.size(); i += 3) all.push_back({p[i], p[i + 1], p[i + 2]});
  return all;
}

template <class Volume>
Volume fitted(const Content& content) {
  const Mat3 axes =
      Volume::kOriented ? fitFrame(content, ObbFit::triangles).axes : Mat3(Mat3::Identity());
  return Volume::around(enclosingObb(content, axes), content);
}

template <class Volume>
void expectInside(const Volume& volume, const Content& content) {
  const ExactVolume<Volume> exact(volume);
  for (const Triangle& t : content.triangles) {
    if constexpr (requires { exact.containsTriangle(t); }) {
      ASSERT_TRUE(exact.containsTriangle(t));
    } else {
      for (const Vec3& p : t) ASSERT_TRUE(exact.contains(row(p), 0));
    }
  }
  for (const Ball& b : content.balls) ASSERT_TRUE(exact.contains(row(b.center), b.radius));
  // The sphere about the middle contains the whole volume. This test covers only the volume's
  // content.
  const BoundingSphere sphere{volume.ballCenter(), volume.radius() * (1 + 0x1p-40)};
  const ExactVolume<BoundingSphere> around(sphere);
  content.forEach([&](const Vec3& p, double r) { ASSERT_TRUE(around.contains(row(p), r)); });
}

template <class Volume>
class CurvedVolumes : public testing::Test {};
using Types = testing::Types<Shell, Ellipsoid, Hull>;
TYPED_TEST_SUITE(CurvedVolumes, Types);

TYPED_TEST(CurvedVolumes, ContainTheirContentInRationals) {
  Random random(test::testSeed(81));
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE(n);
    std::vector<Vec3> points = cloud(random, n % kFamilies, n % 3 ? 3 : 24);
    const int scale =
        std::array{0, 0, -40, 300, -330, 1000, -1010}[static_cast<std::size_t>(n / kFamilies) % 7];
    const double far = n % 5 == 0 ? 1e6 : 0;
    for (Vec3& p : points) p = p.unaryExpr([&](double x) { return std::ldexp(x + far, scale); });
    expectInside(fitted<TypeParam>(trianglesOf(points)), trianglesOf(points));
    std::vector<Ball> balls;
    for (const Vec3& p : points)
      balls.push_back({p, n % 2 ? 0 : std::ldexp(real(random, 0, 1), scale)});
    expectInside(fitted<TypeParam>(balls), balls);
    if (testing::Test::HasFatalFailure()) return;
  }
}

/// No volume contains points that are clearly outside.
TYPED_TEST(CurvedVolumes, DoNotContainOtherPoints) {
  Random random(test::testSeed(82));
  for (int n = 0; n < 300; ++n) {
    const std::vector<Triangle> content = trianglesOf(cloud(random, n % kFamilies, 12));
    const ExactVolume<TypeParam> exact(fitted<TypeParam>(content));
    const Vec3 away = 5 * anyDirection(random);
    EXPECT_FALSE(exact.contains(row(away), 0));
    EXPECT_FALSE(exact.contains(row(content[0][0]), 1)) << "a sphere that sticks out";
  }
}

TEST(Ellipsoid, IsNearTheSmallestOne) {
  Random random(test::testSeed(83));
  for (int n = 0; n < 100; ++n) {
    const Mat3 axes = test::anyPose(random, 1).m;
    const Vec3 half(real(random, 0.01, 2), real(random, 0.01, 2), real(random, 0.01, 2));
    // The smallest ellipsoid around a box has √3 times its half extents.
    std::vector<Ball> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back({axes * Vec3(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1],
                                     i & 4 ? half[2] : -half[2])});
    const Ellipsoid box = Ellipsoid::around(enclosingObb(corners, axes), corners);
    EXPECT_TRUE(box.core.half.isApprox(std::sqrt(3.0) * half, 1e-6)) << box.core.half.transpose();
    // The smallest ellipsoid around points all over an ellipsoid is that ellipsoid.
    std::vector<Ball> points;
    for (int i = 0; i < 3'000; ++i)
      points.push_back({axes * half.cwiseProduct(anyDirection(random))});
    const Ellipsoid round = Ellipsoid::around(enclosingObb(points, axes), points);
    EXPECT_LT(round.core.half.prod(), 1.15 * half.prod());
    EXPECT_GT(round.core.half.prod(), 0.95 * half.prod());
  }
}

/// A shell around a curved patch is far thinner than the patch's sagitta: this is the purpose of
/// shells.
TEST(Shell, FollowsACurvedSurface) {
  Random random(test::testSeed(84));
  for (const double angle : {0.4, 0.2, 0.1}) {
    std::vector<Triangle> patch;
    constexpr int kCells = 16;
    const auto at = [&](int i, int k) {
      return Vec3(
          Vec3(angle * (2.0 * i / kCells - 1), angle * (2.0 * k / kCells - 1), 1).normalized() +
          Vec3(3, 2, 1));
    };
    for (int i = 0; i < kCells; ++i)
      for (int k = 0; k < kCells; ++k) {
        patch.push_back({at(i, k), at(i + 1, k), at(i, k + 1)});
        patch.push_back({at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
      }
    const Shell shell = fitted<Shell>(patch);
    ASSERT_TRUE(shell.hasCone());
    EXPECT_LT((shell.center - Vec3(3, 2, 1)).norm(), 1e-6);
    // Chords of cells of width angle/8 are about (angle/8)²/4 inside; the patch is angle² thick.
    EXPECT_LT(shell.outer - shell.inner, 0.006 * angle * angle);
    EXPECT_LT(shell.slope, 1.5 * angle);
  }
}

TEST(HullVertices, OfKnownHulls) {
  std::vector<Vec3> cube, flat, line;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      line.emplace_back(i + k, 2 * (i + k), -(i + k));
      for (int j = 0; j < 3; ++j) {
        cube.emplace_back(i, k, j);
        flat.emplace_back(i, k, i + 2 * k);
        flat.emplace_back(j, i, j + 2 * i);
      }
    }
  EXPECT_EQ(hullVertices(flat).size(), 4u);
  EXPECT_EQ(hullVertices(line).size(), 2u);
  EXPECT_EQ(hullVertices({Vec3(1, 2, 3), Vec3(1, 2, 3)}).size(), 1u);
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    std::vector<Vec3> face;
    for (const Vec3& p : cube)
      if (p.dot(normal) == 0) face.push_back(p);
    EXPECT_EQ(hullVertices(face).size(), 4u) << normal.transpose();
  }
  // Quickhull may keep points on edges and faces, but not the centre.
  const std::vector<Vec3> corners = hullVertices(cube);
  EXPECT_LT(corners.size(), cube.size());
  EXPECT_EQ(std::count(corners.begin(), corners.end(), Vec3(1, 1, 1)), 0);
}

template <class Volume>
VolumeBounds boundsOf(const Volume& v) {
  return {v.axisDefect(), v.centerReach(), roundedUp(v.centerReach() + v.radius())};
}

/// A linear program in rationals decides which hulls meet. Hulls that meet are never separated.
/// Nearly all hulls whose gap is larger than rounding are separated.
TEST(OverlapHulls, AgreeWithLinearPrograms) {
  Random random(test::testSeed(85));
  int separated = 0, missed = 0, meet = 0;
  for (int n = 0; n < 3'000; ++n) {
    const std::vector<Vec3> p = cloud(random, n % kFamilies, 6);
    std::vector<Vec3> q = cloud(random, n / kFamilies % kFamilies, 6);
    const Vec3 by = (n % 2 ? 1 : 0.1) * anyVector(random);
    // Some pairs share a vertex; others would do so if they were moved a little.
    const Vec3 shift = n % 3 ? by : Vec3(p[0] - q[0] + std::pow(10.0, -n % 17) * by);
    for (Vec3& v : q) v += shift;
    const Hull a = fitted<Hull>(trianglesOf(p)), b = fitted<Hull>(trianglesOf(q));
    std::vector<std::vector<double>> columns;
    for (const Vec3& v : p) columns.push_back({v[0], v[1], v[2], 1, 0});
    for (const Vec3& v : q) columns.push_back({-v[0], -v[1], -v[2], 0, 1});
    const bool truth = test::hasSolution(columns, {0, 0, 0, 1, 1});
    const PairTest<Hull> test(boundsOf(a), boundsOf(b), {}, 0);
    const bool answer = test.separated(a, b, 0);
    ASSERT_FALSE(answer && truth) << n;
    ASSERT_FALSE(truth && test.distanceBound(a, b) > 0) << n;
    meet += truth;
    separated += answer;
    // Gaps as small as rounding errors may be missed. Such pairs are not counted; others may be
    // missed, too, if their gap is far smaller than the shift.
    missed += !truth && !answer && (n % 3 || n % 17 < 13);
  }
  EXPECT_GT(meet, 500);
  EXPECT_GT(separated, 1'000);
  EXPECT_LE(missed, 12);
}

Ellipsoid anyEllipsoid(Random& random, int n) {
  Ellipsoid e;
  e.core.axes = n % 3 ? test::anyPose(random, 1).m : Mat3(Mat3::Identity());
  for (int i = 0; i < 3; ++i) e.core.half[i] = std::pow(10.0, real(random, n % 4 ? -1 : -9, 0));
  return e;
}

/// Two ellipsoids are on opposite sides of a plane. They touch in one point, overlap by −`gap`, or
/// are `gap` apart.
TEST(OverlapEllipsoids, TouchingByConstruction) {
  Random random(test::testSeed(86));
  int proved = 0, close = 0, possible = 0;
  for (int n = 0; n < 20'000; ++n) {
    Ellipsoid a = anyEllipsoid(random, n), b = anyEllipsoid(random, n + 1);
    if (n % 5 == 0) a.size = real(random, 0, 0.5), b.size = real(random, 0, 0.5);
    const double scale = n % 7 ? 1 : std::ldexp(1.0, n % 11 * 60 - 300);
    const Vec3 normal = n % 2 ? anyDirection(random) : Vec3(a.core.axes.col(n % 3));
    // The point of an ellipsoid farthest along a direction, relative to its centre.
    const auto extreme = [](const Ellipsoid& e, const Vec3& along) -> Vec3 {
      const Vec3 d = e.core.half.cwiseProduct(e.core.axes.transpose() * along);
      return e.core.axes * e.core.half.cwiseProduct(d / d.norm()) + e.size * along;
    };
    // The chord from any point of an ellipsoid along its normal is at least 2·least²/largest long.
    const auto chord = [](const Vec3& half) {
      return half.minCoeff() * half.minCoeff() / half.maxCoeff();
    };
    const double gap =
        (n % 2 ? 1 : -std::min(chord(a.core.half), chord(b.core.half))) * std::pow(10.0, -(n % 18));
    b.core.center = extreme(a, normal) - extreme(b, -normal) + gap * normal;
    for (Ellipsoid* e : {&a, &b}) e->core.center *= scale, e->core.half *= scale, e->size *= scale;
    const PairTest<Ellipsoid> test(boundsOf(a), boundsOf(b), {}, 0);
    // The construction is off by some 2^-50. The distance of the two extreme points is known up to
    // this error, so no bound may be larger than `distance`.
    const double off = 0x1p-50 * scale, distance = std::max(0.0, gap * scale) + off;
    ASSERT_LE(test.distanceBound(a, b), distance) << n;
    ASSERT_FALSE(test.separated(a, b, distance)) << n;
    // For ellipsoids that are swept by large spheres, the search uses other ellipsoids as
    // approximations, so small gaps may be missed.
    if (gap < (a.size > 0 ? 1e-4 : 0x1p-30)) continue;
    ++possible;
    proved += test.separated(a, b, 0.5 * gap * scale);
    // The search for a bound ends if it has proved this share of the distance between the cores,
    // except if the search runs out of steps, or the points that it has found are within its
    // rounding noise.
    const double bound = test.distanceBound(a, b) / scale, radii = (a.size + b.size) / scale;
    close += bound >= (1 - internal::kBound) * (gap + radii) - radii;
  }
  std::cout << proved << " of " << possible << " proved, " << close << " bounds are close\n";
  EXPECT_GE(proved, 0.997 * possible);
  EXPECT_GE(close, 0.995 * possible);
}

/// Returns a point of the shell.
Vec3 anyPoint(Random& random, const Shell& s) {
  const double angle = (s.hasCone() ? std::atan(s.slope) : M_PI) *
                       std::min(1.0, real(random, 0, 1.5));  // a third are on the rim
  const Vec3 side = s.axis.cross(anyDirection(random)).normalized();
  const double r = std::array{s.inner, s.outer, real(random, s.inner, s.outer)}[random() % 3];
  return s.center + r * (std::cos(angle) * s.axis + std::sin(angle) * side) +
         real(random, 0, 1) * s.size * anyDirection(random);
}

/// The sphere around a volume contains the whole volume, not only the content to which the volume
/// is fitted.
TEST(CurvedVolumeBalls, ContainSampledPoints) {
  Random random(test::testSeed(88));
  int cones = 0;
  for (int n = 0; n < 300; ++n) {
    const std::vector<Vec3> points = cloud(random, n % kFamilies, n % 3 ? 3 : 24);
    std::vector<Ball> balls;
    for (const Vec3& p : points) balls.push_back({p, n % 2 ? 0 : real(random, 0, 0.1)});
    const std::vector<Triangle> triangles = trianglesOf(points);
    for (const Content& content : {Content(balls), Content(triangles)}) {
      const Shell shell = fitted<Shell>(content);
      const Ellipsoid e = fitted<Ellipsoid>(content);
      cones += shell.hasCone();
      for (int i = 0; i < 100; ++i) {
        // The samples are off by some roundings of the lengths involved.
        ASSERT_LE((anyPoint(random, shell) - shell.boundingCenter).norm(),
                  shell.boundingRadius + 0x1p-48 * (shell.outer + shell.center.norm()))
            << n;
        const Vec3 d = i < 3 ? Vec3(Vec3::Unit(i)) : anyDirection(random);
        const Vec3 p = e.core.axes * e.core.half.cwiseProduct(d) + e.size * (e.core.axes * d);
        ASSERT_LE(p.norm(), e.radius() * (1 + 0x1p-48)) << n;
      }
    }
  }
  EXPECT_GT(cones, 100);
}

/// Compares bounds for pairs of shells with the distances of sampled points, for all relations:
/// cones that face each other, one shell in the hole of the other, and nested caps.
TEST(OverlapShells, NeverFartherThanSampledPoints) {
  Random random(test::testSeed(87));
  int byHole = 0, positive = 0;
  const int count = test::casesOf(1'700, 3'000);
  for (int n = 0; n < count; ++n) {
    std::array<Shell, 2> pair;
    for (Shell& s : pair) {
      s.outer = real(random, 0.1, 2);
      s.inner = s.outer * real(random, 0, 0.999);
      s.axis = anyDirection(random);
      if (random() % 4) s.slope = std::pow(10, real(random, -3, 1));
      s.center = (n % 2 ? 0.3 : 1.5) * anyVector(random);
      s.size = random() % 3 ? 0 : real(random, 0, 0.1);
      s.boundingCenter = s.center, s.boundingRadius = roundedUp(s.outer + s.size);
    }
    const auto& [a, b] = pair;
    const Transform X = n % 3 ? test::anyPose(random, 0.3) : Transform();
    const PairTest<Shell> test(boundsOf(a), boundsOf(b), X, 0);
    const double bound = test.distanceBound(a, b);
    double least = HUGE_VAL;
    for (int i = 0; i < 300; ++i)
      least = std::min(least, (anyPoint(random, a) - X * anyPoint(random, b)).norm());
    ASSERT_LE(bound, least + 1e-14) << n;
    ASSERT_FALSE(test.separated(a, b, least + 1e-14)) << n;
    positive += bound > 0;
    ASSERT_TRUE(!(bound > 0) || test.separated(a, b, 0.9 * bound)) << n;
    byHole += bound > 0 && (a.center - X * b.center).norm() < std::max(a.inner, b.inner);
  }
  EXPECT_GT(positive, count / 10);
  EXPECT_GT(byHole, count / 60);
}

/// Spheres whose distance from the hole, the outside or the side of a shell is known.
TEST(OverlapShells, ClosedForms) {
  Shell shell, point;
  shell.inner = 2, shell.outer = 3, shell.boundingRadius = 3;
  const auto bound = [&](const Vec3& at, double radius) {
    point.center = point.boundingCenter = at;
    point.size = point.boundingRadius = radius;
    return std::array{
        PairTest<Shell>(boundsOf(shell), boundsOf(point), {}, 0).distanceBound(shell, point),
        PairTest<Shell>(boundsOf(point), boundsOf(shell), {}, 0).distanceBound(point, shell)};
  };
  const auto expectNear = [](const std::array<double, 2>& bounds, double distance) {
    for (const double b : bounds) {
      EXPECT_LE(b, distance);
      EXPECT_NEAR(b, distance, 1e-12);
    }
  };
  expectNear(bound(Vec3(0.5, 0, 0), 0.25), 1.25);  // in the hole
  expectNear(bound(Vec3(0, 4, 0), 0.25), 0.75);    // outside
  expectNear(bound(Vec3(0, 0, 2.5), 0.25), 0);     // in the wall
  shell.slope = 1;                                 // a cone of 45° around z
  expectNear(bound(Vec3(0, 0, 5), 1), 1);          // above
  expectNear(bound(Vec3(0, 0, 1), 0.25), 0.75);    // the cone's inside, below the inner sphere
}

}  // namespace
}  // namespace corridor
