#include "collision/motion/certify_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "collision/convex/convex_distance.h"
#include "collision/core/rounding.h"
#include "collision/hierarchy/with_volume.h"
#include "collision/motion/descend.h"
#include "collision/motion/descend_volumes.h"
#include "collision/motion/may_meet.h"
#include "collision/motion/motion_answer.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"

namespace corridor {
namespace {

/// One query: walks the time intervals, the earlier half first.
class Certifier {
 public:
  Certifier(MotionSource& motion, std::span<const MotionPair> pairs, const MotionOptions& options,
            QueryContext& context, MotionCertificate* certificate)
      : motion_(motion),
        pairs_(pairs),
        options_(options),
        context_(context),
        counters_(context.counters),
        openPairs_(context.openPairs),
        workList_(context.workList),
        certificate_(certificate) {}

  MotionResult run() {
    openPairs_.assign(pairs_.size(), QueryContext::kWholeTrees);
    workList_.resize(pairs_.size());
    std::size_t bodies = 0;
    for (std::uint32_t k = 0; k < pairs_.size(); ++k) {
      workList_[k] = whole(k);
      if (pairs_[k].worldB != MotionPair::kNone)  // others have no sphere in the world
        bodies = std::max({bodies, pairs_[k].bodyA + 1, pairs_[k].bodyB + 1});
    }
    context_.spheres.makeRoom(bodies);
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() - work();
    workEnd_ = work() + std::min(options_.workLimit, most);
    if (options_.earliest ? walkInOrder({0, 1, 0, workList_.size()}) : walkByLevels()) return {};
    return result_;
  }

 private:
  using Item = QueryContext::NodePair4;
  using Group = QueryContext::PairWork;

  /// Split thresholds: limits on the work in one interval. An interval that is far too wide should
  /// be halved before all of its pairs are tested. The walk of a pair of bodies stops once it has
  /// left this many node pairs. The remaining bodies are left once this many pairs of bodies have
  /// left something, and these are more than three quarters of the pairs tested. The whole motion
  /// is mostly too wide, so its thresholds are the lowest, but only if b rotates: a translation is
  /// described exactly to first order in any interval.
  struct SplitThresholds {
    unsigned pairsOfNodes;
    std::size_t pairsOfBodies;
  };
  static constexpr SplitThresholds kFirst = {1, 1}, kLater = {8, 4};
  /// The angle in half of an interval, in radians, above which b counts as rotating.
  static constexpr double kTurns = 0.02;
  /// A body is left to the interval's halves if it rotates, moves farther than `kFar` times its own
  /// radius, and its swept sphere is not separated. Below a half width of `kShortestFar` this rule
  /// ends. Pairs that are left untested count no work, and a joint may make any number of turns, so
  /// the query might otherwise never reach its work limit.
  static constexpr double kFar = 2, kShortestFar = 0x1p-8;
  /// The number of levels of halving that are walked level by level if only the verdict is
  /// requested, so that a contact anywhere is found early.
  static constexpr int kFirstLevels = 4;
  /// The number of levels below the whole motion at whose middles the remaining pairs are tested
  /// for contact. Measured on the edges that plans test: one more level costs more than it finds.
  static constexpr int kSampledLevels = 2;
  /// Intervals with a half width of 2^-48 of the motion are not halved: much below, their middles
  /// would no longer be exact.
  static constexpr double kShortest = 0x1p-48;

  std::uint64_t work() const { return counters_.work(); }

  /// A time interval, and the range of `workList_` that is its work list: what is not yet separated
  /// in it.
  struct Interval {
    double t0, t1;
    std::size_t begin, end;
    double half() const { return (t1 - t0) / 2; }
    double middle() const { return t0 + half(); }  // dyadic: exact
    bool near = false;                             // the bounds of all bodies were tested in it
  };

  /// Selects the interval [t − h, t + h] for all queries that follow.
  void moveTo(double t, double h) {
    if (t == t_ && h == h_) return;
    t_ = t;
    h_ = h;
    posed_ = MotionPair::kNone;
    context_.spheres.forget();
  }

