// Tests of the verifier's components: rational contacts, bounds of distances, the search in two
// trees, and the curve of an edge.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/verify/body_tree.h"
#include "planner/verify/edge_curve.h"
#include "planner/verify/exact_contact.h"
#include "tests/planner/verify/random_arm.h"
#include "tests/planner/verify/rigid_world.h"
#include "tests/support/support.h"

namespace corridor::verify {
namespace {

using test::placementOf;
using test::poseOf;
using test::randomPose;
using test::randomSet;
using test::randomSoup;
using test::randomVec;

const RigidPose kStill;
const Corners kFlat = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};

bool touches(const Corners& a, const Corners& b) {
  const bool ab = exactContact(kStill, a, b).has_value();
  EXPECT_EQ(ab, exactContact(kStill, b, a).has_value());
  return ab;
}

TEST(ExactContact, ClosedTriangles) {
  EXPECT_TRUE(touches(kFlat, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 2, 1)}));  // through the face
  EXPECT_TRUE(touches(kFlat, {Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, 2, 1)}));  // vertex on the face
  EXPECT_TRUE(touches(kFlat, {Vec3(2, 2, -1), Vec3(2, 2, 1), Vec3(5, 5, 0)}));  // edge on the edge
  EXPECT_TRUE(touches(kFlat, {Vec3(4, 0, 0), Vec3(5, 0, 1), Vec3(5, 1, 1)}));  // vertex on a vertex
  EXPECT_TRUE(
      touches(kFlat, {Vec3(1, 1, 0), Vec3(1.5, 1, 0), Vec3(1, 1.5, 0)}));  // inside, in plane
  EXPECT_TRUE(
      touches(kFlat, {Vec3(-1, -1, 0), Vec3(9, -1, 0), Vec3(-1, 9, 0)}));      // around, in plane
  EXPECT_TRUE(touches(kFlat, {Vec3(4, 0, 0), Vec3(9, 0, 0), Vec3(9, 1, 0)}));  // corner, in plane
  const double ulp = 0x1p-52;
  EXPECT_FALSE(touches(kFlat, {Vec3(1, 1, 0x1p-1074), Vec3(1, 1, 1), Vec3(1, 2, 1)}));
  EXPECT_FALSE(touches(kFlat, {Vec3(4 * (1 + ulp), 0, 0), Vec3(9, 0, 0), Vec3(9, 1, 0)}));
  EXPECT_FALSE(touches(kFlat, {Vec3(2, 2 + 2 * ulp, -1), Vec3(2, 2 + 2 * ulp, 1), Vec3(5, 5, 0)}));
}

TEST(ExactContact, DegenerateTriangles) {
  const Corners needle = {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 0.5)};
  const Corners inPlane = {Vec3(-1, 1, 0), Vec3(9, 1, 0), Vec3(0, 1, 0)};
  const Corners point = {Vec3(1, 1, 0), Vec3(1, 1, 0), Vec3(1, 1, 0)};
  const Corners away = {Vec3(1, 1, 2), Vec3(1, 1, 3), Vec3(1, 1, 3)};
  EXPECT_TRUE(touches(kFlat, needle));
  EXPECT_TRUE(touches(kFlat, inPlane));
  EXPECT_TRUE(touches(kFlat, point));
  EXPECT_TRUE(touches(needle, inPlane));
  EXPECT_TRUE(touches(needle, point));
  EXPECT_TRUE(touches(point, point));
  EXPECT_FALSE(touches(kFlat, away));
  EXPECT_FALSE(touches(needle, away));  // collinear, apart
  EXPECT_FALSE(touches(point, away));
  EXPECT_TRUE(touches(needle, {Vec3(1, 1, 1), Vec3(1, 1, 3), Vec3(1, 1, 3)}));
  // The two degenerate triangles are segments that have only an end in common. None of their edges
  // is a single point.
  const Corners first = {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(2, 2, 0)};
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(1, 3, 2), Vec3(0, 0, 1)}) {
    const Vec3 end(2, 2, 0);
    EXPECT_TRUE(touches(first, {end, Vec3(end + d), Vec3(end + 2 * d)})) << d.transpose();
    EXPECT_FALSE(
        touches(first, {Vec3(end + 0x1p-51 * Vec3::UnitX()), Vec3(end + d), Vec3(end + 2 * d)}))
        << d.transpose();
  }
}

