#pragma once

#include <algorithm>
#include <vector>

/// The cost model of queries, T = N_v·C_v + N_p·C_p (Gottschalk, Lin, Manocha 1996, eq. 1), fitted
/// to measured queries.
namespace corridor {

/// The numbers of tests of a query, and the time that it took.
struct QueryCost {
  double boxTests = 0, primitiveTests = 0;  ///< N_v, N_p
  double ns = 0;                            ///< T, above 0
};

/// Nanoseconds of one test within a query, including its share of the tree traversal.
struct CostModel {
  double box = 0, triangle = 0;  ///< C_v, C_p
  /// Whether the queries determine each cost: the standard error of the cost is at most half of the
  /// cost. If N_v and N_p are nearly proportional, the queries determine neither cost, although the
  /// fitted sum may predict times well. A report shows a dash for an unknown cost.
  bool boxKnown = false, triangleKnown = false;
  double predicted(const QueryCost& c) const {
    return c.boxTests * box + c.primitiveTests * triangle;
  }
};

/// Returns the traversal's share per box test: the nanoseconds that a query takes for each of its
/// box tests in addition to the test itself. It is fitted by least squares of the errors, each
/// divided by √T, with the costs of single tests given. This share is determined even if N_v and
/// N_p are proportional. It may be negative if tests take less time in a query than in the
/// measurement of single tests.
/// @param tests  the costs of single tests. @param call  nanoseconds that each query takes besides
/// its tests and the traversal.
inline double traversalShare(const std::vector<QueryCost>& queries, const CostModel& tests,
                             double call) {
  double vv = 0, v = 0;
  for (const QueryCost& c : queries) {
    vv += c.boxTests * c.boxTests / c.ns;
    v += c.boxTests * (c.ns - call - tests.predicted(c)) / c.ns;
  }
  return vv > 0 ? v / vv : 0;
}

/// Returns the costs ≥ 0 that fit the queries best: by least squares of the errors, each divided by
/// √T, because the error of a sum of many tests grows like √T. (Without weights, the few longest
/// queries would decide the fit; with errors divided by T, the shortest queries.) If N_v and N_p
/// are proportional, box tests get the whole cost, and neither cost is known. If one of N_v and N_p
/// is 0 in all queries, the cost of the other kind of test is known.
/// @param call  nanoseconds that each query takes besides its tests. @pre queries not empty.
inline CostModel fittedCosts(const std::vector<QueryCost>& queries, double call = 0) {
  // Normal equations of Σ (N_v·C_v + N_p·C_p + call − T)²/T.
  double vv = 0, vp = 0, pp = 0, v = 0, p = 0;
  for (const QueryCost& c : queries) {
    const double share = (c.ns - call) / c.ns;
    vv += c.boxTests * c.boxTests / c.ns;
    vp += c.boxTests * c.primitiveTests / c.ns;
    pp += c.primitiveTests * c.primitiveTests / c.ns;
    v += c.boxTests * share, p += c.primitiveTests * share;
  }
  const double det = vv * pp - vp * vp;
  if (det > 1e-12 * vv * pp) {  // well above the rounding of the sums
    CostModel both{(v * pp - p * vp) / det, (p * vv - v * vp) / det};
    if (both.box >= 0 && both.triangle >= 0) {
      // The variance of the weighted errors, and the covariance matrix of the two costs.
      double errors = 0;
      for (const QueryCost& c : queries) {
        const double error = both.predicted(c) + call - c.ns;
        errors += error * error / c.ns;
      }
      if (queries.size() > 2) {
        const double variance = errors / static_cast<double>(queries.size() - 2);
        both.boxKnown = 4 * variance * pp / det <= both.box * both.box && both.box > 0;
        both.triangleKnown =
            4 * variance * vv / det <= both.triangle * both.triangle && both.triangle > 0;
      }
      return both;
    }
  }
  // One of the two costs would be negative, or the two can't be separated. So use the single cost
  // that fits better. A single cost lowers the sum of squares by v²/vv (C_v) or p²/pp (C_p).
  const CostModel boxes{vv > 0 ? std::max(v / vv, 0.0) : 0, 0, vv > 0 && pp == 0, false};
  const CostModel triangles{0, pp > 0 ? std::max(p / pp, 0.0) : 0, false, pp > 0 && vv == 0};
  // If the counts are proportional, both fit equally well up to the rounding of the sums; prefer
  // box tests.
  return boxes.box * v >= (1 - 1e-12) * triangles.triangle * p ? boxes : triangles;
}

}  // namespace corridor