  /// Returns the motion in the selected interval; keeps the last one.
  const RelativeMotion& relativeMotionOf(std::size_t motion) {
    if (motion == posed_) return relative_;
    posed_ = motion;
    relative_ = motion_.relativeMotion(motion, t_, h_);
    ++counters_.poses;
    return relative_;
  }

  const SweptSphere& worldSphere(std::size_t motion, const Body& body, std::size_t index) {
    return context_.spheres.of(index, [&] { return sweptSphere(body, relativeMotionOf(motion)); });
  }

  /// Returns a lower bound of the distance of two bodies in the interval by their bounds, in
  /// metres. Without a certificate, a value above `asked` need not be the best bound. Sets `far_`
  /// if the result is not above `asked`.
  double bodiesStayApart(const MotionPair& pair, double asked) {
    const double enough = certificate_ ? HUGE_VAL : asked;
    if (pair.worldA != MotionPair::kNone) {
      const double clearance =
          clearanceBound(worldSphere(pair.worldA, *pair.a, pair.bodyA),
                         worldSphere(pair.worldB, *pair.b, pair.bodyB), enough);
      if (clearance > asked) return clearance;
    }
    // Only a motion as seen from the world has a sphere that other pairs can use.
    const SweptSphere sphere = pair.worldB == pair.motion
                                   ? worldSphere(pair.motion, *pair.b, pair.bodyB)
                                   : sweptSphere(*pair.b, relativeMotionOf(pair.motion));
    far_ = sphere.isotropic > kFar * pair.b->sphereRadius() &&
           sphere.angular.squaredNorm() > kTurns * kTurns;
    return clearanceBound(*pair.a, sphere, enough);
  }

  bool provedByBodies(const Interval& w, const Group& group) {
    const double asked = roundedUp(options_.margin + options_.clearanceSlack);
    const double clearance = bodiesStayApart(pairs_[group.bodies], asked);
    if (!(clearance > asked)) return false;
    proved(w, group, clearance - asked);
    return true;
  }

  /// Tests the interval's work list, and appends what it cannot separate to `workList_`.
  /// @return false: `found_` is a contact at the middle, or the reason why the interval stays
  /// undecided.
  bool testInterval(const Interval& w) {
    const double h = w.half();
    moveTo(w.middle(), h);
    std::size_t tested = 0, left = 0;
    for (std::size_t g = w.begin; g < w.end; ++g) {
      Group group = workList_[g];
      const bool whole = isWhole(group);
      if (whole && !w.near && provedByBodies(w, group)) continue;
      const MotionPair& pair = pairs_[group.bodies];
      const bool first = h == 0.5 && relativeMotionOf(pair.motion).angle > kTurns;
      const SplitThresholds thresholds = first ? kFirst : kLater;
      const bool tooMuch = left >= thresholds.pairsOfBodies && 4 * left > 3 * tested;
      const bool tooFar = whole && !w.near && far_ && h >= kShortestFar;
      if (h > kShortest && (tooMuch || tooFar)) {
        workList_.push_back(group);
        ++left, ++tested;
        continue;
      }
      ++tested;
      RelativeMotion relative = relativeMotionOf(pair.motion);
      relative.fixedError += options_.clearanceSlack;  // a proof needs it, a contact does not
      const std::size_t later = openPairs_.size(), count = stacked(group);
      const DescentOptions asked = {options_.margin,         options_.tolerance,
                                    h <= kShortest,          workEnd_,
                                    thresholds.pairsOfNodes, certificate_ != nullptr};
      found_ = walkTrees(pair, relative, asked, count);
      group.clearance = std::min(group.clearance, found_.clearance);
      if (openPairs_.size() > later) {
        workList_.push_back({group.bodies, later, openPairs_.size(), group.clearance});
        ++left;
      } else if (found_.kind == Descent::Kind::done) {
        proved(w, group, HUGE_VAL);
      }
      if (found_.kind == Descent::Kind::done) continue;
      bodies_ = group.bodies;
      for (std::size_t k = g + 1; k < w.end; ++k)
        workList_.push_back(Group(workList_[k]));  // not tested
      return false;
    }
    return true;
  }

