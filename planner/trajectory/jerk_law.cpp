#include "planner/trajectory/jerk_law.h"

#include <algorithm>
#include <cmath>

#include "planner/trajectory/jerk_spline.h"

namespace corridor {
namespace {

/// The smallest number of intervals in each piece: a law is slow in the middle of a rounded corner,
/// so one interval is not enough.
constexpr int kIntervalsOfPiece = 6;
/// Numbers of intervals of a run before intervals are halved: `kFewIntervals` in the first search,
/// from `kFewIntervals` to `kMostIntervals` in the second.
constexpr double kFewIntervals = 64, kMostIntervals = 200;
/// The number of intervals in the time in which the largest jerk takes a component from no
/// acceleration to its limit of acceleration.
constexpr double kIntervalsOfRamp = 4;
/// Weights of the barrier method, in ascending order. With the weight 300, a law takes some 1 %
/// longer than the optimum on its knots; with 2000, some 0.2 %.
constexpr double kWeights[] = {10, 60, 300, 2000};
/// The largest number of times that intervals are halved, for each of the last two weights.
constexpr int kHalvings = 4;

/// Returns the states of a law at about `count` equally spaced times, and at the ends of pieces.
std::vector<PathState> statesOf(const PathRun& run, const std::vector<double>& begins,
                                const std::vector<LawSegment>& law, double count) {
  std::vector<PathState> states;
  const double duration = law.back().time + law.back().duration;
  std::size_t next = 0;
  for (std::size_t p = 0; p < run.parts.size(); ++p) {
    std::size_t at = next;
    while (next < law.size() && law[next].piece == run.parts[p].piece) ++next;
    if (at == next) continue;
    const double from = law[at].time, to = law[next - 1].time + law[next - 1].duration,
                 length = run.parts[p].length;
    const int n =
        std::max(kIntervalsOfPiece, static_cast<int>(std::ceil(count * (to - from) / duration)));
    for (int i = states.empty() ? 0 : 1; i <= n; ++i) {
      const double time = from + (to - from) * i / n;
      while (at + 1 < next && law[at + 1].time <= time) ++at;
      const LawSegment& s = law[at];
      const double d = std::clamp(time - s.time, 0.0, s.duration);
      const double tau = s.tau + d * (s.rate + d / 2 * (s.acceleration + d / 3 * s.jerk));
      states.push_back({time,
                        i == n ? begins[p + 1] : begins[p] + length * std::clamp(tau, 0.0, 1.0),
                        length * (s.rate + d * (s.acceleration + d / 2 * s.jerk)),
                        length * (s.acceleration + d * s.jerk)});
    }
  }
  return states;
}

/// Returns the segments of a law between its states. In each interval, three constant jerks, each
/// for a third of the time, lead from s, ṡ and s̈ of one state to those of the next.
std::vector<LawSegment> segmentsBetween(const PathRun& run, const std::vector<double>& begins,
                                        const std::vector<std::size_t>& parts,
                                        const std::vector<PathState>& states) {
  std::vector<LawSegment> result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PathState &a = states[i], &b = states[i + 1];
    const PathRun::Part& part = run.parts[parts[i]];
    const double h = b.time - a.time, third = h / 3;
    // The equations for the three jerks j1, j2, j3, with t in units of `third`: ∫j = j1 + j2 + j3,
    // ∫j·(3 − t) = (5j1 + 3j2 + j3)/2, and ∫j·(3 − t)²/2 = (19j1 + 7j2 + j3)/6.
    const double sum = (b.acceleration - a.acceleration) / third,
                 first = (b.rate - a.rate - h * a.acceleration) / (third * third),
                 second =
                     (b.s - a.s - h * (a.rate + h / 2 * a.acceleration)) / (third * third * third);
    const double p = 2 * first - sum, q = 6 * second - sum;  // 4j1 + 2j2 and 18j1 + 6j2
    const double j1 = (q - 3 * p) / 6, j2 = (p - 4 * j1) / 2, j3 = sum - j1 - j2;
    double s = a.s, rate = a.rate, acceleration = a.acceleration, time = a.time;
    for (const double j : {j1, j2, j3}) {
      result.push_back(
          {time, third, part.piece, std::clamp((s - begins[parts[i]]) / part.length, 0.0, 1.0),
           std::max(0.0, rate) / part.length, acceleration / part.length, j / part.length});
      s += third * (rate + third / 2 * (acceleration + third / 3 * j));
      rate += third * (acceleration + third / 2 * j);
      acceleration += third * j;
      time += third;
    }
  }
  return result;
}

}  // namespace

std::vector<LawSegment> jerkLimitedLaw(const PathView& view, const PathRun& run,
                                       const JointLimits& limits, const KinematicTree& tree,
                                       const std::vector<LawSegment>& start) {
  JerkSpline spline(view, run, limits, tree);
  // The shortest time in which a component can reach its limit of acceleration.
  double ramp = INFINITY;
  for (const LimitedNumbers& n : limitedNumbers(view.space()))
    if (std::isfinite(limits.jerk[n.first]))
      ramp = std::min(ramp, limits.acceleration[n.first] / limits.jerk[n.first]);
  const auto segments = [&] {
    return segmentsBetween(run, spline.begins(), spline.parts(), spline.states());
  };
  spline.set(statesOf(run, spline.begins(), start, kFewIntervals));
  if (!spline.slowToLimits()) return {};
  spline.shorten(kWeights[0]);
  spline.shorten(kWeights[1]);
  const double count =
      std::clamp(kIntervalsOfRamp * spline.duration() / ramp, kFewIntervals, kMostIntervals);
  spline.set(statesOf(run, spline.begins(), segments(), count));
  if (!spline.slowToLimits()) return {};
  const double shortest = std::min(ramp / kIntervalsOfRamp, spline.duration() / kMostIntervals / 2);
  for (const double weight : kWeights) {
    spline.shorten(weight);
    if (weight < kWeights[2]) continue;
    for (int k = 0; k < kHalvings && spline.refine(shortest); ++k) {
      if (!spline.slowToLimits()) return {};
      spline.shorten(weight);
    }
  }
  return segments();
}

}  // namespace corridor
