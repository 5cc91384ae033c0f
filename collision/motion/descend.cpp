#include "collision/motion/descend.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/hierarchy/obb4_tree_pose.h"
#include "collision/motion/moving_parts.h"
#include "collision/motion/moving_triangles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/motion/descend.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/hierarchy/obb4_walk-inl.h"
#include "collision/motion/motion_bound4-inl.h"
#include "collision/motion/moving_triangles-inl.h"
#include "collision/queries/obb4_leaves-inl.h"
#include "collision/volumes/overlap_obb4_moving-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The query that `walkObb4` runs for `descend`: two 4-wide OBB trees in one time interval.
class Moving {
 public:
  using Item = NodePair4;
  using Node = Obb4Tree::Node;

  Moving(const Obb4Tree& a, const Obb4Tree& b, const RelativeMotion& relative,
         const Obb4TreePose& pose, const DescentOptions& options, std::vector<Item>& later,
         Counters& counters)
      : a_(a),
        b_(b),
        relative_(relative),
        pose_(pose),
        options_(options),
        later_(later),
        counters_(counters),
        bound_(b, relative, pose.unitA, options.margin, options.tolerance),
        leaves_(a, b, pose, counters) {}

  static constexpr bool kSorted = false;

  bool skip(const Item& item) {
    if (result_.kind == Descent::Kind::workLimit) return true;
    if (counters_.work() >= options_.workEnd) {
      result_.kind = Descent::Kind::workLimit;
      return true;
    }
    if (deferred_ < options_.deferAllAfter) return false;
    later_.push_back(item);
    return true;
  }

  unsigned boxes(const Item& item, const Node& na, const Node& nb, float* keys) {
    const NodeMotionBound& bound = bound_.of(nb);
    const MovingBoxes found = movingBoxes(na, nb, pose_.floats, bound, keys, clearances());
    noteClearances(item.pairs & ~found.open);
    if (options_.shortest) return found.open;
    const unsigned coarse = found.coarse & item.pairs & bound.far * 0x1111U;
    defer(item, coarse);
    return found.open & ~coarse;
  }

  bool leaves(const Item& item, const Node& na, const Node& nb, unsigned pairs, const float*) {
    unsigned open = 0;
    const bool stop = a_.hasParts() || b_.hasParts() ? solids(na, nb, pairs, open)
                                                     : triangles(na, nb, pairs, open);
    if (!stop) defer(item, open);
    return stop;
  }

  const Descent& result() const { return result_; }

 private:
  void defer(const Item& item, unsigned pairs) {
    if (!pairs) return;
    later_.push_back({item.a, item.b, item.key, pairs});
    deferred_ += static_cast<unsigned>(std::popcount(pairs));
  }
  bool full(unsigned open) const {
    return deferred_ + static_cast<unsigned>(std::popcount(open)) >= options_.deferAllAfter;
  }

  float* clearances() { return options_.clearance ? clearances_ : nullptr; }
  /// If clearances are requested: lowers the clearance of the result, so that it is at most that of
  /// each of these separated pairs.
  void noteClearances(unsigned pairs) {
    if (!options_.clearance) return;
    for (; pairs; pairs &= pairs - 1)
      result_.clearance =
          std::min(result_.clearance,
                   static_cast<double>(clearances_[std::countr_zero(pairs)]) / pose_.unitA);
  }

  bool solids(const Node& na, const Node& nb, unsigned pairs, unsigned& open) {
    return forEachLeafPrimitivePair(
        na, nb, pairs, [&](unsigned leaves, std::uint32_t s, std::uint32_t t) {
          if (open & leaves || full(open)) {
            open |= leaves;
            return false;
          }
          const double margin = options_.margin;
          const MovingPairAnswer answer =
              !a_.hasParts()  ? decideMovingParts(a_.triangle(s), b_.part(t), relative_, margin)
              : b_.hasParts() ? decideMovingParts(a_.part(s), b_.part(t), relative_, margin)
                              : decideMovingParts(a_.part(s), b_.triangle(t), relative_, margin);
          counters_.addTest(answer.exact);
          return take(answer, s, t, leaves, open);
        });
  }

