// Queries of meshes whose triangles make contact hard to decide. The 4-wide OBB tree is compared
// with the binary OBB tree, with brute force and with rationals. Rotating and scaling both meshes,
// or adding triangles, must change the results in a known way; this is tested, too. There are 110
// pairs of meshes, or 20,000 with CORRIDOR_STRESS.
#include "tests/support/soups.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/volumes/rss.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/rational_contact.h"
#include "tests/support/support.h"
#include "tests/support/triangle_families.h"

namespace corridor {
namespace {

using Random = std::mt19937_64;
using test::TrianglePairs;

struct Soups {
  TriangleMesh a, b;
  Transform X_WA, X_WB;
};

/// Returns two meshes, made of pairs of triangles of the families (triangle_families.h) at random
/// places. In half of the cases, mesh b is then shifted. In the other half, pairs that touch by
/// construction still touch if both meshes have the same map. In some meshes the triangles are
/// dense, in others they are far apart. Some maps are rigid only up to rounding, with large
/// translations.
Soups anySoups(Random& random, int count) {
  Soups s;
  const auto families = test::pairFamilies();
  const auto integer = [&](int most) { return static_cast<int>(random() % (2 * most + 1)) - most; };
  const int spread = 1 << random() % 26, only = static_cast<int>(random() % 20);
  for (int n = 0; n < count; ++n) {
    Triangle a, b;
    const std::size_t family = only < 9 ? only : random() % families.size();
    families[family].make(random, a, b);
    const int x = integer(spread), y = integer(spread), z = integer(spread);
    const Vec3 place(x, y, z);
    for (Triangle* t : {&a, &b})
      for (Vec3& p : *t) p += place;
    test::add(s.a, a);
    // Only one in eight of the triangles b is added, so that most meshes do not touch everywhere.
    if (random() % 8 == 0 || s.b.triangles.empty()) test::add(s.b, b);
  }
  if (random() % 2) {
    const double least = s.a.vertices[0][0];
    for (Vec3& v : s.b.vertices) v[0] += 0.5 + std::abs(least) / 4096;
  }
  switch (random() % 4) {
    case 0:
      break;
    case 1:
      s.X_WA = s.X_WB = {test::exactRotation(random), 1e6 * Vec3(1, -3, 2)};
      break;
    case 2:
      s.X_WA = s.X_WB = test::anyPose(random, 1e6);
      break;
    default: {
      s.X_WB = test::anyPose(random, spread);
      for (Vec3& v : s.b.vertices) v = s.X_WB.m.transpose() * (v - s.X_WB.t);
    }
  }
  const int exponent = random() % 3 ? 0 : static_cast<int>(random() % 665) - 332;  // 10^±100
  for (TriangleMesh* mesh : {&s.a, &s.b})
    for (Vec3& v : mesh->vertices) v *= std::ldexp(1.0, exponent);
  for (Transform* X : {&s.X_WA, &s.X_WB}) X->t *= std::ldexp(1.0, exponent);
  return s;
}

TrianglePairs pairsOf(const std::vector<TriangleContact>& contacts) {
  TrianglePairs pairs;
  for (const TriangleContact& c : contacts) pairs.insert({c.a, c.b});
  return pairs;
}

class SoupQueries : public testing::Test {
 protected:
  /// Expects that contacts, distances and tolerance queries agree with brute force.
  void expectAgreement(const Soups& s, const TrianglePairs& expected) {
    const Obb4Tree a(s.a), b(s.b);
    const ObbTree binaryA(s.a), binaryB(s.b);
    const bool touch = !expected.empty();
    ASSERT_EQ(interference(Posed(a, s.X_WA), Posed(b, s.X_WB), context_).has_value(), touch);
    ASSERT_EQ(interference(Posed(b, s.X_WB), Posed(a, s.X_WA), context_).has_value(), touch);
    ASSERT_EQ(interference(Posed(binaryA, s.X_WA), Posed(binaryB, s.X_WB), context_).has_value(),
              touch);
    const auto found = contacts(Posed(a, s.X_WA), Posed(b, s.X_WB), context_);
    ASSERT_EQ(pairsOf(found), expected);
    ASSERT_EQ(found.size(), expected.size()) << "a pair came twice";
    ASSERT_EQ(pairsOf(contacts(Posed(binaryA, s.X_WA), Posed(binaryB, s.X_WB), context_)),
              expected);
    const double d = distance(Posed(a, s.X_WA), Posed(b, s.X_WB), {}, context_).distance,
                 back = distance(Posed(b, s.X_WB), Posed(a, s.X_WA), {}, context_).distance,
                 binary = distance(Posed(binaryA, s.X_WA), Posed(binaryB, s.X_WB), {}, context_)
                              .distance;
    ASSERT_EQ(d == 0, touch);
    ASSERT_EQ(back == 0, touch);
    ASSERT_EQ(binary == 0, touch);
    const double scale = std::max(test::errorScale(s.a, s.X_WA), test::errorScale(s.b, s.X_WB));
    const double off = 1e-12 * d + 4 * kUnit * scale;
    ASSERT_LE(std::abs(d - binary), 2 * off);
    ASSERT_LE(std::abs(d - back), 2 * off);
    ASSERT_EQ(closerThan(Posed(a, s.X_WA), Posed(b, s.X_WB), 0, context_), touch);
    ASSERT_TRUE(closerThan(Posed(a, s.X_WA), Posed(b, s.X_WB), d + off, context_));
    if (d > 2 * off) {
      ASSERT_FALSE(closerThan(Posed(b, s.X_WB), Posed(a, s.X_WA), d - 2 * off, context_));
    }
  }

