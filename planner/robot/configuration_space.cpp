#include "planner/robot/configuration_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/core/transform.h"
#include "planner/robot/angles.h"
#include "planner/robot/difference.h"

namespace corridor {
namespace {

using Eigen::Quaterniond;
using std::numbers::pi;

Quaterniond quaternionAt(const Configuration& q, std::size_t first) {
  return Quaterniond(q.data() + first);
}

Quaterniond nearer(const Quaterniond& a, const Quaterniond& b) {
  return a.dot(b) < 0 ? Quaterniond(-b.coeffs()) : b;
}

Quaterniond slerp(const Quaterniond& from, const Quaterniond& to, double t) {
  const Quaterniond a = unitQuaternion(from), b = nearer(a, unitQuaternion(to));
  const double angle = quaternionAngle(a, b);
  // sin(tθ)/sin θ = t(1 + θ²(1 − t²)/6 + …): for θ < 2^-27, the quotient differs from t by at most
  // half an ulp.
  const bool tiny = angle < 0x1p-27;
  const double wa = tiny ? 1 - t : std::sin((1 - t) * angle) / std::sin(angle);
  const double wb = tiny ? t : std::sin(t * angle) / std::sin(angle);
  return Quaterniond(Eigen::Vector4d(wa * a.coeffs() + wb * b.coeffs())).normalized();
}

/// Returns the Euclidean norm, even if the squares of the numbers overflow or underflow.
template <class Vector>
double lengthOf(const Vector& v) {
  const double norm = v.norm();
  return norm > 1e-150 && norm < HUGE_VAL ? norm : v.stableNorm();
}

}  // namespace

std::size_t ConfigurationSpace::add(Coordinate coordinate) {
  coordinate.first = size_;
  size_ += coordinate.size();
  coordinates_.push_back(std::move(coordinate));
  lineWeights_.clear();
  return coordinates_.size() - 1;
}

void ConfigurationSpace::addGroup(CoordinateGroup group) {
  groups_.push_back(std::move(group));
  const CoordinateGroup& first = groups_.front();
  bool isLines = groups_.size() == 1 && first.kind == CoordinateGroup::Kind::joints &&
                 first.coordinates.size() == coordinates_.size();
  for (std::size_t i = 0; isLines && i < coordinates_.size(); ++i)
    isLines = first.coordinates[i] == i && coordinates_[i].kind == Coordinate::Kind::line;
  lineWeights_.clear();
  if (isLines)
    for (const Coordinate& c : coordinates_) lineWeights_.push_back(c.weight);
}

Coordinate::Kind ConfigurationSpace::kindOfNumber(std::size_t number) const {
  for (const Coordinate& c : coordinates_)
    if (c.first <= number && number < c.first + c.size()) return c.kind;
  throw std::invalid_argument("a frame is moved by a variable that the space doesn't have");
}

std::vector<std::string> ConfigurationSpace::numberNames() const {
  std::vector<std::string> names;
  for (const Coordinate& c : coordinates_) {
    if (c.kind != Coordinate::Kind::rotation) {
      names.push_back(c.name);
      continue;
    }
    const std::size_t slash = c.name.rfind('/');
    const std::string prefix = slash == std::string::npos ? "" : c.name.substr(0, slash + 1);
    for (const char* number : {"qx", "qy", "qz", "qw"}) names.push_back(prefix + number);
  }
  return names;
}

bool ConfigurationSpace::inBounds(const Configuration& q) const {
  return std::all_of(coordinates_.begin(), coordinates_.end(), [&](const Coordinate& c) {
    const double value = q[static_cast<Eigen::Index>(c.first)];
    return c.kind != Coordinate::Kind::line || (c.lower <= value && value <= c.upper);
  });
}

bool ConfigurationSpace::isFinite(const Configuration& q) const {
  return q.allFinite() &&
         std::all_of(coordinates_.begin(), coordinates_.end(), [&](const Coordinate& c) {
           return c.kind != Coordinate::Kind::rotation ||
                  !quaternionAt(q, c.first).coeffs().isZero(0);
         });
}

void ConfigurationSpace::normalise(Configuration& q) const {
  for (const Coordinate& c : coordinates_) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::circle) q[i] = intoCircle(q[i]);
    if (c.kind == Coordinate::Kind::rotation)
      q.segment<4>(i) = unitQuaternion(quaternionAt(q, c.first)).coeffs();
  }
}

