#include "planner/trajectory/smooth_law.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/trajectory/jerk_law.h"
#include "planner/trajectory/link_speed.h"

namespace corridor {
namespace {

/// Windows that are always tried, as fractions of the run's duration. smoothLaw also tries a window
/// that follows from the limits of jerk.
constexpr double kWindows[] = {0x1p-12, 0x1p-9};
/// If the averaged law takes longer than the law without limits of jerk by more than this factor,
/// smoothLaw searches for a better law.
constexpr double kMuchLonger = 1.01;

/// A law of s over time, with constant s̈ between knots.
struct PathMotion {
  std::vector<double> time, s, rate;  // at the knots
  std::vector<double> acceleration;   // in each interval between two knots
};

PathMotion motionOf(const PathRun& run, const std::vector<LawSegment>& segments) {
  PathMotion motion;
  double begin = 0;  // s at the start of the part
  std::size_t part = 0;
  for (const LawSegment& segment : segments) {
    while (run.parts[part].piece != segment.piece) begin += run.parts[part++].length;
    const double length = run.parts[part].length;
    motion.time.push_back(segment.time);
    motion.s.push_back(begin + segment.tau * length);
    motion.rate.push_back(segment.rate * length);
    motion.acceleration.push_back(segment.acceleration * length);
  }
  motion.time.push_back(segments.back().time + segments.back().duration);
  motion.s.push_back(begin + run.parts[part].length);
  motion.rate.push_back(0);
  return motion;
}

/// Evaluates a PathMotion at ascending times. Before the first knot and after the last knot, s is
/// constant.
class Walk {
 public:
  explicit Walk(const PathMotion& motion) : motion_(motion) {}
  /// Evaluates the motion at `time`, with the polynomial of the interval that contains `inside`.
  /// (`time` is usually at a knot, up to rounding, so it does not determine whether the interval
  /// before or after the knot is meant.)
  void to(double time, double inside) {
    while (next_ < motion_.time.size() && motion_.time[next_] <= inside) ++next_;
    if (next_ == 0) {
      s = motion_.s.front();
      rate = acceleration = 0;
    } else if (next_ == motion_.time.size()) {
      s = motion_.s.back();
      rate = acceleration = 0;
    } else {
      const std::size_t k = next_ - 1;
      const double d = time - motion_.time[k];
      acceleration = motion_.acceleration[k];
      rate = motion_.rate[k] + d * acceleration;
      s = motion_.s[k] + d * (motion_.rate[k] + d / 2 * acceleration);
    }
  }
  double s = 0, rate = 0, acceleration = 0;

