#include "collision/course/dobkin_kirkpatrick.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/collision/convex/random_points.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using test::exactDot;
using test::RandomPoints;

TEST(DobkinKirkpatrick, HierarchiesPassTheCheck) {
  RandomPoints random(test::testSeed(21));
  for (std::size_t kind = 0; kind < 6; ++kind)
    for (const std::size_t count : {5u, 8u, 30u, 500u, 5000u / test::kSlowdown}) {
      std::vector<Vec3> points = random.points(kind, count);
      points.push_back({0, 0, -2});  // so that the points of no kind are flat
      points.push_back({1, 0, -3});
      const DobkinKirkpatrick hierarchy{Polytope(points)};
      EXPECT_EQ(hierarchy.check(), std::nullopt) << "kind " << kind << ", " << count << " points";
      const double n = static_cast<double>(hierarchy.polytope().vertices().size());
      // Each level keeps at most 19/20 of the vertices.
      EXPECT_LE(static_cast<double>(hierarchy.levels()), 2 + std::log(n) / std::log(20.0 / 19))
          << "kind " << kind;
    }
}

TEST(DobkinKirkpatrick, ExtremeVerticesAreExact) {
  RandomPoints random(test::testSeed(22));
  const int sets = test::casesOf(45, 1'000);
  std::size_t queries = 0, climbed = 0;
  for (int n = 0; n < sets; ++n) {
    std::vector<Vec3> points =
        random.points(static_cast<std::size_t>(n), 4 + random.below(n % 10 == 0 ? 500 : 40));
    points.push_back({0, 0, -2});
    points.push_back({1, 0, -3});
    const DobkinKirkpatrick hierarchy{Polytope(points)};
    const auto vertices = hierarchy.polytope().vertices();
    for (int k = 0; k < 60; ++k) {
      Vec3 d = random.direction();
      if (k % 6 == 1) d = Vec3(Vec3::Unit(k / 6 % 3)) * (k % 4 ? 1 : -1);
      if (k % 6 == 2) {  // the rounded normal of a face, or a direction near it
        const auto& face =
            hierarchy.polytope().faces()[random.below(hierarchy.polytope().faces().size())];
        d = (vertices[face[1]] - vertices[face[0]]).cross(vertices[face[2]] - vertices[face[0]]);
        if (k % 4 == 0) d[0] = std::nextafter(d[0], 1e9);
      }
      if (k % 6 == 3) d *= std::ldexp(1.0, k % 4 ? 600 : -600);
      if (k % 6 == 4) d[static_cast<int>(random.below(3))] *= 1e-17;
      if (k % 6 == 5) d = random.gridPoint(3);
      DobkinKirkpatrick::Cost cost;
      const std::uint32_t found = hierarchy.extreme(d, &cost);
      Rational most = exactDot(d, vertices[0]);
      for (const Vec3& v : vertices) most = std::max(most, exactDot(d, v));
      ASSERT_EQ(exactDot(d, vertices[found]), most) << "set " << n << " direction " << k;
      ++queries;
      climbed += cost.climbs > 0;
    }
  }
  std::cout << queries << " queries; rounding led astray in " << climbed << "\n";
  EXPECT_LT(climbed, queries / 20);
}

/// The number of operations grows like the logarithm of the number of vertices, even if a vertex
/// has many neighbours.
TEST(DobkinKirkpatrick, QueriesTakeLogarithmicTime) {
  RandomPoints random(test::testSeed(23));
  for (const std::size_t kind : {0u, 3u, 4u})
    for (const std::size_t count : {100u, 1000u, 10'000u, 40'000u / test::kSlowdown}) {
      std::vector<Vec3> points = random.points(kind, count);
      if (kind == 4) points.push_back({1e6, -1e6, 100});
      if (kind == 3) points.push_back({0, 0, -1});
      const DobkinKirkpatrick hierarchy{Polytope(points)};
      std::size_t most = 0, sum = 0;
      for (int k = 0; k < 200; ++k) {
        DobkinKirkpatrick::Cost cost;
        hierarchy.extreme(random.direction(), &cost);
        most = std::max(most, cost.products);
        sum += cost.products;
      }
      std::cout << "kind " << kind << ", " << count << " points: " << hierarchy.levels()
                << " levels, products: mean " << sum / 200 << ", most " << most << "\n";
      // A level costs at most 4 products for new vertices, then 16 for a ring.
      EXPECT_LE(most, 20 * hierarchy.levels() + 20);
      EXPECT_LE(hierarchy.bytes(), 300 * hierarchy.polytope().vertices().size());
    }
}

}  // namespace
}  // namespace corridor
