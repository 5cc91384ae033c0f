#include "collision/motion/certify_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "collision/convex/convex_distance.h"
#include "collision/motion/broad_phase.h"
#include "collision/motion/decide_interval.h"
#include "collision/motion/motion_answer.h"
#include "collision/motion/split_rules.h"

namespace corridor {
namespace {

/// Scratch memory of motion queries.
struct MotionScratch {
  WorkList list;
  std::vector<Interval> open;       ///< a stack of intervals, the earliest on top
  std::vector<std::uint32_t> near;  ///< the pairs that the broad phase found, or all pairs
};

/// Returns a number above the index of every body whose swept sphere, as seen from the world, the
/// query may need. Only pairs whose `worldMotionB` is set need such spheres.
std::size_t bodyCountOf(const MotionQuery& query) {
  if (query.broadPhase) return query.broadPhase->bodies();
  std::size_t bodies = 0;
  for (const MotionPair& pair : query.pairs)
    if (pair.worldMotionB != MotionPair::kNone)
      bodies = std::max({bodies, pair.bodyA + 1, pair.bodyB + 1});
  return bodies;
}

/// One query: the loop over time intervals.
class Certifier {
 public:
  Certifier(MotionSource& source, const MotionQuery& query)
      : source_(source),
        query_(query),
        motions_(source, bodyCountOf(query), query.context),
        use_(query.context.scratch.use<MotionScratch>()),
        list_(use_->list),
        open_(use_->open) {
    list_.begin(nearPairs());
    open_.clear();
  }

  MotionResult run() {
    if (query_.options.earliest) {
      open_.push_back({0, 1, 0, list_.groups.size(), list_.mark()});
    } else if (const auto answer = walkByLevels()) {
      return *answer;
    }
    return walkInOrder();
  }

  /// Returns the pairs that bounds and hulls do not prove apart.
  std::vector<std::uint32_t> pairsLeft() {
    std::vector<bool> left(query_.pairs.size());
    open_.push_back({0, 1, 0, list_.groups.size(), list_.mark()});
    while (!open_.empty()) {
      const Interval w = open_.back();
      open_.pop_back();
      list_.cut(w.mark);
      const std::size_t later = list_.groups.size();
      separateBodies(query_, w, motions_, list_, left);
      if (list_.groups.size() == later) continue;
      ++query_.context.counters.splits;
      const double t = w.middle();
      open_.push_back({t, w.t1, later, list_.groups.size(), list_.mark()});
      open_.push_back({w.t0, t, later, list_.groups.size(), list_.mark()});
    }
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t k = 0; k < left.size(); ++k)
      if (left[k]) numbers.push_back(k);
    return numbers;
  }

 private:
  /// Returns the pairs that may come too close during the motion, in ascending order.
  std::span<const std::uint32_t> nearPairs() {
    if (query_.options.only) return *query_.options.only;
    std::vector<std::uint32_t>& near = use_->near;
    if (query_.broadPhase && !query_.certificate) {
      motions_.select(0.5, 0.5);
      query_.broadPhase->find(motions_, query_.largestRequiredDistance(), near);
    } else {
      near.resize(query_.pairs.size());
      std::iota(near.begin(), near.end(), std::uint32_t{0});
    }
    return near;
  }

  struct KnownContact {
    double time;
    Contact pair;
  };