TEST(ExactContact, QuaternionIsNormalisedExactly) {
  // 3² + 4² = 5², so the matrix of this rotation is rational. (5, 0, 0) goes to (-1.4, 4.8, 0),
  // whose coordinates are not exactly doubles.
  RigidPose pose;
  pose.q = Eigen::Quaterniond(3, 0, 0, 4);
  const Corners needle = {Vec3(25, 0, 0), Vec3(26, 0, 0), Vec3(26, 1, 0)};
  const Corners at = {Vec3(-7, 24, 0), Vec3(-7, 24, -1), Vec3(-8, 24, -1)};
  const auto point = exactContact(pose, needle, at);
  ASSERT_TRUE(point);
  EXPECT_EQ(*point, Vec3(-7, 24, 0));
  pose.p.z() = 0x1p-60;
  EXPECT_FALSE(exactContact(pose, needle, at));
}

TEST(ExactContact, SharedTriangles) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "no shared test data (CORRIDOR_DATA)";
  int pairs = 0, wrong = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*data / "collision/tripairs")) {
    std::ifstream file(entry.path());
    int taken = 0;
    for (std::string line; std::getline(file, line) && taken < 200;) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream numbers(line);
      std::string word;
      numbers >> word;
      const bool hit = word == "1";
      Corners a, b;
      for (Corners* corners : {&a, &b}) {
        for (Vec3& corner : *corners) {
          for (int i = 0; i < 3; ++i) {
            numbers >> word;
            corner[i] = std::strtod(word.c_str(), nullptr);
          }
        }
      }
      wrong += exactContact(kStill, a, b).has_value() != hit;
      ++pairs;
      ++taken;
    }
  }
  EXPECT_GT(pairs, 1000);
  EXPECT_EQ(wrong, 0);
}

bool holds(const RealVec t[3], const RealVec& x, Real slack) {
  const RealVec points[1][3] = {{x, x, x}};
  return triangleGap(t, points[0]).lower <= slack;
}

TEST(DistanceBounds, BracketIsTightAndItsWitnessesLieInTheTriangles) {
  std::mt19937_64 random(test::testSeed(1));
  int apart = 0;
  for (int i = 0; i < 20000; ++i) {
    RealVec a[3], b[3];
    const double flat = i % 4 == 1 ? 1e-9 : 1;  // includes needles, plates and parallel triangles
    const Vec3 shift = randomVec(random, 3);
    for (int j = 0; j < 3; ++j) {
      Vec3 p = randomVec(random, 1), q = randomVec(random, 1);
      if (i % 4 == 2) q = p;
      if (i % 4 == 3 && j == 2) p = (p + a[0].cast<double>()) * 0.5;
      p.y() *= flat;
      q.y() *= flat;
      a[j] = p.cast<Real>();
      b[j] = (q + shift).cast<Real>();
    }
    const DistanceBounds gap = triangleGap(a, b);
    EXPECT_LE(gap.lower, gap.upper + 0x1p-58L) << i;
    EXPECT_TRUE(holds(a, gap.onA, 0x1p-58L)) << i;
    EXPECT_TRUE(holds(b, gap.onB, 0x1p-58L)) << i;
    if (gap.lower > 0) {
      ++apart;
      EXPECT_GE(gap.lower, gap.upper - 1e-12L) << i;
    } else {
      Corners ca, cb;
      for (int j = 0; j < 3; ++j) {
        ca[j] = a[j].cast<double>();
        cb[j] = b[j].cast<double>();
      }
      if (i % 4 != 1) {
        EXPECT_TRUE(exactContact(kStill, ca, cb)) << i;
      }
    }
  }
  EXPECT_GT(apart, 10000);
}

