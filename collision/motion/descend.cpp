#include "collision/motion/descend.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/hierarchy/wide_pose.h"
#include "collision/motion/moving_parts.h"
#include "collision/motion/moving_triangles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/motion/descend.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

#include "collision/hierarchy/wide_walk-inl.h"
#include "collision/motion/moving_triangles-inl.h"
#include "collision/motion/wide_travel-inl.h"
#include "collision/queries/wide_leaves-inl.h"
#include "collision/volumes/overlap_obb4_moving-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

class Moving {
 public:
  using Item = QueryContext::WideItem;
  using Node = WideObbTree::Node;

  Moving(const WideObbTree& a, const WideObbTree& b, const MotionWindow& window,
         const WidePose& pose, const DescentOptions& options, std::vector<Item>& later,
         Counters& counters)
      : a_(a),
        b_(b),
        window_(window),
        pose_(pose),
        options_(options),
        later_(later),
        counters_(counters),
        travel_(b, window, pose.unitA, options.margin, options.tolerance),
        leaves_(a, b, pose, counters) {}

  static constexpr bool kSorted = false;

  bool skip(const Item& item) {
    if (result_.kind == Descent::Kind::workLimit) return true;
    if (counters_.work() >= options_.workEnd) {
      result_.kind = Descent::Kind::workLimit;
      return true;
    }
    if (left_ < options_.mostLeft) return false;
    later_.push_back(item);
    return true;
  }

  unsigned boxes(const Item& item, const Node& na, const Node& nb, float* keys) {
    const NodeTravel& travel = travel_.of(nb);
    const MovingBoxes found = movingBoxes(na, nb, pose_.floats, travel, keys, clearances());
    noteClearances(item.pairs & ~found.open);
    if (options_.shortest) return found.open;
    const unsigned coarse = found.coarse & item.pairs & travel.far * 0x1111U;
    leave(item, coarse);
    return found.open & ~coarse;
  }

  bool leaves(const Item& item, const Node& na, const Node& nb, unsigned pairs, const float*) {
    unsigned open = 0;
    const bool stop =
        a_.part() || b_.part() ? solids(na, nb, pairs, open) : triangles(na, nb, pairs, open);
    if (!stop) leave(item, open);
    return stop;
  }

  const Descent& result() const { return result_; }

 private:
  void leave(const Item& item, unsigned pairs) {
    if (!pairs) return;
    later_.push_back({item.a, item.b, item.key, pairs});
    left_ += static_cast<unsigned>(std::popcount(pairs));
  }
  bool full(unsigned open) const {
    return left_ + static_cast<unsigned>(std::popcount(open)) >= options_.mostLeft;
  }

  float* clearances() { return options_.clearance ? clearances_ : nullptr; }
  /// Of pairs that were told apart.
  void noteClearances(unsigned pairs) {
    if (!options_.clearance) return;
    for (; pairs; pairs &= pairs - 1)
      result_.clearance =
          std::min(result_.clearance,
                   static_cast<double>(clearances_[std::countr_zero(pairs)]) / pose_.unitA);
  }

  bool solids(const Node& na, const Node& nb, unsigned pairs, unsigned& open) {
    return forEachItem(na, nb, pairs, [&](unsigned leaves, std::uint32_t s, std::uint32_t t) {
      if (open & leaves || full(open)) {
        open |= leaves;
        return false;
      }
      const double margin = options_.margin;
      const ConvexPart *pa = a_.part(), *pb = b_.part();
      const MovingTrianglesAnswer answer =
          !pa  ? decideMovingParts(a_.triangle(s), *pb, window_, margin, counters_)
          : pb ? decideMovingParts(*pa, *pb, window_, margin, counters_)
               : decideMovingParts(*pa, b_.triangle(t), window_, margin, counters_);
      return take(answer, s, t, leaves, open);
    });
  }

  bool triangles(const Node& na, const Node& nb, unsigned leaves, unsigned& open) {
    LeafPairs pairs(na, nb);
    for (unsigned rest = leaves; rest; rest &= rest - 1)
      pairs.add(static_cast<unsigned>(std::countr_zero(rest)));
    LeafTravel goes = travel_.ofLeaves(nb, pairs.lanesB());
    // Where a shorter window is no help, or none is to be had, doubles decide all that is left.
    const bool last = options_.shortest || !travel_.of(nb).far;
    // A pair that the filter drops, which knows no distances, would have none either.
    const float far = options_.clearance ? HUGE_VALF : goes.cap + goes.pad;
    return leaves_.forEachNearSixteen(
        pairs, [&] { return far; },
        [&](const TriangleCorners& a, const TriangleCorners& b, unsigned first, unsigned near) {
          travel_.setLinear(goes, b.center, a_.origin());
          const MovingPairs found =
              movingTriangles(a, b, pairs.from(first), pose_.leafError, goes, clearances());
          noteClearances(near & found.apart);
          for (near &= ~found.apart; near; near &= near - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(near));
            const unsigned pair = pairs.leavesOf(first + bit);
            if (open & pair || full(open) || (!last && found.later >> bit & 1)) {
              open |= pair;
              continue;
            }
            const auto [s, t] = pairs.triangles(first + bit);
            --counters_.triangleTests;  // the filter has counted the pair
            const MovingTrianglesAnswer answer = decideMovingTriangles(
                a_.triangle(s), b_.triangle(t), window_, options_.margin, counters_);
            if (take(answer, s, t, pair, open)) return true;
          }
          return false;
        });
  }

  /// True: enough.
  bool take(const MovingTrianglesAnswer& answer, std::uint32_t s, std::uint32_t t, unsigned leaves,
            unsigned& open) {
    const LeafPair pair = judged(answer, a_.meshTriangle(s), b_.meshTriangle(t), options_, result_);
    if (pair == LeafPair::left) open |= leaves;
    return pair == LeafPair::last;
  }

  const WideObbTree &a_, &b_;
  const MotionWindow& window_;
  const WidePose& pose_;
  const DescentOptions& options_;
  std::vector<Item>& later_;
  Counters& counters_;
  WideTravel travel_;
  WideLeaves leaves_;
  unsigned left_ = 0;  // pairs that `later_` has of this window
  alignas(64) float clearances_[16];
  Descent result_;
};

Descent descendWide(const WideObbTree& a, const WideObbTree& b, const MotionWindow& window,
                    const DescentOptions& options, std::size_t count,
                    std::vector<QueryContext::WideItem>& later, QueryContext& context) {
  // `travelOf` knows how far b goes; the pose has only to know where it is.
  const WidePose pose(a, {}, b, window.X_AB, HUGE_VAL);
  Moving query(a, b, window, pose, options, later, context.counters);
  const std::size_t left = walkWide(a, b, pose.floats.scale, context, query, count);
  if (query.result().kind == Descent::Kind::contact)
    later.insert(later.end(), context.wideStack.begin(),
                 context.wideStack.begin() + static_cast<std::ptrdiff_t>(left));
  return query.result();
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(descendWide);

Descent descend(const WideObbTree& a, const WideObbTree& b, const MotionWindow& window,
                const DescentOptions& options, std::size_t count,
                std::vector<QueryContext::WideItem>& later, QueryContext& context) {
  return HWY_DYNAMIC_DISPATCH(descendWide)(a, b, window, options, count, later, context);
}

}  // namespace corridor
#endif
