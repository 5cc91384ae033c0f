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
#include "collision/queries/interference_wide.h"

namespace corridor {
namespace {

/// One query: walks windows of time, earlier half first.
class Certifier {
 public:
  Certifier(MotionSource& motion, std::span<const MotionPair> pairs, const MotionOptions& options,
            QueryContext& context, MotionEvidence* evidence)
      : motion_(motion),
        pairs_(pairs),
        options_(options),
        context_(context),
        counters_(context.counters),
        items_(context.pending),
        groups_(context.groups),
        evidence_(evidence) {}

  MotionResult run() {
    items_.assign(pairs_.size(), QueryContext::kWholeTrees);
    groups_.resize(pairs_.size());
    std::size_t bodies = 0;
    for (std::uint32_t k = 0; k < pairs_.size(); ++k) {
      groups_[k] = whole(k);
      if (pairs_[k].worldB != MotionPair::kNone)  // others have no balls in the world
        bodies = std::max({bodies, pairs_[k].bodyA + 1, pairs_[k].bodyB + 1});
    }
    context_.balls.makeRoom(bodies);
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() - work();
    workEnd_ = work() + std::min(options_.workLimit, most);
    if (options_.earliest ? walkInOrder({0, 1, 0, groups_.size()}) : walkByLevels()) return {};
    return result_;
  }

 private:
  using Item = QueryContext::WideItem;
  using Group = QueryContext::PairItems;

  /// How soon a window gives up, for one far too wide to decide anything should not look at
  /// everything: once it has left so much of a pair of bodies to its halves, or something of so
  /// many pairs of bodies, if that is nearly all that it has looked at. The whole motion, which
  /// mostly is too wide, leaves all the rest at once, where b turns: of what goes straight any
  /// window is told to first order, exactly.
  struct Patience {
    unsigned pairsOfNodes;
    std::size_t pairsOfBodies;
  };
  static constexpr Patience kFirst = {1, 1}, kLater = {8, 4};
  /// Radians of half a window, from where on b turns.
  static constexpr double kTurns = 0.02;
  /// A body that turns, and goes so many times its own radius in a window, is left to the halves if
  /// its ball isn't told apart; not of half windows under `kShortestFar`, for no work is counted of
  /// what isn't looked at, and a joint may turn as often as it likes.
  static constexpr double kFar = 2, kShortestFar = 0x1p-8;
  /// The first levels of halving: walked level by level for a verdict alone, so that a contact
  /// anywhere is found soon.
  static constexpr int kFirstLevels = 4;
  /// Of so many levels below the whole motion the middles are sampled, where something is left.
  /// Measured on the edges that plans ask about: one more costs more than it finds.
  static constexpr int kSampledLevels = 2;
  /// Half windows are not halved below 2^-48 of the motion: much below, their middles would no
  /// longer be exact.
  static constexpr double kShortest = 0x1p-48;

  std::uint64_t work() const { return counters_.work(); }

  /// A window of time and what is not separated in it yet: a range of the groups.
  struct Window {
    double t0, t1;
    std::size_t begin, end;
    double half() const { return (t1 - t0) / 2; }
    double middle() const { return t0 + half(); }  // dyadic: exact
    bool near = false;                             // all bodies' bounds were looked at in it
  };

  /// What is asked from now on is of the window [t − h, t + h].
  void moveTo(double t, double h) {
    if (t == t_ && h == h_) return;
    t_ = t;
    h_ = h;
    posed_ = MotionPair::kNone;
    context_.balls.forget();
  }

  /// The motion in the window; that of the last call is kept.
  const MotionWindow& windowOf(std::size_t motion) {
    if (motion == posed_) return window_;
    posed_ = motion;
    window_ = motion_.window(motion, t_, h_);
    ++counters_.poses;
    return window_;
  }

  const SweptBall& worldBall(std::size_t motion, const Body& body, std::size_t index) {
    return context_.balls.of(index, [&] { return sweptBall(body, windowOf(motion)); });
  }

