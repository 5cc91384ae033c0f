#include "planner/trajectory/limits_proof.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/link_speed.h"
#include "planner/trajectory/row_polynomials.h"
#include "planner/trajectory/row_rotation.h"

namespace corridor {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
/// A bound that exceeds an attained value by at most this fraction is not improved further.
constexpr double kTight = 1e-4;
/// The largest number of halvings. Each halving brings the control polygon four times nearer to the
/// curve. So 24 halvings are more than kTight needs, except near 0.
constexpr int kBoundHalvings = 24;

/// A vector of up to three polynomials of the same degree.
struct Vectors {
  int degree = 0, count = 0;
  std::array<std::array<double, 3>, 6> c{};
  double error = 0;  // a bound of the error of each coefficient vector's length

  void add(const BoundedPolynomial& p) {
    degree = p.degree;
    for (int i = 0; i <= degree; ++i) c[i][count] = p.c[i];
    error += *std::max_element(p.error.begin(), p.error.end());
    ++count;
  }
  /// Returns the length of coefficient vector i, rounded up. The factor 1 + 8u (u = 2^-53) covers
  /// the roundings of at most 3 squares, 2 sums and a root. With one component, the length is an
  /// absolute value, which is exact.
  double length(int i) const {
    double squares = 0;
    for (int k = 0; k < count; ++k) squares += c[i][k] * c[i][k];
    return count == 1 ? std::abs(c[i][0]) : std::sqrt(squares) * (1 + 0x1p-50);
  }
  double bound() const {
    double most = 0;
    for (int i = 0; i <= degree; ++i)
      if (!(length(i) <= most)) most = length(i);  // keeps a NaN
    return std::isnan(most) ? kUnbounded : most + error;
  }
  double attained() const { return std::max(length(0), length(degree)) - error; }
  /// Splits the polynomials at 1/2 by de Casteljau's algorithm. The object becomes the first half;
  /// the second half is returned. Each of the `degree` levels rounds each component once, by at
  /// most 2^-53 of bound(). The rounding error of a vector of three components is at most √3 times
  /// as long, so 2^-52 for each level is enough.
  Vectors split() {
    Vectors second = *this;
    const double rounding = degree * 0x1p-52 * bound();
    for (int level = 1; level <= degree; ++level)
      for (int i = degree; i >= level; --i)
        for (int k = 0; k < count; ++k) c[i][k] = (c[i - 1][k] + c[i][k]) / 2;
    for (int level = 1; level <= degree; ++level)
      for (int i = 0; i <= degree - level; ++i)
        for (int k = 0; k < count; ++k) second.c[i][k] = (second.c[i][k] + second.c[i + 1][k]) / 2;
    error += rounding;
    second.error += rounding;
    return second;
  }
};

/// Returns a bound of the largest length of the vector on [0, 1]. Parts whose bound is at most
/// `known` are not halved further.
/// @param limit a bound above `limit` is improved as far as possible, unless `known` or an attained
/// length exceeds `limit`.
double largestLength(Vectors part, double known, double limit, int halvings = kBoundHalvings) {
  const double bound = part.bound();
  if (bound <= known || halvings == 0 || part.degree == 0 || !std::isfinite(bound)) return bound;
  const double attained = part.attained(), enough = std::max(known, attained * (1 + kTight));
  // Halving brings the bound near the attained value, but does not reduce the rounding, which is in
  // both: if it is most of the difference, halving is of no use.
  if (bound - attained <= 4 * part.error) return bound;
  const bool isNearLimit = bound > limit && attained <= limit && known <= limit;
  if (bound <= enough && !isNearLimit) return bound;
  const double least = isNearLimit ? std::max(known, attained) : enough;
  const Vectors second = part.split();
  const double first = largestLength(part, least, limit, halvings - 1);
  return std::max(first, largestLength(second, std::max(least, first), limit, halvings - 1));
}

void raise(LimitShare& most, double share, std::size_t number, double time) {
  if (!(share <= most.share)) most = {std::isnan(share) ? kUnbounded : share, number, time};
}

/// Raises `most` to the ratio of the vector's length to its limit, if that is larger.
void raiseBy(const Vectors& vectors, double limit, Eigen::Index number, double time,
             LimitShare& most) {
  if (std::isinf(limit)) return;
  const double length = largestLength(vectors, most.share * limit, limit);
  // 2^-51 covers the roundings of the quotient here and of the product above.
  const double share = length == 0 ? 0 : length / limit * (1 + 0x1p-51);
  raise(most, share, static_cast<std::size_t>(number), time);
}

/// Returns an upper bound of the polynomial with the Bernstein coefficients g on [0, 1], or 0 if
/// the bound is below 0. @param error a bound of the error of each coefficient.
double largestValue(std::array<double, 6> g, int degree, double error, int halvings) {
  const double bound = *std::max_element(g.begin(), g.begin() + degree + 1) + error;
  const double attained = std::max({g[0], g[static_cast<std::size_t>(degree)], 0.0});
  if (bound <= attained * (1 + 1e-2) || halvings == 0) return std::max(0.0, bound);
  std::array<double, 6> second = g;
  double size = 0;
  for (int i = 0; i <= degree; ++i) size = std::max(size, std::abs(g[i]));
  for (int level = 1; level <= degree; ++level) {
    for (int i = degree; i >= level; --i) g[i] = (g[i - 1] + g[i]) / 2;
    for (int i = 0; i <= degree - level; ++i) second[i] = (second[i] + second[i + 1]) / 2;
  }
  error += degree * 0x1p-53 * size;
  return std::max(largestValue(g, degree, error, halvings - 1),
                  largestValue(second, degree, error, halvings - 1));
}

/// Returns an upper bound of the distance by which the curve leaves [lower, upper].
double excessOf(const RowPolynomials& p, double lower, double upper) {
  double most = 0;
  for (const double sign : {1.0, -1.0}) {
    const double limit = sign > 0 ? upper : lower;
    if (!std::isfinite(limit)) continue;
    std::array<double, 6> g{};
    double error = 0;
    bool any = false;
    for (int i = 0; i <= p.rise.degree; ++i) {
      const double gap = sign * (p.near[i] - limit), rise = sign * p.rise.c[i];
      g[i] = gap + rise;
      // The difference and the sum round once each. At a row (rise 0), the sign of g is exact.
      const double slack =
          rise == 0 ? 0 : p.rise.error[i] + 0x1p-51 * (std::abs(gap) + std::abs(rise));
      error = std::max(error, slack);
      // If gap ≤ 0 and the rise is surely not positive, the coefficient is within the limit.
      if (gap <= 0 && rise + p.rise.error[i] <= 0) continue;
      any = any || g[i] + slack > 0;
    }
    if (any) most = std::max(most, largestValue(g, p.rise.degree, error, 12));
  }
  return most;
}

class Prover {
 public:
  Prover(const std::vector<TimedRow>& rows, int degree, const ConfigurationSpace& space,
         const JointLimits& limits, const KinematicTree& tree)
      : rows_(rows), degree_(degree), space_(space), limits_(limits), tree_(tree) {
    for (const PositionGroup& group : positionGroups(space)) positions_.push_back(group);
    for (const Coordinate& c : space.coordinates()) {
      const auto first = static_cast<Eigen::Index>(c.first);
      if (c.kind == Coordinate::Kind::rotation) {
        rotations_.push_back(first);
        continue;
      }
      const bool inGroup =
          std::any_of(positions_.begin(), positions_.end(), [&](const PositionGroup& group) {
            return first >= group.first && first < group.first + group.count;
          });
      if (!inGroup) positions_.push_back({first, 1});
    }
  }

