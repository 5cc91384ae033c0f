#include "collision/motion/certify_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/motion/moving_parts.h"
#include "collision/motion/moving_triangles.h"
#include "collision/queries/interference.h"
#include "collision/volumes/overlap_obb_obb.h"

namespace corridor {
namespace {

/// One query: walks windows of time depth first, earlier half first.
class Certifier {
 public:
  Certifier(MotionSource& motion, std::span<const MotionPair> pairs, const MotionOptions& options,
            QueryContext& context)
      : motion_(motion),
        pairs_(pairs),
        options_(options),
        context_(context),
        counters_(context.counters) {}

  MotionResult run() {
    auto& pending = context_.pending;
    pending.clear();
    for (std::uint32_t k = 0; k < pairs_.size(); ++k) pending.push_back({0, 0, k});
    // Those of one motion together, and so they stay in every list: each window of a motion is
    // asked for once.
    const auto before = [&](const NodePair& p, const NodePair& q) {
      return pairs_[p.bodies].motion < pairs_[q.bodies].motion;
    };
    if (!std::is_sorted(pending.begin(), pending.end(), before))
      std::stable_sort(pending.begin(), pending.end(), before);
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() - work();
    workEnd_ = work() + std::min(options_.workLimit, most);
    sampled_ = !options_.earliest && !motion_.still();
    if (sampled_ && touchesAtSamples()) {
      contact(0, false);
      return result_;
    }
    if (options_.earliest ? walkInOrder({0, 1, 0, pending.size()}, 0) : walkByLevels()) return {};
    if (!options_.earliest) result_.certifiedUntil = 0;
    return result_;
  }

 private:
  using NodePair = QueryContext::NodePair;
  enum class Descent { done, contact, undecided };

  /// What one window may leave to its halves before it gives up: a window far too wide to decide
  /// anything should not look at everything.
  static constexpr std::size_t kLeftovers = 8;
  /// Levels of halving at which a middle whose window was not certified is tested for contact as a
  /// static pose: likely collisions first.
  static constexpr int kProbedLevels = 4;
  /// Where a motion is sampled before it is walked: the end, then the middles of the first levels.
  static constexpr double kSamples[] = {1, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875};
  static constexpr int kSampledLevels = 3;
  /// Half windows are not halved below 2^-48 of the motion: much below, their middles would no
  /// longer be exact.
  static constexpr double kShortest = 0x1p-48;

  std::uint64_t work() const { return counters_.boxTests + counters_.triangleTests; }

  /// A window of time and the pairs that are not separated in it yet: a range of the list at hand.
  struct Window {
    double t0, t1;
    std::size_t begin, end;
  };

  /// Looks at the window's pairs, `from` its list; what it cannot separate is appended to `to`, in
  /// the same order.
  /// @return contact: at the middle.
  Descent look(const Window& w, const std::vector<NodePair>& from, std::vector<NodePair>& to,
               int level) {
    const double h = (w.t1 - w.t0) / 2;
    middle_ = w.t0 + h;  // dyadic: exact
    MotionWindow window;
    auto& posed = context_.posed;
    posed.clear();
    const std::size_t later = to.size();
    leftoversEnd_ = later + (w.end - w.begin) + kLeftovers;
    for (std::size_t i = w.begin; i < w.end; ++i) {
      const NodePair pair = from[i];  // a copy: `to` may be the same list
      if (const std::size_t m = pairs_[pair.bodies].motion;
          posed.empty() || posed.back().motion != m) {
        window = motion_.window(m, middle_, h);
        window.fixedError +=
            options_.reserve;  // asked of a proof, not of a contact: as the tube is
        posed.push_back({m, window.X_AB});
        ++counters_.poses;
      }
      const Descent descent = descend(pair, window, h, to);
      if (descent == Descent::done) continue;
      for (std::size_t k = i + 1; k < w.end; ++k) to.push_back(NodePair(from[k]));  // not looked at
      return descent;
    }
    const bool sampled = sampled_ && level < kSampledLevels;
    return level < kProbedLevels && !sampled && probe(to, later) ? Descent::contact : Descent::done;
  }