  /// How far the bounds of two bodies stay apart in the window, metres; of what is more than
  /// `asked` maybe less, where nobody asks for evidence. Sets `far_` where it isn't more than that.
  double bodiesStayApart(const MotionPair& pair, double asked) {
    const double enough = evidence_ ? HUGE_VAL : asked;
    if (pair.worldA != MotionPair::kNone) {
      const double clearance = clearanceBound(worldBall(pair.worldA, *pair.a, pair.bodyA),
                                              worldBall(pair.worldB, *pair.b, pair.bodyB), enough);
      if (clearance > asked) return clearance;
    }
    // Of a motion that isn't the world's, the ball is nobody else's.
    const SweptBall ball = pair.worldB == pair.motion ? worldBall(pair.motion, *pair.b, pair.bodyB)
                                                      : sweptBall(*pair.b, windowOf(pair.motion));
    far_ = ball.cap > kFar * pair.b->sphereRadius() && ball.angular.squaredNorm() > kTurns * kTurns;
    return clearanceBound(*pair.a, ball, enough);
  }

  bool provedByBodies(const Window& w, const Group& group) {
    const double asked = roundedUp(options_.margin + options_.reserve);
    const double clearance = bodiesStayApart(pairs_[group.bodies], asked);
    if (!(clearance > asked)) return false;
    proved(w, group, clearance - asked);
    return true;
  }

  /// Looks at the window's groups; what it cannot separate is appended to them.
  /// @return false: `found_` is a contact at the middle, or why the window stays undecided.
  bool look(const Window& w) {
    const double h = w.half();
    moveTo(w.middle(), h);
    std::size_t looked = 0, left = 0;
    for (std::size_t g = w.begin; g < w.end; ++g) {
      Group group = groups_[g];
      const bool whole = isWhole(group);
      if (whole && !w.near && provedByBodies(w, group)) continue;
      const MotionPair& pair = pairs_[group.bodies];
      const bool first = h == 0.5 && windowOf(pair.motion).angle > kTurns;
      const Patience patience = first ? kFirst : kLater;
      const bool tooMuch = left >= patience.pairsOfBodies && 4 * left > 3 * looked;
      const bool tooFar = whole && !w.near && far_ && h >= kShortestFar;
      if (h > kShortest && (tooMuch || tooFar)) {
        groups_.push_back(group);
        ++left, ++looked;
        continue;
      }
      ++looked;
      MotionWindow window = windowOf(pair.motion);
      window.fixedError += options_.reserve;  // asked of a proof, not of a contact: as the tube is
      const std::size_t later = items_.size(), count = stacked(group);
      const DescentOptions asked = {options_.margin, options_.tolerance,    h <= kShortest,
                                    workEnd_,        patience.pairsOfNodes, evidence_ != nullptr};
      found_ = walkTrees(pair, window, asked, count);
      group.clearance = std::min(group.clearance, found_.clearance);
      if (items_.size() > later) {
        groups_.push_back({group.bodies, later, items_.size(), group.clearance});
        ++left;
      } else if (found_.kind == Descent::Kind::done) {
        proved(w, group, HUGE_VAL);
      }
      if (found_.kind == Descent::Kind::done) continue;
      bodies_ = group.bodies;
      for (std::size_t k = g + 1; k < w.end; ++k)
        groups_.push_back(Group(groups_[k]));  // not looked at
      return false;
    }
    return true;
  }

  /// All of the group is apart in the window, its last by `clearance` beyond margin and pads.
  void proved(const Window& w, const Group& group, double clearance) {
    if (!evidence_) return;
    const double beyond = std::min(group.clearance, clearance);
    evidence_->free.push_back(
        {group.bodies, w.t0, w.t1, roundedDown(options_.margin + options_.reserve + beyond)});
  }

  /// The first items are all pairs of bodies.
  static Group whole(std::uint32_t bodies) {
    return {bodies, bodies, bodies + std::size_t{1}, HUGE_VAL};
  }
  bool isWhole(const Group& group) const {
    const Item& item = items_[group.begin];
    return group.end - group.begin == 1 && item.a == 0 && item.b == 0 &&
           item.pairs == QueryContext::kWholeTrees.pairs;
  }

