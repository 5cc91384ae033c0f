#include "planner/trajectory/jerk_spline.h"

#include <algorithm>
#include <cmath>

#include "planner/trajectory/link_speed.h"

namespace corridor {
namespace {

/// The places in an interval, from 0 to 1, at which limits hold.
constexpr std::array kPlaces{0.0, 0.5, 1.0};
/// Gauss–Legendre quadrature with three points: places and weights.
const std::array<std::array<double, 2>, 3> kQuadrature{
    {{0.5 - std::sqrt(0.15), 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + std::sqrt(0.15), 5.0 / 18}}};
/// Newton's method ends when the decrease that a step predicts, divided by the number of
/// coefficients, is below this. For comparison, each limit that is nearly reached adds about 1 to
/// the objective.
constexpr double kSmallDecrease = 1e-3;
constexpr int kMostSteps = 20;
/// An interval is halved if times must be multiplied by more than this to keep the limits between
/// its places.
constexpr double kExcess = 1.002;
/// An interval is halved if y varies by more than this factor in it.
constexpr double kMostVariation = 1.5;
/// Two adjacent intervals are halved if the jerk jumps between them by more than this fraction of
/// its limit, and if they take long enough (the parameter `shortest` of `refine`).
constexpr double kJump = 0.5;
/// An interval is halved if the jerk varies in it by more than this fraction of its limit, and if
/// it takes long enough. If such an interval were not halved, the jerk could reach its limit only
/// at one place of it.
constexpr double kJerkVariation = 0.15;

/// A symmetric band matrix. Row i has the elements (i, i), (i, i + 1) and (i, i + 2); the other
/// elements of the upper half are 0.
using Band = std::vector<std::array<double, 3>>;

/// Solves band·solution = x in place: `x` becomes the solution, and `band` is overwritten. @returns
/// false if the matrix is not positive definite.
bool solveBand(Band& band, std::vector<double>& x) {
  const std::size_t n = band.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!(band[i][0] > 0)) return false;
    for (std::size_t k = 1; k <= 2 && i + k < n; ++k) {
      const double factor = band[i][k] / band[i][0];
      for (std::size_t m = k; m <= 2 && i + m < n; ++m) band[i + k][m - k] -= factor * band[i][m];
      x[i + k] -= factor * x[i];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    double rest = x[i];
    for (std::size_t k = 1; k <= 2 && i + k < n; ++k) rest -= band[i][k] * x[i + k];
    x[i] = rest / band[i][0];
  }
  return true;
}

}  // namespace

void JerkSpline::Local::addSquare(double factor, double y, double u, double w) {
  hessian[0] += factor * y * y;
  hessian[1] += factor * y * u;
  hessian[2] += factor * y * w;
  hessian[3] += factor * u * u;
  hessian[4] += factor * u * w;
  hessian[5] += factor * w * w;
}

JerkSpline::JerkSpline(const PathView& view, const PathRun& run, const JointLimits& limits,
                       const KinematicTree& tree)
    : view_(view),
      run_(run),
      limits_(limits),
      tree_(tree),
      numbers_(limitedNumbers(view.space())),
      begins_(beginsOf(run)),
      map_(begins_.back()) {
  for (const LimitedNumbers& n : numbers_) rowCount_ += static_cast<std::size_t>(n.count);
}

void JerkSpline::set(const std::vector<PathState>& states) {
  knots_.clear();
  parts_.clear();
  std::vector<double> y;
  for (const PathState& state : states) {
    const double sigma = map_.parameterOf(state.s);
    if (!knots_.empty() && !(sigma > knots_.back() + 1e-12 * map_.end())) continue;
    const double s1 = map_.at(sigma)[1];
    knots_.push_back(sigma);
    y.push_back(s1 > 0 ? (state.rate / s1) * (state.rate / s1) : 0);
  }
  knots_.front() = 0;
  knots_.back() = map_.end();
  y.front() = y[1];  // at both ends, the loop above computes 0/0
  y.back() = y[y.size() - 2];
  std::size_t part = 0;
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const double middle = (knots_[i] + knots_[i + 1]) / 2, s = map_.at(middle)[0];
    while (part + 1 < run_.parts.size() && s > begins_[part + 1]) ++part;
    parts_.push_back(part);
  }
  c_ = {y.front()};
  for (std::size_t i = 0; i + 1 < y.size(); ++i) c_.push_back((y[i] + y[i + 1]) / 2);
  c_.push_back(y.back());
  setRows();
}