TEST(DistanceBounds, ClosedForms) {
  const RealVec a[3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const RealVec face[3] = {{1, 1, 0.5L}, {1, 1, 2}, {2, 1, 2}};
  EXPECT_EQ(triangleGap(a, face).upper, 0.5L);
  EXPECT_EQ(triangleGap(a, face).lower, 0.5L);
  const RealVec corner[3] = {{7, 0, 4}, {8, 0, 4}, {8, 1, 4}};
  EXPECT_EQ(triangleGap(a, corner).upper, 5);
  const RealVec edges[3] = {{-3, 2, -9}, {-3, 2, 9}, {-7, 2, 0}};
  EXPECT_EQ(triangleGap(a, edges).upper, 3);
}

TEST(BodyDistance, EqualsTheDoubleLoop) {
  std::mt19937_64 random(test::testSeed(2));
  const TriangleMesh meshB = randomSoup(random, 40, 1, 0.2),
                     meshA = randomSoup(random, 150, 3, 0.2);
  const BodyTree a(meshA), b(meshB);
  BodyDistance distance;
  LeafPair guess;
  const Real infinity = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < 50; ++i) {
    const Placement placement = placementOf(randomPose(random, 3));
    distance.place(a, b, placement);
    Real lower = infinity, upper = infinity;
    std::size_t within = 0;
    for (std::uint32_t s = 0; s < meshA.triangles.size(); ++s)
      for (std::uint32_t t = 0; t < meshB.triangles.size(); ++t) {
        const DistanceBounds gap = distance.gap({s, t});
        lower = std::min(lower, gap.lower);
        upper = std::min(upper, gap.upper);
        within += gap.upper < 0.5L;
      }
    const auto never = [](LeafPair) { return false; };
    const BodyGap found = distance.measure(guess, 0, infinity, never);
    // Instead of the closest pair, the search may return a pair whose distance is larger by a
    // factor of up to 1 + 2^-30.
    EXPECT_LE(std::abs(found.upper - upper), 0x1p-29L * upper);
    EXPECT_LE(std::abs(found.lower - lower), 0x1p-29L * upper);
    EXPECT_FALSE(found.touching);
    guess = found.pair;
    // If the search stops early, `lower` is still a lower bound.
    EXPECT_LE(distance.measure({}, 0, upper / 2, never).lower, upper);
    EXPECT_GE(distance.measure({}, 0, lower / 2, never).lower, lower / 2 * (1 - 0x1p-29L));
    std::vector<LeafPair> near;
    const auto none = [](const CentredBox&, const CentredBox&) { return false; };
    ASSERT_TRUE(distance.collectNear(0.5L, SIZE_MAX, none, near));
    std::size_t among = 0;
    for (const LeafPair& pair : near) among += distance.gap(pair).upper < 0.5L;
    EXPECT_EQ(among, within);
    if (within > 1) {
      EXPECT_FALSE(distance.collectNear(0.5L, within - 1, none, near));
    }
  }
}

/// Two points: every bound of their boxes can be compared with their distance, which takes a few
/// roundings in long double. Lengths from 1e-250 to 1e250: squares in double overflow and vanish.
TEST(BodyDistance, BoxesOfTwoPointsNeverClaimMore) {
  std::mt19937_64 random(test::testSeed(61));
  std::uniform_real_distribution<double> exponent(-250, 250);
  BodyDistance distance;
  const auto never = [](LeafPair) { return false; };
  for (int i = 0; i < 4000; ++i) {
    const double scale = i % 2 ? 1 : std::pow(10.0, exponent(random));
    const ConvexPart partA{{scale * randomVec(random, 1)}, 0, false};
    const ConvexPart partB{{scale * randomVec(random, 1)}, 0, false};
    const BodyTree a(std::span(&partA, 1)), b(std::span(&partB, 1));
    Placement X_AB;  // like the verifier's placements: a rotation up to the rounding of long double
    X_AB.rotation = Eigen::Quaternion<Real>(randomPose(random, 1).q.cast<Real>())
                        .normalized()
                        .toRotationMatrix();
    X_AB.position = (scale * randomVec(random, 1)).cast<Real>();
    distance.place(a, b, X_AB);
    const RealVec between =
        X_AB.rotation * partB.points[0].cast<Real>() + X_AB.position - partA.points[0].cast<Real>();
    const Real size = a.radius() + b.radius() + X_AB.position.norm(), apart = between.norm();
    for (const Real share : {0.25L, 1 - 0x1p-40L, 1 - 0x1p-46L, 1 - 0x1p-55L}) {
      const BodyGap found = distance.measure({}, 0, share * apart, never);
      EXPECT_LE(found.lower, apart + 0x1p-58L * size) << scale;
      EXPECT_GE(found.lower, share * apart - 0x1p-42L * size) << "not much less: " << scale;
    }
  }
}

using test::Arm;

