#include "collision/motion/certify_motion.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/motion/moving_triangles.h"
#include "collision/volumes/overlap_obb_obb.h"

namespace corridor {
namespace {

/// One query: walks windows of time depth first, earlier half first.
class Certifier {
 public:
  Certifier(const RigidMotion& motion, std::span<const TreePair> pairs, const MotionOptions& options, QueryContext& context)
      : motion_(motion), pairs_(pairs), options_(options), context_(context), counters_(context.counters) {}

  MotionResult run() {
    auto& pending = context_.pending;
    pending.clear();
    for (std::uint32_t k = 0; k < pairs_.size(); ++k) pending.push_back({0, 0, k});
    workEnd_ = work() + options_.workLimit;
    if (walk(0, 1, 0, pending.size())) return {};
    if (!options_.earliest) result_.certifiedUntil = 0;
    return result_;
  }

 private:
  using NodePair = QueryContext::NodePair;
  enum class Descent { done, contact, undecided };

  std::uint64_t work() const { return counters_.boxTests + counters_.triangleTests; }

  /// Certifies the pairs pending[begin, end) over [t0, t1]; all is certified up to t0. False: stop, `result_` says why.
  bool walk(double t0, double t1, std::size_t begin, std::size_t end) {
    const double h = (t1 - t0) / 2;
    middle_ = t0 + h;  // dyadic: exact
    const double t = middle_;
    const MotionWindow window = motion_.window(t, h);
    ++counters_.poses;
    const std::size_t later = context_.pending.size();
    for (std::size_t i = begin; i < end; ++i) {
      const NodePair pair = context_.pending[i];
      const Descent descent = descend(pair, window, h);
      if (descent == Descent::done) continue;
      if (descent == Descent::undecided) return undecided(t0, t1);
      if (!options_.earliest || t - t0 <= options_.timeTolerance) return contact(t0, false);
      // A contact at t: only the first half matters now. This window has not looked at the rest of the list.
      for (std::size_t k = i + 1; k < end; ++k) context_.pending.push_back(NodePair(context_.pending[k]));
      return walk(t0, t, later, context_.pending.size());
    }
    const std::size_t count = context_.pending.size();
    const bool free = count == later || (walk(t0, t, later, count) && walk(t, t1, later, count));
    context_.pending.resize(later);
    return free;
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

  /// Something in [t0, t1] stays undecided; with a contact known at t1, or close to t0, that is its bracket all the same.
  bool undecided(double t0, double t1) {
    const bool clearance = result_.reason == UndecidedReason::clearance;
    if (contactTime_ == t1 && clearance) return contact(t0, true);
    if (contactTime_ >= 0 && contactTime_ - t0 <= options_.timeTolerance) return contact(t0, false);
    result_.verdict = MotionVerdict::undecided;
    result_.certifiedUntil = t0;
    result_.contactTime = middle_;
    return false;
  }

  /// Walks the trees below one pair of nodes. What this window cannot separate goes to `pending`.
  Descent descend(const NodePair& root, const MotionWindow& window, double h) {
    const ObbTree &a = *pairs_[root.bodies].fixed, &b = *pairs_[root.bodies].moving;
    const BoxPairMargins margins =
        boxPairMargins(a.axisDefect(), a.centerReach(), b.axisDefect(), b.centerReach(), window.X_WB);
    auto& stack = context_.stack;
    stack.clear();
    stack.push_back(root);
    while (!stack.empty()) {
      if (work() >= workEnd_) {
        result_.reason = UndecidedReason::workLimit;
        result_.pair.reset();
        return Descent::undecided;
      }
      const NodePair pair = stack.back();
      stack.pop_back();
      const ObbTree::Node &na = a.node(pair.a), &nb = b.node(pair.b);
      // The sphere about box b: every point y of it has |y| ≤ |c| + ρ and turns by at most |ω × c| + α·ρ.
      const Vec3 c = window.X_WB.m * nb.box.center;
      const Vec3 lever = window.angular.cross(c);
      const double reach = nb.box.center.norm() + nb.radius;
      const double turn = lever.norm() + window.angle * (nb.radius + 16 * kUnit * reach);
      BoxTravel travel;
      travel.linear = window.linear + lever;
      travel.angular = window.angular;
      travel.curvature = roundedUp(window.curvature(turn));
      travel.cap = roundedUp(window.speed + turn);
      const double pad = roundedUp(options_.margin + window.fixedError + window.reachError * reach);
      ++counters_.boxTests;
      if (obbsSeparated(na.box, nb.box, window.X_WB, margins, pad, travel)) continue;

      // Time before space where the window's travel dominates the boxes. The factors are measured, soundness does not need them.
      const double size = std::max(na.radius, nb.radius);
      if (travel.cap > options_.tolerance && (4 * travel.curvature * window.angle > size || 0.2 * travel.cap > size)) {
        context_.pending.push_back(pair);
      } else if (na.isLeaf() && nb.isLeaf()) {
        const Descent leaf = leafPair(pair, window, h);
        if (leaf == Descent::undecided) return leaf;
        if (leaf == Descent::contact) {  // who goes on to the first half must look at this and the rest again
          context_.pending.push_back(pair);
          context_.pending.insert(context_.pending.end(), stack.begin(), stack.end());
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

  /// All triangles of one leaf against all of another (one each, but for indivisible leaves).
  Descent leafPair(const NodePair& pair, const MotionWindow& window, double h) {
    const TreePair& bodies = pairs_[pair.bodies];
    const ObbTree::Node &na = bodies.fixed->node(pair.a), &nb = bodies.moving->node(pair.b);
    bool later = false;
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        const MovingTrianglesAnswer found = decideMovingTriangles(bodies.fixed->triangles()[s], bodies.moving->triangles()[t],
                                                                  window, options_.margin, counters_);
        if (found.separated) continue;
        const Contact triangles{bodies.movingBody, bodies.fixedBody, bodies.moving->meshTriangle(t),
                                bodies.fixed->meshTriangle(s)};
        if (found.contact) {
          contactTime_ = middle_;
          contactPair_ = triangles;
          return Descent::contact;
        }
        // 2^-48 of the motion: much below, the halves of windows would no longer be exact.
        if (found.travel <= options_.tolerance || h <= 0x1p-48) {
          result_.reason = UndecidedReason::clearance;
          result_.pair = triangles;
          result_.gap = found.gap;
          return Descent::undecided;
        }
        later = true;
      }
    if (later) context_.pending.push_back(pair);
    return Descent::done;
  }

  const RigidMotion& motion_;
  std::span<const TreePair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  Counters& counters_;
  std::uint64_t workEnd_ = 0;
  double middle_ = 0;        // of the window under way
  double contactTime_ = -1;  // of the earliest contact known
  Contact contactPair_;
  MotionResult result_;
};

}  // namespace

MotionResult certifyMotion(const RigidMotion& motion, std::span<const TreePair> pairs, const MotionOptions& options,
                           QueryContext& context) {
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
