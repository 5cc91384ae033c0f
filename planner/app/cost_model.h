#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/LU>

#include "collision/core/transform.h"

/// T = N_v·C_v + N_p·C_p (Gottschalk, Lin, Manocha 1996, eq. 1): what queries cost, told from
/// counts.
namespace corridor::app {

/// What a query did and how long it took.
struct QueryCost {
  double boxTests = 0, triangleTests = 0;  ///< N_v, N_p
  double ns = 0;                           ///< T, above 0
};

/// Nanoseconds that a test takes within a query: with its share of walking the trees.
struct CostModel {
  double call = 0;               ///< what a query takes before its first test: not in the model
  double box = 0, triangle = 0;  ///< C_v, C_p
  double predicted(const QueryCost& c) const {
    return c.boxTests * box + c.triangleTests * triangle;
  }
};

/// The costs ≥ 0 that these queries bear out best: least squares of the errors, each over √T, since
/// what is a sum of many tests varies so. (Weighed alike, the few longest queries would tell all;
/// relative to T, the shortest.) A cost that the counts don't tell from the others is 0: where all
/// queries have the same counts, box tests take it all. @pre not empty.
inline CostModel fittedCosts(const std::vector<QueryCost>& queries) {
  // Normal equations of Σ (N_v·C_v + N_p·C_p + call − T)²/T.
  Mat3 squares = Mat3::Zero();
  Vec3 products = Vec3::Zero();
  double total = 0;
  for (const QueryCost& c : queries) {
    const Vec3 counts(c.boxTests, c.triangleTests, 1);
    squares += counts * counts.transpose() / c.ns;
    products += counts;
    total += c.ns;
  }
  // Some of the costs are 0. Three unknowns: all choices are tried, C_v alone first; another one
  // has to leave clearly less of the errors.
  Vec3 best = Vec3::Zero();
  double left = total;
  for (const unsigned some : {1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
    Mat3 equations = squares;
    Vec3 right = products;
    for (int i = 0; i < 3; ++i)
      if (!(some >> i & 1)) {
        equations.row(i).setZero();
        equations.col(i).setZero();
        equations(i, i) = 1;
        right[i] = 0;
      }
    const Vec3 scale = equations.diagonal();
    if (!(std::abs(equations.determinant()) > 1e-10 * scale.prod())) continue;  // proportional
    const Vec3 costs = equations.inverse() * right;
    const double error = total - costs.dot(right);
    if ((costs.array() >= 0).all() && error < left - 1e-9 * total) best = costs, left = error;
  }
  return {best[2], best[0], best[1]};
}

/// The number that a share of the numbers do not exceed. @pre not empty, 0 ≤ share ≤ 1.
inline double quantile(std::vector<double> numbers, double share) {
  const auto rank =
      static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size() - 1) + 0.5);
  std::nth_element(numbers.begin(), numbers.begin() + rank, numbers.end());
  return numbers[static_cast<std::size_t>(rank)];
}

}  // namespace corridor::app
