#include "planner/trajectory/limit_bands.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/trajectory/link_speed.h"

namespace corridor {

std::vector<PositionGroup> positionGroups(const ConfigurationSpace& space) {
  std::vector<PositionGroup> groups;
  for (const CoordinateGroup& group : space.groups())
    if (group.kind != CoordinateGroup::Kind::joints)
      groups.push_back(
          {static_cast<Eigen::Index>(space.coordinates()[group.coordinates.front()].first),
           group.kind == CoordinateGroup::Kind::planar ? 2 : 3});
  return groups;
}

std::vector<LimitedNumbers> limitedNumbers(const ConfigurationSpace& space) {
  std::vector<LimitedNumbers> result;
  const std::vector<PositionGroup> groups = positionGroups(space);
  for (const Coordinate& c : space.coordinates()) {
    const auto first = static_cast<Eigen::Index>(c.first);
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const PositionGroup& g) {
      return first >= g.first && first < g.first + g.count;
    });
    if (group == groups.end())
      result.push_back({first, c.kind == Coordinate::Kind::rotation ? 3 : 1});
    else if (first == group->first)
      result.push_back({first, group->count});
  }
  return result;
}

Configuration sharesOf(const Configuration& values, const Configuration& limits,
                       const ConfigurationSpace& space) {
  Configuration shares = values.cwiseAbs().cwiseQuotient(limits);
  for (Eigen::Index i = 0; i < shares.size(); ++i)
    if (values[i] == 0) shares[i] = 0;
  const auto join = [&](Eigen::Index first, Eigen::Index count, Eigen::Index numbers) {
    const double length = values.segment(first, count).norm();
    shares.segment(first, numbers).setZero();
    if (length > 0) shares[first] = length / limits[first];
  };
  for (const PositionGroup& group : positionGroups(space))
    join(group.first, group.count, group.count);
  for (const Coordinate& c : space.coordinates())
    if (c.kind == Coordinate::Kind::rotation) join(static_cast<Eigen::Index>(c.first), 3, 4);
  return shares;
}

LimitBands::LimitBands(const PathView& view, const JointLimits& limits, const KinematicTree& tree)
    : view_(view), limits_(limits), tree_(tree), positions_(positionGroups(view.space())) {
  std::vector<bool> single(static_cast<std::size_t>(limits.velocity.size()), true);
  for (const PositionGroup& group : positions_)
    std::fill_n(single.begin() + group.first, group.count, false);
  for (const Eigen::Index r : view.rotations()) std::fill_n(single.begin() + r, 4, false);
  for (std::size_t i = 0; i < single.size(); ++i)
    if (single[i]) singles_.push_back(static_cast<Eigen::Index>(i));
  count_ = singles_.size() + kDirections * positions_.size() + view.rotations().size();
}

double LimitBands::at(std::size_t piece, double tau, double length, double* a, double* b) const {
  view_.derivatives(piece, tau, first_, second_);
  first_ /= length;
  second_ /= length * length;
  double xMax = std::numeric_limits<double>::infinity();
  const auto limitSpeed = [&](double speed, double limit) {
    if (speed > 0) xMax = std::min(xMax, (limit / speed) * (limit / speed));
  };
  for (const Eigen::Index i : singles_) {
    limitSpeed(std::abs(first_[i]), limits_.velocity[i]);
    *a++ = first_[i] / limits_.acceleration[i];
    *b++ = second_[i] / limits_.acceleration[i];
  }
  for (const Eigen::Index r : view_.rotations()) {
    const double rate = first_.segment<3>(r).norm();
    limitSpeed(rate, limits_.velocity[r]);
    *a++ = rate / limits_.acceleration[r];
    *b++ = 0;
  }
  for (const PositionGroup& group : positions_) {
    const Eigen::VectorXd along = first_.segment(group.first, group.count);
    const double speed = along.norm(), limit = limits_.acceleration[group.first];
    limitSpeed(speed, limits_.velocity[group.first]);
    // The acceleration of the position is in the plane of q′ and q″. In this plane, with e1 along
    // q′, it is (|q′|u + t·x, n·x).
    const Eigen::VectorXd second = second_.segment(group.first, group.count);
    const Eigen::VectorXd e1 =
        speed > 0 ? Eigen::VectorXd(along / speed) : Eigen::VectorXd(second.stableNormalized());
    const double t = e1.dot(second), n = (second - t * e1).norm();
    const bool straight = n <= 1e-12 * second.norm();
    const double side = straight ? limit : limit * std::cos(std::numbers::pi / (2 * kDirections));
    for (int k = 0; k < kDirections; ++k) {
      const double angle = k * std::numbers::pi / kDirections;
      const double c = std::cos(angle), s = std::sin(angle);
      const bool used = !straight || k == 0;
      *a++ = used ? c * speed / side : 0;
      *b++ = used ? (c * t + s * n) / side : 0;
    }
  }
  if (!limits_.links.empty())
    for (const double share :
         linkSpeedShares(tree_, limits_.links, view_.value(piece, tau), first_))
      limitSpeed(share, 1);
  return xMax;
}

}  // namespace corridor
