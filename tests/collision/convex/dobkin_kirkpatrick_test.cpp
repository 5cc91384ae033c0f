#include "collision/convex/dobkin_kirkpatrick.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <span>
#include <vector>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

using Rational = boost::multiprecision::cpp_rational;

/// Returns d·x, exactly.
Rational along(const Vec3& d, const Vec3& x) {
  Rational sum = 0;
  for (int k = 0; k < 3; ++k) sum += Rational(d[k]) * Rational(x[k]);
  return sum;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  Vec3 direction() {
    return Vec3(normal_(engine_), normal_(engine_), normal_(engine_)).normalized();
  }
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }
  Vec3 gridPoint(std::uint64_t n) {
    return Vec3::NullaryExpr([&] { return static_cast<double>(below(n)); });
  }
  double real() { return std::uniform_real_distribution(-1.0, 1.0)(engine_); }

  /// Makes point sets of many kinds: on a sphere, an ellipsoid, a grid (coplanar faces), a cone
  /// (one vertex with many neighbours), a paraboloid far from the origin, a nearly flat disc.
  std::vector<Vec3> points(std::size_t kind, std::size_t count) {
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 u = direction();
      const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(count);
      switch (kind % 6) {
        case 0:
          result.push_back(u);
          break;
        case 1:
          result.emplace_back(1000 * u[0], u[1], 0.001 * u[2]);
          break;
        case 2:
          result.push_back(gridPoint(6));
          break;
        case 3:
          result.emplace_back(std::cos(angle), std::sin(angle), i == 0 ? 5 : 0);
          break;
        case 4: {
          const double x = real(), y = real();
          result.emplace_back(1e6 + x, y - 1e6, x * x + y * y);
          break;
        }
        default:
          result.emplace_back(u[0], u[1], 1e-12 * u[2]);
      }
    }
    return result;
  }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

TEST(DobkinKirkpatrick, HierarchiesPassTheCheck) {
  Random random(test::testSeed(21));
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
  Random random(test::testSeed(22));
  const int sets = test::isStressRun() ? 1000 : 60 / test::kSlowdown + 6;
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
      Rational most = along(d, vertices[0]);
      for (const Vec3& v : vertices) most = std::max(most, along(d, v));
      ASSERT_EQ(along(d, vertices[found]), most) << "set " << n << " direction " << k;
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
  Random random(test::testSeed(23));
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
