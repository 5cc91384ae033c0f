#include "collision/queries/relative_pose.h"

#include <cmath>

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {

double relativePoseError(const Transform& X_WA, const Transform& X_AB, const Transform& X_WB,
                         double reach) {
  const Transform back = X_WA * X_AB;
  // Each entry of `back` has at most 4 roundings of its terms. The magnitudes of all terms sum up
  // to `size` for `back.m`, and to at most `sizeT` for `back.t`.
  const double size = (X_WA.m.cwiseAbs() * X_AB.m.cwiseAbs()).sum();
  const double sizeT =
      (X_WA.m.cwiseAbs() * X_AB.t.cwiseAbs() + X_WA.t.cwiseAbs() + X_WB.t.cwiseAbs()).sum();
  const double error = ((back.m - X_WB.m).norm() + 8 * kUnit * size) * reach +
                       (back.t - X_WB.t).norm() + 8 * kUnit * sizeT;
  // Uses |M x| ≥ √(1 − 3η)·|x| ≥ (1 − 3η)|x| for M = X_WA.m, with η the `orthonormalityDefect` of
  // M. If 1 − 3η is at most 1/2, the bound is infinite and nothing is pruned.
  const double shrink = 1 - 3 * orthonormalityDefect(X_WA.m);
  return shrink > 0.5 ? roundedUp(error / shrink) : HUGE_VAL;
}

}  // namespace corridor
