#include "planner/trajectory/emit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/core/shortest.h"
#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/link_speed.h"
#include "planner/trajectory/row_deviation.h"
#include "planner/trajectory/row_polynomials.h"
#include "planner/trajectory/smooth_law.h"

namespace corridor {
namespace {

/// In the first attempt, an interval between rows is halved if its curve exceeds a limit by more
/// than this factor. If the law must be slowed down, it is made slower than needed by this factor.
/// In later attempts, an interval is halved if its curve exceeds a limit at all. Few curves do,
/// because the law is then slower.
constexpr double kMostExcess = 1.0005;
/// The largest number of times that one segment of the law is halved.
constexpr int kLevels = 10;
constexpr std::size_t kMostRows = 1'000'000;

/// Chooses the rows of a law.
class Rows {
 public:
  Rows(const std::vector<LawSegment>& segments, const std::vector<double>& stops,
       const PathView& view, const JointLimits& limits, const KinematicTree& tree,
       const EmitOptions& options, double excess)
      : segments_(segments),
        view_(view),
        limits_(limits),
        tree_(tree),
        options_(options),
        excess_(excess),
        clock_(segments, view) {
    addRequired(stops);
  }

  void make() {
    rows.push_back(clock_.row({0, 0}));
    for (std::size_t i = 0; i + 1 < required_.size(); ++i)
      fill(required_[i], required_[i + 1], kLevels);
    extra = rows.size() - required_.size();
  }

  std::vector<TimedRow> rows;
  double deviation = 0;
  std::size_t extra = 0;

 private:
  /// Collects the times that must have a row: start, end, stops, the regular times and, if the
  /// space has rotations, the ends of pieces.
  void addRequired(const std::vector<double>& stops) {
    std::vector<LawTime> all;
    const double end = clock_.timeOf(clock_.end());
    std::size_t stop = 0;
    for (std::size_t k = 0; k < segments_.size(); ++k) {
      const bool isStop = stop < stops.size() && segments_[k].time >= stops[stop];
      if (isStop) ++stop;
      const bool isPiece = k > 0 && segments_[k].piece != segments_[k - 1].piece;
      if (k == 0 || isStop || (isPiece && !view_.rotations().empty())) all.push_back({k, 0});
    }
    if (options_.rate) {
      const double period = 1 / *options_.rate;
      for (double i = 1; i * period < end; ++i) all.push_back(clock_.at(i * period));
    }
    std::stable_sort(all.begin(), all.end(), [&](const LawTime& a, const LawTime& b) {
      return clock_.timeOf(a) < clock_.timeOf(b);
    });
    // If two required times are at most `least` seconds apart, only one of them gets a row. For
    // example, the times of a stop and of a regular row may differ only by rounding. With a rate,
    // rounding would spoil the derivatives at rows that are very close together.
    const double least = std::max(1e-9 * end, options_.rate ? 1e-3 / *options_.rate : 0);
    for (const LawTime& t : all)
      if (required_.empty() || clock_.timeOf(t) > clock_.timeOf(required_.back()) + least)
        required_.push_back(t);
      else if (t.since == 0)
        required_.back() = t;  // prefer the begin of a segment, whose time is exact
    while (required_.size() > 1 && clock_.timeOf(required_.back()) > end - least)
      required_.pop_back();
    required_.push_back(clock_.end());
  }

  /// Adds the rows after `from` up to `to`.
  void fill(const LawTime& from, const LawTime& to, int halvings) {
    const TimedRow first = rows.back(), last = clock_.row(to);
    const double distance = rowDeviation(segments_, view_, from, to, first, last, options_.degree);
    const bool isNear = distance <= options_.deviation;
    // The acceleration of a law does not jump inside a segment. So after three halvings within one
    // segment, only the deviation is a reason to halve again.
    const bool oneSegment =
        to.segment == from.segment || (to.segment == from.segment + 1 && to.since == 0);
    const bool fine = isNear && (usesLittle(first, last) || (oneSegment && halvings < kLevels - 2));
    if (fine || halvings == 0 || rows.size() >= kMostRows) {
      rows.push_back(last);
      deviation = std::max(deviation, distance);
      return;
    }
    const LawTime middle = between(from, to, oneSegment);
    const int left = oneSegment ? halvings - 1 : halvings;
    fill(from, middle, left);
    fill(middle, to, left);
  }