  /// For the verdict alone: the coarse windows level by level, so that a contact anywhere is found
  /// soon; what they leave, depth first, so that a place that can't be decided is found before
  /// everything else is refined. False: `result_` says why.
  bool walkByLevels() {
    auto &pending = context_.pending, &next = context_.next;
    std::vector<Window> windows = {{0, 1, 0, pending.size()}}, below;
    for (int level = 0; level < kProbedLevels && !windows.empty(); ++level) {
      next.clear();
      below.clear();
      for (const Window& w : windows) {
        const std::size_t later = next.size();
        const Descent descent = look(w, pending, next, level);
        if (descent == Descent::contact) return contact(0, false);
        if (descent == Descent::undecided) return undecided(w.t0, w.t1);
        if (next.size() == later) continue;
        below.push_back({w.t0, middle_, later, next.size()});
        below.push_back({middle_, w.t1, later, next.size()});
      }
      std::swap(pending, next);
      std::swap(windows, below);
    }
    return std::all_of(windows.begin(), windows.end(),
                       [&](const Window& w) { return walkInOrder(w, kProbedLevels); });
  }

  /// Depth first, earlier half first: all is certified up to w.t0. False: stop, `result_` says why.
  bool walkInOrder(const Window& w, int level) {
    auto& pending = context_.pending;
    const std::size_t later = pending.size();
    const Descent descent = look(w, pending, pending, level);
    const double t = middle_;
    const std::size_t count = pending.size();
    if (descent == Descent::undecided) return undecided(w.t0, w.t1);
    if (descent == Descent::contact) {  // only the first half matters now
      if (!options_.earliest || t - w.t0 <= options_.timeTolerance) return contact(w.t0, false);
      return walkInOrder({w.t0, t, later, count}, level + 1);
    }
    const bool free = count == later || (walkInOrder({w.t0, t, later, count}, level + 1) &&
                                         walkInOrder({t, w.t1, later, count}, level + 1));
    pending.resize(later);
    return free;
  }

  /// Most motions that a planner tries and that touch anything touch it for long: a few poses find
  /// that for a small part of what a walk over windows costs.
  bool touchesAtSamples() {
    return std::any_of(std::begin(kSamples), std::end(kSamples), [&](double t) {
      middle_ = t;
      auto& posed = context_.posed;
      posed.clear();
      for (const NodePair& pair : context_.pending) {
        const std::size_t m = pairs_[pair.bodies].motion;
        if (!posed.empty() && posed.back().motion == m) continue;
        posed.push_back({m, motion_.window(m, t, 0).X_AB});
        ++counters_.poses;
      }
      return probe(context_.pending, 0);
    });
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

  /// Something in [t0, t1] stays undecided; with a contact known at t1, or close to t0, that is its
  /// bracket all the same.
  bool undecided(double t0, double t1) {
    const bool clearance = result_.reason == UndecidedReason::clearance;
    if (contactTime_ == t1 && clearance && !wide_) return contact(t0, true);
    if (contactTime_ >= 0 && contactTime_ - t0 <= options_.timeTolerance) return contact(t0, false);
    result_.verdict = MotionVerdict::undecided;
    result_.certifiedUntil = t0;
    result_.contactTime = middle_;
    return false;
  }

  Descent outOfWork() {
    result_.reason = UndecidedReason::workLimit;
    result_.pair.reset();
    return Descent::undecided;
  }

  /// Walks the trees below one pair of nodes. What this window cannot separate goes to `later`.
  Descent descend(const NodePair& root, const MotionWindow& window, double h,
                  std::vector<NodePair>& later) {
    const ObbTree &a = *pairs_[root.bodies].a, &b = *pairs_[root.bodies].b;
    const BoxPairMargins margins = boxPairMargins(a.axisDefect(), a.centerReach(), b.axisDefect(),
                                                  b.centerReach(), window.X_AB);
    auto& stack = context_.stack;
    stack.clear();
    stack.push_back(root);
    while (!stack.empty()) {
      if (work() >= workEnd_) return outOfWork();
      if (later.size() >= leftoversEnd_) {
        later.insert(later.end(), stack.begin(), stack.end());
        return Descent::done;
      }
      const NodePair pair = stack.back();
      stack.pop_back();
      const ObbTree::Node &na = a.node(pair.a), &nb = b.node(pair.b);
      const Vec3 c = window.X_AB.m * nb.box.center;
      const PointTravel sphere = travelOf(window, c + window.X_AB.t, nb.radius);
      const BoxTravel travel = {window.linear + window.angular.cross(c), window.angular,
                                sphere.bend, sphere.curvature, sphere.cap};
      const double pad = roundedUp(options_.margin + sphere.pad);
      ++counters_.boxTests;
      if (obbsSeparated(na.box, nb.box, window.X_AB, margins, pad, travel)) continue;

      // Time before space where the window's travel dominates the boxes. The factors are measured,
      // soundness does not need them.
      const double size = std::max(na.radius, nb.radius);
      if (travel.cap > options_.tolerance && h > kShortest &&
          (32 * (travel.bend * window.angle + travel.curvature) > size || 1 * travel.cap > size)) {
        later.push_back(pair);
      } else if (na.isLeaf() && nb.isLeaf()) {
        const Descent leaf = leafPair(pair, window, h, later);
        if (leaf == Descent::undecided) return leaf;
        if (leaf == Descent::contact) {  // who goes on to the first half must look at this and the
                                         // rest again
          later.push_back(pair);
          later.insert(later.end(), stack.begin(), stack.end());
          return leaf;
        }
      } else if (nb.isLeaf() || (!na.isLeaf() && na.radius >= nb.radius)) {
        stack.push_back({na.right, pair.b, pair.bodies});
        stack.push_back({pair.a + 1, pair.b, pair.bodies});
      } else {
        stack.push_back({pair.a, nb.right, pair.bodies});
        stack.push_back({pair.a, pair.b + 1, pair.bodies});
      }
    }
    return Descent::done;
  }

  /// All that one leaf holds against all of another (one triangle each, but for indivisible leaves
  /// and convex parts).
  Descent leafPair(const NodePair& pair, const MotionWindow& window, double h,
                   std::vector<NodePair>& later) {
    const MotionPair& bodies = pairs_[pair.bodies];
    const ObbTree &a = *bodies.a, &b = *bodies.b;
    const ObbTree::Node &na = a.node(pair.a), &nb = b.node(pair.b);
    bool open = false;
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        if (work() >= workEnd_) return outOfWork();
        const MovingTrianglesAnswer found = decide(a, s, b, t, window);
        if (found.separated) continue;
        const Contact here{bodies.bodyA, bodies.bodyB, a.meshTriangle(s), b.meshTriangle(t)};
        if (found.contact) {
          contactTime_ = middle_;
          contactPair_ = here;
          return Descent::contact;
        }
        // Refining does not help, or need not.
        if (found.stuck || !(found.travel > options_.tolerance) || h <= kShortest) {
          wide_ = found.travel > options_.tolerance;
          result_.reason = UndecidedReason::clearance;
          result_.pair = here;
          result_.gap = found.gap;
          return Descent::undecided;
        }
        open = true;
      }
    if (open) later.push_back(pair);
    return Descent::done;
  }

