#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// T = N_v·C_v + N_p·C_p (Gottschalk, Lin, Manocha 1996, eq. 1): what queries cost, told from
/// counts.
namespace corridor {

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

/// The costs ≥ 0 that these queries bear out best: least squares of the errors, each over √T, since
/// what is a sum of many tests varies so. (Weighed alike, the few longest queries would tell all;
/// relative to T, the shortest.) Where the counts are proportional box tests take it all.
/// @param call  nanoseconds of each T that no test takes. @pre queries not empty.
inline CostModel fittedCosts(const std::vector<QueryCost>& queries, double call = 0) {
  // Normal equations of Σ (N_v·C_v + N_p·C_p + call − T)²/T.
  double vv = 0, vp = 0, pp = 0, v = 0, p = 0;
  for (const QueryCost& c : queries) {
    const double share = (c.ns - call) / c.ns;
    vv += c.boxTests * c.boxTests / c.ns;
    vp += c.boxTests * c.triangleTests / c.ns;
    pp += c.triangleTests * c.triangleTests / c.ns;
    v += c.boxTests * share, p += c.triangleTests * share;
  }
  const double det = vv * pp - vp * vp;
  if (det > 1e-12 * vv * pp) {  // well above the rounding of the sums
    const CostModel both{(v * pp - p * vp) / det, (p * vv - v * vp) / det};
    if (both.box >= 0 && both.triangle >= 0) return both;
  }
  // The better one alone: the sum falls by v²/vv, or p²/pp.
  const CostModel boxes{vv > 0 ? std::max(v / vv, 0.0) : 0, 0};
  const CostModel triangles{0, pp > 0 ? std::max(p / pp, 0.0) : 0};
  // Equal, but for the rounding of the sums, where the counts are proportional.
  return boxes.box * v >= (1 - 1e-12) * triangles.triangle * p ? boxes : triangles;
}

/// The number that a share of the numbers do not exceed. @pre not empty, 0 ≤ share ≤ 1.
inline double quantile(std::vector<double> numbers, double share) {
  const std::ptrdiff_t rank = std::lround(share * static_cast<double>(numbers.size() - 1));
  std::nth_element(numbers.begin(), numbers.begin() + rank, numbers.end());
  return numbers[static_cast<std::size_t>(rank)];
}

}  // namespace corridor