  /// Expects the same contacts after both meshes are rotated and scaled by a power of two.
  void expectInvariance(Random& random, const Soups& s, const TrianglePairs& expected) {
    const Mat3 R = test::exactRotation(random);
    const double unit = std::ldexp(1.0, static_cast<int>(random() % 401) - 200);
    Soups turned = s;
    for (Transform* X : {&turned.X_WA, &turned.X_WB}) *X = {R * X->m, R * X->t};
    Soups q = turned;
    for (Transform* X : {&q.X_WA, &q.X_WB}) X->t *= unit;
    for (TriangleMesh* mesh : {&q.a, &q.b})
      for (Vec3& v : mesh->vertices) v *= unit;
    rotations_.insert({R.data(), R.data() + R.size()});
    expectSameDistance<Obb4Tree>(s, turned, q, unit);
    expectSameDistance<ObbTree>(s, turned, q, unit);
    expectSameDistance<VolumeTree<Rss>>(s, turned, q, unit);
    for (TriangleMesh* mesh : {&q.a, &q.b})
      for (auto& t : mesh->triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    const Obb4Tree a(q.a), b(q.b);
    ASSERT_EQ(pairsOf(contacts(Posed(a, q.X_WA), Posed(b, q.X_WB), context_)), expected);
  }

  /// Expects the same verdict for the rotated and the scaled meshes. Scaling must scale the
  /// distance bit for bit. After a rotation sums are taken in another order: the distance must be
  /// within the promised error, and is nearly always the same.
  template <class Tree>
  void expectSameDistance(const Soups& s, const Soups& turned, const Soups& scaled, double unit) {
    const auto answerOf = [](const Soups& t) {
      const Tree a(t.a), b(t.b);
      QueryContext hit, far;  // new contexts: a context that other queries have used may change the
                              // last digits
      return std::pair(interference(Posed(a, t.X_WA), Posed(b, t.X_WB), hit).has_value(),
                       distance(Posed(a, t.X_WA), Posed(b, t.X_WB), {}, far).distance);
    };
    const auto [hit, d] = answerOf(s);
    const auto [hitTurned, dTurned] = answerOf(turned);
    const auto [hitScaled, dScaled] = answerOf(scaled);
    ASSERT_EQ(hitTurned, hit);
    ASSERT_EQ(hitScaled, hit);
    ASSERT_EQ(dScaled, unit * dTurned);
    const double scale = std::max(test::errorScale(s.a, s.X_WA), test::errorScale(s.b, s.X_WB));
    ASSERT_LE(std::abs(dTurned - d), 2 * (1e-12 * d + 4 * kUnit * scale));
    distances_ += !hit;
    otherBits_ += dTurned != d;
  }

  QueryContext context_;
  std::set<std::vector<double>> rotations_;  // the exact rotations that occurred
  int distances_ = 0,
      otherBits_ = 0;  // distances compared; those whose last bits differ after a rotation
};

TEST_F(SoupQueries, AgainstBruteForce) {
  Random random(test::testSeed(91));
  const int cases = test::casesOf(110, 20'000);
  int touching = 0, nearer = 0;
  std::size_t pairs = 0;
  for (int n = 0; n < cases; ++n) {
    const int count = 1 + static_cast<int>(random() % (n % 50 == 0 ? 2'000 : 100));
    Soups s = anySoups(random, count);
    const TrianglePairs expected = test::bruteForcePairs(s.a, s.X_WA, s.b, s.X_WB);
    expectAgreement(s, expected);
    expectInvariance(random, s, expected);
    touching += !expected.empty();
    pairs += expected.size();
    // After triangles are added to mesh a, all contacts must remain, and the distance must not
    // grow.
    const TriangleMesh old = s.a;
    const double size = test::errorScale(old, {});
    for (const auto& t : old.triangles)
      if (random() % 4 == 0) {
        const TriangleMesh more = test::soup(random, 1, 0.1);
        const Vec3& at = old.vertices[t[0]];
        test::add(s.a, at, at + size * more.vertices[1], at + size * more.vertices[2]);
      }
    const Obb4Tree a(s.a), b(s.b);
    const TrianglePairs grown = pairsOf(contacts(Posed(a, s.X_WA), Posed(b, s.X_WB), context_));
    ASSERT_TRUE(std::includes(grown.begin(), grown.end(), expected.begin(), expected.end()));
    const double before = distance(Posed(Obb4Tree(old), s.X_WA), Posed(b, s.X_WB), {}, context_)
                              .distance,
                 after = distance(Posed(a, s.X_WA), Posed(b, s.X_WB), {}, context_).distance;
    const double scale = std::max(test::errorScale(s.a, s.X_WA), test::errorScale(s.b, s.X_WB));
    ASSERT_EQ(after == 0, !grown.empty());
    ASSERT_LE(after, before + 2 * (1e-12 * before + 4 * kUnit * scale)) << "farther when grown";
    nearer += after < before;
    ASSERT_FALSE(HasFatalFailure()) << "case " << n;
  }
  std::cout << cases << " pairs of meshes, " << touching << " touching, " << pairs
            << " contacts; N_v " << context_.counters.boxTests << ", N_p "
            << context_.counters.primitiveTests << "; " << otherBits_ << " of " << distances_
            << " distances differ in their last bits when rotated\n";
  EXPECT_LE(otherBits_, distances_ / 100 + 9);
  EXPECT_GT(touching, cases / 4);
  EXPECT_LT(touching, cases - cases / 16);
  EXPECT_GT(nearer, cases / 200);
  EXPECT_GE(rotations_.size(), static_cast<std::size_t>(std::min(24, cases / 8)));
}

/// Tests in rationals some of the reported contacts, and some unreported pairs whose bounding boxes
/// overlap. Adds the numbers of tested pairs to `touching` and `apart`.
void expectRationals(Random& random, const Soups& s, const TrianglePairs& found, int& touching,
                     int& apart) {
  const auto contact = [&](std::uint32_t i, std::uint32_t k) {
    return test::rationalContact(test::corners(s.a, i), s.X_WA, test::corners(s.b, k), s.X_WB);
  };
  const std::size_t asked = test::isStressRun() ? 300 : 50, step = found.size() / asked + 1;
  std::size_t n = random() % step;
  for (const auto& [i, k] : found)
    if (n++ % step == 0) {
      ASSERT_TRUE(contact(i, k)) << i << ", " << k;
      ++touching;
    }
  const auto bounds = [](const TriangleMesh& mesh, std::size_t t, const Transform& X) {
    Eigen::AlignedBox3d box;
    for (int k = 0; k < 3; ++k) box.extend(X.m * mesh.corner(t, k) + X.t);
    return box;
  };
  std::vector<Eigen::AlignedBox3d> ofB;
  for (std::size_t k = 0; k < s.b.triangles.size(); ++k) ofB.push_back(bounds(s.b, k, s.X_WB));
  for (std::size_t tries = 0; tries < asked; ++tries) {
    const auto i = static_cast<std::uint32_t>(random() % s.a.triangles.size());
    const Eigen::AlignedBox3d box = bounds(s.a, i, s.X_WA);
    std::vector<std::uint32_t> near;
    for (std::uint32_t k = 0; k < ofB.size(); ++k)
      if (box.intersects(ofB[k]) && !found.contains({i, k})) near.push_back(k);
    if (near.empty()) continue;
    const std::uint32_t k = near[random() % near.size()];
    ASSERT_FALSE(contact(i, k)) << i << ", " << k;
    ++apart;
  }
}

/// Compares, on large meshes, 4-wide and binary OBB trees with each other and with rationals. The
/// two kinds of trees share only the predicate for triangles.
TEST_F(SoupQueries, HugeSoups) {
  Random random(test::testSeed(92));
  const int count = test::casesOf(3'000, 50'000);
  int touching = 0, apart = 0;
  for (int n = 0; n < 4; ++n) {
    const Soups s = anySoups(random, count);
    const Obb4Tree a(s.a), b(s.b);
    const ObbTree binaryA(s.a), binaryB(s.b);
    const TrianglePairs pairs = pairsOf(contacts(Posed(a, s.X_WA), Posed(b, s.X_WB), context_));
    ASSERT_EQ(pairs, pairsOf(contacts(Posed(binaryA, s.X_WA), Posed(binaryB, s.X_WB), context_)))
        << n;
    ASSERT_EQ(interference(Posed(a, s.X_WA), Posed(b, s.X_WB), context_).has_value(),
              !pairs.empty())
        << n;
    expectRationals(random, s, pairs, touching, apart);
    ASSERT_FALSE(HasFatalFailure()) << n;
    std::cout << pairs.size() << " contacts\n";
  }
  std::cout << touching << " contacts and " << apart
            << " unreported pairs confirmed by rationals\n";
  EXPECT_GT(touching, 50);
  EXPECT_GT(apart, 50);
}

}  // namespace
}  // namespace corridor