  LimitRatios prove() {
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
      for (const PositionGroup& group : positions_) addNumbers(i, group);
      for (const Eigen::Index r : rotations_) addRotation(i, r);
      addPositions(i);
      addLinks(i);
      if (degree_ == 1) addBends(i);
    }
    return ratios_;
  }

 private:
  void addNumbers(std::size_t i, const PositionGroup& group) {
    Vectors velocity, acceleration, jerk;
    for (Eigen::Index k = 0; k < group.count; ++k) {
      const RowPolynomials p = rowPolynomials(rows_[i], rows_[i + 1], degree_, group.first + k);
      velocity.add(p.velocity);
      acceleration.add(p.acceleration);
      jerk.add(p.jerk);
    }
    const Eigen::Index n = group.first;
    raiseBy(velocity, limits_.velocity[n], n, rows_[i].time, ratios_.velocity);
    raiseBy(acceleration, limits_.acceleration[n], n, rows_[i].time, ratios_.acceleration);
    raiseBy(jerk, limits_.jerk[n], n, rows_[i].time, ratios_.jerk);
  }

  void addRotation(std::size_t i, Eigen::Index r) {
    const RowRotation rotation = rowRotation(rows_[i], rows_[i + 1], r);
    raiseTo(rotation.length(), limits_.velocity[r], r, i, ratios_.velocity);
    if (i == 0) return;
    const RowRotation before = rowRotation(rows_[i - 1], rows_[i], r);
    // The errors of the two rates displace their difference. The sums, the length and the quotients
    // round by less than 2^-60 of the result, which `raiseTo` includes.
    const long double change = (rotation.rate - before.rate).norm() + rotation.error + before.error;
    const long double mean = (static_cast<long double>(rows_[i + 1].time) - rows_[i - 1].time) / 2;
    const bool defined = !rotation.ambiguous && !before.ambiguous;
    raiseTo(defined ? change / mean : kUnbounded, limits_.acceleration[r], r, i,
            ratios_.acceleration);
  }

