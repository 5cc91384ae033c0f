#include "collision/motion/distance_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/rounding.h"
#include "collision/motion/may_meet.h"
#include "collision/motion/motion_answer.h"
#include "collision/queries/surface_distance.h"

/// The bound. Let X̂ be the rounded map at t, which the distance D is of, in real arithmetic. Every
/// point of the real b, anywhere in [t − h, t + h] and in the tube, is within cap + pad of where X̂
/// has it (`PointTravel`, of a ball that holds b): so b is at least D − cap − pad away from a then.
/// The reserve is in the pad, as an error of the motion.
///
/// A measure with the relative error ρ = cap/4T, T = margin + pad + cap, proves more than T if the
/// distance exceeds T(1 + ρ) = T + cap/4: a window is proved wherever the clearance beyond margin
/// and pad is above 5/4 of the travel.
namespace corridor {
namespace {

/// Steps after which a contact is looked for where the clearance has vanished: doubling from here,
/// of the motion.
constexpr double kFirstProbe = 0x1p-40;

}  // namespace

DistanceSteps::DistanceSteps(MotionSource& motion, std::span<const MotionPair> pairs,
                             const MotionOptions& options, QueryContext& context)
    : motion_(motion), pairs_(pairs), options_(options), context_(context) {
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() - work();
  workEnd_ = work() + std::min(options_.workLimit, most);
}

std::uint64_t DistanceSteps::work() const {
  return context_.counters.work() + kLookWork * looks_;
}

bool DistanceSteps::outOfWork() const {
  return work() >= workEnd_;
}

MotionWindow DistanceSteps::window(std::uint32_t pair, double t, double h) {
  MotionWindow w = motion_.window(pairs_[pair].motion, t, h);
  w.fixedError += options_.reserve;  // asked of a proof, not of a contact: as the tube is
  ++context_.counters.poses;
  return w;
}

DistanceSteps::Bound DistanceSteps::boundOf(std::uint32_t pair, const MotionWindow& window) const {
  const Body& b = *pairs_[pair].b;
  const PointTravel goes = travelOf(window, window.X_AB * b.sphereCenter(), b.sphereRadius());
  return {goes.cap, roundedUp(options_.margin + goes.cap + goes.pad)};
}

DistanceSteps::Bound DistanceSteps::bound(std::uint32_t pair, double t, double h) {
  return boundOf(pair, window(pair, t, h));
}

bool DistanceSteps::staysAway(std::uint32_t pair, double t, double h) {
  const Body &a = *pairs_[pair].a, &b = *pairs_[pair].b;
  return !mayMeet(a, sweptBall(b, window(pair, t, h)), options_.margin);
}

DistanceSteps::Look DistanceSteps::look(std::uint32_t pair, double t, double h, bool exact) {
  ++looks_;
  const Body &a = *pairs_[pair].a, &b = *pairs_[pair].b;
  const MotionWindow w = window(pair, t, h);
  Look look;
  look.bound = boundOf(pair, w);
  const auto [travel, needed] = look.bound;
  DistanceOptions measure;
  if (!exact) measure.relative = needed < HUGE_VAL ? travel / (4 * needed) : 0.25;

  const std::uint64_t states = context_.counters.states;
  const Distance told = surfaceDistance(a, {}, b, w.X_AB, measure, context_, options_.trees);
  look.s = told.a;
  look.t = told.b;
  look.gap = std::max(0.0, told.distance - options_.margin);
  // Where the pose overflows, "contact" only says that nothing is known.
  look.contact =
      w.X_AB.isFinite() &&
      (told.distance == 0 || distanceFromAbove(a, {}, b, w.X_AB, told) <= options_.margin);
  look.hopeless = !(told.distance > needed - travel);
  if (told.distance > needed)
    look.lower = provedDistance(a, {}, b, w.X_AB, told, measure, context_, options_.trees);
  context_.counters.states = states;  // part of an edge
  return look;
}

MotionResult DistanceSteps::contact(std::uint32_t pair, double t0, double t1,
                                    const Look& seen) const {
  MotionResult result;
  result.verdict = MotionVerdict::contact;
  result.certifiedUntil = t0;
  result.contactTime = t1;
  result.pair = Contact{pairs_[pair].bodyA, pairs_[pair].bodyB, seen.s, seen.t};
  return result;
}

MotionResult DistanceSteps::workLimit(double t0) const {
  MotionResult result;
  result.verdict = MotionVerdict::undecided;
  result.reason = UndecidedReason::workLimit;
  result.certifiedUntil = t0;
  result.contactTime = t0;
  return result;
}

MotionResult DistanceSteps::close(std::uint32_t pair, double t0, double time, double clearance) {
  for (double after = kFirstProbe; !motion_.still(); after *= 2) {
    const double t1 = std::min(t0 + after, 1.0), h = (t1 - t0) / 2;
    const bool narrow = !options_.earliest || t1 - t0 <= options_.timeTolerance;
    // `grazing`: all over [t0, t1] the clearance is under twice the tolerance.
    if (!narrow && clearance + 2 * bound(pair, t0 + h, h).travel > 2 * options_.tolerance) break;
    const Look there = look(pair, t1, 0, true);
    if (there.contact) {
      MotionResult result = contact(pair, t0, t1, there);
      result.grazing = !narrow;
      return result;
    }
    if (t1 == 1) break;
  }
  const Look seen = look(pair, time, 0, true);
  MotionResult result;
  result.verdict = MotionVerdict::undecided;
  result.reason = reasonOf(motion_.window(pairs_[pair].motion, time, 0), *pairs_[pair].b, seen.gap,
                           options_.tolerance);
  result.certifiedUntil = t0;
  result.contactTime = time;
  result.pair = Contact{pairs_[pair].bodyA, pairs_[pair].bodyB, seen.s, seen.t};
  result.gap = seen.gap;
  return result;
}

}  // namespace corridor
