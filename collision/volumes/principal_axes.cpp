#include "collision/volumes/principal_axes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/volumes/principal_axes.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/volumes/principal_axes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// Computes the axes of one matrix, in the first lane.
void principalAxes1(const Mat3& m, Mat3& axes) {
  Covariances8 c = {};
  int at = 0;
  for (int k = 0; k < 3; ++k)
    for (int l = k; l < 3; ++l) c.entry[at++][0] = m(k, l);
  Axes8 found;
  principalAxes8(c, found);
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) axes(k, j) = found.axes[j][k][0];
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(principalAxes1);

Mat3 principalAxes(const Mat3& covariance) {
  Mat3 axes;
  HWY_DYNAMIC_DISPATCH(principalAxes1)(covariance, axes);
  return axes;
}

}  // namespace corridor
#endif
