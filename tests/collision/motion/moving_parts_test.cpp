#include "collision/motion/moving_parts.h"

#include <array>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "collision/convex/polytope.h"
#include "collision/motion/moving_hulls.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Shape;
using test::ShapeFeature;
using test::Touching;

/// A relative motion, which starts at a given pose: the origin of body b moves on a straight line,
/// and b rotates about its origin, both at constant speed.
struct LineAndTurn {
  Transform start;
  Vec3 delta = Vec3::Zero(), axis = Vec3::UnitZ();
  double angle = 0;
  mutable std::array<ScrewMotion, 2> screws{};

  RelativeMotion relativeMotion(double t, double h) const {
    RelativeMotion w;
    w.X_AB.m = Eigen::AngleAxisd(t * angle, axis).toRotationMatrix() * start.m;
    w.X_AB.t = start.t + t * delta;
    w.linear = h * delta;
    w.angular = h * angle * axis;
    w.speed = w.linear.norm() * (1 + 0x1p-50);
    w.angle = h * std::abs(angle) * (1 + 0x1p-50);
    screws[0] = {ScrewMotion::Kind::prismatic, delta.normalized(), Vec3::Zero(), w.speed, 0};
    screws[1] = {ScrewMotion::Kind::revolute, angle < 0 ? Vec3(-axis) : axis, w.X_AB.t, w.angle, 0};
    w.screws = screws;
    w.fixedError = 0x1p-48 * (start.t.norm() + delta.norm());
    w.reachError = 0x1p-46;
    return w;
  }
};

MovingPairAnswer decide(const ShapeFeature& a, const ShapeFeature& b,
                        const RelativeMotion& relative, double margin) {
  const auto triangle = [](const ShapeFeature& f) {
    return Triangle{f.part.points[0], f.part.points[1], f.part.points[2]};
  };
  if (a.isTriangle) return decideMovingParts(triangle(a), b.part, relative, margin);
  if (b.isTriangle) return decideMovingParts(a.part, triangle(b), relative, margin);
  return decideMovingParts(a.part, b.part, relative, margin);
}

/// Returns the solid as a body: those with flat faces as meshes.
Body bodyOf(const ShapeFeature& f) {
  if (f.isTriangle || f.part.radius > 0 || f.part.points.size() < 4) return {"part", f.part};
  const Polytope hull(f.part.points);
  TriangleMesh mesh;
  mesh.vertices.assign(hull.vertices().begin(), hull.vertices().end());
  mesh.triangles.assign(hull.faces().begin(), hull.faces().end());
  return {"mesh", std::move(mesh)};
}

/// Two bodies whose hulls are tested first.
struct Hulls {
  Body a, b;
  HullGuess guess;
  int separated = 0;
};

enum class Verdict { free, contact, undecided };

Verdict certify(const ShapeFeature& a, const ShapeFeature& b, const LineAndTurn& motion, double t,
                double h, double tolerance, double margin, std::uint64_t& decided,
                Hulls* hulls = nullptr) {
  ++decided;
  if (hulls &&
      decideMovingHulls(hulls->a, hulls->b, motion.relativeMotion(t, h), margin, hulls->guess)
          .separated) {
    ++hulls->separated;
    return Verdict::free;
  }
  const MovingPairAnswer answer = decide(a, b, motion.relativeMotion(t, h), margin);
  if (answer.separated) return Verdict::free;
  if (answer.contact) return Verdict::contact;
  if (answer.stuck || answer.bound < tolerance) return Verdict::undecided;
  const Verdict first = certify(a, b, motion, t - h / 2, h / 2, tolerance, margin, decided, hulls);
  if (first != Verdict::free) return first;
  return certify(a, b, motion, t + h / 2, h / 2, tolerance, margin, decided, hulls);
}

using Vec3L = Eigen::Matrix<long double, 3, 1>;

/// Returns the least height of b along n at time t, by a closed form, in long double.
long double lowest(const ShapeFeature& b, const LineAndTurn& motion, long double t, const Vec3& n) {
  const Eigen::Matrix<long double, 3, 3> R =
      Eigen::AngleAxis<long double>(t * motion.angle, motion.axis.cast<long double>().normalized())
          .toRotationMatrix() *
      motion.start.m.cast<long double>();
  const Vec3L nL = n.cast<long double>(), m = R.transpose() * nL;
  const Vec3L origin = motion.start.t.cast<long double>() + t * motion.delta.cast<long double>();
  const ConvexSet set = b.set();
  long double least = 1e30L;
  for (const Vec3& p : set.points) least = std::min(least, m.dot(p.cast<long double>()));
  const Vec3L axis = set.axis.cast<long double>();
  return origin.dot(nL) + least - set.ball * m.norm() - set.disc * m.cross(axis).norm();
}

