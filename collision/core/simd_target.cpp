#include "collision/core/simd_target.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/core/simd_target.cpp"
#include "hwy/foreach_target.h"
// Highway requires that highway.h is included after foreach_target.h.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {
const char* targetName() {
  return hwy::TargetName(HWY_TARGET);
}
}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(targetName);

const char* simdTarget() {
  return HWY_DYNAMIC_DISPATCH(targetName)();
}

}  // namespace corridor
#endif
