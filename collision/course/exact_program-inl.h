#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "collision/convex/rational-inl.h"
#include "collision/convex/seidel-inl.h"
#include "collision/core/rounding.h"

/// Linear programs in few variables, first in double, then in rationals: the engine of
/// linear_program.h and separating_plane.h. A linear program is given by a function `row` of type
/// `Rows`. row(i) returns half-space i in doubles, with `name` = i.
namespace corridor::seidel {

template <std::size_t M>
using Row = HalfSpace<double, M>;

/// A candidate: the best point in double, and the rows and bounds that are tight at this point.
/// Names below `count` are names of rows. The bounds have the names from `count` on.
template <std::size_t M>
struct Candidate {
  Point<double, M> x{};
  Tight<M> tight;
};

/// Runs Seidel's algorithm in double, in random order, on the rows and the bounds |x_i| ≤ reach.
template <std::size_t M, class Rows>
Candidate<M> candidate(std::size_t count, const Rows& row, const Point<double, M>& goal,
                       double reach, std::uint64_t seed) {
  std::vector<Row<M>> list(count);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::mt19937_64 random(seed);
  // Not std::shuffle: its order depends on the standard library.
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  for (std::size_t i = 0; i < count; ++i) list[i] = row(order[i]);
  Bounds<double, M> bounds;
  bounds.reach.fill(reach);
  for (std::size_t i = 0; i < M; ++i) bounds.name[i] = static_cast<std::uint32_t>(count + i);
  Candidate<M> found;
  HeapMemory<double, M - 1> memory;
  solve<double, M>(bounds, std::span<const Row<M>>(list), goal, found.x, found.tight, memory);
  return found;
}

/// Computes the sign of normal·x − offset for rows and one rational point x.
template <std::size_t M>
class Side {
 public:
  explicit Side(const Point<Rational, M>& x) : x_(x) {
    for (std::size_t i = 0; i < M; ++i) rough_[i] = static_cast<double>(x[i]);
  }
  /// Returns normal·x − offset for one row. The sign is exact; the magnitude is rounded.
  ///
  /// Rounding in double: each coordinate is off by at most 2u of itself, each product by 1u more,
  /// and each of the M sums by 1u of all terms: (M + 3)u of the sum of magnitudes. For each
  /// coordinate and each product, underflow adds at most 2^-1022 times the larger of 1 and the
  /// largest entry.
  double operator()(const Row<M>& row) const {
    double sum = -row.offset, size = std::abs(row.offset), largest = 1;
    for (std::size_t i = 0; i < M; ++i) {
      const double term = row.normal[i] * rough_[i];
      sum += term;
      size += std::abs(term);
      largest = std::max(largest, std::abs(row.normal[i]));
    }
    const double error = (M + 8) * kUnit * size + static_cast<double>(M + 1) * 0x1p-1020 * largest;
    if (std::abs(sum) > error) return sum;
    Rational value = -rational(row.offset);
    for (std::size_t i = 0; i < M; ++i) value += rational(row.normal[i]) * x_[i];
    if (value == 0) return 0;
    const double rough = std::abs(sum), least = std::numeric_limits<double>::min();
    return (value > 0 ? 1 : -1) * (rough > least ? rough : least);  // `rough` may be NaN
  }

