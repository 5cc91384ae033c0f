#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

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
  double box = 0, triangle = 0;  ///< C_v, C_p
  double predicted(const QueryCost& c) const {
    return c.boxTests * box + c.triangleTests * triangle;
  }
};

/// The costs ≥ 0 that these queries bear out best: least squares of the *relative* errors, so that
/// a query of a microsecond counts as much as one of a millisecond. Neither cost is told where no
/// query has such a test. @pre not empty.
inline CostModel fittedCosts(const std::vector<QueryCost>& queries) {
  // Normal equations of Σ (v·C_v + p·C_p − 1)², v = N_v/T, p = N_p/T.
  double vv = 0, vp = 0, pp = 0, v1 = 0, p1 = 0;
  for (const QueryCost& c : queries) {
    const double v = c.boxTests / c.ns, p = c.triangleTests / c.ns;
    vv += v * v, vp += v * p, pp += p * p, v1 += v, p1 += p;
  }
  const double det = vv * pp - vp * vp;
  if (det > 1e-12 * vv * pp) {  // else the counts are proportional: boxes take it all
    const CostModel both{(v1 * pp - p1 * vp) / det, (p1 * vv - v1 * vp) / det};
    if (both.box >= 0 && both.triangle >= 0) return both;
  }
  // The better one alone: the sum falls by its v1²/vv, or p1²/pp.
  const double byBox = vv > 0 ? v1 * v1 / vv : 0, byTriangle = pp > 0 ? p1 * p1 / pp : 0;
  if (byBox >= byTriangle) return {vv > 0 ? v1 / vv : 0, 0};
  return {0, p1 / pp};
}

/// The number that a share of the numbers do not exceed. @pre not empty, 0 ≤ share ≤ 1.
inline double quantile(std::vector<double> numbers, double share) {
  const auto rank =
      static_cast<std::ptrdiff_t>(share * static_cast<double>(numbers.size() - 1) + 0.5);
  std::nth_element(numbers.begin(), numbers.begin() + rank, numbers.end());
  return numbers[static_cast<std::size_t>(rank)];
}

}  // namespace corridor::app