  /// Records that the whole group is separated in the interval. The node pairs that were separated
  /// last have this clearance, beyond margin and pads.
  void proved(const Interval& w, const Group& group, double clearance) {
    if (!certificate_) return;
    const double beyond = std::min(group.clearance, clearance);
    certificate_->free.push_back({group.bodies, w.t0, w.t1,
                                  roundedDown(options_.margin + options_.clearanceSlack + beyond)});
  }

  /// The first items are all pairs of bodies as a whole.
  static Group whole(std::uint32_t bodies) {
    return {bodies, bodies, bodies + std::size_t{1}, HUGE_VAL};
  }
  bool isWhole(const Group& group) const {
    const Item& item = openPairs_[group.begin];
    return group.end - group.begin == 1 && item.a == 0 && item.b == 0 &&
           item.pairs == QueryContext::kWholeTrees.pairs;
  }

  /// Returns the work list of the whole motion: the pairs of bodies whose bounds do not separate
  /// them. Sets `far` if any of these bodies moves far in it.
  Interval nearBodies(bool& far) {
    moveTo(0.5, 0.5);
    const std::size_t later = workList_.size();
    for (std::size_t g = 0; g < later; ++g) {
      const Group group = workList_[g];
      if (provedByBodies({0, 1, 0, 0}, group)) continue;
      workList_.push_back(group);
      far = far || far_;
    }
    return {0, 1, later, workList_.size(), true};
  }

  /// Finds the verdict only. Returns false if the answer is not `free`: `result_` is it.
  bool walkByLevels() {
    const auto touchesInMiddle = [&](const Interval& w) {
      return !motion_.still() && touchesAt(w.middle(), w.begin, w.end);
    };
    bool far = false;
    std::array<Interval, 1 << kFirstLevels> intervals, below;
    intervals[0] = nearBodies(far);
    std::size_t count = intervals[0].begin < intervals[0].end;
    // Many motions with a contact have one at their end.
    if (!motion_.still() && touchesAt(1, intervals[0].begin, intervals[0].end))
      return contact(0, false);
    for (int level = 0; level < kFirstLevels && count; ++level) {
      std::size_t halves = 0;
      for (Interval w : std::span(intervals).first(count)) {
        if (0 < level && level <= kSampledLevels && touchesInMiddle(w)) return contact(0, false);
        if (level > 0 || !far) {
          const std::size_t later = workList_.size();
          if (!testInterval(w)) return stopped(w);
          if (workList_.size() == later) continue;
          w.begin = later, w.end = workList_.size();
        }
        if (level == 0 && touchesInMiddle(w)) return contact(0, false);
        ++counters_.splits;
        const double t = w.middle();
        below[halves++] = {w.t0, t, w.begin, w.end};
        below[halves++] = {t, w.t1, w.begin, w.end};
      }
      std::swap(intervals, below);
      count = halves;
    }
    // Depth first, so that a place that cannot be decided is found before everything else is
    // refined.
    for (const Interval& w : std::span(intervals).first(count))
      if (!walkInOrder(w)) return false;
    return true;
  }

  /// Walks the interval depth first, the earlier half first. Everything before w.t0 is certified.
  /// Returns false if the walk has to stop: `result_` is the answer.
  bool walkInOrder(const Interval& w) {
    const std::size_t items = openPairs_.size(), later = workList_.size();
    const bool done = testInterval(w);
    const double t = w.middle();
    const std::size_t count = workList_.size();
    if (!done && found_.kind != Descent::Kind::contact) return stopped(w);
    if (!done) {
      touched(w);
      // From now on only the first half matters.
      if (!options_.earliest || t - w.t0 <= options_.timeTolerance) return contact(w.t0, false);
      ++counters_.splits;
      return walkInOrder({w.t0, t, later, count}) ? contact(t, false) : false;
    }
    counters_.splits += count > later;
    const bool free = count == later || (walkInOrder({w.t0, t, later, count}) &&
                                         walkInOrder({t, w.t1, later, count}));
    openPairs_.resize(items);
    workList_.resize(later);
    return free;
  }