/// Returns the Bernstein coefficients of y in interval i. The second one is the spline's
/// coefficient c[i + 1]. The first one is between c[i] and c[i + 1], and the third one is between
/// c[i + 1] and c[i + 2]. The two weights are in `blend_`; they follow from the widths of the
/// intervals.
JerkSpline::Triple JerkSpline::bernstein(const std::vector<double>& c, std::size_t i) const {
  const auto& [left, right] = blend_[i];
  return {c[i] + left * (c[i + 1] - c[i]), c[i + 1], c[i + 1] + right * (c[i + 2] - c[i + 1])};
}

JerkSpline::Value JerkSpline::valueAt(const Triple& b, double h, double t) {
  return {(1 - t) * ((1 - t) * b[0] + 2 * t * b[1]) + t * t * b[2],
          ((1 - t) * (b[1] - b[0]) + t * (b[2] - b[1])) / h, (b[0] - 2 * b[1] + b[2]) / (h * h)};
}

double JerkSpline::timeOf(const Triple& b, double h) {
  double sum = 0;
  for (const auto& [t, weight] : kQuadrature) sum += weight / std::sqrt(valueAt(b, h, t).y);
  return h * sum;
}

double JerkSpline::durationOf(const std::vector<double>& c) const {
  double time = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) time += timeOf(bernstein(c, i), widthOf(i));
  return time;
}

std::vector<PathState> JerkSpline::states() const {
  std::vector<PathState> result;
  double time = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Triple b = bernstein(c_, i);
    const auto [y, u, w] = valueAt(b, widthOf(i), 0);
    const auto [s, s1, s2, s3] = map_.at(knots_[i]);
    result.push_back({time, s, s1 * std::sqrt(y), s2 * y + s1 * u});
    time += timeOf(b, widthOf(i));
  }
  result.push_back({time, begins_.back(), 0, 0});
  return result;
}

double JerkSpline::rowsAt(std::size_t i, double t, Row* rows) const {
  const PathRun::Part& part = run_.parts[parts_[i]];
  const double sigma = t == 1 ? knots_[i + 1] : knots_[i] + t * widthOf(i);
  const auto [s, s1, s2, s3] = map_.at(sigma);
  const double tau = std::clamp((s - begins_[parts_[i]]) / part.length, 0.0, 1.0),
               t1 = s1 / part.length, t2 = s2 / part.length, t3 = s3 / part.length;
  Configuration q1, q2;
  view_.derivatives(part.piece, tau, q1, q2);
  Configuration q3 = view_.thirdDerivative(part.piece, tau);
  q3 = t1 * t1 * t1 * q3 + 3 * t1 * t2 * q2 + t3 * q1;
  q2 = t1 * t1 * q2 + t2 * q1;
  q1 *= t1;
  double most = INFINITY;
  const auto limitSpeed = [&](double share) {
    if (share > 0) most = std::min(most, 1 / (share * share));
  };
  for (const LimitedNumbers& n : numbers_) {
    limitSpeed(q1.segment(n.first, n.count).norm() / limits_.velocity[n.first]);
    const double acceleration = limits_.acceleration[n.first], jerk = limits_.jerk[n.first];
    for (Eigen::Index m = n.first; m < n.first + n.count; ++m)
      *rows++ = {q1[m] / acceleration, q2[m] / acceleration, q1[m] / jerk, 3 * q2[m] / jerk,
                 q3[m] / jerk};
  }
  if (!limits_.links.empty() && t1 > 0)
    for (const double share :
         linkSpeedShares(tree_, limits_.links, view_.value(part.piece, tau), q1))
      limitSpeed(share);
  return most;
}