/// Bodies that graze by construction. Body a is below a plane, and touches the plane at a known
/// point. Body b is above the plane, and its lowest point is exactly above that point, at a
/// distance `gap`. This holds at the end of the motion, and throughout the motion if b slides along
/// the plane and rotates about its normal.
TEST(MovingParts, GrazingByConstruction) {
  Touching make(test::testSeed(25));
  const int count = test::casesOf(6'000, 100'000);
  int falseFree = 0, falseContact = 0, notFree = 0, apart = 0, together = 0;
  std::uint64_t slideIntervals = 0, slides = 0, hullsSeparated = 0;
  for (int n = 0; apart + together < count; ++n) {
    const Shape sa = test::kShapes[make.pick(6)], sb = test::kShapes[make.pick(6)];
    if (sa == Shape::triangle && sb == Shape::triangle) continue;
    const ShapeFeature a = make.feature(sa), b = make.feature(sb);
    const double amount = std::pow(10.0, -2 - n % 12);
    const double gap = n / 12 % 2 ? amount : -amount;
    if (gap < -0.4e-7) continue;  // some parts are so thin that a larger depth is not possible
    const Transform end = make.pose(b, a.x + gap * a.m, -a.m);  // in a's frame
    const Vec3 up = a.m, u = up.unitOrthogonal(), v = up.cross(u);
    LineAndTurn motion;
    const bool slide = n % 3 == 0;
    Vec3 from = end.t + u * make.real() + v * make.real();
    if (slide) {
      motion.axis = up;
      motion.angle = make.real(-2, 2);
    } else {
      from += up * make.real(0.5, 2);
      motion.axis = make.vector().normalized();
      motion.angle = make.real();
    }
    motion.delta = end.t - from;
    motion.start = {Eigen::AngleAxisd(-motion.angle, motion.axis).toRotationMatrix() * end.m, from};
    bool known = true;
    const long double least = lowest(b, motion, 1, up);
    for (int i = 0; i < 200 && known && !slide; ++i)
      known = lowest(b, motion, i / 200.0L, up) >= least;
    for (int k = 1; k < 14 && known && !slide; ++k)
      known = lowest(b, motion, 1 - std::pow(10.0L, -k), up) >= least;
    if (!known) continue;
    (gap > 0 ? apart : together)++;
    std::uint64_t decided = 0;
    const bool flat = !a.isTriangle && !b.isTriangle && bodyOf(a).hull() && bodyOf(b).hull();
    std::optional<Hulls> hulls;
    if (flat && n % 2) hulls.emplace(bodyOf(a), bodyOf(b));
    const Verdict verdict =
        certify(a, b, motion, 0.5, 0.5, 1e-7, 0, decided, hulls ? &*hulls : nullptr);
    if (hulls) hullsSeparated += static_cast<std::uint64_t>(hulls->separated);
    if (gap < 0) {
      falseFree += verdict == Verdict::free;
    } else {
      // The pose at the end of the motion is rounded again, so the limit includes the error of that
      // pose.
      falseContact += verdict == Verdict::contact && amount > 0x1p-44 * 8;
      notFree += verdict != Verdict::free && amount > 2e-7;
      if (slide && amount > 1e-3) slideIntervals += decided, ++slides;
    }
  }
  EXPECT_EQ(falseFree, 0);
  EXPECT_EQ(falseContact, 0);
  EXPECT_EQ(notFree, 0);
  EXPECT_GT(apart, count / 4);
  EXPECT_GT(together, count / 10);
  EXPECT_GT(hullsSeparated, static_cast<std::uint64_t>(count) / 10);
  std::cout << apart << " apart, " << together << " together; intervals per slide "
            << double(slideIntervals) / double(slides) << "\n";
}

TEST(MovingParts, SlidesOnceAndKeepsMargins) {
  const ShapeFeature table{placed(Box{Vec3(4, 4, 1)}, {}), false, false, {}, {}};
  const ShapeFeature can{placed(Cylinder{0.5, 1}, {}), false, false, {}, {}};
  LineAndTurn motion;
  motion.start = {Mat3::Identity(), Vec3(-1, 0, 1.01)};
  motion.delta = Vec3(2, 0, 0);
  motion.angle = 1.5;  // about its own axis
  std::uint64_t decided = 0;
  EXPECT_EQ(certify(table, can, motion, 0.5, 0.5, 1e-7, 0, decided), Verdict::free);
  EXPECT_EQ(decided, 1U) << "the disc rotates about its axis, and slides along the table";
  EXPECT_EQ(certify(table, can, motion, 0.5, 0.5, 1e-7, 0.0099, decided), Verdict::free);
  const MovingPairAnswer close =
      decideMovingParts(table.part, can.part, motion.relativeMotion(0.5, 0.25), 0.0101);
  EXPECT_TRUE(close.contact);
  EXPECT_FALSE(close.separated);
}