  /// Reports whether a group of this range is in contact at the rounded pose at t.
  bool touchesAt(double t, std::size_t begin, std::size_t end) {
    moveTo(t, 0);
    for (std::size_t g = begin; g < end && work() < workEnd_; ++g) {
      const MotionPair& pair = pairs_[workList_[g].bodies];
      // A pair that the interval did not reach may be far apart, and then needs no tree.
      if (isWhole(workList_[g]) && bodiesStayApart(pair, 0) > 0) continue;
      if (touches(pair, relativeMotionOf(pair.motion).X_AB, t, stacked(workList_[g]))) return true;
    }
    return false;
  }

  /// Reports whether, at the rounded pose X_AB at time t, there is a contact below one of the node
  /// pairs in the first `count` items of the stack.
  bool touches(const MotionPair& pair, const Transform& X_AB, double t, std::size_t count) {
    if (!X_AB.isFinite()) return false;  // overflow counts as overlap, but is no contact
    const auto hit = touchBelow(pair, X_AB, count);
    --counters_.states;  // part of an edge
    if (!hit) return false;
    contactTime_ = t;
    contactPair_ = {pair.bodyA, pair.bodyB, hit->a, hit->b};
    return true;
  }

  // The next two functions dispatch on the kind of trees, once per pair of bodies and interval.

  Descent walkTrees(const MotionPair& pair, const RelativeMotion& relative,
                    const DescentOptions& asked, std::size_t count) {
    if (!relative.X_AB.isFinite()) return {.kind = Descent::Kind::undecided};
    if (options_.trees == TreeKind::obb4)
      return descend(pair.a->tree(), pair.b->tree(), relative, asked, count, openPairs_, context_);
    return onVolumeTrees(
        options_.trees, *pair.a, *pair.b, [&](auto overlap, const auto& a, const auto& b) {
          return descend<decltype(overlap)>(a, b, relative, asked, count, openPairs_, context_);
        });
  }

  std::optional<TrianglePair> touchBelow(const MotionPair& pair, const Transform& X_AB,
                                         std::size_t count) {
    if (options_.trees == TreeKind::obb4)
      return interferenceBelow(pair.a->tree(), {}, pair.b->tree(), X_AB, count, context_, workEnd_);
    return onVolumeTrees(
        options_.trees, *pair.a, *pair.b, [&](auto overlap, const auto& a, const auto& b) {
          return interferenceBelow<decltype(overlap)>(a, {}, b, X_AB, count, context_, workEnd_);
        });
  }

  /// Copies the group's items to the stack that walks begin with, and returns their number.
  std::size_t stacked(const Group& group) {
    const std::size_t count = group.end - group.begin;
    auto& stack = context_.stack4;
    if (stack.size() < count) stack.resize(2 * count);
    std::copy_n(openPairs_.begin() + static_cast<std::ptrdiff_t>(group.begin), count,
                stack.begin());
    return count;
  }

  /// Reports whether the pair that was not separated touches at the interval's end, or after it
  /// within the time tolerance of the interval's beginning. An interval that ends where a contact
  /// begins can never be proved.
  bool touchesAfter(const Interval& w) {
    const MotionPair& pair = pairs_[bodies_];
    for (double after = 0; !motion_.still(); after = std::max(2 * after, 0x1p-40)) {
      const double t = std::min(w.t1 + after, 1.0);
      if (after > 0 && t - w.t0 > options_.timeTolerance) return false;
      const Transform X_AB = motion_.relativeMotion(pair.motion, t, 0).X_AB;
      if (touches(pair, X_AB, t, stacked(whole(bodies_)))) return true;
      if (t == 1) return false;
    }
    return false;
  }

  /// Records the contact that `testInterval` found at the interval's middle.
  void touched(const Interval& w) {
    const MotionPair& pair = pairs_[bodies_];
    contactTime_ = w.middle();
    contactPair_ = {pair.bodyA, pair.bodyB, found_.s, found_.t};
  }

  bool contact(double certifiedUntil, bool grazing) {
    result_.verdict = MotionVerdict::contact;
    result_.certifiedUntil = certifiedUntil;
    result_.contactTime = contactTime_;
    result_.pair = contactPair_;
    result_.reason = UndecidedReason::none;
    result_.gap = 0;
    result_.grazing = grazing;
    return false;
  }