void JerkSpline::setRows() {
  const std::size_t n = parts_.size();
  blend_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    blend_[i] = {i > 0 ? widthOf(i - 1) / (widthOf(i - 1) + widthOf(i)) : 0,
                 i + 1 < n ? widthOf(i) / (widthOf(i) + widthOf(i + 1)) : 1};
  rows_.resize(n * kPlaces.size() * rowCount_);
  maxY_.resize(n * kPlaces.size());
  for (std::size_t place = 0; place < maxY_.size(); ++place)
    maxY_[place] = rowsAt(place / kPlaces.size(), kPlaces[place % kPlaces.size()],
                          rows_.data() + place * rowCount_);
}

double JerkSpline::excessAt(std::size_t i, double t) const {
  std::vector<Row> rows(rowCount_);
  const double most = rowsAt(i, t, rows.data());
  const auto [y, u, w] = valueAt(bernstein(c_, i), widthOf(i), t);
  double excess = std::sqrt(y / most);
  auto row = rows.begin();
  for (const LimitedNumbers& n : numbers_) {
    double acceleration = 0, jerk = 0;  // squared ratios to the limits
    for (Eigen::Index m = 0; m < n.count; ++m, ++row) {
      acceleration += std::pow(row->acceleration(y, u), 2);
      jerk += y * std::pow(row->jerk(y, u, w), 2);
    }
    excess = std::max({excess, std::pow(acceleration, 0.25), std::pow(jerk, 1.0 / 6)});
  }
  return excess;
}

double JerkSpline::jerkChange(std::size_t a, std::size_t b) const {
  double most = 0;
  std::array<const Row*, 2> rows;
  std::array<Value, 2> values;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t place = k == 0 ? a : b, i = place / kPlaces.size();
    rows[k] = rows_.data() + place * rowCount_;
    values[k] = valueAt(bernstein(c_, i), widthOf(i), kPlaces[place % kPlaces.size()]);
  }
  for (std::size_t m = 0; m < rowCount_; ++m) {
    std::array<double, 2> jerk{};
    for (std::size_t k = 0; k < 2; ++k)
      jerk[k] = std::sqrt(values[k].y) * rows[k][m].jerk(values[k].y, values[k].u, values[k].w);
    most = std::max(most, std::abs(jerk[1] - jerk[0]));
  }
  return most;
}

bool JerkSpline::refine(double shortest) {
  std::vector<double> knots{knots_[0]}, c{c_[0]};
  std::vector<std::size_t> parts;
  bool jumped = false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::size_t place = i * kPlaces.size();
    const bool jumps = i + 1 < parts_.size() && jerkChange(place + 1, place + 4) > kJump;
    const bool varies = jumps || jumped || jerkChange(place, place + 2) > kJerkVariation;
    jumped = jumps;
    const Triple b = bernstein(c_, i);
    const double h = widthOf(i);
    const auto [least, most] = std::minmax({b[0], b[1], b[2]});
    const bool halve = h > 1e-9 * map_.end() &&
                       (most > kMostVariation * least || (varies && timeOf(b, h) > shortest) ||
                        std::max(excessAt(i, 0.25), excessAt(i, 0.75)) > kExcess);
    parts.push_back(parts_[i]);
    if (halve) {  // the spline stays the same: the coefficient of a new interval is its second
                  // Bernstein coefficient
      parts.push_back(parts_[i]);
      knots.push_back(knots_[i] + h / 2);
      c.push_back((b[0] + b[1]) / 2);
      c.push_back((b[1] + b[2]) / 2);
    } else {
      c.push_back(b[1]);
    }
    knots.push_back(knots_[i + 1]);
  }
  c.push_back(c_.back());
  if (parts.size() == parts_.size()) return false;
  knots_ = std::move(knots);
  parts_ = std::move(parts);
  c_ = std::move(c);
  setRows();
  return true;
}