  /// Tests the first levels of halving, all intervals of a level before the next level. Returns the
  /// answer if these levels give it. Otherwise fills the stack with the intervals that are left
  /// (none: the motion is free), and returns nothing.
  std::optional<MotionResult> walkByLevels() {
    const auto findContactInMiddle = [&](const Interval& w) {
      return !source_.still() && findContactAt(w.middle(), w);
    };
    bool far = false;
    std::array<Interval, 1 << SplitRules::kFirstLevels> intervals, below;
    intervals[0] = testBodies(query_, motions_, list_, far);
    std::size_t count = intervals[0].begin < intervals[0].end;
    // Many motions with a contact have one at their end.
    if (!source_.still() && findContactAt(1, intervals[0])) return contact(0, false);
    for (int level = 0; level < SplitRules::kFirstLevels && count; ++level) {
      std::size_t halves = 0;
      for (Interval w : std::span(intervals).first(count)) {
        if (0 < level && level <= SplitRules::kSampledLevels && findContactInMiddle(w))
          return contact(0, false);
        if (level > 0 || !far) {
          const std::size_t later = list_.groups.size();
          const IntervalAnswer answer = decideInterval(query_, w, motions_, list_);
          if (answer.found.kind != Descent::Kind::done) return answerWhereUnproved(w, answer);
          if (list_.groups.size() == later) continue;
          w.begin = later, w.end = list_.groups.size();
        }
        if (level == 0 && findContactInMiddle(w)) return contact(0, false);
        ++query_.context.counters.splits;
        const double t = w.middle();
        below[halves++] = {w.t0, t, w.begin, w.end};
        below[halves++] = {t, w.t1, w.begin, w.end};
      }
      std::swap(intervals, below);
      count = halves;
    }
    for (std::size_t i = count; i-- > 0;) {
      intervals[i].mark = list_.mark();
      open_.push_back(intervals[i]);
    }
    return std::nullopt;
  }

  /// Walks the open intervals depth first, the earlier half first. Everything before the interval
  /// on top of the stack is therefore proved. A time that cannot be decided is found before the
  /// later intervals are refined.
  MotionResult walkInOrder() {
    while (!open_.empty()) {
      const Interval w = open_.back();
      open_.pop_back();
      list_.cut(w.mark);
      const std::size_t later = list_.groups.size();
      const IntervalAnswer answer = decideInterval(query_, w, motions_, list_);
      const bool touches = answer.found.kind == Descent::Kind::contact;
      if (!touches && answer.found.kind != Descent::Kind::done)
        return answerWhereUnproved(w, answer);
      const double t = w.middle();
      if (touches) {
        keepContact(answer, t);
        if (!query_.options.earliest || t - w.t0 <= query_.options.timeTolerance)
          return contact(w.t0, false);
        open_.clear();  // only the time before the contact matters now
      } else if (list_.groups.size() == later) {
        continue;
      }
      ++query_.context.counters.splits;
      if (!touches) open_.push_back({t, w.t1, later, list_.groups.size(), list_.mark()});
      open_.push_back({w.t0, t, later, list_.groups.size(), list_.mark()});
    }
    return known_ ? contact(known_->time, false) : MotionResult{};
  }

  /// Finds a pair of bodies in this range of groups that touches at the rounded pose at t. Keeps
  /// the contact in `known_`, and returns whether one was found. Gives up at the work limit.
  bool findContactAt(double t, const Interval& range) {
    motions_.select(t, 0);
    for (std::size_t g = range.begin; g < range.end && !outOfWork(); ++g) {
      const WorkList::Group group = list_.groups[g];
      const MotionPair& pair = query_.pairs[group.bodies];
      // If no tree of the pair has been walked yet, the bodies' bounding spheres and boxes may be
      // separated at t. Then no tree is needed.
      const bool wantBestBound = query_.certificate != nullptr;
      if (list_.isNotWalkedYet(group) && motions_.separation(pair, 0, wantBestBound).clearance > 0)
        continue;
      if (testHulls(query_, g, 0, 0, motions_, list_).separated) continue;
      if (findContact(group.bodies, motions_.relative(pair.motion).X_AB, t,
                      list_.nodePairsOf(group)))
        return true;
    }
    return false;
  }

  /// Finds a contact of two bodies below these node pairs, at the pose X_AB at t. Keeps the contact
  /// in `known_`, and returns whether one was found.
  bool findContact(std::uint32_t bodies, const Transform& X_AB, double t,
                   std::span<const NodePair4> start) {
    const auto hit = contactBelow(query_, bodies, X_AB, start);
    if (!hit) return false;
    const MotionPair& pair = query_.pairs[bodies];
    known_ = {t, {pair.bodyA, pair.bodyB, hit->a, hit->b}};
    return true;
  }

