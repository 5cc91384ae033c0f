#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/robot/tangent_step.h"

/// Small steps of a configuration that change the distances of pairs of bodies as wanted.
namespace corridor {

/// Returns, for each pair, the gradient of its distance at q: one entry for each number of a step.
/// The closest points are kept fixed in their frames, which changes the distances only to second
/// order. The gradient of a pair with the distance 0 is zero.
std::vector<TangentStep> distanceGradients(const Checker& checker,
                                           const std::vector<Scene::NearPair>& near,
                                           const Configuration& q);

/// A pair whose distance a step should change by at least `need` metres, to first order:
/// gradient·step ≥ need. `step` has the direction of the largest change of the distance for its
/// length in the space's distance; it changes the distance by `change` > 0.
struct DistanceConstraint {
  std::size_t pair = 0;  ///< its index in `Scene::pairs()`
  double distance = 0;   ///< metres
  TangentStep gradient, step;
  double change = 0, need = 0;
  double multiplier = 0;  ///< used by `shortestStep`
};

/// Returns the constraints, with the need 0, of the pairs that a step can move apart.
std::vector<DistanceConstraint> constraintsOf(const Checker& checker,
                                              const std::vector<Scene::NearPair>& near,
                                              const Configuration& q);

/// Returns the shortest step, in the space's distance, that meets all constraints up to a tenth of
/// their needs, by Hildreth's method (1957), or nullopt if it finds none.
/// @param size the length of a step (`tangentSize`)
std::optional<TangentStep> shortestStep(std::vector<DistanceConstraint>& constraints,
                                        Eigen::Index size);

}  // namespace corridor
