#pragma once

#include <memory>
#include <vector>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSpace.h>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// A ConfigurationSpace as OMPL's compound space: consecutive lines of one group are a
/// RealVectorStateSpace, circles SO2, rotations SO3. `interpolate`, `distance` and `equalStates`
/// are Corridor's: OMPL 1.5.2's own return `from` for rotations under 9e-5 rad, even at t = 1, take
/// them for distance 0, and flip the way near half turns on a last bit. OMPL's samplers (a single
/// rigid body is sampled as by SE2StateSpace and SE3StateSpace), bounds and `validSegmentCount`
/// (the largest of the subspaces') are kept.
class ProblemStateSpace : public ompl::base::CompoundStateSpace {
 public:
  /// `space` must outlive the object.
  /// @throws ompl::Exception at setup where a bound isn't lower < upper.
  explicit ProblemStateSpace(const ConfigurationSpace& space);

  const ConfigurationSpace& configurations() const { return space_; }
  Configuration read(const ompl::base::State* state) const;
  void write(const Configuration& q, ompl::base::State* state) const;

  /// All is read before anything is written: `state` may be either end.
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  /// A state is one piece of memory: planners look at very many for a moment each.
  ompl::base::State* allocState() const override;
  void freeState(ompl::base::State* state) const override;
  bool equalStates(const ompl::base::State* a, const ompl::base::State* b) const override;
  /// Of that distance.
  double getMaximumExtent() const override;
  /// The default one is the position of the first planar or floating joint, else the first joints,
  /// at most three: they move the most.
  void registerProjections() override;

 private:
  struct Part {
    Coordinate::Kind kind;
    std::size_t first, count;  ///< numbers of a Configuration
    std::size_t offset = 0;    ///< of its state from the compound one's beginning, bytes
  };

  /// @param q gets as many numbers as a Configuration has.
  void read(const ompl::base::State* state, double* q) const;

  const ConfigurationSpace& space_;
  std::vector<Part> parts_;  // of each subspace
  std::size_t bytes_ = 0;    // of a state
};

/// @pre the space of `si` is a ProblemStateSpace.
Configuration configurationOf(const ompl::base::SpaceInformation& si,
                              const ompl::base::State* state);

}  // namespace corridor