bool JerkSpline::slowToLimits() {
  for (int i = 0; i < 500; ++i) {  // 0.9^500 = 10^-23
    for (double& c : c_) c *= 0.9;
    if (std::isfinite(barrier(c_))) return true;
  }
  return false;
}

double JerkSpline::barrier(const std::vector<double>& c) const {
  for (const double value : c)
    if (!(value > 0)) return INFINITY;
  // `product` is a product of gaps: its logarithm costs less than one logarithm for each gap.
  double sum = 0, product = 1;
  bool within = true;
  const auto add = [&](double gap) {
    within = within && gap > 0;
    product *= gap;
    if (product < 1e-200) sum -= std::log(product), product = 1;
  };
  const Row* row = rows_.data();
  for (std::size_t place = 0; place < maxY_.size() && within; ++place) {
    const std::size_t i = place / kPlaces.size();
    const auto [y, u, w] = valueAt(bernstein(c, i), widthOf(i), kPlaces[place % kPlaces.size()]);
    add(1 - y / maxY_[place]);
    for (const LimitedNumbers& n : numbers_) {
      double acceleration = 0, jerk = 0;
      for (Eigen::Index m = 0; m < n.count; ++m, ++row) {
        const double a = row->acceleration(y, u), j = row->jerk(y, u, w);
        acceleration += a * a;
        jerk += j * j;
      }
      add(1 - acceleration);
      add(1 - y * jerk);
    }
  }
  return within ? sum - std::log(product) : INFINITY;
}

JerkSpline::Local JerkSpline::barrierAt(std::size_t place, const Value& value) const {
  const auto [y, u, w] = value;
  Local local;
  const double slack = maxY_[place] - y;
  local.gradient[0] += 1 / slack;
  local.hessian[0] += 1 / (slack * slack);
  const Row* row = rows_.data() + place * rowCount_;
  for (const LimitedNumbers& n : numbers_) {
    const Row* const end = row + n.count;
    double aa = 0, ay = 0, au = 0;          // |a|², and Aᵀa for a = A·(y, u)
    double vv = 0, vy = 0, vu = 0, vw = 0;  // |v|², and Vᵀv for v = V·(y, u, w)
    for (const Row* r = row; r != end; ++r) {
      const double a = r->acceleration(y, u), v = r->jerk(y, u, w);
      aa += a * a, ay += r->second * a, au += r->first * a;
      vv += v * v, vy += r->third * v, vu += r->secondJerk * v, vw += r->firstJerk * v;
    }
    // −log(1 − |a|²) is convex.
    const double gap = 1 - aa;
    local.gradient[0] += 2 * ay / gap;
    local.gradient[1] += 2 * au / gap;
    local.addSquare(4 / (gap * gap), ay, au, 0);
    for (const Row* r = row; r != end; ++r) local.addSquare(2 / gap, r->second, r->first, 0);
    // −log(1 − y·|v|²) is not convex. As a function of y and ν = |v|, with p = y·ν² and g = 1 − p,
    // it has the second derivatives 2ν/g² by (yν), and 2y(1 + p)/g² by (νν). The derivative by (yy)
    // is replaced by (2ν/g²)²/(2y(1 + p)/g²), which is larger. Then the Hessian is positive
    // semidefinite: it is 2y(1 + p)/g² times the square of dν + ν/(y(1 + p))·dy, where ν·dν = vᵀdv.
    // In the directions of v that are perpendicular to v, the second derivative is 2y/g.
    const double share = y * vv, rest = 1 - share;
    local.gradient[0] += (vv + 2 * y * vy) / rest;
    local.gradient[1] += 2 * y * vu / rest;
    local.gradient[2] += 2 * y * vw / rest;
    if (vv > 0)
      local.addSquare(2 * y * (1 + share) / (rest * rest * vv), vy + vv / (y * (1 + share)), vu,
                      vw);
    if (vv == 0 || n.count > 1)
      for (const Row* r = row; r != end; ++r)
        local.addSquare(2 * y / rest, r->third, r->secondJerk, r->firstJerk);
    if (vv > 0 && n.count > 1) local.addSquare(-2 * y / (rest * vv), vy, vu, vw);
    row = end;
  }
  return local;
}