TriangleMesh boxMesh(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? half[0] : -half[0], i & 2 ? half[1] : -half[1],
                         i & 4 ? half[2] : -half[2]);
  const Polytope hull(corners);
  TriangleMesh mesh;
  mesh.vertices = corners;
  mesh.triangles.assign(hull.faces().begin(), hull.faces().end());
  return mesh;
}

/// A cube slides past a ball: the gap is known in closed form. Halving is advised while it can
/// help.
TEST(MovingHulls, GapMarginTubeAndAdvice) {
  const Body ball("ball", ConvexPart{{Vec3(0, 0, 0)}, 1, false}),
      cube("cube", boxMesh(Vec3::Constant(0.5)));
  ASSERT_TRUE(haveHulls(ball, cube));
  LineAndTurn motion;
  motion.start.m = Mat3::Identity();
  motion.start.t = Vec3(-1, 0, 1.51);  // a gap of 0.01 at the middle
  motion.delta = Vec3(2, 0, 0);
  HullGuess guess;
  const auto test = [&](double h, double margin, double tube) {
    RelativeMotion relative = motion.relativeMotion(0.5, h);
    relative.fixedError += tube;
    HullGuess fresh;
    const MovingHullsAnswer answer = decideMovingHulls(ball, cube, relative, margin, fresh);
    // The answer does not depend on where the search begins.
    const MovingHullsAnswer again = decideMovingHulls(ball, cube, relative, margin, guess);
    EXPECT_EQ(answer.separated, again.separated);
    return answer;
  };
  const MovingHullsAnswer whole = test(0.5, 0, 0);
  EXPECT_TRUE(whole.separated) << "along z, nothing moves";
  EXPECT_NEAR(whole.clearance, 0.01, 1e-12);
  EXPECT_TRUE(test(0.5, 0.0099, 0).separated);
  EXPECT_FALSE(test(0.5, 0.0101, 0).separated);
  EXPECT_TRUE(test(0.5, 0, 0.0099).separated);
  EXPECT_FALSE(test(0.5, 0, 0.0101).separated);
  // A cube that turns about its own vertical axis sweeps a disc: no direction separates it at once.
  motion.start.t = Vec3(1.75, 0, 0);
  motion.delta = Vec3::Zero();
  motion.angle = 1;
  guess = {};
  const MovingHullsAnswer turn = test(0.5, 0, 0);
  EXPECT_FALSE(turn.separated);
  EXPECT_TRUE(turn.shorter) << "the gap is 0.07 at the middle";
  EXPECT_TRUE(test(0x1p-6, 0, 0).separated);
  EXPECT_FALSE(test(0.5, 0.3, 0).shorter) << "at the middle, the margin is not kept";
}

TEST(MovingHulls, OnlyOfMeshesWithAHull) {
  const Body cube("cube", boxMesh(Vec3::Constant(0.5))),
      ball("ball", ConvexPart{{Vec3(0, 0, 0)}, 1, false});
  EXPECT_TRUE(haveHulls(cube, ball));
  EXPECT_TRUE(haveHulls(ball, cube));
  EXPECT_FALSE(haveHulls(ball, ball)) << "their trees are one box each";
  const Body cloud("cloud", std::vector<ConvexPart>(2, ConvexPart{{Vec3(0, 0, 0)}, 1, false}));
  EXPECT_FALSE(haveHulls(cube, cloud));
  TriangleMesh inside = boxMesh(Vec3::Constant(0.5));
  for (auto& t : inside.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(haveHulls(ball, Body("inside out", inside)));
}

TEST(MovingParts, UndecidedIfTheTubeExceedsTheGap) {
  const ConvexPart a{{Vec3(0, 0, 0)}, 1, false}, b{{Vec3(0, 0, 0)}, 0.5, false};
  LineAndTurn motion;
  motion.start.t = Vec3(1.51, 0, 0);
  motion.delta = Vec3(0, 0.1, 0);
  RelativeMotion relative = motion.relativeMotion(0.5, 0.5);
  EXPECT_TRUE(decideMovingParts(a, b, relative, 0).separated);
  relative.fixedError = 0.02;
  const MovingPairAnswer answer = decideMovingParts(a, b, relative, 0);
  EXPECT_TRUE(answer.stuck);
  EXPECT_FALSE(answer.contact);
  EXPECT_NEAR(answer.gap, std::hypot(1.51, 0.05) - 1.5, 1e-12);
}

}  // namespace
}  // namespace corridor
