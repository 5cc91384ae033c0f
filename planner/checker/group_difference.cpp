#include "planner/checker/group_difference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "collision/core/transform.h"

namespace corridor {

double differenceOf(const Coordinate& c, const Configuration& a, const Configuration& b) {
  const auto i = static_cast<Eigen::Index>(c.first);
  const double off = b[i] - a[i];
  return std::abs(c.kind == Coordinate::Kind::circle ? std::remainder(off, 2 * std::numbers::pi)
                                                     : off);
}

double positionDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b) {
  Vec3 off = Vec3::Zero();
  for (std::size_t k = 0; k + 1 < group.coordinates.size(); ++k)
    off[static_cast<Eigen::Index>(k)] =
        differenceOf(space.coordinates()[group.coordinates[k]], a, b);
  return off.norm();
}

double rotationDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b) {
  const Coordinate& c = space.coordinates()[group.coordinates.back()];
  if (c.kind == Coordinate::Kind::circle) return differenceOf(c, a, b);
  const auto i = static_cast<Eigen::Index>(c.first);
  const Eigen::Vector4d p = a.segment<4>(i).normalized(), q = b.segment<4>(i).normalized();
  // Well conditioned at every angle, as an arc cosine isn't; q and −q are one rotation.
  const double minus = (p - q).norm(), plus = (p + q).norm();
  return 4 * std::atan2(std::min(minus, plus), std::max(minus, plus));
}

}  // namespace corridor
