#include "planner/trajectory/limits_proof.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/link_speed.h"
#include "planner/trajectory/path_view.h"
#include "planner/trajectory/row_polynomials.h"

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

  Eigen::Vector3d turnRate(std::size_t i, Eigen::Index r) const {
    return rotationVector(rows_[i].position.segment<4>(r), rows_[i + 1].position.segment<4>(r)) /
           (rows_[i + 1].time - rows_[i].time);
  }

  void addRotation(std::size_t i, Eigen::Index r) {
    // 2^-45 rad: the angle is computed from the product of two unit quaternions, with an error of
    // some tens of u of a half turn (u = 2^-53). The quaternions themselves are rounded, too, which
    // adds some u of a half turn.
    constexpr double rounding = 0x1p-45;
    const double duration = rows_[i + 1].time - rows_[i].time;
    const Eigen::Vector3d rate = turnRate(i, r);
    const double length = rate.norm() + (rate.isZero() ? 0 : rounding / duration);
    const auto number = static_cast<std::size_t>(r);
    if (std::isfinite(limits_.velocity[r]))
      raise(ratios_.velocity, length == 0 ? 0 : length / limits_.velocity[r], number,
            rows_[i].time);
    if (i == 0 || std::isinf(limits_.acceleration[r])) return;
    const double mean = (rows_[i + 1].time - rows_[i - 1].time) / 2;
    const double change = (rate - turnRate(i - 1, r)).norm();
    raise(ratios_.acceleration, change == 0 ? 0 : change / mean / limits_.acceleration[r], number,
          rows_[i].time);
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
    Configuration reach(n), velocity(n), acceleration(n);
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
    for (const Eigen::Index r : rotations_) {
      velocity.segment<4>(r) << turnRate(i, r), 0;
      acceleration.segment<4>(r).setZero();
    }
    for (std::size_t l = 0; l < limits_.links.size(); ++l) {
      const PointBounds bounds =
          pointBounds(tree_, limits_.links[l], reach, velocity, acceleration);
      raise(ratios_.link, linkShare(i, l, curves, bounds, 0, 1, 16), l, from.time);
    }
  }

  /// Returns an upper bound of the ratio of a link's speed to its limit, on the part [a, b] of
  /// interval i. The interval has the parameters 0 to 1.
  double linkShare(std::size_t i, std::size_t l, const std::vector<RowPolynomials>& curves,
                   const PointBounds& bounds, double a, double b, int halvings) const {
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
      const Eigen::Vector3d rate = turnRate(i, r);
      const Eigen::Vector3d way = rate * (middle * duration);
      v.segment<4>(r) << rate, 0;
      const double angle = way.norm();
      if (angle > 0)
        q.segment<4>(r) =
            (Eigen::Quaterniond(Eigen::AngleAxisd(angle, way / angle)) *
             Eigen::Quaterniond(Eigen::Vector4d(rows_[i].position.segment<4>(r).normalized())))
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
    // have a larger effect: an error of 2u times the angle rotates all points after the joint.
    const double bound = attained + ((b - a) / 2 * duration * bounds.acceleration +
                                     (0x1p-40 + 0x1p-45 * largestAngle) * bounds.speed) /
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