  /// Finds a contact of the pair of bodies that was not separated. The contact is at the interval's
  /// end, or at a later time that is at most the time tolerance after the interval's beginning. (An
  /// interval at whose end a contact begins can never be proved.) Keeps the contact in `known_`,
  /// and returns whether one was found.
  bool findContactAfter(const Interval& w, std::uint32_t bodies) {
    for (double after = 0; !source_.still(); after = std::max(2 * after, 0x1p-40)) {
      const double t = std::min(w.t1 + after, 1.0);
      if (after > 0 && t - w.t0 > query_.options.timeTolerance) return false;
      // Not from `source_` directly: a motion that `motions_` keeps would lose its screws.
      motions_.select(t, 0);
      const Transform X_AB = motions_.relative(query_.pairs[bodies].motion).X_AB;
      if (findContact(bodies, X_AB, t, kWholeTrees)) return true;
      if (t == 1) return false;
    }
    return false;
  }

  bool outOfWork() const { return query_.context.counters.work() >= query_.workEnd; }

  /// Keeps in `known_` the contact that the test of an interval found at its middle.
  void keepContact(const IntervalAnswer& answer, double t) {
    const MotionPair& pair = query_.pairs[answer.bodies];
    known_ = {t, {pair.bodyA, pair.bodyB, answer.found.s, answer.found.t}};
  }

  /// Returns the known contact as the answer.
  MotionResult contact(double certifiedUntil, bool grazing) const {
    MotionResult result;
    result.verdict = MotionVerdict::contact;
    result.certifiedUntil = certifiedUntil;
    result.time = known_->time;
    result.pair = known_->pair;
    result.grazing = grazing;
    return result;
  }

  /// Returns the answer for an interval that could not be proved free; looks for a contact after
  /// the interval if none is known. If a contact is known at the end of the interval, or soon after
  /// its beginning, the answer is this contact, proved free until the interval's beginning.
  MotionResult answerWhereUnproved(const Interval& w, const IntervalAnswer& answer) {
    const auto& [found, bodies] = answer;
    if (found.kind == Descent::Kind::contact) {
      keepContact(answer, w.middle());
      return contact(0, false);
    }
    const bool clearance = found.kind == Descent::Kind::undecided;
    const auto near = [&] { return known_ && known_->time - w.t0 <= query_.options.timeTolerance; };
    const auto atEnd = [&] { return known_ && known_->time == w.t1; };
    if (clearance && !near() && !atEnd()) findContactAfter(w, bodies);
    if (atEnd() && clearance && !found.wide) return contact(w.t0, true);
    if (known_ && (near() || !query_.options.earliest)) return contact(w.t0, false);
    MotionResult result;
    result.verdict = MotionVerdict::undecided;
    result.reason = UndecidedReason::workLimit;
    result.certifiedUntil = w.t0;
    result.time = w.middle();
    if (clearance) {
      const MotionPair& pair = query_.pairs[bodies];
      motions_.select(w.middle(), w.half());
      result.reason =
          reasonOf(motions_.relative(pair.motion), *pair.b, found.gap, query_.options.tolerance);
      result.pair = Contact{pair.bodyA, pair.bodyB, found.s, found.t};
      result.gap = found.gap;
    }
    return result;
  }

  MotionSource& source_;
  const MotionQuery& query_;
  IntervalMotions motions_;
  Scratch::Use<MotionScratch> use_;
  WorkList& list_;
  std::vector<Interval>& open_;
  std::optional<KnownContact> known_;  // the earliest contact found so far
};

/// Returns a point of a, in a's frame, where the two leaf primitives of the contact touch or are
/// closest.
Vec3 contactPoint(MotionSource& motion, std::span<const MotionPair> pairs,
                  const MotionResult& result, Counters& counters) {
  const Contact& contact = *result.pair;
  const auto pair = std::find_if(pairs.begin(), pairs.end(), [&](const MotionPair& p) {
    return p.bodyA == contact.bodyA && p.bodyB == contact.bodyB;
  });
  const auto cornersOf = [](const Body& body, std::size_t i) {
    const TriangleMesh& mesh = body.mesh();
    return body.isMesh() ? Triangle{mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)}
                         : Triangle();
  };
  const Triangle a = cornersOf(*pair->a, contact.primitiveA),
                 b = cornersOf(*pair->b, contact.primitiveB);
  const auto setOf = [](const Body& body, std::size_t i, const Triangle& corners) {
    return body.isMesh() ? ConvexSet(corners) : ConvexSet(body.parts()[i]);
  };
  const Transform X_AB = motion.relativeMotion(pair->motion, result.time, 0).X_AB;
  const ConvexDistance found = convexDistance({setOf(*pair->a, contact.primitiveA, a), {}},
                                              {setOf(*pair->b, contact.primitiveB, b), X_AB});
  counters.addTest(found.exact);
  return found.p_WA;
}

}  // namespace

