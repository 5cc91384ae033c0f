#include "collision/motion/distance_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/rounding.h"
#include "collision/motion/may_meet.h"
#include "collision/motion/motion_answer.h"
#include "collision/queries/surface_distance.h"

/// Derivation of the bound. Let X̂ be the rounded map at t, and D the distance of the bodies under
/// X̂ in real arithmetic. Anywhere in [t − h, t + h] and in the tube, every point of the real b is
/// within isotropic + pad of its place under X̂ (`MotionBound` of a sphere that contains b). Then b
/// stays at least D − isotropic − pad away from a. `pad` includes the clearance slack, as an error
/// of the motion.
///
/// Let T = margin + pad + isotropic. A measurement with the relative error ρ = isotropic/(4T)
/// proves more than T if the distance exceeds T(1 + ρ) = T + isotropic/4. An interval is therefore
/// proved whenever the clearance beyond margin and `pad` exceeds 5/4 of the motion bound.
namespace corridor {
namespace {

/// The first step of the search for a contact after the time at which the clearance has vanished,
/// as a fraction of the motion. Each further step is twice as long.
constexpr double kFirstProbe = 0x1p-40;

}  // namespace

DistanceSteps::DistanceSteps(MotionSource& motion, std::span<const MotionPair> pairs,
                             const MotionOptions& options, QueryContext& context)
    : motion_(motion), pairs_(pairs), options_(options), context_(context) {
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() - work();
  workEnd_ = work() + std::min(options_.workLimit, most);
}

std::uint64_t DistanceSteps::work() const {
  return context_.counters.work() + kMeasurementWork * measurements_;
}

bool DistanceSteps::outOfWork() const {
  return work() >= workEnd_;
}

RelativeMotion DistanceSteps::relativeMotion(std::uint32_t pair, double t, double h) {
  RelativeMotion w = motion_.relativeMotion(pairs_[pair].motion, t, h);
  spreadNaN(w);
  w.fixedError += options_.clearanceSlack;  // a proof requires the slack, a contact does not
  ++context_.counters.poses;
  return w;
}

DistanceSteps::Bound DistanceSteps::boundOf(std::uint32_t pair,
                                            const RelativeMotion& relative) const {
  const Body& b = *pairs_[pair].b;
  const MotionBound goes =
      motionBound(relative, relative.X_AB * b.sphereCenter(), b.sphereRadius());
  return {goes.isotropic, roundedUp(options_.marginOf(pair) + goes.isotropic + goes.pad)};
}

DistanceSteps::Bound DistanceSteps::bound(std::uint32_t pair, double t, double h) {
  return boundOf(pair, relativeMotion(pair, t, h));
}

bool DistanceSteps::staysAway(std::uint32_t pair, double t, double h) {
  const Body &a = *pairs_[pair].a, &b = *pairs_[pair].b;
  return !mayMeet(a, sweptSphere(b, relativeMotion(pair, t, h)), options_.marginOf(pair));
}

DistanceSteps::Measurement DistanceSteps::measureAt(std::uint32_t pair, double t, double h,
                                                    bool exact) {
  ++measurements_;
  const Body &a = *pairs_[pair].a, &b = *pairs_[pair].b;
  const RelativeMotion w = relativeMotion(pair, t, h);
  Measurement measured;
  measured.bound = boundOf(pair, w);
  const auto [bound, needed] = measured.bound;
  DistanceOptions measure;
  if (!exact) measure.relative = needed < HUGE_VAL ? bound / (4 * needed) : 0.25;

  const Posed posedA(a), posedB(b, w.X_AB);
  const Distance found =
      surfaceDistance(posedA, posedB, measure, context_, options_.trees, &context_.lastPair(pair));
  measured.s = found.a;
  measured.t = found.b;
  const double margin = options_.marginOf(pair);
  measured.gap = std::max(0.0, found.distance - margin);
  // If the pose overflows, a measured distance of 0 is no contact: it only means that nothing is
  // known.
  measured.contact = w.X_AB.isFinite() &&
                     (found.distance == 0 || distanceUpperBound(posedA, posedB, found) <= margin);
  measured.hopeless = !(found.distance > needed - bound);
  if (found.distance > needed)
    measured.lower = distanceLowerBound(posedA, posedB, found, measure, context_, options_.trees);
  return measured;
}

MotionResult DistanceSteps::contact(std::uint32_t pair, double t0, double t1,
                                    const Measurement& seen) const {
  MotionResult result;
  result.verdict = MotionVerdict::contact;
  result.certifiedUntil = t0;
  result.time = t1;
  result.pair = Contact{pairs_[pair].bodyA, pairs_[pair].bodyB, seen.s, seen.t};
  return result;
}

MotionResult DistanceSteps::workLimit(double t0) const {
  MotionResult result;
  result.verdict = MotionVerdict::undecided;
  result.reason = UndecidedReason::workLimit;
  result.certifiedUntil = t0;
  result.time = t0;
  return result;
}

MotionResult DistanceSteps::answerWhereStuck(std::uint32_t pair, double t0, double time,
                                             double clearance) {
  for (double after = kFirstProbe; !motion_.still(); after *= 2) {
    const double t1 = std::min(t0 + after, 1.0), h = (t1 - t0) / 2;
    const bool narrow = !options_.earliest || t1 - t0 <= options_.timeTolerance;
    // `grazing` requires that on all of [t0, t1] the clearance is below twice the tolerance.
    if (!narrow && clearance + 2 * bound(pair, t0 + h, h).bound > 2 * options_.tolerance) break;
    const Measurement there = measureAt(pair, t1, 0, true);
    if (there.contact) {
      MotionResult result = contact(pair, t0, t1, there);
      result.grazing = !narrow;
      return result;
    }
    if (t1 == 1) break;
  }
  const Measurement seen = measureAt(pair, time, 0, true);
  MotionResult result;
  result.verdict = MotionVerdict::undecided;
  result.reason = reasonOf(motion_.relativeMotion(pairs_[pair].motion, time, 0), *pairs_[pair].b,
                           seen.gap, options_.tolerance);
  result.certifiedUntil = t0;
  result.time = time;
  result.pair = Contact{pairs_[pair].bodyA, pairs_[pair].bodyB, seen.s, seen.t};
  result.gap = seen.gap;
  return result;
}

}  // namespace corridor
