#pragma once

#include <memory>

#include <ompl/base/Planner.h>

namespace corridor {

class Checker;

/// Two trees that reach for each other, as in RRTConnect (Kuffner and LaValle, 2000), and slide
/// along obstacles. Trees enter passages that random states rarely meet.
///
/// An edge that meets an obstacle is shortened until it is free. From its end, the tree grows on
/// along the obstacle: each step goes towards the same target, but the part of it that would bring
/// close pairs of bodies into contact is removed. This part follows from the gradients of the
/// pairs' distances (contact_step.h), of which the latest twelve are remembered. The idea is that
/// of retraction (Zhang and Manocha, An Efficient Retraction-based RRT Planner, 2008). Here states
/// with contacts need no depth, because the tree never leaves the free space.
///
/// It pays where random states seldom lie in the passage and its walls lead through it. Measured,
/// medians of 10 seeds against RRTConnect with the ranges in the problems' files: twisted_tubes
/// 0.11 of the search time, polygon_maze 0.5, piano 0.5. It does not pay where most edges are free
/// (cubicles: 2.6), for short square slots, nor for most arms (ur5 in a cage: above 10), because
/// distances of all close pairs are measured.
///
/// All edges are tested by the motion validator of the space. The same random numbers give the same
/// path.
///
/// Parameters:
/// - `range`: the longest edge, in the planner's distance; 0: a fifth of the extent of the space.
/// - `slides`: the largest number of steps along obstacles after each edge that meets one.
/// - `turn_weight`: how much the rotation of a rigid body counts in the planner's distance, in
///   multiples of the body's radius (largest distance from its frame's origin), per radian. 0: as
///   in the distance of the space. The space's distance suits bodies of a size near 1 m; for larger
///   bodies, rotations count too little in it. The weights of joints do not change.
class SlidingConnect final : public ompl::base::Planner {
 public:
  /// The state space of `si` must be a ProblemStateSpace.
  /// @param checker tests the motions of `si`, and measures distances; null: nothing slides. It
  /// must outlive the planner.
  SlidingConnect(const ompl::base::SpaceInformationPtr& si, const Checker* checker);
  ~SlidingConnect() override;

  void clear() override;
  /// May be called again to go on.
  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& stop) override;
  void getPlannerData(ompl::base::PlannerData& data) const override;

  void setRange(double range) { range_ = range; }
  double getRange() const { return range_; }
  /// Sets a factor of the range that is used if `range` is 0.
  void setRangeFactor(double factor) { rangeFactor_ = factor; }
  void setSlides(unsigned slides) { slides_ = slides; }
  unsigned getSlides() const { return slides_; }
  void setTurnWeight(double weight) { turnWeight_ = weight; }
  double getTurnWeight() const { return turnWeight_; }

 private:
  class Search;
  const Checker* checker_;
  double range_ = 0, rangeFactor_ = 1, turnWeight_ = 1;
  unsigned slides_ = 8;
  std::unique_ptr<Search> search_;  // null before the first call of `solve`
};

}  // namespace corridor
