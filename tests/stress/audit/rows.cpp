#include "tests/stress/audit/rows.h"

#include <cmath>
#include <cstdio>
#include <utility>

namespace corridor::audit {

// The Hermite polynomials are those of the unit interval.
Quad trueValue(const FileRow& from, const FileRow& to, int degree, std::size_t joint, Quad tau) {
  const Quad T = Quad(to.time) - Quad(from.time), p0 = from.p[joint], p1 = to.p[joint],
             v0 = T * Quad(from.v[joint]), v1 = T * Quad(to.v[joint]),
             a0 = T * T * Quad(from.a[joint]), a1 = T * T * Quad(to.a[joint]);
  const Quad s = tau, r = 1 - tau;
  if (degree == 1) return r * p0 + s * p1;
  if (degree == 3)
    return (1 + 2 * s) * r * r * p0 + s * r * r * v0 + s * s * (3 - 2 * s) * p1 - s * s * r * v1;
  const Quad r3 = r * r * r, s3 = s * s * s;
  return r3 * (1 + 3 * s + 6 * s * s) * p0 + s * r3 * (1 + 3 * s) * v0 + s * s * r3 / 2 * a0 +
         s3 * (1 + 3 * r + 6 * r * r) * p1 - r * s3 * (1 + 3 * r) * v1 + r * r * s3 / 2 * a1;
}

double controllerValue(const FileRow& from, const FileRow& to, int degree, std::size_t joint,
                       double T, double t) {
  const double p0 = from.p[joint], p1 = to.p[joint], v0 = from.v[joint], v1 = to.v[joint],
               a0 = from.a[joint], a1 = to.a[joint], T2 = T * T, T3 = T2 * T;
  if (degree == 1) return p0 + t * ((p1 - p0) / T);
  if (degree == 3) {
    const double c2 = (-3 * p0 + 3 * p1 - 2 * v0 * T - v1 * T) / T2,
                 c3 = (2 * p0 - 2 * p1 + v0 * T + v1 * T) / T3;
    return p0 + t * v0 + t * t * c2 + t * t * t * c3;
  }
  const double T4 = T3 * T, T5 = T4 * T;
  const double c3 = (-20 * p0 + 20 * p1 - 3 * a0 * T2 + a1 * T2 - 12 * v0 * T - 8 * v1 * T) /
                    (2 * T3),
               c4 = (30 * p0 - 30 * p1 + 3 * a0 * T2 - 2 * a1 * T2 + 16 * v0 * T + 14 * v1 * T) /
                    (2 * T4),
               c5 = (-12 * p0 + 12 * p1 - a0 * T2 + a1 * T2 - 6 * v0 * T - 6 * v1 * T) / (2 * T5);
  return p0 + t * v0 + t * t * (0.5 * a0) + t * t * t * c3 + t * t * t * t * c4 +
         t * t * t * t * t * c5;
}

double controllerTime(Dice& dice, double time) {
  return time + 2 * 0x1p-53 * dice.real() * time;
}

std::vector<FileRow> randomRows(Dice& dice, RowKind kind, std::size_t count) {
  const auto size = [&] {
    return kind == RowKind::large   ? dice.power(3, 9)
           : kind == RowKind::small ? dice.power(-200, -9)
           : kind == RowKind::mixed ? dice.power(-12, 6)
                                    : dice.power(-1, 0.5);
  };
  const auto duration = [&] {
    return kind == RowKind::tinyDurations   ? dice.power(-9, -5)
           : kind == RowKind::longDurations ? dice.power(2, 6)
           : kind == RowKind::mixed         ? dice.power(-6, 3)
                                            : dice.power(-2, 0.3);
  };
  std::vector<FileRow> rows(count);
  double time = kind == RowKind::largeTimes ? dice.real(1.6e9, 1.8e9)
                : dice.oneIn(2)             ? 0
                                            : dice.real();
  for (std::size_t k = 0; k < count; ++k) {
    FileRow& row = rows[k];
    row.time = time;
    const double T = duration();
    time += T;
    for (std::size_t j = 0; j < kRowJoints; ++j) {
      const double way = size() * dice.real();
      row.p[j] = k == 0 ? size() * dice.real() : rows[k - 1].p[j] + way;
      // The angle of a continuous joint may change by half a turn from row to row.
      if (j == 1) row.p[j] = k == 0 ? 3 * dice.real() : rows[k - 1].p[j] + 3.1 * std::tanh(way);
      // Velocities that suit the way or not; accelerations that suit the velocities or not.
      row.v[j] = dice.oneIn(4) ? 0 : dice.oneIn(3) ? size() * dice.real() : way / T * dice.real();
      row.a[j] = dice.oneIn(4) ? 0 : dice.oneIn(3) ? size() * dice.real() : row.v[j] / T;
    }
  }
  return rows;
}

std::string textOf(const std::vector<FileRow>& rows, int degree, bool timed) {
  std::string text = timed ? "time" : "";
  const char* names[] = {"slide", "pan", "lift"};
  for (const char* end : {"", "_vel", "_acc"})
    for (const char* name : names)
      if (*end == 0 || (end[1] == 'v' && degree > 1) || degree > 3)
        text += (text.empty() ? "" : ",") + std::string(name) + end;
  const auto number = [&](double value, bool first = false) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.17g", value);
    text += (first ? "\n" : ",") + std::string(digits);
  };
  for (const FileRow& row : rows) {
    bool first = true;
    if (timed) number(row.time, std::exchange(first, false));
    for (const double p : row.p) number(p, std::exchange(first, false));
    for (const double v : row.v)
      if (degree > 1) number(v);
    for (const double a : row.a)
      if (degree > 3) number(a);
  }
  return text + "\n";
}

}  // namespace corridor::audit
