#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "collision/course/separating_plane.h"
#include "tests/support/rational_program.h"

namespace corridor::test {

template <int D>
using Points = std::vector<Eigen::Matrix<double, D, 1>>;

/// Returns the relation of two convex hulls, by the rational simplex method, which shares no code
/// with Corridor.
/// * The points are p_i in the first set and q_j in the second. The hulls share a point if Σ λ_i
///   p_i = Σ μ_j q_j, Σ λ_i = Σ μ_j = 1 has a solution with all λ_i ≥ 0 and all μ_j ≥ 0.
/// * No plane separates the hulls, not even one that touches them, if the rows (p_i, −1) and (−q_j,
///   1) span all of space with weights ≥ 0: that is, if the rows have full rank, and Σ w_i row_i =
///   0 has a solution with all w_i ≥ 1.
template <int D>
HullRelation hullRelation(const Points<D>& first, const Points<D>& second) {
  std::vector<std::vector<double>> meet, rows;
  for (const bool isFirst : {true, false})
    for (const auto& p : isFirst ? first : second) {
      const double s = isFirst ? 1 : -1;
      std::vector<double> column, row;
      for (int k = 0; k < D; ++k) column.push_back(s * p[k]);
      row = column;
      column.insert(column.end(), {isFirst ? 1.0 : 0.0, isFirst ? 0.0 : 1.0});
      row.push_back(-s);
      meet.push_back(column);
      rows.push_back(row);
    }
  std::vector<double> right(D + 2, 0.0);
  right[D] = right[D + 1] = 1;
  if (!hasSolution(meet, right)) return HullRelation::disjoint;
  if (rankOf(rows) < D + 1) return HullRelation::touching;
  // w_i = 1 + v_i with v ≥ 0. A sum of all rows in doubles would not be exact. So each row occurs
  // twice: once with the weight v_i, and once with a weight that an additional equation sets to 1.
  const std::size_t count = rows.size();
  std::vector<std::vector<double>> all = rows;
  all.insert(all.end(), rows.begin(), rows.end());
  std::vector<double> zero(D + 1 + count, 0.0);
  for (auto& row : all) row.resize(D + 1 + count, 0.0);
  for (std::size_t i = 0; i < count; ++i) all[count + i][D + 1 + i] = zero[D + 1 + i] = 1;
  return hasSolution(all, zero) ? HullRelation::overlapping : HullRelation::touching;
}

/// Makes pairs of point sets, of four kinds, which are equally frequent: random points; points of a
/// small grid, where sets often touch and points are often coplanar; sets that share some points,
/// the other points being mostly on opposite sides of a plane; needles and nearly flat sets. Half
/// of all pairs are moved away from the origin by up to 10^6, in steps of the grid, so that
/// touching sets still touch.
template <int D>
class HullPairs {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  explicit HullPairs(std::uint64_t seed) : random_(seed) {}

  std::pair<Points<D>, Points<D>> next() {
    const std::uint64_t n = count_++;
    Points<D> p, q;
    const std::size_t np = 1 + random_() % 7, nq = 1 + random_() % 7;
    switch (n % 4) {
      case 0: {
        const Point away = Point::NullaryExpr([&] { return real() * 1.5; });
        for (std::size_t i = 0; i < np; ++i) p.push_back(point());
        for (std::size_t i = 0; i < nq; ++i) q.push_back(point() + away);
        break;
      }
      case 1:
        for (std::size_t i = 0; i < np; ++i) p.push_back(gridPoint());
        for (std::size_t i = 0; i < nq; ++i) q.push_back(gridPoint());
        break;
      case 2: {  // shared points; the other points are on the two sides of a plane through 0
        const std::size_t shared = 1 + random_() % D;
        const Point normal = gridPoint();
        for (std::size_t i = 0; i < shared; ++i) {
          p.push_back(gridPoint());
          if (random_() % 2) q.push_back(p.back());
        }
        for (std::size_t i = 0; i < np; ++i) p.push_back(side(normal, 1));
        for (std::size_t i = 0; i < nq; ++i) q.push_back(side(normal, random_() % 4 ? -1 : 1));
        break;
      }
      default: {  // nearly flat, or needles
        Point size = Point::Ones();
        for (int k = 0; k < D; ++k)
          if (random_() % 2) size[k] = std::ldexp(1.0, -static_cast<int>(random_() % 50));
        for (std::size_t i = 0; i < np; ++i) p.push_back(point().cwiseProduct(size));
        for (std::size_t i = 0; i < nq; ++i) q.push_back(point().cwiseProduct(size));
      }
    }
    if (random_() % 2) {
      const Point away = Point::NullaryExpr([&] { return std::floor(real() * 1e6); });
      for (Point& x : p) x += away;
      for (Point& x : q) x += away;
    }
    return {p, q};
  }

 private:
  double real() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Point point() {
    return Point::NullaryExpr([&] { return real(); });
  }
  Point gridPoint() {
    return Point::NullaryExpr([&] { return static_cast<double>(random_() % 5) - 2; });
  }
  /// Returns a grid point x with s·(normal·x) ≥ 0: a point on one side of the plane through the
  /// origin with this normal, or on the plane. @pre s is 1 or −1.
  Point side(const Point& normal, double s) {
    const Point x = gridPoint();
    return s * normal.dot(x) < 0 ? Point(-x) : x;
  }

  std::mt19937_64 random_;
  std::uint64_t count_ = 0;
};

}  // namespace corridor::test
