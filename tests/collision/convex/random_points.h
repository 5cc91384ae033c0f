#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "collision/core/transform.h"

namespace corridor::test {

/// Returns a·b, exactly.
inline boost::multiprecision::cpp_rational exactDot(const Vec3& a, const Vec3& b) {
  boost::multiprecision::cpp_rational sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += boost::multiprecision::cpp_rational(a[k]) * boost::multiprecision::cpp_rational(b[k]);
  return sum;
}

/// Random numbers, directions and sets of points.
class RandomPoints {
 public:
  explicit RandomPoints(std::uint64_t seed) : engine_(seed) {}
  Vec3 direction() {
    return Vec3(normal_(engine_), normal_(engine_), normal_(engine_)).normalized();
  }
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }
  Vec3 gridPoint(std::uint64_t n) {
    return Vec3::NullaryExpr([&] { return static_cast<double>(below(n)); });
  }
  double real() { return std::uniform_real_distribution(-1.0, 1.0)(engine_); }

  std::vector<Vec3> onSphere(std::size_t count) {
    std::vector<Vec3> points(count);
    for (Vec3& p : points) p = direction();
    return points;
  }

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

}  // namespace corridor::test