 private:
  const Point<Rational, M>& x_;
  Point<double, M> rough_;
};

/// A determinant in double, and the sum of the magnitudes of its terms.
struct Determinant {
  double value = 1, size = 1;
};
template <std::size_t M>
Determinant determinant(const std::array<Point<double, M>, M>& columns) {
  if constexpr (M == 1) {
    return {columns[0][0], std::abs(columns[0][0])};
  } else {
    Determinant sum{0, 0};
    for (std::size_t j = 0; j < M; ++j) {
      if (columns[j][0] == 0) continue;
      std::array<Point<double, M - 1>, M - 1> minor;
      for (std::size_t k = 0, to = 0; k < M; ++k)
        if (k != j) minor[to++] = without(columns[k], 0);
      const Determinant below = determinant<M - 1>(minor);
      sum.value += (j % 2 ? -columns[j][0] : columns[j][0]) * below.value;
      sum.size += std::abs(columns[j][0]) * below.size;
    }
    return sum;
  }
}

/// Returns the weights w with Σ w_j normal_j = goal, if they are proved to be above 0. Otherwise
/// returns nothing.
///
/// By Cramer's rule the signs are those of determinants of M ≤ 7 rows. Each term of a determinant
/// has at most M − 1 roundings of products and M(M − 1)/2 of sums. 2u more of the sum of the terms'
/// magnitudes covers the rounding of that sum, and of the bound. Entries are 0 or within 2^±60, so
/// nothing underflows.
template <std::size_t M>
std::optional<Point<double, M>> provedWeights(const std::array<Point<double, M>, M>& normals,
                                              const Point<double, M>& goal) {
  static_assert(M <= 7);
  constexpr double kError = (static_cast<double>((M + 2) * (M - 1)) / 2 + 2) * kUnit;
  const auto usual = [](const Point<double, M>& p) {
    return std::all_of(p.begin(), p.end(), [](double x) {
      return x == 0 || (std::abs(x) > 0x1p-60 && std::abs(x) < 0x1p60);
    });
  };
  if (!usual(goal) || !std::all_of(normals.begin(), normals.end(), usual)) return std::nullopt;
  const auto sure = [](const Determinant& d) { return std::abs(d.value) > kError * d.size; };
  const Determinant all = determinant<M>(normals);
  if (!sure(all)) return std::nullopt;
  Point<double, M> weights;
  for (std::size_t j = 0; j < M; ++j) {
    std::array<Point<double, M>, M> columns = normals;
    columns[j] = goal;
    const Determinant d = determinant<M>(columns);
    weights[j] = d.value / all.value;
    if (!sure(d) || !(weights[j] > 0)) return std::nullopt;
  }
  return weights;
}

/// The optimum of a linear program that has one, in rationals.
template <std::size_t M>
struct Optimum {
  Point<Rational, M> x;
  Rational value;  ///< goal·x
  /// The rows that prove the optimum, with their weights, which are above 0. The weighted sum of
  /// their normals is the goal. Bounds may also be part of this sum, but are not listed.
  std::vector<std::pair<std::uint32_t, Rational>> weights;
  bool atBounds = false;  ///< a bound is part of the sum, with a weight above 0
};

/// Solves A w = r for an invertible M × M matrix A. `a` holds the columns of A.
template <std::size_t M>
Point<Rational, M> weightsOf(std::array<Point<Rational, M>, M> a, Point<Rational, M> r) {
  // Row i of the system is (a[0][i], …, a[M−1][i] | r[i]).
  for (std::size_t c = 0; c < M; ++c) {
    std::size_t pivot = c;
    while (pivot + 1 < M && a[c][pivot] == 0) ++pivot;
    for (std::size_t j = 0; j < M; ++j) std::swap(a[j][c], a[j][pivot]);
    std::swap(r[c], r[pivot]);
    for (std::size_t i = 0; i < M; ++i) {
      if (i == c || a[c][i] == 0) continue;
      const Rational factor = a[c][i] / a[c][c];
      for (std::size_t j = c; j < M; ++j) a[j][i] -= factor * a[j][c];
      r[i] -= factor * r[c];
    }
  }
  Point<Rational, M> w;
  for (std::size_t i = 0; i < M; ++i) w[i] = r[i] / a[i][i];
  return w;
}

/// Solves a linear program exactly. Begins with the rows that are tight at a candidate, and adds
/// the row that the result violates most, until the result violates no row.
/// @pre some point satisfies all rows and bounds.
template <std::size_t M, class Rows>
Optimum<M> exactOptimum(std::size_t count, const Rows& row, const Point<Rational, M>& goal,
                        const Rational& reach, const Tight<M>& start) {
  const auto exactRow = [&](std::uint32_t i) {
    const Row<M> rounded = row(i);
    HalfSpace<Rational, M> exact{{}, rational(rounded.offset), i};
    for (std::size_t k = 0; k < M; ++k) exact.normal[k] = rational(rounded.normal[k]);
    return exact;
  };
  std::vector<HalfSpace<Rational, M>> rows;
  for (std::size_t i = 0; i < start.count; ++i)
    if (start.name[i] < count) rows.push_back(exactRow(start.name[i]));
  Bounds<Rational, M> bounds;
  bounds.reach.fill(reach);
  for (std::size_t i = 0; i < M; ++i) bounds.name[i] = static_cast<std::uint32_t>(count + i);
  Optimum<M> best;
  Tight<M> tight;
  HeapMemory<Rational, M - 1> memory;
  for (;;) {
    solve<Rational, M>(bounds, std::span<const HalfSpace<Rational, M>>(rows), goal, best.x, tight,
                       memory);
    const Side<M> side(best.x);
    double most = 0;
    std::uint32_t worst = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double outside = side(row(i));
      if (outside > most) most = outside, worst = i;
    }
    if (!(most > 0)) break;
    for (const HalfSpace<Rational, M>& each : rows)
      if (each.name == worst)
        throw std::logic_error("an exact linear program violates its own row");
    rows.push_back(exactRow(worst));
  }
  best.value = dot(goal, best.x);
  std::array<Point<Rational, M>, M> normals;
  for (std::size_t i = 0; i < M; ++i) {
    if (tight.name[i] < count) {
      normals[i] = exactRow(tight.name[i]).normal;
    } else {
      const std::size_t k = tight.name[i] - count;
      normals[i] = {};
      normals[i][k] = best.x[k] < 0 ? -1 : 1;
    }
  }
  const Point<Rational, M> w = weightsOf(normals, goal);
  for (std::size_t i = 0; i < M; ++i) {
    if (w[i] == 0) continue;
    if (tight.name[i] < count)
      best.weights.emplace_back(tight.name[i], w[i]);
    else
      best.atBounds = true;
  }
  return best;
}

}  // namespace corridor::seidel
