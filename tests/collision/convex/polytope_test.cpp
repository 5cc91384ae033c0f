#include "collision/convex/polytope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/collision/convex/hull_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Returns a point set of one of several kinds: on a sphere, in a box, on a small grid (with
/// coplanar and equal points), on a cylinder, nearly flat, or far away.
std::vector<Vec3> points(std::mt19937_64& random, int kind, std::size_t count) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> real(-1, 1);
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    switch (kind % 6) {
      case 0:
        result.push_back(direction);
        break;
      case 1:
        result.emplace_back(real(random), real(random), real(random));
        break;
      case 2:
        result.emplace_back(random() % 4, random() % 4, random() % 4);
        break;
      case 3: {
        const double angle = 2 * M_PI * static_cast<double>(random() % 12) / 12;
        result.emplace_back(std::cos(angle), std::sin(angle), static_cast<double>(random() % 3));
        break;
      }
      case 4:
        result.emplace_back(direction.x(), direction.y(), 1e-15 * direction.z());
        break;
      default:
        result.push_back(direction + Vec3(1e6, -2e6, 3e6));
    }
  }
  return result;
}

/// Compares the vertices with the rational simplex method: a point is a vertex if it is not in the
/// hull of the points that differ from it.
TEST(Polytope, VerticesAreTheExtremePoints) {
  std::mt19937_64 random(test::testSeed(11));
  const int sets = test::isStressRun() ? 3000 : 120 / test::kSlowdown + 6;
  int built = 0, vertices = 0;
  for (int n = 0; n < sets; ++n) {
    const std::vector<Vec3> all = points(random, n, 4 + random() % 20);
    std::optional<Polytope> hull;
    try {
      hull.emplace(all);
    } catch (const std::invalid_argument&) {
      // The points must all lie in one plane.
      std::vector<std::vector<double>> rows;
      for (const Vec3& p : all) rows.push_back({p[0], p[1], p[2], 1});
      EXPECT_LT(test::rankOf(rows), 4u) << "set " << n;
      continue;
    }
    ++built;
    ASSERT_EQ(hull->check(), std::nullopt) << "set " << n;
    std::vector<bool> isVertex(all.size(), false);
    for (std::size_t i = 0; i < hull->vertices().size(); ++i) {
      EXPECT_EQ(hull->vertices()[i], all[hull->source(i)]);
      isVertex[hull->source(i)] = true;
    }
    vertices += static_cast<int>(hull->vertices().size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::vector<Vec3> others;
      bool earlier = false;
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (all[k] != all[i]) others.push_back(all[k]);
        earlier = earlier || (all[k] == all[i] && isVertex[k]);
      }
      const bool extreme = test::hullRelation<3>({all[i]}, others) == HullRelation::disjoint;
      EXPECT_EQ(earlier, extreme) << "set " << n << " point " << i;
    }
  }
  std::cout << built << " polytopes, " << vertices << " vertices\n";
  EXPECT_GT(built, sets / 2);
}

TEST(Polytope, LargeSetsPassTheCheck) {
  std::mt19937_64 random(test::testSeed(12));
  for (int kind = 0; kind < 6; ++kind) {
    const Polytope hull(points(random, kind, 20'000 / test::kSlowdown));
    EXPECT_EQ(hull.check(), std::nullopt) << "kind " << kind;
    if (kind == 0) {
      EXPECT_EQ(hull.vertices().size(), 20'000u / test::kSlowdown);
    }
    if (kind == 2) {
      EXPECT_EQ(hull.vertices().size(), 8u);
    }
    if (kind == 3) {
      EXPECT_EQ(hull.vertices().size(), 24u);
    }
  }
}

TEST(Polytope, WrongBoundariesAreFound) {
  using Faces = std::vector<Polytope::Face>;
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Faces tetrahedron = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  EXPECT_EQ(checkConvexBoundary(corners, tetrahedron), std::nullopt);
  Faces wrong = tetrahedron;
  std::swap(wrong[0][0], wrong[0][1]);
  EXPECT_NE(checkConvexBoundary(corners, wrong), std::nullopt) << "a flipped face";
  wrong = tetrahedron;
  wrong.pop_back();
  EXPECT_NE(checkConvexBoundary(corners, wrong), std::nullopt) << "a missing face";
  wrong = tetrahedron;
  for (Polytope::Face& face : wrong) std::swap(face[0], face[1]);
  EXPECT_NE(checkConvexBoundary(corners, wrong), std::nullopt) << "inside out";
  std::vector<Vec3> dented = corners;
  dented.push_back({0.2, 0.2, 0.2});
  EXPECT_NE(checkConvexBoundary(
                dented, Faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}}),
            std::nullopt)
      << "a dent";
  dented.back() = {0.25, 0.25, 0.5};  // on the face
  EXPECT_NE(checkConvexBoundary(
                dented, Faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}}),
            std::nullopt)
      << "a vertex that is not extreme";
  // The bipyramid over a pentagram: every edge is convex, but its apexes wind around twice.
  std::vector<Vec3> star = {{0, 0, 1}, {0, 0, -1}};
  Faces faces;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const double angle = 4 * M_PI * i / 5;
    star.emplace_back(std::cos(angle), std::sin(angle), 0);
    faces.push_back({0, 2 + i, 2 + (i + 1) % 5});
    faces.push_back({1, 2 + (i + 1) % 5, 2 + i});
  }
  EXPECT_NE(checkConvexBoundary(star, faces), std::nullopt) << "a pentagram";
}