  /// Returns a time between two times: the begin of a segment, or, within one segment, the middle.
  LawTime between(const LawTime& from, const LawTime& to, bool oneSegment) const {
    if (oneSegment) {
      const double end = to.segment == from.segment ? to.since : segments_[from.segment].duration;
      return {from.segment, (from.since + end) / 2};
    }
    const std::size_t last = to.since == 0 ? to.segment - 1 : to.segment;
    return {from.segment + (last - from.segment + 1) / 2, 0};
  }

  /// Returns whether the curve of two rows exceeds no limit by more than the factor `excess_`.
  /// Speeds of links are only estimated here; proveLimits proves them.
  bool usesLittle(const TimedRow& first, const TimedRow& last) const {
    const auto size = static_cast<Eigen::Index>(view_.space().size());
    constexpr int kKinds = 3;
    std::array<std::array<Configuration, 6>, kKinds> values;
    for (auto& kind : values) kind.fill(Configuration::Zero(size));
    std::array<int, kKinds> degrees{};
    for (Eigen::Index n = 0; n < size; ++n) {
      const RowPolynomials p = rowPolynomials(first, last, options_.degree, n);
      const std::array polynomials{&p.velocity, &p.acceleration, &p.jerk};
      for (std::size_t kind = 0; kind < kKinds; ++kind) {
        degrees[kind] = polynomials[kind]->degree;
        for (std::size_t i = 0; i < 6; ++i) values[kind][i][n] = polynomials[kind]->c[i];
      }
    }
    const std::array limits{&limits_.velocity, &limits_.acceleration, &limits_.jerk};
    for (std::size_t kind = 0; kind < kKinds; ++kind)
      for (int i = 0; i <= degrees[kind]; ++i) {
        Configuration& at = values[kind][static_cast<std::size_t>(i)];
        for (const Eigen::Index r : view_.rotations()) at.segment<4>(r).setZero();
        if (sharesOf(at, *limits[kind], view_.space()).maxCoeff() > excess_) return false;
      }
    if (limits_.links.empty()) return true;
    // The speeds between the rows are estimated by the Bernstein coefficients of the velocity. The
    // link speeds for the first half of these coefficients are evaluated at the first row's
    // position, the others at the last row's position. If the rows are near each other, these
    // estimates are near the speeds.
    for (int i = 0; i <= degrees[0]; ++i) {
      Configuration& velocity = values[0][static_cast<std::size_t>(i)];
      const TimedRow& row = 2 * i < degrees[0] ? first : last;
      for (const Eigen::Index r : view_.rotations())
        velocity.segment<4>(r) = row.velocity.segment<4>(r);
      for (const double share : linkSpeedShares(tree_, limits_.links, row.position, velocity))
        if (share > excess_) return false;
    }
    return true;
  }

