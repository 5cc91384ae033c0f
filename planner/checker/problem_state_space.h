#pragma once

#include <memory>
#include <vector>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSpace.h>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// A ConfigurationSpace as an OMPL compound space. Consecutive coordinates of kind `line` in one
/// group are one RealVectorStateSpace, each `circle` is an SO2StateSpace, and each `rotation` an
/// SO3StateSpace.
///
/// `interpolate`, `distance` and `equalStates` are Corridor's own. OMPL 1.5.2 computes the distance
/// 0 for rotations below 9e-5 rad, and its `interpolate` then returns `from`, even at t = 1. Near
/// half turns, OMPL's direction of rotation depends on the last bit of a number.
///
/// Samplers, bounds and `validSegmentCount` (the largest count of a subspace) are OMPL's. A single
/// rigid body is sampled as by SE2StateSpace or SE3StateSpace.
class ProblemStateSpace : public ompl::base::CompoundStateSpace {
 public:
  /// `space` must outlive the object.
  /// OMPL's setup of the space throws ompl::Exception unless all bounds have lower < upper.
  explicit ProblemStateSpace(const ConfigurationSpace& space);

  const ConfigurationSpace& configurations() const { return space_; }
  /// Convert a state of OMPL to a configuration, and back.
  Configuration read(const ompl::base::State* state) const;
  void write(const Configuration& q, ompl::base::State* state) const;

  /// `state` may be the same object as `from` or `to`: both are read before `state` is written.
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  /// Allocates a state as one block of memory, because planners allocate many short-lived ones.
  ompl::base::State* allocState() const override;
  void freeState(ompl::base::State* state) const override;
  bool equalStates(const ompl::base::State* a, const ompl::base::State* b) const override;
  /// Returns the largest possible value of `distance`.
  double getMaximumExtent() const override;
  /// Registers the default projection: the position of the first rigid robot, or planar or floating
  /// joint. In a space without any of these, the projection consists of the values of the first
  /// joints, at most three, because these joints move the robot the most.
  void registerProjections() override;

 private:
  /// The numbers of one subspace.
  struct Part {
    Coordinate::Kind kind;
    std::size_t first, count;  ///< the index of its first number in a Configuration, its length
    std::size_t offset = 0;    ///< bytes, from the beginning of the compound state
  };

  /// @param q memory for all numbers of a Configuration.
  void read(const ompl::base::State* state, double* q) const;

  const ConfigurationSpace& space_;
  std::vector<Part> parts_;  // one per subspace
  std::size_t bytes_ = 0;    // size of a state
};

/// Checks that states of `si` can be read as configurations of a checker.
/// @param configurations the checker's space.
/// @throws std::invalid_argument if the space of `si` is not a ProblemStateSpace, or if its
/// configurations have another length.
void requireProblemStateSpace(const ompl::base::SpaceInformation& si,
                              const ConfigurationSpace& configurations);

/// Returns the numbers of a state. @pre the space of `si` is a ProblemStateSpace.
Configuration configurationOf(const ompl::base::SpaceInformation& si,
                              const ompl::base::State* state);

}  // namespace corridor