Configuration ConfigurationSpace::interpolate(const Configuration& from, const Configuration& to,
                                              double t) const {
  const bool atEnd = t == 0 || t == 1;
  Configuration at = t == 0 ? from : to;
  for (const Coordinate& c : coordinates_) {
    const auto i = static_cast<Eigen::Index>(c.first);
    switch (c.kind) {
      case Coordinate::Kind::line:
        if (!atEnd)
          at[i] = std::clamp(from[i] + (to[i] - from[i]) * t, std::min(from[i], to[i]),
                             std::max(from[i], to[i]));
        break;
      case Coordinate::Kind::circle:
        at[i] =
            intoCircle(atEnd ? at[i] : intoCircle(from[i]) + t * circleTurn(from[i], to[i]).angle);
        break;
      case Coordinate::Kind::rotation:
        if (!atEnd)
          at.segment<4>(i) =
              slerp(quaternionAt(from, c.first), quaternionAt(to, c.first), t).coeffs();
        break;
    }
  }
  return at;
}

double ConfigurationSpace::distance(const double* a, const double* b) const {
  if (!lineWeights_.empty()) {  // the common case, without its indirections
    double squares = 0;
    for (std::size_t i = 0; i < lineWeights_.size(); ++i) {
      const double weighted = lineWeights_[i] * std::abs(b[i] - a[i]);
      squares += weighted * weighted;
    }
    const double length = std::sqrt(squares);
    if (length > 1e-150 && length < HUGE_VAL) return length;
  }
  double sum = 0;
  for (const CoordinateGroup& group : groups_) {
    const std::vector<std::size_t>& members = group.coordinates;
    if (group.kind == CoordinateGroup::Kind::joints) {
      const auto lengthTimes = [&](double scale) {
        double squares = 0;
        for (const std::size_t member : members) {
          const Coordinate& c = coordinates_[member];
          const double weighted = scale * (c.weight * differenceOf(c, a, b));
          squares += weighted * weighted;
        }
        return std::sqrt(squares);
      };
      const double length = lengthTimes(1);
      if (length > 1e-150 && length < HUGE_VAL) {
        sum += length;
      } else {  // the squares overflow or underflow
        const double scale = length > 1 ? 0x1p-600 : 0x1p600;
        sum += lengthTimes(scale) / scale;
      }
    } else {
      // `away` is the difference of the positions. The group's last coordinate is the rotation.
      Vec3 away = Vec3::Zero();
      for (std::size_t k = 0; k + 1 < members.size(); ++k) {
        const std::size_t i = coordinates_[members[k]].first;
        away[static_cast<Eigen::Index>(k)] = b[i] - a[i];
      }
      const Coordinate& angle = coordinates_[members.back()];
      sum += coordinates_[members.front()].weight * lengthOf(away) +
             angle.weight * differenceOf(angle, a, b);
    }
  }
  return sum;
}

bool ConfigurationSpace::equal(const Configuration& a, const Configuration& b) const {
  return std::all_of(coordinates_.begin(), coordinates_.end(), [&](const Coordinate& c) {
    // OMPL normalises quaternions and wraps angles in passing (enforceBounds), and treats the
    // result as the same state. So quaternion angles and circles may differ by 32u, with u = 2^-53.
    // The reasons are these. The norm of a quaternion (sum of squares, root) and the quotient are
    // off by at most 5u. So the angle between two normalised quaternions is off by at most 12u, and
    // its computation adds 8u. An angle that is brought into [−π, π] is off by its ulp, 2u·π.
    const double off = differenceOf(c, a, b);
    return off <= (c.kind == Coordinate::Kind::line ? 0 : 32 * kUnit);
  });
}

bool ConfigurationSpace::ambiguous(const Configuration& a, const Configuration& b) const {
  return std::any_of(coordinates_.begin(), coordinates_.end(), [&](const Coordinate& c) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::circle) return circleTurn(a[i], b[i]).ambiguous();
    return c.kind == Coordinate::Kind::rotation &&
           !(2 * differenceOf(c, a, b) <= pi - kHalfTurnBand);
  });
}

double ConfigurationSpace::largestTurn(const Configuration& a, const Configuration& b) const {
  double largest = 0;
  for (const Coordinate& c : coordinates_) {
    const double off = c.kind == Coordinate::Kind::line ? 0 : differenceOf(c, a, b);
    largest = std::max(largest, c.kind == Coordinate::Kind::rotation ? 2 * off : off);
  }
  return largest;
}

}  // namespace corridor
