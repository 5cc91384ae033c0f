// Queries of a body of many convex parts must have the same answers as queries of one body per
// part.
#include <algorithm>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "collision/queries/containment.h"
#include "collision/volumes/kdop.h"
#include "collision/world/body_queries.h"
#include "collision/world/rigid_scene.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"

namespace corridor::test {
namespace {

/// Returns parts of all kinds near the origin; some parts occur twice.
std::vector<ConvexPart> someParts(std::mt19937_64& random, int count) {
  std::vector<ConvexPart> all = parts(random, count, 0.2);
  for (int i = 0; i < count; i += 7) all.push_back(all[static_cast<std::size_t>(i)]);
  return all;
}

/// Returns balls about the points of a wavy surface, as a sensor measures such a surface.
std::vector<ConvexPart> cloud(int side) {
  std::vector<ConvexPart> balls;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      const double x = 2.0 * i / side - 1, y = 2.0 * k / side - 1;
      balls.push_back({{Vec3(x, y, 0.2 * std::sin(5 * x) * std::cos(4 * y))}, 1.2 / side, false});
    }
  return balls;
}

std::vector<Body> oneBodyEach(const std::vector<ConvexPart>& all) {
  std::vector<Body> bodies;
  for (const ConvexPart& part : all) bodies.emplace_back("", part);
  return bodies;
}

TEST(PartUnions, TreesContainAllParts) {
  std::mt19937_64 random(testSeed(300));
  for (const int count : {1, 2, 3, 4, 5, 9, 60, 300}) {
    std::vector<ConvexPart> all = someParts(random, count);
    const double size = std::exp2(std::uniform_real_distribution<double>(-40, 40)(random));
    for (ConvexPart& part : all) {
      part.radius *= size;
      for (Vec3& p : part.points) p = size * (p + Vec3(count % 2 ? 0 : 1e4, 0, 0));
    }
    const Body body("", all);
    EXPECT_EQ(test::treeFault(body.tree()), std::nullopt) << count;
    EXPECT_EQ(test::treeFault(body.volumeTree<Kdop<18>>()), std::nullopt) << count;
    EXPECT_EQ(body.tree().itemCount(), all.size());
    for (const ConvexPart& part : all)
      for (const Vec3& p : part.points) {
        const double ball = part.flatEnds ? 0 : part.radius;
        EXPECT_LE(p.norm() + ball, body.radius());
        EXPECT_LE((p - body.tree().origin()).norm() + ball, body.tree().radius() * (1 + 1e-15));
        EXPECT_TRUE((body.lower().array() <= p.array() - ball * 0.999999).all());
        EXPECT_TRUE((body.upper().array() >= p.array() + ball * 0.999999).all());
      }
  }
  const Body surface("", cloud(12));
  EXPECT_EQ(test::treeFault(surface.tree()), std::nullopt);
}

/// `treeFault` must find a box that is too small; otherwise the test above would prove nothing.
TEST(PartUnions, CheckFindsAPartOutsideOfItsBox) {
  auto parts = std::make_shared<std::vector<ConvexPart>>(cloud(5));
  const Obb4Tree tree(parts);
  EXPECT_EQ(test::treeFault(tree), std::nullopt);
  (*parts)[7].radius *= 1.5;  // the tree shares the parts, and was built for the old radius
  EXPECT_NE(test::treeFault(tree), std::nullopt);
}

TEST(PartUnions, BoundsAreThoseOfAllParts) {
  const Body body("", {{{Vec3(1, 0, 0)}, 0.5, false}, {{Vec3(0, 2, 0), Vec3(0, 3, 0)}, 1, true}});
  EXPECT_LE((body.lower() - Vec3(-1, -0.5, -1)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE((body.upper() - Vec3(1.5, 3, 1)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_THROW(Body("", std::vector<ConvexPart>()), std::invalid_argument);
  EXPECT_THROW(Body("", {{{Vec3(1, 0, 0)}, 0.5, false}, {{}, 1, false}}), std::invalid_argument);
  EXPECT_THROW(Obb4Tree(std::make_shared<std::vector<ConvexPart>>()), std::invalid_argument);
}

TEST(PartUnions, StaticQueries) {
  std::mt19937_64 random(testSeed(301));
  int touching = 0, apart = 0;
  for (int n = 0; n < 60; ++n) {
    const std::vector<ConvexPart> all = n % 3 ? someParts(random, 40) : cloud(8);
    const Body whole("", all);
    const std::vector<Body> each = oneBodyEach(all);
    const Body mesh = bodyOf(soup(random, 30, 0.05)), other("", someParts(random, 10));
    for (const Body* against : {&mesh, &other})
      for (const TreeKind trees : {TreeKind::obb4, TreeKind::obbBinary, TreeKind::kdop18}) {
        Transform X = anyPose(random, 1.2);
        if (n % 5 == 0) X.m *= 0.3;  // a map that is not rigid
        QueryContext context;
        const Posed a{whole, {}}, b{*against, X};
        bool hit = false;
        double least = HUGE_VAL;
        for (const Body& one : each) {
          hit = hit || interference({one, {}}, b, context).has_value();
          least = std::min(least, distance({one, {}}, b, {}, context).distance);
        }
        const auto found = interference(a, b, context, trees);
        ASSERT_EQ(found.has_value(), hit) << n;
        if (found) {
          const Body& one = each.at(found->a);
          EXPECT_TRUE(interference({one, {}}, b, context)) << "the number is that of the part";
        }
        const Distance d = distance(a, b, {}, context, trees);
        EXPECT_NEAR(d.distance, least, 1e-12 * (1 + least));
        EXPECT_FALSE(closerThan(a, b, least * (1 - 1e-9) - 1e-12 < 0 ? 0 : least * (1 - 1e-9),
                                context, trees) &&
                     least > 1e-9);
        EXPECT_TRUE(closerThan(a, b, least * (1 + 1e-9) + 1e-12, context, trees));
        (hit ? touching : apart) += 1;
      }
  }
  EXPECT_GT(touching, 30);
  EXPECT_GT(apart, 30);
}

/// Many balls at random places: in some poses, a ball is inside a solid box. Some of the maps are
/// not rigid.
TEST(PartUnions, PartsInsideSolids) {
  std::mt19937_64 random(testSeed(302));
  const Body solid("", box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), true);
  int inside = 0, outside = 0;
  for (int n = 0; n < 300; ++n) {
    std::vector<ConvexPart> all;
    for (int i = 0; i < 50; ++i) all.push_back({{anyPose(random, 3).t}, 0.01, false});
    const Body whole("", all);
    const std::vector<Body> each = oneBodyEach(all);
    Transform X = anyPose(random, 3), Y = anyPose(random, 3);
    if (n % 2) X.m = X.m * Vec3(0.5, 2, 1).asDiagonal();
    if (n % 3) Y.m = Y.m * Vec3(1, 0.7, 1.5).asDiagonal();
    QueryContext context;
    bool any = false;
    for (const Body& one : each) any = any || findEnclosed({solid, X}, {one, Y}, context);
    const auto found = findEnclosed({solid, X}, {whole, Y}, context);
    ASSERT_EQ(found.has_value(), any) << n;
    if (found) {
      EXPECT_TRUE(findEnclosed({solid, X}, {each.at(found->b), Y}, context));
    }
    (any ? inside : outside) += 1;
  }
  EXPECT_GT(inside, 20);
  EXPECT_GT(outside, 50);
}

TEST(PartUnions, Motions) {
  std::mt19937_64 random(testSeed(303));
  std::map<MotionVerdict, int> verdicts;
  for (int n = 0; n < 400; ++n) {
    const std::vector<ConvexPart> all = n % 2 ? someParts(random, 30) : cloud(8);
    std::vector<Body> moving, fixed, movingToo, fixedToo = oneBodyEach(all);
    const TriangleMesh body = blob(random, 20, 0.2, 0.2);
    moving.push_back(bodyOf(body));
    movingToo.push_back(bodyOf(body));
    fixed.emplace_back("", all);
    if (n % 3 == 0) {  // the union moves
      std::swap(moving, fixed);
      std::swap(movingToo, fixedToo);
    }
    const RigidScene one(std::move(moving), std::move(fixed)),
        many(std::move(movingToo), std::move(fixedToo));
    const auto [from, to] = randomEdge(random);
    MotionOptions options;
    options.tolerance = 1e-5;
    options.margin = n % 4 == 0 ? 0.05 : 0;
    options.earliest = n % 5 == 0;
    options.trees = n % 7 == 0 ? TreeKind::aabb : TreeKind::obb4;
    RigidEdge edge(RigidMotion::spatial(from, to, {.position = 1e-6, .rotation = 1e-6}));
    QueryContext context;
    const MotionResult a = one.scene().certify(edge, options, context),
                       b = many.scene().certify(edge, options, context);
    ++verdicts[a.verdict];
    if (a.verdict != MotionVerdict::undecided && b.verdict != MotionVerdict::undecided) {
      EXPECT_EQ(a.verdict, b.verdict) << n;
    }
    for (const EdgeMethod method : {EdgeMethod::adaptive, EdgeMethod::advancement}) {
      const MotionResult c = one.scene().certify(edge, options, context, method);
      if (a.verdict != MotionVerdict::undecided && c.verdict != MotionVerdict::undecided) {
        EXPECT_EQ(a.verdict, c.verdict) << n;
      }
    }
    if (options.trees != TreeKind::obb4 || a.verdict != MotionVerdict::free) continue;
    MotionCertificate certificate;
    one.scene().certify(edge, options, context, certificate);
    EXPECT_FALSE(
        checkCertificate(edge, one.scene().motionPairs(), options, 1, certificate, context))
        << n;
  }
  EXPECT_GT(verdicts[MotionVerdict::free], 40);
  EXPECT_GT(verdicts[MotionVerdict::contact], 40);
}

}  // namespace
}  // namespace corridor::test