TEST(EdgeCurve, PointsStayWithinTheirReach) {
  std::mt19937_64 random(test::testSeed(3));
  Real fullestSpeed = 0, fullestBend = 0;
  for (int i = 0; i < 300; ++i) {
    const Arm arm(random);
    const Configuration from = arm.random(random), to = arm.random(random);
    const EdgeCurve curve(arm.tree, arm.space.coordinates(), from, to);
    if (curve.ambiguous()) continue;
    const std::size_t frame = i % 2 ? arm.tip : arm.side;
    for (const std::size_t base : {std::size_t(0), std::size_t(3)}) {
      const KinematicChain chain = chainOf(arm.tree, base, frame);
      const Vec3 x = randomVec(random, 0.5);
      const Reach reach = curve.reach(chain, x.norm(), Configuration::Zero(from.size()));
      const auto image = [&](Real t) -> RealVec {
        const Placement p = curve.at(chain, t).at;
        return p.rotation * x.cast<Real>() + p.position;
      };
      const Real h = 1 / 128.0L;
      for (int k = 0; k < 64; ++k) {
        const Real t = (k + 0.5L) / 64;
        const FrameState state = curve.at(chain, t);
        const RealVec middle = image(t);
        const RealVec velocity = state.linear + state.angular.cross(middle);
        for (const Real s : {-h, h}) {
          const RealVec moved = image(t + s) - middle;
          EXPECT_LE(moved.norm(), reach.speed * h * (1 + 1e-15L));
          EXPECT_LE((moved - s * velocity).norm(), reach.bend * h * h / 2 + 1e-17L);
          fullestSpeed = std::max(fullestSpeed, moved.norm() / (reach.speed * h));
          fullestBend =
              std::max(fullestBend, (moved - s * velocity).norm() / (reach.bend * h * h / 2));
        }
      }
    }
  }
  EXPECT_GT(fullestSpeed, 0.5);  // some point attains half of the bound
  EXPECT_GT(fullestBend, 0.2);
}

TEST(EdgeCurve, EndsWhereItShould) {
  std::mt19937_64 random(test::testSeed(4));
  for (int i = 0; i < 100; ++i) {
    const Arm arm(random);
    const Configuration from = arm.random(random), to = arm.random(random);
    const EdgeCurve curve(arm.tree, arm.space.coordinates(), from, to);
    for (const auto& [t, q] : {std::pair{Real(0), from}, std::pair{Real(1), to}}) {
      const EdgeCurve still(arm.tree, arm.space.coordinates(), q, q);
      const KinematicChain chain = chainOf(arm.tree, 0, arm.tip);
      const Placement a = curve.at(chain, t).at, b = still.at(chain, 0.5L).at;
      EXPECT_LE((a.rotation - b.rotation).norm(), 1e-17L);
      EXPECT_LE((a.position - b.position).norm(), 1e-17L);
      Configuration end = curve.configuration(t);
      for (Eigen::Index k = 0; k < 3; ++k) EXPECT_EQ(end[k], q[k]);
    }
  }
}

TEST(ConvexGap, BracketsTheDistanceOfAllKinds) {
  std::mt19937_64 random(test::testSeed(5));
  int apart = 0;
  Real worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const ConvexSet a = randomSet(random, i % 5, Vec3::Zero()),
                    b = randomSet(random, i / 5 % 5, randomVec(random, 1.5));
    const DistanceBounds gap = convexGap(a, b);
    EXPECT_LE(gap.lower, gap.upper + 0x1p-50L);
    if (gap.upper == 0) continue;
    ++apart;
    worst = std::max(worst, gap.upper - gap.lower);
    const DistanceBounds swapped = convexGap(b, a);
    EXPECT_NEAR(static_cast<double>(swapped.upper), static_cast<double>(gap.upper), 1e-13);
    // No two points of the sets are closer than `lower`.
    std::normal_distribution<double> normal;
    for (int k = 0; k < 20; ++k) {
      const RealVec d(normal(random), normal(random), normal(random));
      const auto extreme = [&](const ConvexSet& set, const RealVec& n) {
        return RealVec(set.farthest(n) + n.normalized() * set.sweptRadius());
      };
      EXPECT_GE((extreme(b, -d) - extreme(a, d)).norm(), gap.lower * (1 - 1e-15L));
    }
  }
  EXPECT_GT(apart, 5000);
  // The largest values are those of cylinders; for other sets they are rounding errors.
  EXPECT_LT(worst, 1e-9L);
}

TEST(ConvexGap, ClosedForms) {
  const Placement still;
  const ConvexSet ball = placed({{Vec3(0, 0, 3)}, 0.5, false}, still),
                  can = placed({{Vec3(0, 0, -1), Vec3(0, 0, 1)}, 0.7, true}, still),
                  rod = placed({{Vec3(2, -5, 0), Vec3(2, 5, 0)}, 0.25, false}, still);
  EXPECT_EQ(convexGap(ball, can).upper, 1.5L);
  EXPECT_EQ(convexGap(ball, can).lower, 1.5L);
  EXPECT_NEAR(static_cast<double>(convexGap(can, rod).lower), 2 - 0.7 - 0.25, 1e-12);
  const ConvexSet rim = placed({{Vec3(3, 0, 3)}, 0, false}, still);  // (2.3, 2) from the rim
  EXPECT_NEAR(static_cast<double>(convexGap(can, rim).lower), std::hypot(2.3, 2.0), 1e-12);
}

}  // namespace
}  // namespace corridor::verify