PairMargins::PairMargins(std::vector<double> metres) : metres_(std::move(metres)) {
  for (const double margin : metres_) {
    if (!(margin >= 0 && std::isfinite(margin)))
      throw std::invalid_argument("the margins of pairs must be finite and not negative");
    largest_ = std::max(largest_, margin);
  }
}

const char* nameOf(MotionVerdict verdict) {
  switch (verdict) {
    case MotionVerdict::free:
      return "free";
    case MotionVerdict::contact:
      return "contact";
    case MotionVerdict::undecided:
      break;
  }
  return "undecided";
}

const char* nameOf(UndecidedReason reason) {
  switch (reason) {
    case UndecidedReason::none:
      break;
    case UndecidedReason::clearance:
      return "clearance";
    case UndecidedReason::workLimit:
      return "work_limit";
    case UndecidedReason::ambiguous:
      return "ambiguous";
    case UndecidedReason::rounding:
      return "rounding";
    case UndecidedReason::floatingPoint:
      return "floating_point";
    case UndecidedReason::beyondProofs:
      return "beyond_proofs";
  }
  return "";
}

void requireValid(const MotionOptions& options, std::size_t pairs) {
  const auto finite = [](double x, bool zeroToo) {
    return std::isfinite(x) && (zeroToo ? x >= 0 : x > 0);
  };
  if (!finite(options.tolerance, false))
    throw std::invalid_argument("the tolerance of a motion query must be positive and finite");
  if (!finite(options.margin, true) || !finite(options.clearanceSlack, true))
    throw std::invalid_argument("margin and clearance slack must be finite and not negative");
  if (!finite(options.timeTolerance, false))
    throw std::invalid_argument("the time tolerance must be positive and finite");
  if (options.pairMargins && options.pairMargins->size() != pairs)
    throw std::invalid_argument("margins of pairs: one for each pair is required");
}

MotionResult certifyMotion(MotionSource& motion, std::span<const MotionPair> pairs,
                           const MotionOptions& options, QueryContext& context,
                           MotionCertificate* certificate, const BroadPhase* broadPhase) {
  requireValid(options, pairs.size());
  if (certificate) *certificate = {};
  return answered(motion, options.earliest, [&] {
    const std::uint64_t before = context.counters.work(),
                        most = std::numeric_limits<std::uint64_t>::max() - before;
    const MotionQuery query{
        pairs,     options, context, certificate, before + std::min(options.workLimit, most),
        broadPhase};
    const MotionResult result = Certifier(motion, query).run();
    if (certificate && result.verdict == MotionVerdict::contact)
      certificate->point_A = contactPoint(motion, pairs, result, context.counters);
    return result;
  });
}

std::vector<std::uint32_t> pairsLeftByHulls(MotionSource& motion, std::span<const MotionPair> pairs,
                                            const MotionOptions& options, QueryContext& context,
                                            const BroadPhase* broadPhase) {
  requireValid(options, pairs.size());
  std::vector<std::uint32_t> left;
  const MotionResult asked = answered(motion, false, [&] {
    left =
        Certifier(motion, {pairs, options, context, nullptr, kNoWorkLimit, broadPhase}).pairsLeft();
    return MotionResult();
  });
  if (asked.verdict == MotionVerdict::free) return left;
  left.resize(pairs.size());  // no curve, or no bound holds
  std::iota(left.begin(), left.end(), std::uint32_t{0});
  return left;
}

}  // namespace corridor
