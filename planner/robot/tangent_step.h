#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// A small change of a configuration: one number for each line and circle (m, rad), and a rotation
/// vector for each rotation, in the order of the coordinates. A rotation vector is in rad, in the
/// coordinates of the frame in which the rotation is given (the parent's).
using TangentStep = Eigen::VectorXd;

/// Returns the quaternion of a rotation vector, which is in radians.
Eigen::Quaterniond rotationOf(const Eigen::Vector3d& v);
/// Returns the rotation vector from quaternion a to b (x, y, z, w; any norms) along the shorter
/// arc, in the coordinates of the frame in which a and b are given.
Eigen::Vector3d rotationVector(const Eigen::Vector4d& a, const Eigen::Vector4d& b);

/// Returns the length of a step's vector: the number of degrees of freedom of the space.
Eigen::Index tangentSize(const ConfigurationSpace& space);

/// Returns the number of entries of a coordinate in a step.
Eigen::Index stepSize(const Coordinate& coordinate);
/// Returns, for each coordinate of a space, the index of its first entry in a step.
std::vector<Eigen::Index> firstsInStep(const ConfigurationSpace& space);

/// Returns the factor of each number of a step in the space's distance: a step of length x in one
/// coordinate alone has the distance factor·x.
TangentStep tangentWeights(const ConfigurationSpace& space);

/// Returns the step that leads from one configuration to another: circles and rotations go the
/// shorter way round. @pre both are finite, and no quaternion is zero.
TangentStep stepBetween(const ConfigurationSpace& space, const Configuration& from,
                        const Configuration& to);

/// Returns the Euclidean length of this step with each number multiplied by its weight.
/// @param weights the three of a rotation are equal
double weightedLength(const ConfigurationSpace& space, const Configuration& from,
                      const Configuration& to, const TangentStep& weights);

/// Returns the configuration that a step leads to. Lines stay within their bounds: a step beyond a
/// bound ends at the bound. A line that is outside its bounds in `q` moves no farther outside.
/// Angles are brought into [−π, π], and quaternions to norm 1. @pre `q` is finite, and no
/// quaternion is zero.
Configuration displaced(const ConfigurationSpace& space, const Configuration& q,
                        const TangentStep& step);

}  // namespace corridor
