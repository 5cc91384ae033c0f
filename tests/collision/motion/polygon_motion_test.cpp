// Tests of planar polygons as bodies: contact is compared with rationals, and certified motions
// that graze have known verdicts.
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "collision/convex/simple_polygon.h"
#include "collision/motion/certify_motion.h"
#include "collision/world/body_queries.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/planar.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Points = test::Polygons::Points;

Body bodyOf(const Points& polygon) {
  std::vector<ConvexPart> parts;
  for (const auto& piece : convexPieces(polygon)) {
    ConvexPart& part = parts.emplace_back();
    for (const std::uint32_t i : piece) part.points.emplace_back(polygon[i].x(), polygon[i].y(), 0);
  }
  return Body("", std::move(parts));
}

/// Returns the polygon under the map, computed from exactly the stored numbers.
std::vector<test::Point2> mapped(const Points& polygon, const Transform& X) {
  using test::Fraction;
  std::vector<test::Point2> points;
  for (const Vec2& p : polygon) {
    const Fraction x(p.x()), y(p.y());
    points.emplace_back(Fraction(X.m(0, 0)) * x + Fraction(X.m(0, 1)) * y + Fraction(X.t.x()),
                        Fraction(X.m(1, 0)) * x + Fraction(X.m(1, 1)) * y + Fraction(X.t.y()));
  }
  return points;
}

/// Compares contact with rationals, for polygons with integer coordinates. Some maps are
/// translations by integers, under which many pairs touch without overlapping; others are
/// rotations.
TEST(PolygonBodies, ContactAgreesWithRationals) {
  test::Polygons random(test::testSeed(61));
  const int count = test::isStressRun() ? 50'000 : 600;
  QueryContext context;
  int meeting = 0, tested = 0, touching = 0;
  for (int n = 0; n < count; ++n) {
    Points p = random.polygon(3 + random.below(10), n % test::Polygons::kinds),
           q = random.polygon(3 + random.below(10), static_cast<int>(random.below(6)));
    for (Points* each : {&p, &q})
      for (Vec2& v : *each) v = (8 * v).array().round();
    if (checkSimple(p) || checkSimple(q)) continue;
    Transform X_WP, X_WQ;
    X_WQ.t = Vec3(std::round(20 * random.real()), std::round(20 * random.real()), 0);
    if (n % 3 == 0) X_WP.m = Eigen::AngleAxisd(random.real(-3, 3), Vec3::UnitZ()).matrix();
    if (n % 5 == 0) X_WP.t = X_WQ.t = X_WQ.t + Vec3(1e6, 1e6, 0);
    const auto a = mapped(p, X_WP), b = mapped(q, X_WQ);
    const bool truth = test::polygonsMeet(a, b);
    const Body bodyP = bodyOf(p), bodyQ = bodyOf(q);
    const Posed<Body> posedP(bodyP, X_WP), posedQ(bodyQ, X_WQ);
    ASSERT_EQ(interference(posedP, posedQ, context).has_value(), truth) << "pair " << n;
    const double d = distance(posedP, posedQ, {}, context).distance;
    ASSERT_EQ(d == 0, truth) << "pair " << n;
    meeting += truth;
    ++tested;
    Transform moved = X_WQ;  // one step of the grid farther away: apart, if they only touched
    moved.t.x() += 0x1p-10;
    touching += truth && n % 3 != 0 && !test::polygonsMeet(a, mapped(q, moved));
  }
  std::cout << meeting << " of " << tested << " pairs meet, at least " << touching
            << " without overlap\n";
  EXPECT_GT(meeting, tested / 5);
  EXPECT_LT(meeting, tested * 9 / 10);
  EXPECT_GT(touching, 0);
}

/// An L whose inner corner is the origin. The two arms of the L are below y = 0 and to the left of
/// x = 0.
const Points corner{{-1, -1}, {3, -1}, {3, 0}, {0, 0}, {0, 3}, {-1, 3}};

/// Runs motions of random polygons past others, at known gaps of 10^-2 to 10^-8 of the size, half
/// of them negative. `verdictOf(polygon, gap)` returns the verdict of a motion; it must be contact
/// if and only if the gap is negative.
template <class VerdictOf>
void expectVerdictsAtKnownGaps(test::Polygons& random, const VerdictOf& verdictOf) {
  int decided = 0;
  for (int n = 0; n < 2000 / test::kSlowdown; ++n) {
    const Points p = random.polygon(3 + random.below(8), n % test::Polygons::kinds);
    if (checkSimple(p)) continue;
    const double gap = (n % 2 ? 1 : -1) * std::pow(10.0, -2 - n / 2 % 7);
    ASSERT_EQ(verdictOf(p, gap), gap < 0 ? MotionVerdict::contact : MotionVerdict::free)
        << "motion " << n << ", gap " << gap;
    ++decided;
  }
  EXPECT_GT(decided, 500 / test::kSlowdown);
}

/// The other polygon slides along the L's inner edge y = 0. Its height above this edge is `gap`
/// times its size.
TEST(PolygonBodies, MotionsThatSlideAtAKnownHeight) {
  test::Polygons random(test::testSeed(62));
  QueryContext context;
  expectVerdictsAtKnownGaps(random, [&](const Points& p, double gap) {
    double lowest = 1e300, left = 1e300, size = 0;
    for (const Vec2& v : p) {
      lowest = std::min(lowest, v.y());
      left = std::min(left, v.x());
      size = std::max(size, v.norm());
    }
    // The pose has y = gap·size − lowest, up to rounding.
    Points fixed = corner;
    for (Vec2& v : fixed) v = (v.array() > 1).select(10 * size, v);  // longer than the motion
    const double y = gap * size - lowest, from = 0.1 * size - left, to = from + 2 * size;
    MotionOptions options;
    options.tolerance = 1e-10 * size;
    return test::certify(bodyOf(p), bodyOf(fixed),
                         RigidMotion::planar({to, y, 0}, {from, y, 0}, {}), options, context)
        .verdict;
  });
}

/// The polygon turns about its reference point, and its farthest corner passes a wall at a known
/// distance.
TEST(PolygonBodies, RotationsThatGraze) {
  test::Polygons random(test::testSeed(63));
  QueryContext context;
  expectVerdictsAtKnownGaps(random, [&](const Points& p, double gap) {
    Vec2 farthest = p[0];
    for (const Vec2& v : p)
      if (v.norm() > farthest.norm()) farthest = v;
    const double r = farthest.norm(), angle = std::atan2(farthest.y(), farthest.x());
    // A polygon in the form of a U, open to the right, whose left edge is on the line at x.
    const double x = r + gap * r;
    const Points wall{{x, -3 * r},    {x + 2 * r, -3 * r}, {x + 2 * r, -2 * r}, {x + r, -2 * r},
                      {x + r, 2 * r}, {x + 2 * r, 2 * r},  {x + 2 * r, 3 * r},  {x, 3 * r}};
    const double start = -angle - random.real(0.2, 1.2), end = -angle + random.real(0.2, 1.2);
    MotionOptions options;
    options.tolerance = 1e-10 * r;
    return test::certify(bodyOf(p), bodyOf(wall),
                         RigidMotion::planar({0, 0, start}, {0, 0, end}, {}), options, context)
        .verdict;
  });
}

}  // namespace
}  // namespace corridor
