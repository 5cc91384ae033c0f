// The selection of boxes in distance queries on two 4-wide OBB trees, for every SIMD target:
// foreach_target.h includes this file once per target.

// clang-format off
#if defined(CORRIDOR_BOXES_WITHIN_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_BOXES_WITHIN_INL_H_
#undef CORRIDOR_BOXES_WITHIN_INL_H_
#else
#define CORRIDOR_BOXES_WITHIN_INL_H_
#endif
// clang-format on

#include <algorithm>

#include "collision/core/posed.h"
#include "collision/hierarchy/obb4_tree_pose.h"
#include "collision/hierarchy/obb4_walk-inl.h"
#include "collision/queries/distance.h"
#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The base class of the queries that `walkObb4` runs for distances. Visits the pairs of boxes that
/// are not proved to be farther apart than a limit, the nearest first.
/// @tparam kFar see `nearBoxes`.
template <bool kFar>
class BoxesWithin {
 public:
  static constexpr bool kSorted = true;
  bool skip(const NodePair4& item) const { return isBeyond(item.key); }

  unsigned boxes(const NodePair4&, const Obb4Tree::Node& a, const Obb4Tree::Node& b,
                 float* squares) const {
    return nearBoxes<kFar>(a, b, pose_.floats, limit_, squares);
  }

 protected:
  /// @param limit metres.
  BoxesWithin(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
              double limit, Counters& counters)
      : a_(a.shape),
        b_(b.shape),
        pose_(pose),
        counters_(counters),
        limit_(pose.inUnitsOfA(limit)) {}

  /// Returns whether `square`, the square of a distance in a's unit, exceeds the square of the
  /// limit. Returns false for 0, because such a pair may touch.
  bool isBeyond(float square) const {
    return square > 0 && square > limit_ * limit_ * (1 + 0x1p-20F);
  }
  /// Lowers the limit, given that the distance is at most `metres`. Pairs that can't improve this
  /// distance by more than the options allow are then skipped.
  void reduceLimit(double metres, const DistanceOptions& options) {
    const double most = (metres - options.absolute) / (1 + options.relative);
    limit_ = std::min(limit_, pose_.inUnitsOfA(std::max(0.0, most)));
  }

  const Obb4Tree &a_, &b_;
  const Obb4TreePose& pose_;
  Counters& counters_;
  float limit_;  // in a's unit: pairs that are farther apart are skipped
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
