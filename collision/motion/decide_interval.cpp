#include "collision/motion/decide_interval.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/with_trees.h"
#include "collision/motion/descend_volumes.h"
#include "collision/motion/split_rules.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"

namespace corridor {
namespace {

/// Records in the certificate that the whole group is separated in [t0, t1].
/// @param clearance a lower bound of the clearance beyond margin, clearance slack and motion,
/// metres. The smaller one of this bound and `group.clearance` is recorded. Infinite if
/// `group.clearance` already covers all node pairs.
void record(const MotionQuery& query, double t0, double t1, const WorkList::Group& group,
            double clearance) {
  if (!query.certificate) return;
  const double beyond = std::min(group.clearance, clearance);
  query.certificate->free.push_back(
      {group.bodies, t0, t1,
       roundedDown(query.options.marginOf(group.bodies) + query.options.clearanceSlack + beyond)});
}

/// The result of testing the bounds of a whole pair of bodies.
struct BodiesAnswer {
  bool separated = false, far = false;
};
BodiesAnswer testBounds(const MotionQuery& query, double t0, double t1,
                        const WorkList::Group& group, IntervalMotions& motions) {
  const double asked = query.requiredDistance(group.bodies);
  const auto [clearance, far] =
      motions.separation(query.pairs[group.bodies], asked, query.certificate != nullptr);
  if (!(clearance > asked)) return {false, far};
  record(query, t0, t1, group, clearance - asked);
  return {true, false};
}

/// Walks the trees of a pair of bodies below the node pairs of its group. Appends the node pairs
/// that cannot be separated to `list.nodePairs`. For a pose that overflows, or a bound that is NaN,
/// returns `undecided` at once: not every comparison in a kernel fails for NaN.
Descent walkTrees(const MotionQuery& query, const WorkList::Group& group,
                  const RelativeMotion& relative, const DescentOptions& asked, WorkList& list) {
  if (!relative.X_AB.isFinite() || std::isnan(relative.fixedError))
    return {.kind = Descent::Kind::undecided};
  const MotionPair& pair = query.pairs[group.bodies];
  return withTrees(query.options.trees, *pair.a, *pair.b,
                   [&](auto overlap, const auto& a, const auto& b) {
                     return descend<decltype(overlap)>(list.nodePairsOf(group), a, b, relative,
                                                       asked, list.nodePairs, query.context);
                   });
}

}  // namespace

MovingHullsAnswer testHulls(const MotionQuery& query, std::size_t g, double margin, double slack,
                            IntervalMotions& motions, WorkList& list) {
  const MotionPair& pair = query.pairs[list.groups[g].bodies];
  if (!query.options.hulls || query.options.trees != TreeKind::obb4 ||
      !list.isNotWalkedYet(list.groups[g]) || !haveHulls(*pair.a, *pair.b))
    return {};
  RelativeMotion relative = motions.relative(pair.motion);
  relative.fixedError += slack;
  HullGuess& guess = list.hullsOf(g);
  if (guess.met || !relative.X_AB.isFinite() || std::isnan(relative.fixedError)) return {};
  query.context.counters.addTest(false);
  return decideMovingHulls(*pair.a, *pair.b, relative, margin, guess);
}

IntervalAnswer decideInterval(const MotionQuery& query, const Interval& interval,
                              IntervalMotions& motions, WorkList& list) {
  using Rules = SplitRules;
  const double h = interval.half();
  motions.select(interval.middle(), h);
  std::size_t tested = 0, left = 0;
  for (std::size_t g = interval.begin; g < interval.end; ++g) {
    WorkList::Group group = list.groups[g];
    bool tooFar = false;
    if (!interval.boundsAreTested && list.isNotWalkedYet(group)) {
      const BodiesAnswer bodies = testBounds(query, interval.t0, interval.t1, group, motions);
      if (bodies.separated) continue;
      tooFar = bodies.far && h >= Rules::kLeastHalfWidthFar;
    }
    const std::size_t motion = query.pairs[group.bodies].motion;
    // A proof requires the slack, a contact does not.
    const double margin = query.options.marginOf(group.bodies),
                 slack = query.options.clearanceSlack;
    // `descend` keeps the work limit only where trees are walked.
    if (query.context.counters.work() >= query.workEnd) {
      for (std::size_t k = g; k < interval.end; ++k)
        list.groups.push_back(WorkList::Group(list.groups[k]));
      return {{.kind = Descent::Kind::workLimit}, group.bodies};
    }
    if (!tooFar) {
      const MovingHullsAnswer hulls = testHulls(query, g, margin, slack, motions, list);
      group.hulls = list.groups[g].hulls;
      if (hulls.separated) {
        record(query, interval.t0, interval.t1, group, hulls.clearance);
        ++tested;
        continue;
      }
      if (hulls.shorter && h > Rules::kLeastHalfWidthHulls) {
        list.groups.push_back(group);
        ++left;
        ++tested;
        continue;
      }
    }
    const bool first = h == 0.5 && motions.relative(motion).angle > Rules::kTurns;
    const SplitThresholds thresholds = first ? Rules::kFirst : Rules::kLater;
    const bool tooMuch = left >= thresholds.bodyPairsLeft && 4 * left > 3 * tested;
    ++tested;
    if (h > Rules::kLeastHalfWidth && (tooMuch || tooFar)) {
      list.groups.push_back(group);
      ++left;
      continue;
    }
    RelativeMotion relative = motions.relative(motion);
    relative.fixedError += slack;
    const std::size_t later = list.nodePairs.size();
    const DescentOptions asked = {
        margin,        query.options.tolerance, h <= Rules::kLeastHalfWidth,
        query.workEnd, thresholds.boxPairsLeft, query.certificate != nullptr};
    const Descent found = walkTrees(query, group, relative, asked, list);
    group.clearance = std::min(group.clearance, found.clearance);
    if (list.nodePairs.size() > later) {
      list.groups.push_back(
          {group.bodies, later, list.nodePairs.size(), group.clearance, group.hulls});
      ++left;
    } else if (found.kind == Descent::Kind::done) {
      record(query, interval.t0, interval.t1, group, HUGE_VAL);
    }
    if (found.kind == Descent::Kind::done) continue;
    for (std::size_t k = g + 1; k < interval.end; ++k)
      list.groups.push_back(WorkList::Group(list.groups[k]));  // not tested
    return {found, group.bodies};
  }
  return {};
}

void separateBodies(const MotionQuery& query, const Interval& interval, IntervalMotions& motions,
                    WorkList& list, std::vector<bool>& left) {
  const double h = interval.half();
  motions.select(interval.middle(), h);
  for (std::size_t g = interval.begin; g < interval.end; ++g) {
    WorkList::Group group = list.groups[g];
    if (left[group.bodies] || testBounds(query, interval.t0, interval.t1, group, motions).separated)
      continue;
    const MovingHullsAnswer hulls = testHulls(query, g, query.options.marginOf(group.bodies),
                                              query.options.clearanceSlack, motions, list);
    if (hulls.separated) continue;
    group.hulls = list.groups[g].hulls;
    const bool hasHulls = group.hulls != WorkList::kNone;
    const bool isHalved = hasHulls ? hulls.apart && h > SplitRules::kLeastHalfWidthHulls
                                   : h > SplitRules::kLeastHalfWidthBounds;
    if (isHalved)
      list.groups.push_back(group);
    else
      left[group.bodies] = true;
  }
}

Interval testBodies(const MotionQuery& query, IntervalMotions& motions, WorkList& list, bool& far) {
  motions.select(0.5, 0.5);
  const std::size_t count = list.groups.size();
  for (std::size_t g = 0; g < count; ++g) {
    const WorkList::Group group = list.groups[g];
    const BodiesAnswer bodies = testBounds(query, 0, 1, group, motions);
    if (bodies.separated) continue;
    list.groups.push_back(group);
    far = far || bodies.far;
  }
  return {.t0 = 0, .t1 = 1, .begin = count, .end = list.groups.size(), .boundsAreTested = true};
}

std::optional<PrimitivePair> contactBelow(const MotionQuery& query, std::uint32_t bodies,
                                          const Transform& X_AB, std::span<const NodePair4> start) {
  if (!X_AB.isFinite()) return std::nullopt;  // overlapping boxes would prove no contact
  const MotionPair& pair = query.pairs[bodies];
  return withTrees(
      query.options.trees, *pair.a, *pair.b, [&](auto overlap, const auto& a, const auto& b) {
        return interferenceBelow<decltype(overlap)>(start, Posed(a), Posed(b, X_AB), query.context,
                                                    &query.context.lastPair(bodies), query.workEnd);
      });
}

}  // namespace corridor
