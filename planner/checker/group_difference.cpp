#include "planner/checker/group_difference.h"

#include "collision/core/transform.h"
#include "planner/robot/difference.h"

namespace corridor {

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
  return (c.kind == Coordinate::Kind::rotation ? 2 : 1) * differenceOf(c, a, b);
}

}  // namespace corridor
