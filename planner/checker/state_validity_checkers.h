#pragma once

#include <ompl/base/StateValidityChecker.h>

#include "planner/checker/checker.h"

namespace corridor {

/// Base of the state validity checkers: provides `clearance` for OMPL's samplers and objectives.
/// The value is `Checker::clearance`, the least distance of the tested pairs minus the margin,
/// metres. If a pair touches, this is 0 − margin (no depth is computed). For a state that is not
/// finite it is −∞. Bounds of coordinates are ignored.
///
/// The state space of `si` must be a ProblemStateSpace, made of the space of the checker's model.
/// The checker must outlive the object.
/// The constructors throw std::invalid_argument if the space is of another class, or if its
/// configurations have another length than the checker's.
class ClearanceChecker : public ompl::base::StateValidityChecker {
 public:
  double clearance(const ompl::base::State* state) const final;

 protected:
  ClearanceChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker);

  const Checker& checker_;
};

/// A state is valid if it is in bounds and certified free, with tolerance, margin and tube. An
/// undecided state is not valid.
class CertifiedStateValidityChecker : public ClearanceChecker {
 public:
  CertifiedStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : ClearanceChecker(si, checker) {}
  bool isValid(const ompl::base::State* state) const override;
};

/// The test of states for the discrete baseline. If the checker's margin and all its paddings are
/// 0, a state is valid if it is in bounds and an exact test of the rounded poses finds no tested
/// pair in contact. This test ignores the tube. If the margin or a padding is above 0, a state is
/// valid if it is in bounds and certified free.
class ExactStateValidityChecker : public ClearanceChecker {
 public:
  ExactStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : ClearanceChecker(si, checker) {}
  bool isValid(const ompl::base::State* state) const override;
};

}  // namespace corridor