  /// Raises `most` to the ratio of a value to its limit, if that is larger. 2^-51 covers the
  /// roundings here, and those of a value in long double.
  void raiseTo(long double value, double limit, Eigen::Index number, std::size_t row,
               LimitShare& most) const {
    if (std::isinf(limit)) return;
    const double share = value == 0 ? 0 : static_cast<double>(value / limit) * (1 + 0x1p-51);
    raise(most, share, static_cast<std::size_t>(number), rows_[row].time);
  }

  void addPositions(std::size_t i) {
    for (const Coordinate& c : space_.coordinates())
      if (c.kind == Coordinate::Kind::line) {
        const RowPolynomials p =
            rowPolynomials(rows_[i], rows_[i + 1], degree_, static_cast<Eigen::Index>(c.first));
        raise(ratios_.position, excessOf(p, c.lower, c.upper), c.first, rows_[i].time);
      }
  }

  /// Counts a bend of linear rows as an infinite acceleration, for components with a limit of
  /// acceleration.
  void addBends(std::size_t i) {
    if (i == 0) return;
    for (Eigen::Index n = 0; n < limits_.acceleration.size(); ++n) {
      const auto rate = [&](std::size_t k) {
        return (rows_[k + 1].position[n] - rows_[k].position[n]) /
               (rows_[k + 1].time - rows_[k].time);
      };
      if (std::isfinite(limits_.acceleration[n]) && rate(i) != rate(i - 1))
        raise(ratios_.acceleration, kUnbounded, static_cast<std::size_t>(n), rows_[i].time);
    }
  }

  void addLinks(std::size_t i) {
    if (limits_.links.empty()) return;
    const TimedRow &from = rows_[i], &to = rows_[i + 1];
    const Eigen::Index n = from.position.size();
    std::vector<RowPolynomials> curves;
    Configuration reach(n), velocity(n), acceleration(n), rounding = Configuration::Zero(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      curves.push_back(rowPolynomials(from, to, degree_, k));
      const RowPolynomials& p = curves.back();
      const auto most = [](const BoundedPolynomial& b) {
        double value = 0;
        for (int m = 0; m <= b.degree; ++m) value = std::max(value, std::abs(b.c[m]) + b.error[m]);
        return value;
      };
      reach[k] = std::max(std::abs(from.position[k]), std::abs(to.position[k])) + most(p.rise);
      velocity[k] = most(p.velocity);
      acceleration[k] = most(p.acceleration);
    }
    bool defined = true;
    for (const Eigen::Index r : rotations_) {
      const RowRotation rotation = rowRotation(from, to, r);
      const double length = static_cast<double>(rotation.length()) * (1 + 0x1p-51);
      velocity.segment<4>(r) << length, 0, 0, 0;
      acceleration.segment<4>(r).setZero();
      rounding[r] = static_cast<double>(rotation.error);
      defined = defined && !rotation.ambiguous;
    }
    for (std::size_t l = 0; l < limits_.links.size(); ++l) {
      const LinkSpeed& link = limits_.links[l];
      const LinkBounds bounds{
          pointBounds(tree_, link, reach, velocity, acceleration),
          pointBounds(tree_, link, reach, rounding, Configuration::Zero(n)).speed};
      const bool finite = std::isfinite(bounds.points.speed + bounds.points.acceleration);
      raise(ratios_.link,
            defined && finite ? linkShare(i, l, curves, bounds, 0, 1, 16) : kUnbounded, l,
            from.time);
    }
  }