bool JerkSpline::improve(double weight) {
  Band band(c_.size(), {0, 0, 0});
  std::vector<double> step(c_.size(), 0);
  // Converts a gradient and a Hessian from derivatives by (y, u, w) to derivatives by the spline's
  // coefficients. Subtracts the gradient from `step`, and adds the Hessian to `band`. Each of y, u
  // and w is the product of a row of three factors with the three coefficients c[i], c[i + 1], c[i
  // + 2].
  const auto add = [&](std::size_t i, const std::array<Triple, 3>& rows, const Local& local) {
    const auto& H = local.hessian;
    const std::array<Triple, 3> full{{{H[0], H[1], H[2]}, {H[1], H[3], H[4]}, {H[2], H[4], H[5]}}};
    for (std::size_t a = 0; a < 3; ++a) {
      Triple product{};  // row a of the transpose of `rows`, times the Hessian
      for (std::size_t r = 0; r < 3; ++r) {
        step[i + a] -= rows[r][a] * local.gradient[r];
        for (std::size_t m = 0; m < 3; ++m) product[m] += rows[r][a] * full[r][m];
      }
      for (std::size_t b = a; b < 3; ++b)
        for (std::size_t r = 0; r < 3; ++r) band[i + a][b - a] += product[r] * rows[r][b];
    }
  };
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double h = widthOf(i);
    const double left = blend_[i][0], right = blend_[i][1];
    const Triple b = bernstein(c_, i);
    // Returns the factors by which y, u and w at t depend on the spline's three coefficients. They
    // follow from the factors of the Bernstein coefficients.
    const auto rowsOf = [&](double t) {
      const auto combined = [&](double x, double y, double z) -> Triple {
        return {x * (1 - left), x * left + y + z * (1 - right), z * right};
      };
      return std::array{combined((1 - t) * (1 - t), 2 * t * (1 - t), t * t),
                        combined((t - 1) / h, (1 - 2 * t) / h, t / h),
                        combined(1 / (h * h), -2 / (h * h), 1 / (h * h))};
    };
    for (std::size_t p = 0; p < kPlaces.size(); ++p)
      add(i, rowsOf(kPlaces[p]), barrierAt(i * kPlaces.size() + p, valueAt(b, h, kPlaces[p])));
    for (const auto& [t, share] : kQuadrature) {
      const double y = valueAt(b, h, t).y, factor = weight * h * share / std::sqrt(y);
      Local local;  // the derivatives of weight·h·share/√y
      local.gradient[0] = -factor / (2 * y);
      local.hessian[0] = 0.75 * factor / (y * y);
      add(i, rowsOf(t), local);
    }
  }
  const std::vector<double> downhill = step;
  if (!solveBand(band, step)) return false;
  double decrease = 0;
  for (std::size_t i = 0; i < step.size(); ++i) decrease += downhill[i] * step[i];
  if (!(decrease > kSmallDecrease * static_cast<double>(step.size()))) return false;
  const double before = weight * durationOf(c_) + barrier(c_);
  std::vector<double> next(c_.size());
  for (double size = 1; size > 1e-6; size /= 2) {
    for (std::size_t i = 0; i < next.size(); ++i) next[i] = c_[i] + size * step[i];
    const double after = barrier(next);
    if (!std::isfinite(after)) continue;
    if (!(weight * durationOf(next) + after <= before - 0.1 * size * decrease)) continue;
    c_.swap(next);
    return true;
  }
  return false;
}

void JerkSpline::shorten(double weight) {
  const double absolute = weight * static_cast<double>(knots_.size()) / duration();
  for (int step = 0; step < kMostSteps; ++step)
    if (!improve(absolute)) return;
}

}  // namespace corridor
