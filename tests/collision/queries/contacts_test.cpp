#include "collision/queries/contacts.h"

#include <algorithm>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/hierarchy/obb_tree.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/interference.h"
#include "collision/queries/triangle_intersection.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"
#include "tests/support/triangle_pairs.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::corners;
using test::errorScale;
using Pairs = test::TrianglePairs;
using Long3 = Eigen::Matrix<long double, 3, 1>;

long double distanceToSegment(const Long3& x, const Long3& p, const Long3& q) {
  const long double length = (q - p).squaredNorm();
  const long double t = length > 0 ? std::clamp((x - p).dot(q - p) / length, 0.0L, 1.0L) : 0.0L;
  return (p + t * (q - p) - x).norm();
}

/// Returns the distance from a point to a closed triangle under its map, in long double, minus the
/// rounding error that this distance may have. The normal n of a sliver has a relative error of
/// 2^-60·L²/|n|, where L is its longest edge.
long double distanceToTriangle(const Vec3& point, const Triangle& triangle, const Transform& X) {
  Long3 t[3];
  for (std::size_t i = 0; i < 3; ++i)
    t[i] = X.m.cast<long double>() * triangle[i].cast<long double>() + X.t.cast<long double>();
  const Long3 x = point.cast<long double>();
  const Long3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  long double best = HUGE_VALL;
  for (int i = 0; i < 3; ++i) best = std::min(best, distanceToSegment(x, t[i], t[(i + 1) % 3]));
  bool inside = n.norm() > 0;
  for (int i = 0; i < 3; ++i)
    inside = inside && (t[(i + 1) % 3] - t[i]).cross(x - t[i]).dot(n) >= 0;
  if (!inside) return best;
  const long double size =
      std::max({(t[1] - t[0]).norm(), (t[2] - t[0]).norm(), (x - t[0]).norm()});
  const long double rounding = 0x1p-60L * size * size * size / n.norm();
  return std::min(best, std::max(0.0L, std::abs(n.dot(x - t[0])) / n.norm() - rounding));
}

/// Expects that both ends of the segment are on both triangles, and that the fast path and the
/// exact path differ by no more than triangle_intersection.h guarantees.
void expectSound(const Segment& s, const Triangle& a, const Transform& X_WA, const Triangle& b,
                 const Transform& X_WB) {
  const double scale = errorScale(a, X_WA, b, X_WB);
  for (const Vec3& end : {s.p, s.q}) {
    // The guaranteed bound is √3·2^-50. It is more than doubled here, for the rounding of long
    // double on badly shaped triangles.
    EXPECT_LE(distanceToTriangle(end, a, X_WA), 4 * 0x1p-50 * scale);
    EXPECT_LE(distanceToTriangle(end, b, X_WB), 4 * 0x1p-50 * scale);
  }
  const Segment exact = triangleIntersectionExact(a, X_WA, b, X_WB);
  const auto off = [](const Segment& u, const Segment& v) {
    return std::max((u.p - v.p).cwiseAbs().maxCoeff(), (u.q - v.q).cwiseAbs().maxCoeff());
  };
  EXPECT_LE(std::min(off(s, exact), off({s.q, s.p}, exact)), 0x1p-50 * scale);
}

TEST(Contacts, SharedWorkloadsAgainstBruteForce) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  std::size_t found = 0, points = 0;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    const ObbTree a(w.a), b(w.b);
    QueryContext context;
    const std::size_t step = std::max<std::size_t>(1, w.poses.size() / 20) * test::kSlowdown;
    const bool few = w.a.triangles.size() * w.b.triangles.size() < 40'000'000;
    for (std::size_t i = 0; i < w.poses.size(); i += step) {
      const Transform& X = w.poses[i];
      const auto all = contacts(Posed(a), Posed(b, X), context);
      Pairs pairs, mirrored;
      for (const TriangleContact& c : all) {
        pairs.insert({c.a, c.b});
        const Triangle ta = corners(w.a, c.a), tb = corners(w.b, c.b);
        expectSound({c.p_W, c.q_W}, ta, {}, tb, X);
        points += c.p_W == c.q_W;
      }
      EXPECT_EQ(pairs.size(), all.size()) << name << ": a pair came twice";
      EXPECT_EQ(pairs.empty(), w.hit[i] == 0) << name << " pose " << i;
      if (few) {
        EXPECT_EQ(pairs, test::bruteForcePairs(w.a, {}, w.b, X)) << name << " pose " << i;
      }
      for (const TriangleContact& c : contacts(Posed(b, X), Posed(a), context))
        mirrored.insert({c.b, c.a});
      EXPECT_EQ(mirrored, pairs) << name << " pose " << i;
      found += all.size();
    }
  }
  std::cout << found << " contacts, " << points << " of them points\n";
  EXPECT_GT(found, 3'000u / test::kSlowdown);
}

