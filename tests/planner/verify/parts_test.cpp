// The parts of the verifier: rational contacts, bracketed distances, the search in two trees, the
// curve of an edge.
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/verify/box_tree.h"
#include "planner/verify/edge_curve.h"
#include "planner/verify/exact_contact.h"
#include "tests/planner/verify/meshes.h"
#include "tests/support/support.h"

namespace corridor::verify {
namespace {

using test::poseOf;
using test::randomPose;
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
  EXPECT_FALSE(touches(needle, away));  // on one line, apart
  EXPECT_FALSE(touches(point, away));
  EXPECT_TRUE(touches(needle, {Vec3(1, 1, 1), Vec3(1, 1, 3), Vec3(1, 1, 3)}));
}

TEST(ExactContact, QuaternionIsNormalisedExactly) {
  // 3² + 4²: a rotation by rational numbers whatever the norm; (5, 0, 0) goes to (-1.4, 4.8, 0),
  // not quite doubles.
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

TEST(TriangleGap, BracketIsTightAndItsWitnessesLieInTheTriangles) {
  std::mt19937_64 random(test::testSeed(1));
  int apart = 0;
  for (int i = 0; i < 20000; ++i) {
    RealVec a[3], b[3];
    const double flat = i % 4 == 1 ? 1e-9 : 1;  // needles, plates, parallel ones among them
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
    const TriangleGap gap = triangleGap(a, b);
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

TEST(TriangleGap, ClosedForms) {
  const RealVec a[3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const RealVec face[3] = {{1, 1, 0.5L}, {1, 1, 2}, {2, 1, 2}};
  EXPECT_EQ(triangleGap(a, face).upper, 0.5L);
  EXPECT_EQ(triangleGap(a, face).lower, 0.5L);
  const RealVec corner[3] = {{7, 0, 4}, {8, 0, 4}, {8, 1, 4}};
  EXPECT_EQ(triangleGap(a, corner).upper, 5);
  const RealVec edges[3] = {{-3, 2, -9}, {-3, 2, 9}, {-7, 2, 0}};
  EXPECT_EQ(triangleGap(a, edges).upper, 3);
}

Placement placementOf(const RigidPose& pose) {
  return {pose.q.normalized().toRotationMatrix().cast<Real>(), pose.p.cast<Real>()};
}

std::vector<SoupTriangle> soupOf(const TriangleMesh& mesh) {
  std::vector<SoupTriangle> soup;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    soup.push_back({{mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)}, 0, i});
  }
  return soup;
}

TEST(SoupDistance, EqualsTheDoubleLoop) {
  std::mt19937_64 random(test::testSeed(2));
  const BoxTree moving(soupOf(randomSoup(random, 40, 1, 0.2)));
  const BoxTree fixed(soupOf(randomSoup(random, 150, 3, 0.2)));
  SoupDistance distance(moving, fixed);
  TrianglePair guess;
  for (int i = 0; i < 50; ++i) {
    const Placement placement = placementOf(randomPose(random, 3));
    Real lower = std::numeric_limits<Real>::infinity(), upper = lower;
    for (const SoupTriangle& m : moving.triangles()) {
      RealVec a[3], b[3];
      for (int k = 0; k < 3; ++k) {
        a[k] = placement.rotation * m.corners[k].cast<Real>() + placement.position;
      }
      for (const SoupTriangle& f : fixed.triangles()) {
        for (int k = 0; k < 3; ++k) b[k] = f.corners[k].cast<Real>();
        const TriangleGap gap = triangleGap(a, b);
        lower = std::min(lower, gap.lower);
        upper = std::min(upper, gap.upper);
      }
    }
    const SoupGap found = distance.measure(placement, guess, 0, [](TrianglePair) { return false; });
    // Pairs within 2^-30 of the closest may stand for it.
    EXPECT_LE(std::abs(found.upper - upper), 0x1p-29L * upper);
    EXPECT_LE(std::abs(found.lower - lower), 0x1p-29L * upper);
    EXPECT_FALSE(found.touching);
    guess = found.pair;
  }
}

TEST(EdgeCurve, FollowsTheShorterArcAndStaysWithinItsTravel) {
  std::mt19937_64 random(test::testSeed(3));
  for (int i = 0; i < 300; ++i) {
    PathState from{randomPose(random, 2), randomVec(random, 4)};
    PathState to{randomPose(random, 2), randomVec(random, 4)};
    if (i % 3 == 0) {
      to = from;
      to.pose.q.coeffs() +=
          1e-5 * randomPose(random, 1).q.coeffs();  // OMPL's slerp stands still here
    }
    const bool planar = i % 2 == 1;
    const EdgeCurve curve(from, to, planar);
    const Vec3 x = randomVec(random, 1).normalized();
    const auto image = [&](Real t) -> RealVec {
      const Placement p = curve.at(t).placement;
      return p.rotation * x.cast<Real>() + p.position;
    };
    const RigidPose end = curve.at(1).pose;
    if (!planar) {
      EXPECT_NEAR(std::abs(end.q.normalized().dot(to.pose.q.normalized())), 1, 1e-15);
      const Eigen::Quaterniond middle = from.pose.q.normalized().slerp(0.5, to.pose.q.normalized());
      EXPECT_NEAR(std::abs(curve.at(0.5L).pose.q.dot(middle)), 1, 1e-14);
    } else {
      EXPECT_NEAR(std::remainder(curve.at(1).yaw - to.xyYaw.z(), 2 * std::numbers::pi), 0, 1e-14);
    }
    // The rotation and the pose rounded to doubles are the same map: 9 entries of about 16
    // roundings of 2^-53.
    const EdgeCurve::At at = curve.at(0.3L);
    EXPECT_LT((placementOf(at.pose).rotation - at.placement.rotation).norm(), 0x1p-47L);
    Real length = 0;
    for (int k = 0; k < 64; ++k) {
      const Real step = (image((k + 1) / 64.0L) - image(k / 64.0L)).norm();
      EXPECT_LE(step, curve.travel(1 / 64.0L, 1)) << i;
      length += step;
    }
    EXPECT_LE(length, curve.travel(0.5L, 1) * 2);
    EXPECT_LE((image(1) - image(0)).norm(), curve.travel(1, 1));
  }
}

}  // namespace
}  // namespace corridor::verify
