#include "planner/trajectory/law_clock.h"

#include <algorithm>
#include <cmath>

namespace corridor {

LawTime LawClock::at(double time) const {
  const auto after =
      std::upper_bound(segments_.begin(), segments_.end(), time,
                       [](double t, const LawSegment& segment) { return t < segment.time; });
  const auto k =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - segments_.begin() - 1));
  return {k, std::clamp(time - segments_[k].time, 0.0, segments_[k].duration)};
}

TimedRow LawClock::row(const LawTime& t) const {
  const LawSegment& s = segments_[t.segment];
  const double d = t.since;
  double tau =
      std::clamp(s.tau + d * (s.rate + d / 2 * (s.acceleration + d / 3 * s.jerk)), 0.0, 1.0);
  const bool endsPiece =
      t.segment + 1 == segments_.size() || segments_[t.segment + 1].piece != s.piece;
  if (endsPiece && d == s.duration) tau = 1;
  double rate = s.rate + d * (s.acceleration + d / 2 * s.jerk);
  // Where the law ends at rest, this rate is 0 up to rounding; make it exactly 0.
  if (endsPiece && d == s.duration && std::abs(rate) < 0x1p-40 * s.rate) rate = 0;
  Configuration first, second;
  view_.derivatives(s.piece, tau, first, second);
  TimedRow row{timeOf(t), view_.value(s.piece, tau), first * rate,
               second * (rate * rate) + first * (s.acceleration + d * s.jerk)};
  return row;
}

}  // namespace corridor
