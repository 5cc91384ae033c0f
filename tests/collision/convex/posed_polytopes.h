#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/polytope.h"
#include "tests/collision/convex/long_double_sets.h"

namespace corridor::test {

/// Makes polytopes and poses whose mapped vertices are doubles, without any rounding: coordinates
/// are multiples of 2^-10 below 4, rotations are rounded to multiples of 2^-34, and translations
/// are multiples of 2^-10. Therefore oracles that take points as doubles decide contact of the
/// posed polytopes exactly. Far from the origin, mapped vertices are exact only if the rotation
/// maps axes to axes.
class ExactPairs {
 public:
  explicit ExactPairs(std::uint64_t seed) : random_(seed) {}

  /// The kinds of polytopes: points on a sphere; points of a grid, with many coplanar faces; a box;
  /// a needle; a nearly flat polytope; a cone of many edges; a prism.
  static constexpr int kKinds = 7;
  Polytope polytope(int kind) {
    for (;;) {
      std::vector<Vec3> points;
      const int count = 4 + pick(12);
      for (int i = 0; i < count; ++i) {
        const Vec3 u = vector().normalized();
        switch (kind) {
          case 0:
            points.push_back(onGrid(u));
            break;
          case 1:
            points.emplace_back(pick(3) - 1, pick(3) - 1, pick(3) - 1);
            break;
          case 2:
            points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 0.5 : -0.5);
            break;
          case 3:
            points.push_back(onGrid(u.cwiseProduct(Vec3(3, 0.004, 0.004))));
            break;
          case 4:
            points.push_back(onGrid(u.cwiseProduct(Vec3(1, 1, 0.003))));
            break;
          case 5: {
            const double angle = 2 * std::numbers::pi * i / count;
            points.push_back(i == 0 ? Vec3(0, 0, 1)
                                    : onGrid(Vec3(std::cos(angle), std::sin(angle), 0)));
            break;
          }
          default: {
            const double angle = 4 * std::numbers::pi * (i / 2) / count;
            points.push_back(onGrid(Vec3(std::cos(angle), std::sin(angle), i % 2 ? 0.5 : -0.5)));
          }
        }
      }
      if (kind == 2 && count < 8) continue;
      try {
        return Polytope(points);
      } catch (const std::invalid_argument&) {  // all points are on one plane
      }
    }
  }

  /// Returns a pose. Half of the poses (or all, if `axesToAxes`) map axes to axes, with a
  /// translation on the coarse grid, so that many pairs touch. The other poses are random.
  Transform pose(double far, bool axesToAxes = false) {
    Transform X;
    if (axesToAxes || pick(2) == 0) {
      for (int turns = pick(24), k = 0; k < turns; ++k)
        X.m = X.m * (k % 2 ? Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX())
                           : Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()))
                        .toRotationMatrix();
      for (double& x : X.m.reshaped()) x = std::round(x);
      for (double& x : X.t) x = std::round(2 * far * real()) / 2;
    } else {
      X.m = Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix();
      for (double& x : X.m.reshaped()) x = std::ldexp(std::round(std::ldexp(x, 34)), -34);
      X.t = onGrid(far * vector());
    }
    return X;
  }

  double real() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vec3 vector() { return {real(), real(), real()}; }
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

 private:
  static Vec3 onGrid(const Vec3& p) {
    return p.unaryExpr([](double x) { return std::ldexp(std::round(std::ldexp(x, 10)), -10); });
  }

  std::mt19937_64 random_;
};

inline std::vector<Vec3> mapped(const Polytope& polytope, const Transform& X) {
  std::vector<Vec3> points;
  for (const Vec3& p : polytope.vertices()) points.push_back(X * p);
  return points;
}
inline Vec3L mappedL(const Transform& X, const Vec3& p) {
  return X.m.cast<long double>() * p.cast<long double>() + X.t.cast<long double>();
}

/// Returns the distance of two segments in long double. It is the least of these distances: of each
/// end from the other segment, and of the two lines if their closest points are inside the
/// segments.
inline long double betweenSegments(const Vec3L& a, const Vec3L& b, const Vec3L& c, const Vec3L& d) {
  long double best =
      std::min({toSegment(a, c, d), toSegment(b, c, d), toSegment(c, a, b), toSegment(d, a, b)});
  const Vec3L u = b - a, v = d - c, n = u.cross(v), r = c - a;
  const long double square = n.squaredNorm();
  if (!(square > 0)) return best;
  const long double s = r.cross(v).dot(n) / square, t = r.cross(u).dot(n) / square;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
    best = std::min(best, std::abs(n.dot(r)) / std::sqrt(square));
  return best;
}

/// Returns the distance of two disjoint features. Each is given by its one to three corners: it is
/// a vertex, an edge or a triangle.
inline long double betweenFeatures(const std::vector<Vec3L>& p, const std::vector<Vec3L>& q) {
  long double best = HUGE_VALL;
  const auto toFeature = [](const Vec3L& x, const std::vector<Vec3L>& f) {
    return f.size() == 3   ? toTriangle(x, f[0], f[1], f[2])
           : f.size() == 2 ? toSegment(x, f[0], f[1])
                           : (x - f[0]).norm();
  };
  for (const Vec3L& x : p) best = std::min(best, toFeature(x, q));
  for (const Vec3L& x : q) best = std::min(best, toFeature(x, p));
  for (std::size_t i = 0; p.size() > 1 && i < p.size(); ++i)
    for (std::size_t k = 0; q.size() > 1 && k < q.size(); ++k)
      best =
          std::min(best, betweenSegments(p[i], p[(i + 1) % p.size()], q[k], q[(k + 1) % q.size()]));
  return best;
}

/// Returns the distance of two disjoint polytopes: the least distance over all pairs of faces.
inline long double betweenPolytopes(const Polytope& a, const Transform& X_WA, const Polytope& b,
                                    const Transform& X_WB) {
  long double best = HUGE_VALL;
  const auto triangles = [](const Polytope& p, const Transform& X) {
    std::vector<std::vector<Vec3L>> all;
    for (const Polytope::Face& f : p.faces())
      all.push_back({mappedL(X, p.vertices()[f[0]]), mappedL(X, p.vertices()[f[1]]),
                     mappedL(X, p.vertices()[f[2]])});
    return all;
  };
  const auto facesB = triangles(b, X_WB);
  for (const auto& f : triangles(a, X_WA))
    for (const auto& g : facesB) best = std::min(best, betweenFeatures(f, g));
  return best;
}

}  // namespace corridor::test