  /// Sets the answer for an interval that `testInterval` did not prove free. If a contact is known
  /// at the interval's end, or close to its beginning, the undecided interval is the bracket of
  /// that contact.
  bool stopped(const Interval& w) {
    if (found_.kind == Descent::Kind::contact) {
      touched(w);
      return contact(0, false);
    }
    const bool clearance = found_.kind == Descent::Kind::undecided;
    const auto near = [&] {
      return contactTime_ >= 0 && contactTime_ - w.t0 <= options_.timeTolerance;
    };
    if (clearance && !near() && contactTime_ != w.t1) touchesAfter(w);
    if (contactTime_ == w.t1 && clearance && !found_.wide) return contact(w.t0, true);
    if (contactTime_ >= 0 && (near() || !options_.earliest)) return contact(w.t0, false);
    result_.verdict = MotionVerdict::undecided;
    result_.reason = UndecidedReason::workLimit;
    result_.certifiedUntil = w.t0;
    result_.contactTime = w.middle();
    if (clearance) {
      const MotionPair& pair = pairs_[bodies_];
      moveTo(w.middle(), w.half());
      result_.reason =
          reasonOf(relativeMotionOf(pair.motion), *pair.b, found_.gap, options_.tolerance);
      result_.pair = Contact{pair.bodyA, pair.bodyB, found_.s, found_.t};
      result_.gap = found_.gap;
    }
    return false;
  }

  MotionSource& motion_;
  std::span<const MotionPair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  Counters& counters_;
  std::vector<Item>& openPairs_;
  std::vector<Group>& workList_;
  MotionCertificate* certificate_;
  std::uint64_t workEnd_ = 0;
  double t_ = -1, h_ = 0;                  // of the selected interval
  RelativeMotion relative_;                // in the selected interval,
  std::size_t posed_ = MotionPair::kNone;  // and of this motion
  bool far_ = false;                       // the body tested last moves far in the interval
  Descent found_;                          // in the interval tested last
  std::uint32_t bodies_ = 0;               // the pair of bodies that `found_` is about
  double contactTime_ = -1;                // the earliest contact known
  Contact contactPair_;
  MotionResult result_;
};

/// Returns a point where the two leaf primitives of the contact touch, in a's frame.
Vec3 contactPoint(MotionSource& motion, std::span<const MotionPair> pairs,
                  const MotionResult& result, Counters& counters) {
  const Contact& contact = *result.pair;
  const auto pair = std::find_if(pairs.begin(), pairs.end(), [&](const MotionPair& p) {
    return p.bodyA == contact.bodyA && p.bodyB == contact.bodyB;
  });
  const auto cornersOf = [](const Body& body, std::size_t i) {
    const TriangleMesh& mesh = body.mesh();
    return body.part() ? Triangle()
                       : Triangle{mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)};
  };
  const Triangle a = cornersOf(*pair->a, contact.triangleA),
                 b = cornersOf(*pair->b, contact.triangleB);
  const auto setOf = [](const Body& body, const Triangle& corners) {
    return body.part() ? ConvexSet(*body.part()) : ConvexSet(corners);
  };
  const Transform X_AB = motion.relativeMotion(pair->motion, result.contactTime, 0).X_AB;
  return convexDistance({setOf(*pair->a, a), {}}, {setOf(*pair->b, b), X_AB}, 0, 0, counters).p_WA;
}

}  // namespace

MotionResult certifyMotion(MotionSource& motion, std::span<const MotionPair> pairs,
                           const MotionOptions& options, QueryContext& context,
                           MotionCertificate* certificate) {
  if (certificate) *certificate = {};
  return answered(motion, options.earliest, context, [&] {
    const MotionResult result = Certifier(motion, pairs, options, context, certificate).run();
    if (certificate && result.verdict == MotionVerdict::contact)
      certificate->point_A = contactPoint(motion, pairs, result, context.counters);
    return result;
  });
}

}  // namespace corridor
