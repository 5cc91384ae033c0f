#include "collision/motion/check_certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "collision/core/rounding.h"
#include "collision/motion/relative_motion.h"
#include "collision/queries/containment.h"
#include "collision/queries/distance.h"

namespace corridor {
namespace {

using Kind = CertificateFault::Kind;

/// Returns the motion bound of all of b in the interval, tube and rounding included.
MotionBound motionBoundOf(const Body& b, const RelativeMotion& relative) {
  const Vec3 y = relative.X_AB.m * b.sphereCenter();
  // The computed centre of the sphere is off by less than 8u of its terms per coordinate: 16u as a
  // length.
  const double terms = y.cwiseAbs().sum() + relative.X_AB.t.cwiseAbs().sum();
  return motionBound(relative, y + relative.X_AB.t,
                     roundedUp(b.sphereRadius() + 16 * kUnit * terms));
}

/// The check of the intervals of one certificate, with a work limit for all of them together.
class CertificateCheck {
 public:
  CertificateCheck(MotionSource& motion, std::span<const MotionPair> pairs,
                   const MotionOptions& options, QueryContext& context)
      : motion_(motion), pairs_(pairs), options_(options), context_(context) {
    const std::uint64_t done = context.counters.work();
    workEnd_ = done + std::min(options.workLimit, std::numeric_limits<std::uint64_t>::max() - done);
  }

  /// Proves that b keeps from a the distance margin + (clearance − margin)/2 on all of [t0, t1].
  /// Returns a fault if this fails.
  std::optional<CertificateFault> faultIn(const FreeInterval& i) {
    const MotionPair& pair = pairs_[i.pair];
    const double h = (i.t1 - i.t0) / 2, middle = i.t0 + h;
    // Below a width of 2^-52 a middle may be rounded, and then [middle − h, middle + h] is another
    // interval.
    if (middle - i.t0 != h || i.t1 - middle != h)
      return CertificateFault{Kind::unproved, i.pair, i.t0};
    if (context_.counters.work() >= workEnd_)
      return CertificateFault{Kind::workLimit, i.pair, middle};
    RelativeMotion relative = motion_.relativeMotion(pair.motion, middle, h);
    spreadNaN(relative);
    const auto closer = [&](double d) {
      return closerThan(Posed(pair.a->binaryTree()), Posed(pair.b->binaryTree(), relative.X_AB), d,
                        context_);
    };
    const MotionBound bound = motionBoundOf(*pair.b, relative);
    const double margin = options_.marginOf(i.pair);
    const double beyond = std::max(0.0, i.clearance - margin);
    const double needed = roundedUp(margin + roundedUp(beyond / 2) + bound.isotropic + bound.pad);
    if (needed < HUGE_VAL && !closer(needed)) {
      // No surfaces touch in this interval, so b cannot enter or leave a. For an interval from t =
      // 0, the middle therefore decides containment at t = 0. Later intervals need no such test.
      if (i.t0 > 0 || !findOneInsideOther(Posed(*pair.a), Posed(*pair.b, relative.X_AB), context_))
        return std::nullopt;
      return CertificateFault{Kind::refuted, i.pair, 0};
    }
    // Shorter intervals would not help: rounding and tube (`pad`) cause the lack of clearance, or
    // the claim is false.
    if (!(bound.isotropic >= std::max(beyond, options_.tolerance) / 4) ||
        !(i.t0 < middle && middle < i.t1))
      return CertificateFault{closer(margin + 0.75 * beyond) ? Kind::refuted : Kind::unproved,
                              i.pair, middle};
    const auto first = faultIn({i.pair, i.t0, middle, i.clearance});
    return first ? first : faultIn({i.pair, middle, i.t1, i.clearance});
  }

 private:
  MotionSource& motion_;
  std::span<const MotionPair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  std::uint64_t workEnd_ = 0;
};

/// Reports whether the ends of the interval are in [0, 1], in the right order, and on the grid of
/// times, so that all middles are exact.
bool isOnGrid(const FreeInterval& i) {
  const auto onGrid = [](double t) {
    return t >= 0 && t <= 1 && std::ldexp(t, 48) == std::floor(std::ldexp(t, 48));
  };
  return onGrid(i.t0) && onGrid(i.t1) && i.t0 < i.t1;
}

bool areOptions(const MotionOptions& options, std::size_t pairs) {
  const auto finite = [](double x) { return x >= 0 && x < HUGE_VAL; };
  if (options.pairMargins && options.pairMargins->size() != pairs) return false;
  return finite(options.margin) && finite(options.clearanceSlack) && finite(options.tolerance) &&
         options.tolerance > 0;
}

}  // namespace

std::optional<CertificateFault> checkCertificate(MotionSource& motion,
                                                 std::span<const MotionPair> pairs,
                                                 const MotionOptions& options, double until,
                                                 const MotionCertificate& certificate,
                                                 QueryContext& context) {
  if (!standardFloatingPoint()) return CertificateFault{Kind::floatingPoint, 0, 0};
  if (!areOptions(options, pairs.size()) || !(until >= 0 && until <= 1))
    return CertificateFault{Kind::malformed, 0, until};
  const bool claims = until > 0 || !certificate.free.empty();
  if (claims && motion.ambiguous()) return CertificateFault{Kind::ambiguous, 0, 0};
  std::vector<FreeInterval> intervals = certificate.free;
  const auto leastOf = [&](std::size_t pair) {
    return roundedDown(options.marginOf(pair) + options.clearanceSlack);
  };
  for (const FreeInterval& i : intervals)
    if (i.pair >= pairs.size() || !isOnGrid(i) ||
        !(i.clearance >= leastOf(i.pair) && i.clearance > 0 && i.clearance < HUGE_VAL))
      return CertificateFault{Kind::malformed, i.pair, i.t0};
  std::sort(intervals.begin(), intervals.end(), [](const FreeInterval& x, const FreeInterval& y) {
    return x.pair != y.pair ? x.pair < y.pair : x.t0 < y.t0;
  });
  auto next = intervals.begin();
  for (std::size_t k = 0; k < pairs.size() && until > 0; ++k) {
    double covered = 0;
    for (; next != intervals.end() && next->pair == k; ++next)
      if (next->t0 <= covered) covered = std::max(covered, next->t1);
    if (covered < until) return CertificateFault{Kind::gap, k, covered};
  }
  CertificateCheck check(motion, pairs, options, context);
  for (const FreeInterval& i : intervals)
    if (auto fault = check.faultIn(i)) return fault;
  return std::nullopt;
}

}  // namespace corridor
