#include "planner/checker/group_difference.h"

#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/transform.h"
#include "planner/robot/turns.h"

namespace corridor {

double differenceOf(const Coordinate& c, const Configuration& a, const Configuration& b) {
  const auto i = static_cast<Eigen::Index>(c.first);
  return std::abs(c.kind == Coordinate::Kind::circle ? circleTurn(a[i], b[i]).angle : b[i] - a[i]);
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
  return 2 * quaternionAngle(Eigen::Quaterniond(a.data() + c.first),
                             Eigen::Quaterniond(b.data() + c.first));
}

}  // namespace corridor