/// Expects that the triangles share the segment with the ends p and q (in any order), also if the
/// triangles are swapped.
void expectEnds(const Triangle& a, const Triangle& b, const Vec3& p, const Vec3& q) {
  for (const bool swapped : {false, true}) {
    const Segment s =
        swapped ? triangleIntersection(b, {}, a, {}) : triangleIntersection(a, {}, b, {});
    EXPECT_TRUE((s.p == p && s.q == q) || (s.p == q && s.q == p))
        << s.p.transpose() << " to " << s.q.transpose();
  }
}

TEST(TriangleIntersection, ClosedForms) {
  const Triangle flat{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  // Triangles that cross. Each triangle cuts the plane of the other in a segment. The shared
  // segment is one of these two segments, or a piece of both, or only a point.
  expectEnds(flat, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(3, 1, 1)}, {1, 1, 0}, {2, 1, 0});
  expectEnds(flat, {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(9, 1, 1)}, {1, 1, 0}, {3, 1, 0});
  expectEnds(flat, {Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(2, 1, 1)}, {1, 1, 0}, {1, 1, 0});
  // An edge in the plane of the other triangle; an edge that crosses a corner; corner on corner.
  expectEnds(flat, {Vec3(1, 1, 0), Vec3(9, 1, 0), Vec3(2, 1, 1)}, {1, 1, 0}, {3, 1, 0});
  expectEnds(flat, {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(-1, -1, 0)}, {0, 0, 0}, {0, 0, 0});
  expectEnds(flat, {Vec3(4, 0, 0), Vec3(5, 0, 1), Vec3(5, 1, 2)}, {4, 0, 0}, {4, 0, 0});
  // Both triangles in one plane: the same triangle, an overlap, a common edge, a common point.
  expectEnds(flat, flat, {4, 0, 0}, {0, 4, 0});
  expectEnds(flat, {Vec3(1, 1, 0), Vec3(-7, 1, 0), Vec3(1, -7, 0)}, {1, 0, 0}, {0, 1, 0});
  expectEnds(flat, {Vec3(1, 0, 0), Vec3(9, 0, 0), Vec3(1, -4, 0)}, {1, 0, 0}, {4, 0, 0});
  expectEnds(flat, {Vec3(0, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}, {0, 0, 0}, {0, 0, 0});
  // Triangles that degenerate to segments and points.
  expectEnds(flat, {Vec3(1, 1, 0), Vec3(9, 1, 0), Vec3(2, 1, 0)}, {1, 1, 0}, {3, 1, 0});
  expectEnds(flat, {Vec3(1, 1, 1), Vec3(1, 1, -1), Vec3(1, 1, -1)}, {1, 1, 0}, {1, 1, 0});
  expectEnds(flat, {Vec3(1, 2, 0), Vec3(1, 2, 0), Vec3(1, 2, 0)}, {1, 2, 0}, {1, 2, 0});
  expectEnds({Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(1, 0, 0)},
             {Vec3(3, 0, 0), Vec3(6, 0, 0), Vec3(9, 0, 0)}, {3, 0, 0}, {4, 0, 0});
}

/// Triangles that cross at a flat angle, far from the origin, and of sizes down to 2^-1000. In
/// these cases the fast path loses the most digits.
TEST(TriangleIntersection, IsRightToTheLastBitsAtAnyAngle) {
  std::mt19937_64 random(test::testSeed(7));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  int touching = 0, general = 0;
  for (int n = 0; n < 20'000 / test::kSlowdown; ++n) {
    const double flat = std::pow(10.0, -n % 18), offset = n % 5 == 0 ? 1e6 : 0;
    const double size = n % 7 == 0 ? 0x1p-300 : n % 11 == 0 ? 0x1p-1000 : 1;
    Triangle a, b;
    for (Triangle* t : {&a, &b})
      for (Vec3& p : *t) p = size * Vec3(real() + offset, real(), flat * real());
    Transform X_WA, X_WB;
    if (n % 2)
      for (Transform* X : {&X_WA, &X_WB}) {
        X->m = Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix();
        X->t = size * 0.3 * Vec3(real(), real(), real());
      }
    if (!trianglesTouchExact(a, X_WA, b, X_WB)) continue;
    const Segment s = triangleIntersection(a, X_WA, b, X_WB);
    if (size > 0x1p-900)
      expectSound(s, a, X_WA, b, X_WB);
    else  // squares of such numbers underflow in the test's own checks
      EXPECT_TRUE(s.p.allFinite() && s.q.allFinite());
    ++touching;
    general += s.p != s.q;
    ASSERT_FALSE(HasFailure()) << "case " << n;
  }
  EXPECT_GT(touching, 1'000 / test::kSlowdown);
  EXPECT_GT(general, touching / 2);
}

TEST(TriangleIntersection, SharedPairsOfTriangles) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  int touching = 0;
  for (const auto& [name, pairs] : test::sharedPairs(*data / "collision"))
    for (std::size_t n = 0; n < pairs.size(); n += test::kSlowdown) {
      const auto& [a, b, touch] = pairs[n];
      if (!touch) continue;
      const Segment s = triangleIntersection(a, {}, b, {}), t = triangleIntersection(b, {}, a, {});
      // Skips sizes at which squares underflow or overflow in the test's own checks.
      const double scale = errorScale(a, {}, b, {});
      if (scale > 0x1p-300 && scale < 0x1p300) expectSound(s, a, {}, b, {});
      const auto off = std::min((s.p - t.p).norm() + (s.q - t.q).norm(),
                                (s.p - t.q).norm() + (s.q - t.p).norm());
      EXPECT_LE(off, 8 * 0x1p-50 * scale) << name << " pair " << n;
      ++touching;
      ASSERT_FALSE(HasFailure()) << name << " pair " << n;
    }
  EXPECT_GT(touching, 5'000 / test::kSlowdown);
}

TEST(Contacts, UnderTwoMapsThatAreOnlyNearlyRigid) {
  std::mt19937_64 random(test::testSeed(13));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  std::size_t found = 0;
  for (int n = 0; n < 60; ++n) {
    TriangleMesh meshes[2];
    for (TriangleMesh& mesh : meshes)
      for (std::uint32_t i = 0; i < 60; i += 3) {
        const Vec3 c(real(), real(), real());
        for (int k = 0; k < 3; ++k) mesh.vertices.push_back(c + 0.6 * Vec3(real(), real(), real()));
        mesh.triangles.push_back({i, i + 1, i % 4 ? i + 2 : i + 1});
      }
    Transform maps[2];
    for (Transform& X : maps) {
      X.m = Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix() +
            std::pow(10.0, -3 * (1 + n % 4)) * Mat3::Random();
      X.t = Vec3(real(), real(), real()) + Vec3::Constant(n % 3 ? 0 : 1e5);
    }
    const ObbTree a(meshes[0]), b(meshes[1]);
    QueryContext context;
    Pairs pairs;
    for (const TriangleContact& c : contacts(Posed(a, maps[0]), Posed(b, maps[1]), context)) {
      pairs.insert({c.a, c.b});
      expectSound({c.p_W, c.q_W}, corners(meshes[0], c.a), maps[0], corners(meshes[1], c.b),
                  maps[1]);
    }
    EXPECT_EQ(pairs, test::bruteForcePairs(meshes[0], maps[0], meshes[1], maps[1])) << "case " << n;
    EXPECT_EQ(pairs.empty(), !interference(Posed(a, maps[0]), Posed(b, maps[1]), context))
        << "case " << n;
    found += pairs.size();
  }
  EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace corridor
