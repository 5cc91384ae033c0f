// Proofs must hold under flush-to-zero and denormals-are-zero. This program is linked with
// -ffast-math, which sets both before `main`.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/core/floating_point.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/course/exact_contact.h"
#include "collision/course/linear_program.h"
#include "collision/course/outer_hierarchy.h"
#include "collision/course/plane_separation.h"
#include "collision/course/polytope_intersection.h"
#include "collision/course/separating_axes.h"
#include "collision/course/separating_plane.h"
#include "collision/course/vclip.h"
#include "collision/motion/check_certificate.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/collision/motion/bodies.h"
#include "tests/collision/motion/grazing.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// The least normal number. It is volatile, so that the compiler does not compute its half at
/// compile time.
volatile double least = 0x1p-1022;

TEST(FlushToZero, IsSetFromTheStart) {
#if defined(__x86_64__)
  EXPECT_EQ(least / 2, 0);
#endif
  EXPECT_EQ(floatingPoint(), FloatingPoint::standard) << "it is allowed";
}

/// Returns k times the least subnormal number. (A product or a conversion would be flushed to
/// zero.)
double tiny(int k) {
  const auto bits = static_cast<std::uint64_t>(std::abs(k));
  return std::bit_cast<double>(k < 0 ? bits | std::uint64_t{1} << 63 : bits);
}

/// The relation of two hulls must not depend on their scale, down to subnormal coordinates.
TEST(FlushToZero, RelationsOfTinyHullsAreExact) {
  std::mt19937_64 random(test::testSeed(8));
  int touching = 0;
  const int pairs = test::casesOf(180, 500);
  for (int n = 0; n < pairs; ++n) {
    std::vector<Vec3> p, q, tinyP, tinyQ;
    for (std::size_t i = 0, count = 2 + random() % 10; i < count; ++i) {
      Vec3 x, small;
      for (int k = 0; k < 3; ++k) {
        const int value = static_cast<int>(random() % 7) - 3;
        x[k] = value;
        small[k] = tiny(value);
      }
      const bool first = i == 0 || (i > 1 && random() % 2);
      (first ? p : q).push_back(x);
      (first ? tinyP : tinyQ).push_back(small);
    }
    const auto relation = separatingPlane<3>(p, q).relation;
    ASSERT_EQ(separatingPlane<3>(tinyP, tinyQ).relation, relation) << n;
    const ConvexPart a{tinyP, 0, false}, b{tinyQ, 0, false};
    ASSERT_EQ(convexHullsTouch({a, {}}, {b, {}}), relation != HullRelation::disjoint) << n;
    touching += relation == HullRelation::touching;
  }
  EXPECT_GT(touching, pairs / 50);
}

/// Contact of tiny polytopes must be exact by each method: closest features, separating axes and
/// hierarchies.
TEST(FlushToZero, ContactOfTinyPolytopesIsExact) {
  std::vector<Vec3> cube;
  for (int i = 0; i < 8; ++i) cube.push_back({tiny(i & 1), tiny(i >> 1 & 1), tiny(i >> 2)});
  const Polytope box(cube);
  const PolytopeFeatures features(box);
  const DobkinKirkpatrick inner(box);
  const OuterHierarchy outer(inner);
  FeaturePair pair;
  for (int n = 0; n < 125; ++n) {
    const int at[] = {n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2};
    const Transform X{Mat3::Identity(), {tiny(at[0]), tiny(at[1]), tiny(at[2])}};
    const bool touch = std::max({std::abs(at[0]), std::abs(at[1]), std::abs(at[2])}) <= 1;
    EXPECT_EQ(separatingAxis(features, {}, features, X).separated, !touch) << n;
    EXPECT_EQ(closestFeatures(features, {}, features, X, pair).distance.distance == 0, touch) << n;
    EXPECT_EQ(intersection(inner, {}, outer, X).intersects, touch) << n;
  }
}

/// Contacts of primitives of any scale must not be missed, even if squares or products of three
/// lengths become 0. At scales of 2^-90 m and more, gaps must be found, too.
TEST(FlushToZero, ContactsOfTinyPrimitivesAreNotMissed) {
  test::Touching make(test::testSeed(11));
  int apart = 0;
  for (const test::Shape sa : test::kShapes)
    for (const test::Shape sb : test::kShapes)
      for (int n = 0; n < 50; ++n) {
        // Two triangles that are pushed into each other may have passed through each other
        // completely.
        if (sa == test::Shape::triangle && sb == test::Shape::triangle) continue;
        test::ShapeFeature a = make.feature(sa), b = make.feature(sb);
        const double scale = std::ldexp(1.0, n % 2 ? -make.pick(90) : -make.pick(1050));
        for (test::ShapeFeature* f : {&a, &b}) {
          for (Vec3& p : f->part.points) p *= scale;
          f->part.radius *= scale;
          f->x *= scale;
        }
        const Vec3 normal = make.vector().normalized(), x = make.vector() * scale;
        const Transform X_WA = make.pose(a, x, normal), X_WB = make.pose(b, x, -normal);
        Transform deep = X_WB, far = X_WB;
        deep.t -= normal * (0x1p-40 * scale);
        far.t += normal * (0x1p-20 * scale);
        ASSERT_TRUE(convexSetsTouch({a.set(), X_WA}, {b.set(), deep}))
            << int(sa) << int(sb) << " " << n << " " << scale;
        if (n % 2 == 0) continue;
        ASSERT_FALSE(convexSetsTouch({a.set(), X_WA}, {b.set(), far})) << n << " " << scale;
        ++apart;
      }
  EXPECT_GT(apart, 800);
}