  /// The pairs of bodies whose bounds don't stay apart in the whole motion; and does any of them go
  /// far in it?
  Window nearBodies(bool& far) {
    moveTo(0.5, 0.5);
    const std::size_t later = groups_.size();
    for (std::size_t g = 0; g < later; ++g) {
      const Group group = groups_[g];
      if (provedByBodies({0, 1, 0, 0}, group)) continue;
      groups_.push_back(group);
      far = far || far_;
    }
    return {0, 1, later, groups_.size(), true};
  }

  /// For the verdict alone: false: `result_` says why.
  bool walkByLevels() {
    const auto touchesInMiddle = [&](const Window& w) {
      return !motion_.still() && touchesAt(w.middle(), w.begin, w.end);
    };
    bool far = false;
    std::array<Window, 1 << kFirstLevels> windows, below;
    windows[0] = nearBodies(far);
    std::size_t count = windows[0].begin < windows[0].end;
    // Many motions that touch anything do so at their end.
    if (!motion_.still() && touchesAt(1, windows[0].begin, windows[0].end))
      return contact(0, false);
    for (int level = 0; level < kFirstLevels && count; ++level) {
      std::size_t halves = 0;
      for (Window w : std::span(windows).first(count)) {
        if (0 < level && level <= kSampledLevels && touchesInMiddle(w)) return contact(0, false);
        if (level > 0 || !far) {
          const std::size_t later = groups_.size();
          if (!look(w)) return stopped(w);
          if (groups_.size() == later) continue;
          w.begin = later, w.end = groups_.size();
        }
        if (level == 0 && touchesInMiddle(w)) return contact(0, false);
        ++counters_.splits;
        const double t = w.middle();
        below[halves++] = {w.t0, t, w.begin, w.end};
        below[halves++] = {t, w.t1, w.begin, w.end};
      }
      std::swap(windows, below);
      count = halves;
    }
    // Depth first, so that a place that can't be decided is found before everything else is
    // refined.
    for (const Window& w : std::span(windows).first(count))
      if (!walkInOrder(w)) return false;
    return true;
  }

  /// Depth first, earlier half first: all is certified up to w.t0. False: stop, `result_` says why.
  bool walkInOrder(const Window& w) {
    const std::size_t items = items_.size(), later = groups_.size();
    const bool done = look(w);
    const double t = w.middle();
    const std::size_t count = groups_.size();
    if (!done && found_.kind != Descent::Kind::contact) return stopped(w);
    if (!done) {
      touched(w);
      // Only the first half matters now.
      if (!options_.earliest || t - w.t0 <= options_.timeTolerance) return contact(w.t0, false);
      ++counters_.splits;
      return walkInOrder({w.t0, t, later, count}) ? contact(t, false) : false;
    }
    counters_.splits += count > later;
    const bool free = count == later || (walkInOrder({w.t0, t, later, count}) &&
                                         walkInOrder({t, w.t1, later, count}));
    items_.resize(items);
    groups_.resize(later);
    return free;
  }

  /// Is one of the groups of this range in contact at the rounded pose at t?
  bool touchesAt(double t, std::size_t begin, std::size_t end) {
    moveTo(t, 0);
    for (std::size_t g = begin; g < end && work() < workEnd_; ++g) {
      const MotionPair& pair = pairs_[groups_[g].bodies];
      // What the window has not come to may be far away, and need no tree.
      if (isWhole(groups_[g]) && bodiesStayApart(pair, 0) > 0) continue;
      if (touches(pair, windowOf(pair.motion).X_AB, t, stacked(groups_[g]))) return true;
    }
    return false;
  }

  /// Are two nodes of the first `count` of the stack's items in contact at the rounded pose, that
  /// of t?
  bool touches(const MotionPair& pair, const Transform& X_AB, double t, std::size_t count) {
    if (!X_AB.isFinite()) return false;  // overflow counts as overlap, and is no contact
    const auto hit = touchBelow(pair, X_AB, count);
    --counters_.states;  // part of an edge
    if (!hit) return false;
    contactTime_ = t;
    contactPair_ = {pair.bodyA, pair.bodyB, hit->a, hit->b};
    return true;
  }

  // Here the kind of trees is looked at, once a pair of bodies and window.

