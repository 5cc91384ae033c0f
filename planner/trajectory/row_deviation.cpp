#include "planner/trajectory/row_deviation.h"

#include <algorithm>
#include <cmath>

#include "planner/robot/tangent_step.h"
#include "planner/trajectory/bernstein.h"
#include "planner/trajectory/row_polynomials.h"

namespace corridor {
namespace {

using bernstein::Polynomial;

/// Returns τ on the part [from, to] of a segment (seconds since its begin), as a polynomial on [0,
/// 1].
Polynomial tauOf(const LawSegment& s, double from, double to) {
  const double T = to - from;
  const double tau = s.tau + from * (s.rate + from / 2 * (s.acceleration + from / 3 * s.jerk));
  const double rate = s.rate + from * (s.acceleration + from / 2 * s.jerk);
  const double acceleration = s.acceleration + from * s.jerk;
  Polynomial p;
  if (s.jerk == 0) {
    p.degree = 2;
    p.c[0] = tau;
    p.c[1] = tau + rate * T / 2;
    p.c[2] = tau + rate * T + acceleration * T * T / 2;
    return p;
  }
  p.degree = 3;
  p.c[0] = tau;
  p.c[1] = tau + rate * T / 3;
  p.c[2] = tau + 2 * rate * T / 3 + acceleration * T * T / 6;
  p.c[3] = tau + rate * T + acceleration * T * T / 2 + s.jerk * T * T * T / 6;
  return p;
}

/// Returns the curve of one component between two rows, as a polynomial on [0, 1].
Polynomial rowCurve(const TimedRow& first, const TimedRow& last, int degree, Eigen::Index number) {
  const RowPolynomials rows = rowPolynomials(first, last, degree, number);
  Polynomial p;
  p.degree = degree;
  for (int i = 0; i <= degree; ++i) p.c[i] = rows.near[i] + rows.rise.c[i];
  return p;
}

}  // namespace

double rowDeviation(const std::vector<LawSegment>& segments, const PathView& view,
                    const LawTime& from, const LawTime& to, const TimedRow& first,
                    const TimedRow& last, int degree) {
  const double start = first.time, duration = last.time - first.time;
  const auto& rotations = view.rotations();
  double most = 0;
  Configuration turned = Configuration::Zero(static_cast<Eigen::Index>(rotations.size()));
  std::vector<double> rates;  // angular speeds of the rows' slerps, rad/s
  for (const Eigen::Index r : rotations)
    rates.push_back(
        rotationVector(first.position.segment<4>(r), last.position.segment<4>(r)).norm() /
        duration);
  for (std::size_t k = from.segment; k <= to.segment; ++k) {
    const LawSegment& segment = segments[k];
    const double begin = k == from.segment ? from.since : 0,
                 end = k == to.segment ? to.since : segment.duration;
    if (!(end > begin)) continue;
    const Polynomial tau = tauOf(segment, begin, end);
    const double a = std::clamp((segment.time + begin - start) / duration, 0.0, 1.0),
                 b = std::clamp((segment.time + end - start) / duration, 0.0, 1.0);
    const Eigen::MatrixXd& c = view.path()[segment.piece].coefficients;
    const bernstein::Composition ofTau(tau, static_cast<int>(c.cols()) - 1);
    std::size_t r = 0;
    for (Eigen::Index n = 0; n < c.rows(); ++n) {
      if (r < rotations.size() && rotations[r] == n) {
        // The law's angle about the rotation's axis, minus the angle of the rows' slerp.
        const double turn = view.turn(segment.piece, r).norm();
        const auto slot = static_cast<Eigen::Index>(r);
        for (int i = 0; i <= tau.degree; ++i) {
          const double share = static_cast<double>(i) / tau.degree;
          const double ofRows = rates[r] * duration * (a + (b - a) * share);
          most = std::max(most, std::abs(turned[slot] + turn * (tau.c[i] - tau.c[0]) - ofRows));
        }
        turned[slot] += turn * (tau.c[tau.degree] - tau.c[0]);
        ++r;
        n += 3;
        continue;
      }
      if ((c.row(n).array() == c(n, 0)).all() && first.velocity[n] == 0 && last.velocity[n] == 0 &&
          first.position[n] == c(n, 0) && last.position[n] == c(n, 0))
        continue;
      Polynomial outer;
      outer.degree = static_cast<int>(c.cols()) - 1;
      for (int i = 0; i <= outer.degree; ++i) outer.c[i] = c(n, i);
      const Polynomial curve = bernstein::restricted(rowCurve(first, last, degree, n), a, b);
      most = std::max(most, bernstein::difference(ofTau.of(outer), curve).largest());
    }
  }
  return most;
}

}  // namespace corridor