 private:
  const PathMotion& motion_;
  std::size_t next_ = 0;
};

/// Returns the times at which the jerk of the averaged motion jumps: the knots of the motion, and
/// these knots plus the window.
std::vector<double> knotsOf(const PathMotion& motion, double window) {
  std::vector<double> knots;
  for (const double t : motion.time) knots.push_back(t), knots.push_back(t + window);
  std::sort(knots.begin(), knots.end());
  // Knots that are at most `least` seconds apart become one knot: a segment between them would have
  // no visible effect.
  const double least = 1e-7 * knots.back();
  std::vector<double> apart{knots.front()};
  for (const double t : knots)
    if (t > apart.back() + least) apart.push_back(t);
  apart.back() = knots.back();
  return apart;
}

/// Returns the time d in [0, most] at which the cubic's `tau` reaches `target`. @pre The cubic
/// ascends.
double timeOf(const LawSegment& cubic, double target, double most) {
  double low = 0, high = most;
  for (int step = 0; step < 60; ++step) {
    const double d = (low + high) / 2;
    const double value =
        cubic.tau + d * (cubic.rate + d / 2 * (cubic.acceleration + d / 3 * cubic.jerk));
    (value < target ? low : high) = d;
  }
  return (low + high) / 2;
}

/// Returns the motion averaged over the window, as segments of a law; each segment is in one piece.
std::vector<LawSegment> averaged(const PathRun& run, const PathMotion& motion, double window) {
  std::vector<LawSegment> result;
  Walk now(motion), then(motion);
  const std::vector<double> knots = knotsOf(motion, window);
  std::size_t part = 0;
  double begin = 0, s = 0;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const double inside = (knots[k] + knots[k + 1]) / 2;
    now.to(knots[k], inside);
    then.to(knots[k] - window, inside - window);
    LawSegment cubic{knots[k],
                     knots[k + 1] - knots[k],
                     0,
                     s,
                     (now.s - then.s) / window,
                     (now.rate - then.rate) / window,
                     (now.acceleration - then.acceleration) / window};
    const auto advance = [&](double d) {
      cubic.tau += d * (cubic.rate + d / 2 * (cubic.acceleration + d / 3 * cubic.jerk));
      cubic.rate += d * (cubic.acceleration + d / 2 * cubic.jerk);
      cubic.acceleration += d * cubic.jerk;
      cubic.time += d;
      cubic.duration -= d;
    };
    const auto push = [&](double d) {
      const double length = run.parts[part].length;
      if (d > 0)
        result.push_back({cubic.time, d, run.parts[part].piece,
                          std::clamp((cubic.tau - begin) / length, 0.0, 1.0),
                          std::max(0.0, cubic.rate) / length, cubic.acceleration / length,
                          cubic.jerk / length});
    };
    for (;;) {
      const double end = begin + run.parts[part].length, d = cubic.duration;
      const double s1 =
          cubic.tau + d * (cubic.rate + d / 2 * (cubic.acceleration + d / 3 * cubic.jerk));
      if (part + 1 == run.parts.size() || s1 < end) break;
      const double split = timeOf(cubic, end, d);
      push(split);
      advance(split);
      cubic.tau = end;
      begin = end;
      ++part;
    }
    push(cubic.duration);
    advance(cubic.duration);
    s = cubic.tau;
  }
  return result;
}

/// Returns the fastest law of a run that is a straight line: constant jerks in at most seven
/// intervals. Returns an empty law for any other run, if there is no limit of jerk, or if a link's
/// speed is limited.
std::vector<LawSegment> straightLaw(const PathView& view, const PathRun& run,
                                    const JointLimits& limits) {
  if (run.parts.size() != 1 || !view.isStraight(run.parts[0].piece) || !limits.links.empty())
    return {};
  const std::size_t piece = run.parts[0].piece;
  // Limits of the derivatives of τ, which goes from 0 to 1.
  double v = INFINITY, a = INFINITY, j = INFINITY;
  Configuration first, second;
  view.derivatives(piece, 0, first, second);
  for (const LimitedNumbers& n : limitedNumbers(view.space())) {
    const double way = first.segment(n.first, n.count).norm();
    if (!(way > 0)) continue;
    v = std::min(v, limits.velocity[n.first] / way);
    a = std::min(a, limits.acceleration[n.first] / way);
    j = std::min(j, limits.jerk[n.first] / way);
  }
  if (!std::isfinite(j)) return {};
  double ramp = 0, steady = 0;  // durations of each constant jerk, and of the largest acceleration
  const auto setTop = [&](double top) {
    const bool isShort = top * j < a * a;
    ramp = isShort ? std::sqrt(top / j) : a / j;
    steady = isShort ? 0 : top / a - a / j;
  };
  setTop(v);
  double cruise = 1 / v - (2 * ramp + steady);
  if (!(cruise >= 0)) {  // the top velocity p is lower: p·(2·ramp + steady) = 1
    cruise = 0;
    const double whole = a / j;
    setTop(1 <= 2 * a * whole * whole ? std::pow(0.25 * j, 1.0 / 3)
                                      : a / 2 * (std::sqrt(whole * whole + 4 / a) - whole));
  }
  std::vector<LawSegment> law;
  LawSegment s{0, 0, piece, 0, 0, 0, 0};
  const std::array<std::array<double, 2>, 7> phases{
      {{ramp, j}, {steady, 0}, {ramp, -j}, {cruise, 0}, {ramp, -j}, {steady, 0}, {ramp, j}}};
  for (const auto& [duration, jerk] : phases) {
    if (!(duration > 0)) continue;
    s.duration = duration;
    s.jerk = jerk;
    law.push_back(s);
    s.time += duration;
    s.tau += duration * (s.rate + duration / 2 * (s.acceleration + duration / 3 * jerk));
    s.rate = std::max(0.0, s.rate + duration * (s.acceleration + duration / 2 * jerk));
    s.acceleration += duration * jerk;
  }
  return law;
}

/// Returns the smallest factor by which all times must be multiplied so that the limits hold at the
/// ends and in the middle of each segment.
double neededFactor(const PathView& view, const JointLimits& limits, const KinematicTree& tree,
                    const std::vector<LawSegment>& segments) {
  const std::vector<LimitedNumbers> numbers = limitedNumbers(view.space());
  // The largest ratios to the limits. `velocity` includes link speeds.
  double velocity = 0, acceleration = 0, jerk = 0;
  Configuration first, second;
  for (const LawSegment& segment : segments) {
    for (int k = 0; k <= 2; ++k) {
      const double d = k * segment.duration / 2;
      const double rate = segment.rate + d * (segment.acceleration + d / 2 * segment.jerk);
      const double change = segment.acceleration + d * segment.jerk;
      const double tau = std::clamp(
          segment.tau + d * (segment.rate + d / 2 * (segment.acceleration + d / 3 * segment.jerk)),
          0.0, 1.0);
      view.derivatives(segment.piece, tau, first, second);
      const Configuration third = view.thirdDerivative(segment.piece, tau);
      for (const LimitedNumbers& n : numbers) {
        const auto most = [&](double& share, const auto& vector, const Configuration& limit) {
          const double length = vector.segment(n.first, n.count).norm();
          if (length > 0) share = std::max(share, length / limit[n.first]);
        };
        most(velocity, first * rate, limits.velocity);
        most(acceleration, second * (rate * rate) + first * change, limits.acceleration);
        most(jerk,
             third * (rate * rate * rate) + second * (3 * rate * change) + first * segment.jerk,
             limits.jerk);
      }
      // Link speeds are not evaluated at the end of a segment (k = 2): this state is also the begin
      // of the next segment, or is at rest.
      if (!limits.links.empty() && k < 2)
        for (const double share :
             linkSpeedShares(tree, limits.links, view.value(segment.piece, tau), first * rate))
          velocity = std::max(velocity, share);
    }
  }
  return std::max({velocity, std::sqrt(acceleration), std::cbrt(jerk)});
}

}  // namespace

