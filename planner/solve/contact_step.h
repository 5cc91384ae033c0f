#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/robot/tangent_step.h"

/// Small steps of a configuration that change the distances of pairs of bodies as wanted.
namespace corridor {

/// A pair whose distance a step should change by at least `need` metres, to first order:
/// gradient·step ≥ need. `step` has the direction of the largest change of the distance for its
/// weighted length; it changes the distance by `change` > 0.
struct DistanceConstraint {
  std::size_t pair = 0;  ///< its index in `Scene::pairs()`
  double distance = 0;   ///< metres
  TangentStep gradient;  ///< of the distance: one entry for each number of a step
  TangentStep step;
  double change = 0, need = 0;
  double multiplier = 0;  ///< used by `shortestStep`
};

/// Returns the constraints, with the need 0, of the pairs that a step can move apart. A pair with
/// the distance 0 has no gradient, so it is left out.
/// @param near pairs, and their distances at q
/// @param weights a factor of each number of a step, above 0, in the length of steps
std::vector<DistanceConstraint> constraintsOf(const Checker& checker,
                                              const std::vector<Scene::NearPair>& near,
                                              const Configuration& q, const TangentStep& weights);

/// Returns the step of the shortest weighted length that meets all constraints up to a tenth of
/// their needs, by Hildreth's method (1957), or nullopt if it finds none.
/// @param size the length of a step (`tangentSize`)
std::optional<TangentStep> shortestStep(std::vector<DistanceConstraint>& constraints,
                                        Eigen::Index size);

}  // namespace corridor