  const std::vector<LawSegment>& segments_;
  const PathView& view_;
  const JointLimits& limits_;
  const KinematicTree& tree_;
  const EmitOptions& options_;
  double excess_;
  LawClock clock_;
  std::vector<LawTime> required_;
};

/// Slows down each motion between two stops so that it lasts a whole number of periods.
void alignRuns(TimeLaw& law, double period) {
  std::vector<LawSegment> result;
  std::vector<double> ends = law.stopTimes, stops;
  ends.push_back(law.duration);
  double begin = 0, newBegin = 0;
  std::size_t k = 0;
  for (const double end : ends) {
    const double length = end - begin;
    // 1e-9: if a run exceeds a whole number of periods only by rounding, it gets no further period.
    const double wanted = std::max(1.0, std::ceil(length / period - 1e-9)) * period;
    std::vector<LawSegment> run;
    for (; k < law.segments.size() && law.segments[k].time < end - 1e-12 * law.duration; ++k) {
      run.push_back(law.segments[k]);
      run.back().time -= begin;
    }
    slowDown(run, std::max(1.0, wanted / length));
    for (LawSegment& segment : run) {
      segment.time += newBegin;
      result.push_back(segment);
    }
    begin = end;
    newBegin = result.back().time + result.back().duration;
    stops.push_back(newBegin);
  }
  law.segments = std::move(result);
  law.duration = newBegin;
  stops.pop_back();
  law.stopTimes = std::move(stops);
}

/// Returns the factor by which all times must be multiplied so that the limits hold.
double neededFactor(const LimitRatios& ratios) {
  return std::max({ratios.velocity.share, ratios.link.share, std::sqrt(ratios.acceleration.share),
                   std::cbrt(ratios.jerk.share)});
}

void slowDown(std::vector<TimedRow>& rows, double factor) {
  for (TimedRow& row : rows) {
    row.time *= factor;
    row.velocity /= factor;
    row.acceleration /= factor * factor;
  }
}

std::string faultOfOptions(const EmitOptions& options) {
  if (options.degree != 3 && options.degree != 5)
    return "the degree must be 3 or 5, not " + std::to_string(options.degree);
  if (!(options.deviation > 0)) return "the deviation must be positive";
  if (options.rate && !(*options.rate > 0 && std::isfinite(*options.rate)))
    return "the rate must be positive";
  return "";
}

}  // namespace

Emission emitRows(const TimeLaw& given, const std::vector<CurvePiece>& path,
                  const ConfigurationSpace& space, const JointLimits& limits,
                  const KinematicTree& tree, const EmitOptions& options) {
  Emission result;
  const auto fail = [&](const std::string& why) {
    result.rows.clear();
    result.fault = "trajectory: " + why;
    return result;
  };
  if (const std::string why = faultOfOptions(options); !why.empty()) return fail(why);
  const PathView view(path, space);
  if (given.segments.empty()) {
    if (path.empty()) return fail("the path is empty");
    const auto size = static_cast<Eigen::Index>(space.size());
    result.rows = {{0, view.value(0, 0), Configuration::Zero(size), Configuration::Zero(size)}};
    return result;
  }
  const bool atRest = given.options.startRate == 0 && given.options.endRate == 0;
  TimeLaw law = given;
  double stretchOfLaw = 1;
  JointLimits smaller = limits;
  if (options.rate && atRest) alignRuns(law, 1 / *options.rate);
  if (options.rate && law.duration * *options.rate > static_cast<double>(kMostRows))
    return fail("more than 10^6 rows; use a smaller rate");
  // Each attempt brings the largest ratio of a value to its limit nearer to 1. Two or three
  // attempts are usually enough.
  for (int attempt = 0; attempt < 8; ++attempt) {
    Rows rows(law.segments, law.stopTimes, view, limits, tree, options,
              attempt == 0 ? kMostExcess : 1);
    rows.make();
    if (rows.deviation > options.deviation)
      return fail("rows within " + shortest(options.deviation) +
                  " of the path were not found, but " + "within " + shortest(rows.deviation) +
                  "; allow a larger deviation");
    result.rows = std::move(rows.rows);
    result.deviation = rows.deviation;
    result.extraRows = options.rate ? rows.extra : 0;
    result.stretch = stretchOfLaw;
    // Times are rounded when they are multiplied, so the proof may need another multiplication.
    for (int round = 0; round < 4; ++round) {
      result.ratios = proveLimits(result.rows, options.degree, space, limits, tree);
      const double factor = neededFactor(result.ratios);
      if (factor <= 1) {
        result.duration = result.rows.back().time;
        return result;
      }
      if (!std::isfinite(factor)) break;
      // Multiplying times would change the rates at the ends, or the period.
      if (!atRest || options.rate) break;
      result.stretch *= factor * (1 + 1e-9);
      slowDown(result.rows, factor * (1 + 1e-9));
    }
    const double factor = neededFactor(result.ratios);
    if (!std::isfinite(factor)) break;
    if (atRest) {  // slow the law down, and choose rows again
      // Without a rate, the rows have been stretched already. The law lacks this stretch.
      const double by = (options.rate ? factor : result.stretch / stretchOfLaw) * kMostExcess;
      slowDown(law.segments, by);
      for (double& stop : law.stopTimes) stop *= by;
      law.duration *= by;
      stretchOfLaw *= by;
      if (options.rate) alignRuns(law, 1 / *options.rate);
      continue;
    }
    smaller.velocity /= std::max(1.0, result.ratios.velocity.share) * kMostExcess;
    smaller.acceleration /= std::max(1.0, result.ratios.acceleration.share) * kMostExcess;
    for (LinkSpeed& link : smaller.links)
      link.speed /= std::max(1.0, result.ratios.link.share) * kMostExcess;
    law = timeLaw(path, space, smaller, tree, given.options);
    if (!law.fault.empty())
      return fail("the rates at the ends are too near to the limits for rows that keep them; " +
                  law.fault);
  }
  return fail("rows that keep the limits were not found: the largest shares are " +
              shortest(result.ratios.velocity.share) + " of a velocity, " +
              shortest(result.ratios.acceleration.share) + " of an acceleration, " +
              shortest(result.ratios.jerk.share) + " of a jerk");
}

}  // namespace corridor