void slowDown(std::vector<LawSegment>& segments, double factor) {
  for (LawSegment& segment : segments) {
    segment.time *= factor;
    segment.duration *= factor;
    segment.rate /= factor;
    segment.acceleration /= factor * factor;
    segment.jerk /= factor * factor * factor;
  }
}

std::vector<LawSegment> smoothLaw(const PathView& view, const PathRun& run,
                                  const JointLimits& limits, const KinematicTree& tree,
                                  const std::vector<LawSegment>& segments) {
  if (segments.empty()) return segments;
  if (std::vector<LawSegment> law = straightLaw(view, run, limits); !law.empty()) return law;
  const PathMotion motion = motionOf(run, segments);
  const double duration = motion.time.back();
  std::vector<LawSegment> best;
  double shortest = INFINITY;
  const auto attempt = [&](std::vector<LawSegment> law) {
    const double factor = neededFactor(view, limits, tree, law),
                 total = factor * (law.back().time + law.back().duration);
    if (!(total < shortest)) return;
    slowDown(law, factor);
    best = std::move(law);
    shortest = total;
  };
  for (const double share : kWindows) attempt(averaged(run, motion, share * duration));
  // The longest time that a component's largest jerk takes to reach the component's limit of
  // acceleration.
  double ramp = 0;
  for (const LimitedNumbers& n : limitedNumbers(view.space()))
    if (std::isfinite(limits.acceleration[n.first]))
      ramp = std::max(ramp, limits.acceleration[n.first] / limits.jerk[n.first]);
  if (ramp > 0) attempt(averaged(run, motion, std::clamp(ramp, kWindows[0] * duration, duration)));
  if (best.empty()) return best;
  if (shortest > kMuchLonger * duration && limits.jerk.array().isFinite().any())
    if (std::vector<LawSegment> law = jerkLimitedLaw(view, run, limits, tree, best); !law.empty())
      attempt(std::move(law));
  return best;
}

}  // namespace corridor