  /// What a's s-th triangle, or part, and b's t-th one do in the window.
  MovingTrianglesAnswer decide(const ObbTree& a, std::uint32_t s, const ObbTree& b, std::uint32_t t,
                               const MotionWindow& window) {
    const double margin = options_.margin;
    const ConvexPart *pa = a.part(s), *pb = b.part(t);
    if (pa)
      return pb ? decideMovingParts(*pa, *pb, window, margin, counters_)
                : decideMovingParts(*pa, b.triangles()[t], window, margin, counters_);
    return pb ? decideMovingParts(a.triangles()[s], *pb, window, margin, counters_)
              : decideMovingTriangles(a.triangles()[s], b.triangles()[t], window, margin,
                                      counters_);
  }

  /// Is one of the pairs from[begin, …), left by the window that was looked at last, in contact at
  /// its middle's pose itself?
  bool probe(const std::vector<NodePair>& from, std::size_t begin) {
    auto posed = context_.posed.begin();
    for (std::size_t i = begin; i < from.size(); ++i) {
      const MotionPair& bodies = pairs_[from[i].bodies];
      while (posed->motion != bodies.motion) ++posed;  // both lists have the same order
      if (const auto hit = interferenceBelow(*bodies.a, *bodies.b, posed->X_AB,
                                             {from[i].a, from[i].b, 0}, context_, workEnd_)) {
        contactTime_ = middle_;
        contactPair_ = {bodies.bodyA, bodies.bodyB, hit->a, hit->b};
        return true;
      }
    }
    return false;
  }

  MotionSource& motion_;
  std::span<const MotionPair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  Counters& counters_;
  std::uint64_t workEnd_ = 0;
  std::size_t leftoversEnd_ = 0;
  bool sampled_ = false;
  double middle_ = 0;        // of the window under way
  double contactTime_ = -1;  // of the earliest contact known
  Contact contactPair_;
  bool wide_ = false;  // undecided at the middle, but the window goes on farther than the tolerance
  MotionResult result_;
};

}  // namespace

MotionResult certifyMotion(MotionSource& motion, std::span<const MotionPair> pairs,
                           const MotionOptions& options, QueryContext& context) {
  ++context.counters.edges;
  MotionResult result;
  if (motion.ambiguous()) {
    result.verdict = MotionVerdict::undecided;
    result.reason = UndecidedReason::ambiguous;
    result.certifiedUntil = 0;
  } else {
    result = Certifier(motion, pairs, options, context).run();
  }
  context.counters.undecided += result.verdict == MotionVerdict::undecided;
  return result;
}

}  // namespace corridor