  Descent walkTrees(const MotionPair& pair, const MotionWindow& window, const DescentOptions& asked,
                    std::size_t count) {
    if (!window.X_AB.isFinite()) return {.kind = Descent::Kind::undecided};
    if (options_.trees == TreeKind::wideObb)
      return descend(pair.a->tree(), pair.b->tree(), window, asked, count, items_, context_);
    return onVolumeTrees(
        options_.trees, *pair.a, *pair.b, [&](auto overlap, const auto& a, const auto& b) {
          return descend<decltype(overlap)>(a, b, window, asked, count, items_, context_);
        });
  }

  std::optional<TrianglePair> touchBelow(const MotionPair& pair, const Transform& X_AB,
                                         std::size_t count) {
    if (options_.trees == TreeKind::wideObb)
      return interferenceBelow(pair.a->tree(), {}, pair.b->tree(), X_AB, count, context_, workEnd_);
    return onVolumeTrees(
        options_.trees, *pair.a, *pair.b, [&](auto overlap, const auto& a, const auto& b) {
          return interferenceBelow<decltype(overlap)>(a, {}, b, X_AB, count, context_, workEnd_);
        });
  }

  /// Puts the group's items on the stack that walks begin with. @return how many.
  std::size_t stacked(const Group& group) {
    const std::size_t count = group.end - group.begin;
    auto& stack = context_.wideStack;
    if (stack.size() < count) stack.resize(2 * count);
    std::copy_n(items_.begin() + static_cast<std::ptrdiff_t>(group.begin), count, stack.begin());
    return count;
  }

  /// A window that ends where a contact begins is never proved: is there one at its end, or after
  /// it, as soon as the bracket allows? Of the two that were not told apart.
  bool touchesAfter(const Window& w) {
    const MotionPair& pair = pairs_[bodies_];
    for (double after = 0; !motion_.still(); after = std::max(2 * after, 0x1p-40)) {
      const double t = std::min(w.t1 + after, 1.0);
      if (after > 0 && t - w.t0 > options_.timeTolerance) return false;
      const Transform X_AB = motion_.window(pair.motion, t, 0).X_AB;
      if (touches(pair, X_AB, t, stacked(whole(bodies_)))) return true;
      if (t == 1) return false;
    }
    return false;
  }

  /// What `look` has found touches, at the window's middle.
  void touched(const Window& w) {
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

  /// `look` has not got through the window. With a contact known at its end, or close to its
  /// beginning, an undecided one is that contact's bracket all the same.
  bool stopped(const Window& w) {
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
      result_.reason = reasonOf(windowOf(pair.motion), *pair.b, found_.gap, options_.tolerance);
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
  std::vector<Item>& items_;
  std::vector<Group>& groups_;
  MotionEvidence* evidence_;
  std::uint64_t workEnd_ = 0;
  double t_ = -1, h_ = 0;                  // of the window that is asked about
  MotionWindow window_;                    // in it,
  std::size_t posed_ = MotionPair::kNone;  // of this motion
  bool far_ = false;                       // the last body that was asked about goes far in it
  Descent found_;                          // in the window that was looked at last
  std::uint32_t bodies_ = 0;               // whose that is
  double contactTime_ = -1;                // of the earliest contact known
  Contact contactPair_;
  MotionResult result_;
};

/// Where the two that `contact` names touch, in a's frame.
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
  const Transform X_AB = motion.window(pair->motion, result.contactTime, 0).X_AB;
  return convexDistance({setOf(*pair->a, a), {}}, {setOf(*pair->b, b), X_AB}, 0, 0, counters).p_WA;
}

}  // namespace

MotionResult certifyMotion(MotionSource& motion, std::span<const MotionPair> pairs,
                           const MotionOptions& options, QueryContext& context,
                           MotionEvidence* evidence) {
  if (evidence) *evidence = {};
  return answered(motion, options.earliest, context, [&] {
    const MotionResult result = Certifier(motion, pairs, options, context, evidence).run();
    if (evidence && result.verdict == MotionVerdict::contact)
      evidence->point_A = contactPoint(motion, pairs, result, context.counters);
    return result;
  });
}

}  // namespace corridor