  bool triangles(const Node& na, const Node& nb, unsigned leaves, unsigned& open) {
    NodeLeafPairs pairs(na, nb);
    for (unsigned rest = leaves; rest; rest &= rest - 1)
      pairs.add(static_cast<unsigned>(std::countr_zero(rest)));
    LeafMotionBound goes = bound_.ofLeaves(nb, pairs.lanesB());
    // If no box of b moves farther than the tolerance, or if shorter intervals are not allowed,
    // double precision decides all pairs that floats leave.
    const bool last = options_.shortest || !bound_.of(nb).far;
    // If clearances are requested, the filter must not drop any pair, because it computes no
    // distances. An infinite pad keeps all pairs.
    const float far = options_.clearance ? HUGE_VALF : goes.isotropic + goes.pad;
    return leaves_.forEachNearSixteen(
        pairs, [&] { return far; },
        [&](const TriangleCorners& a, const TriangleCorners& b, unsigned first, unsigned near) {
          bound_.setLinear(goes, b.center, a_.origin());
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
            const MovingPairAnswer answer =
                decideMovingTriangles(a_.triangle(s), b_.triangle(t), relative_, options_.margin);
            counters_.exactTests += answer.exact;  // the filter has already counted this test
            if (take(answer, s, t, pair, open)) return true;
          }
          return false;
        });
  }

  /// Adds the result for two leaf primitives to the result of the interval. Adds the bits `leaves`
  /// of their leaf pair to `open` if the pair is deferred. Returns true if the walk has to end.
  bool take(const MovingPairAnswer& answer, std::uint32_t s, std::uint32_t t, unsigned leaves,
            unsigned& open) {
    const LeafOutcome pair =
        outcomeOf(answer, a_.meshTriangle(s), b_.meshTriangle(t), options_, result_);
    if (pair == LeafOutcome::deferred) open |= leaves;
    return pair == LeafOutcome::last;
  }

  const Obb4Tree &a_, &b_;
  const RelativeMotion& relative_;
  const Obb4TreePose& pose_;
  const DescentOptions& options_;
  std::vector<Item>& later_;
  Counters& counters_;
  MotionBound4 bound_;
  Obb4Leaves leaves_;
  unsigned deferred_ = 0;  // number of pairs of boxes deferred by tests, for `deferAllAfter`
  alignas(64) float clearances_[16];
  Descent result_;
};

Descent descendObb4(std::span<const NodePair4> start, const Obb4Tree& a, const Obb4Tree& b,
                    const RelativeMotion& relative, const DescentOptions& options,
                    std::vector<NodePair4>& later, QueryContext& context) {
  // `Obb4TreePose` does not know the motion, so it must not separate the root boxes. The infinite
  // pad keeps it from doing so.
  const Obb4TreePose pose(a, {}, b, relative.X_AB, HUGE_VAL);
  Moving query(a, b, relative, pose, options, later, context.counters);
  const auto stack = context.scratch.use<Obb4Stack>();
  const std::span<const NodePair4> left =
      walkObb4(a, b, pose.floats.scale, start, *stack, context.counters, query);
  if (query.result().kind == Descent::Kind::contact)
    later.insert(later.end(), left.begin(), left.end());
  return query.result();
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(descendObb4);

Descent descend(std::span<const NodePair4> start, const Obb4Tree& a, const Obb4Tree& b,
                const RelativeMotion& relative, const DescentOptions& options,
                std::vector<NodePair4>& later, QueryContext& context) {
  return HWY_DYNAMIC_DISPATCH(descendObb4)(start, a, b, relative, options, later, context);
}

}  // namespace corridor
#endif
