#include "collision/predicates/along.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/predicates/exact_number.h"

namespace corridor {
namespace {

/// Returns the exact sign of Σ n_k q_k − Σ n_k p_k, a sum of six products of two doubles.
int exactSign(const Vec3& n, const Vec3& p, const Vec3& q) {
  exact::Grid grid;
  for (int k = 0; k < 3; ++k)
    for (const Vec3* x : {&p, &q}) grid.include(exact::dyadic(n[k]), exact::dyadic((*x)[k]));
  exact::BigInt sum = 0;
  for (int k = 0; k < 3; ++k) {
    sum += exact::term<exact::BigInt>(exact::dyadic(n[k]), exact::dyadic(q[k]), grid);
    sum -= exact::term<exact::BigInt>(exact::dyadic(n[k]), exact::dyadic(p[k]), grid);
  }
  return exact::sign(sum);
}

}  // namespace

int alongSign(const Vec3& n, const Vec3& p, const Vec3& q) {
  // A difference, a product and two sums: at most 4 roundings for each term. For each
  // difference and product, underflow adds at most 2^-1022 times `largest`, the largest factor
  // or 1.
  const Vec3 x = q - p;
  const double along = n.dot(x), size = n.cwiseAbs().dot(x.cwiseAbs());
  const double largest = std::max({1.0, n.cwiseAbs().maxCoeff(), x.cwiseAbs().maxCoeff()});
  if (std::abs(along) > 5 * kUnit * size + 0x1p-1018 * largest) return along > 0 ? 1 : -1;
  return exactSign(n, p, q);
}

}  // namespace corridor