/// Boundaries whose apexes have neighbours on one line with the apex: in both, every edge is
/// convex, and the faces of the apexes go around them twice.
TEST(Polytope, FacesThatGoAroundTwiceAreFound) {
  const Vec3 a(8, 0, 0), b(-4, 8, 0), c(-4, -8, 0), v(0, 0, 8), w(0, 0, -8);
  std::vector<Polytope::Face> faces;
  const auto join = [&](const std::array<std::uint32_t, 6>& top,
                        const std::array<std::uint32_t, 6>& bottom, std::uint32_t iv,
                        std::uint32_t iw) {
    faces.clear();
    for (std::size_t i = 0; i < 6; ++i) {
      faces.push_back({iv, top[i], top[(i + 1) % 6]});
      faces.push_back({iw, bottom[(i + 1) % 6], bottom[i]});
    }
  };
  // A bipyramid over a triangle that is passed twice.
  join({0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 5}, 6, 7);
  EXPECT_NE(checkConvexBoundary(std::vector<Vec3>{a, b, c, a, b, c, v, w}, faces), std::nullopt);
  // The second time, by the middles of the edges at the apexes.
  const auto middle = [](const Vec3& p, const Vec3& q) { return Vec3(0.5 * (p + q)); };
  const std::vector<Vec3> points{
      a, b, c, middle(v, a), middle(v, b), middle(v, c), middle(w, a), middle(w, b), middle(w, c),
      v, w};
  join({0, 1, 2, 3, 4, 5}, {0, 1, 2, 6, 7, 8}, 9, 10);
  for (const Polytope::Face& face :
       {Polytope::Face{2, 6, 3}, {3, 6, 7}, {3, 7, 4}, {4, 7, 8}, {4, 8, 5}, {5, 8, 0}})
    faces.push_back(face);
  EXPECT_NE(checkConvexBoundary(points, faces), std::nullopt);
}

/// The bipyramid over a circle of many corners with a tiny loop inside it, near one corner: every
/// edge is convex. The apexes wind around twice, but only a few of their neighbours show it.
TEST(Polytope, ATinyLoopOfTheBoundaryIsFound) {
  constexpr std::uint32_t kCorners = 1000;
  constexpr double kLoop = 1e-4;  // the loop's radius
  const auto bipyramid = [&](bool loop, std::uint32_t from) {
    std::vector<Vec3> ring;
    for (std::uint32_t i = 1; i < kCorners; ++i) {
      const double angle = 2 * M_PI * i / kCorners;
      ring.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    ring.emplace_back(1, 0, 0);
    if (loop)
      for (const double y : {0.866, -0.866}) ring.emplace_back(1 - 1.5 * kLoop, y * kLoop, 0);
    std::rotate(ring.begin(), ring.begin() + from, ring.end());
    const double x = 1 - 1.49 * kLoop;  // inside the loop
    std::vector<Vec3> points = ring;
    points.emplace_back(x, 0, 1);
    points.emplace_back(x, 0, -1);
    const auto n = static_cast<std::uint32_t>(ring.size());
    std::vector<Polytope::Face> faces;
    for (std::uint32_t i = 0; i < n; ++i) {
      faces.push_back({n, i, (i + 1) % n});
      faces.push_back({n + 1, (i + 1) % n, i});
    }
    return checkConvexBoundary(points, faces);
  };
  EXPECT_EQ(bipyramid(false, 0), std::nullopt);
  // The check may begin at any neighbour of an apex, also at a neighbour on the loop.
  for (std::uint32_t from = 0; from<kCorners; from += from> 20 && from < 980 ? 37 : 1) {
    const auto wrong = bipyramid(true, from);
    ASSERT_TRUE(wrong) << from;
    ASSERT_NE(wrong->find(" are not convex"), wrong->npos) << from << ": " << *wrong;
  }
}

TEST(Polytope, NeighboursShareEdges) {
  const Polytope cube(std::vector<Vec3>{
      {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}});
  EXPECT_EQ(cube.faces().size(), 12u);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Polytope::Face& face : cube.faces())
    for (int k = 0; k < 3; ++k) edges.insert({face[k], face[(k + 1) % 3]});
  EXPECT_EQ(edges.size(), 36u);
  std::size_t pairs = 0;
  for (std::uint32_t v = 0; v < 8; ++v)
    for (const std::uint32_t w : cube.neighbours(v)) {
      EXPECT_TRUE(edges.contains({v, w}));
      ++pairs;
    }
  EXPECT_EQ(pairs, 36u);
}

TEST(Polytope, FlatAndInvalidSetsAreRefused) {
  const auto build = [](const std::vector<Vec3>& p) { return Polytope(p).vertices().size(); };
  EXPECT_THROW(build({}), std::invalid_argument);
  EXPECT_THROW(build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), std::invalid_argument);
  EXPECT_THROW(build({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {3, 4, 1}, {2, 2, 1}}),
               std::invalid_argument);
  EXPECT_THROW(build({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), std::invalid_argument);
  EXPECT_THROW(build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}),
               std::invalid_argument);
  // A fourth point that is one unit in the last place off the plane is enough.
  EXPECT_EQ(build({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, std::nextafter(1.0, 2.0)}}), 4u);
}

}  // namespace
}  // namespace corridor