  /// Bounds of the points of a link in one interval. `rounding`, m/s: how much faster a point may
  /// be than computed, because the rates of rotations are rounded.
  struct LinkBounds {
    PointBounds points;
    double rounding = 0;
  };

  /// Returns an upper bound of the ratio of a link's speed to its limit, on the part [a, b] of
  /// interval i. The interval has the parameters 0 to 1.
  double linkShare(std::size_t i, std::size_t l, const std::vector<RowPolynomials>& curves,
                   const LinkBounds& bounds, double a, double b, int halvings) const {
    const double middle = (a + b) / 2, duration = rows_[i + 1].time - rows_[i].time;
    const Eigen::Index n = rows_[i].position.size();
    Configuration q(n), v(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const RowPolynomials& p = curves[static_cast<std::size_t>(k)];
      std::array<double, 6> values{};
      for (int m = 0; m <= p.rise.degree; ++m) values[m] = p.near[m] + p.rise.c[m];
      q[k] = valueAt(values, p.rise.degree, middle);
      v[k] = valueAt(p.velocity.c, p.velocity.degree, middle);
    }
    for (const Eigen::Index r : rotations_) {
      const Eigen::Vector3d rate = rowRotation(rows_[i], rows_[i + 1], r).rate.cast<double>();
      const Eigen::Vector3d way = rate * (middle * duration);
      v.segment<4>(r) << rate, 0;
      const double angle = way.norm();
      if (angle > 0)
        q.segment<4>(r) = (Eigen::Quaterniond(Eigen::AngleAxisd(angle, way / angle)) *
                           Eigen::Quaterniond(
                               Eigen::Vector4d(rows_[i].position.segment<4>(r).stableNormalized())))
                              .coeffs();
      else
        q.segment<4>(r) = rows_[i].position.segment<4>(r);
    }
    const LinkSpeed& link = limits_.links[l];
    const double attained = linkSpeedShares(tree_, {link}, q, v).front();
    const double largestAngle = q.cwiseAbs().maxCoeff();
    // Between the middle of the part and any other time in it, the speed changes by at most half of
    // the part's duration, times the bound of the acceleration. 2^-40 of the largest speed is far
    // above the rounding of the kinematics: some u for each of up to 100 frames. Only large angles
    // have a larger effect: an error of 2u times the angle rotates all points after the joint. The
    // rounding of the rates of rotations is larger, too, if the rotations are small.
    const double bound =
        attained + ((b - a) / 2 * duration * bounds.points.acceleration + bounds.rounding +
                    (0x1p-40 + 0x1p-45 * largestAngle) * bounds.points.speed) /
                       link.speed * (1 + 0x1p-40);
    if (bound <= std::max({1.0, ratios_.link.share, attained * 1.005}) || halvings == 0)
      return bound;
    const double first = linkShare(i, l, curves, bounds, a, middle, halvings - 1);
    return std::max(first, linkShare(i, l, curves, bounds, middle, b, halvings - 1));
  }

  static double valueAt(std::array<double, 6> c, int degree, double t) {
    for (int level = 1; level <= degree; ++level)
      for (int i = 0; i <= degree - level; ++i) c[i] = (1 - t) * c[i] + t * c[i + 1];
    return c[0];
  }

  const std::vector<TimedRow>& rows_;
  int degree_;
  const ConfigurationSpace& space_;
  const JointLimits& limits_;
  const KinematicTree& tree_;
  std::vector<PositionGroup> positions_;  // also single components, as groups of one
  std::vector<Eigen::Index> rotations_;
  LimitRatios ratios_;
};

}  // namespace

LimitRatios proveLimits(const std::vector<TimedRow>& rows, int degree,
                        const ConfigurationSpace& space, const JointLimits& limits,
                        const KinematicTree& tree) {
  return Prover(rows, degree, space, limits, tree).prove();
}

}  // namespace corridor