/// The square of the plate's thickness is flushed to zero, or some of the terms from which it is
/// computed are.
TEST(FlushToZero, ContactsOfThinPlatesAreNotMissed) {
  const ConvexPart cube = placed(Box{{1, 1, 1}}, {});
  const Transform turned{Eigen::AngleAxisd(0.785398, Vec3::UnitZ()).matrix(), Vec3(0.7, 0, 0)};
  for (int k = 0; k > -1000; --k) {
    const ConvexPart plate = placed(Box{{std::ldexp(0.9, k), 0.2, 0.2}}, {});
    EXPECT_TRUE(convexSetsTouch({plate, {}}, {cube, turned})) << k;
  }
}

TEST(FlushToZero, TinyLinearProgramsAreExact) {
  std::mt19937_64 random(test::testSeed(9));
  for (int n = 0; n < 500; ++n) {
    std::vector<HalfSpace<2>> list, small;
    for (std::size_t i = 0, count = random() % 6; i < count; ++i) {
      const int x = static_cast<int>(random() % 5) - 2, y = static_cast<int>(random() % 5) - 2,
                offset = static_cast<int>(random() % 5) - 1;
      list.push_back({{x, y}, static_cast<double>(offset)});
      small.push_back({{tiny(x), tiny(y)}, tiny(offset)});
    }
    const int x = static_cast<int>(random() % 3) - 1, y = static_cast<int>(random() % 3) - 1;
    ASSERT_EQ(solveLinearProgram<2>(small, {tiny(x), tiny(y)}).status,
              solveLinearProgram<2>(list, {x, y}).status)
        << n;
  }
}

TEST(FlushToZero, ExtremeVerticesAreExact) {
  std::vector<Vec3> cube;
  for (int i = 0; i < 8; ++i) cube.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const DobkinKirkpatrick hierarchy{Polytope(cube)};
  for (int n = 0; n < 27; ++n) {
    const int sign[] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    for (const int big : {-1, 0, 1, 2}) {  // index of the large component; −1: no component is
                                           // large
      Vec3 d;
      for (int k = 0; k < 3; ++k) d[k] = k == big ? 400.0 * sign[k] : tiny(sign[k]);
      const Vec3& found = hierarchy.polytope().vertices()[hierarchy.extreme(d)];
      for (int k = 0; k < 3; ++k) {
        if (sign[k] != 0) {
          EXPECT_EQ(found[k], sign[k] > 0 ? 1 : 0) << n << " " << big;
        }
      }
    }
  }
}

/// The side of a plane on which a unit cube lies must be exact for planes with tiny normals or
/// offsets.
TEST(FlushToZero, SidesOfPlanesAreExact) {
  std::vector<Vec3> cube;
  for (int i = 0; i < 8; ++i) cube.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const DobkinKirkpatrick hierarchy{Polytope(cube)};
  for (int offset = -4; offset <= 4; ++offset) {
    const int side = offset < 0 ? 1 : offset > 3 ? -1 : 0;
    const HalfSpace<3> small{Vec3::Constant(tiny(1)), tiny(offset)};
    EXPECT_EQ(sideOfPlane(hierarchy, small), side) << offset;
    EXPECT_EQ(planeSeparation(hierarchy, small).side, side) << offset;
    const HalfSpace<3> usual{Vec3::Ones(), tiny(offset)};
    EXPECT_EQ(sideOfPlane(hierarchy, usual), offset < 0 ? 1 : 0) << offset;
    EXPECT_EQ(planeSeparation(hierarchy, usual).side, offset < 0 ? 1 : 0) << offset;
  }
}

TEST(FlushToZero, GrazingEdgesAreRight) {
  std::mt19937_64 random(test::testSeed(5));
  int known = 0, audited = 0;
  const int count = test::casesOf(500, 3'000);
  for (int n = 0; n < count; ++n) {
    const double gap = (n % 2 ? 1 : -1) * std::pow(10.0, -2 - n % 12);
    // Every tenth case is so small that squares, or even lengths, become 0. For these cases `free`
    // is not required.
    const double size = std::pow(10.0, n % 10 ? 6 - n % 13 : -100 - n % 210);
    const auto feature = static_cast<test::Grazing::Feature>(n % test::Grazing::features);
    const test::Grazing g(random, feature, n % 5 == 0, gap, size);
    if (!g.known) continue;
    ++known;
    const Body fixed = test::bodyOf(g.fixed), moving = test::bodyOf(g.moving);
    RigidEdge edge(RigidMotion::spatial(g.from, g.to, {}));
    const MotionPair pair{&fixed, &moving};
    MotionOptions options;
    options.tolerance = std::max(1e-7 * size, 1e-300);
    QueryContext context;
    MotionCertificate certificate;
    const MotionResult result = certifyMotion(edge, {&pair, 1}, options, context, &certificate);
    if (gap < 0) {
      ASSERT_NE(result.verdict, MotionVerdict::free) << n;
    } else if (size > 1e-7 && gap * size > 2 * options.tolerance) {
      ASSERT_EQ(result.verdict, MotionVerdict::free) << n;
    }
    if (result.verdict == MotionVerdict::free && gap > 1e-4) {
      ASSERT_FALSE(checkCertificate(edge, {&pair, 1}, options, 1, certificate, context)) << n;
      ++audited;
    }
    certificate.free = {{0, 0, 1, 1e-5 * size}};
    if (gap < 0) {
      ASSERT_TRUE(checkCertificate(edge, {&pair, 1}, options, 1, certificate, context)) << n;
    }
  }
  EXPECT_GT(known, count / 3);
  EXPECT_GT(audited, count / 30);
}

}  // namespace
}  // namespace corridor
