#pragma once

#include <ompl/base/StateValidityChecker.h>

#include "planner/checker/checker.h"

namespace corridor {

/// Base of the state validity checkers: provides `clearance` for OMPL's samplers and objectives.
/// The value is `Checker::clearance`, metres. It is positive if the bodies are farther apart than
/// the margin, 0 − margin if bodies touch (no depth is computed), and −∞ for a state that is not
/// finite. Bounds are ignored.
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

/// For the discrete baseline. A state is valid if it is in bounds and no tested pair touches, by an
/// exact test of the rounded poses; the tube is ignored. If the checker has a margin, the state
/// must be in bounds and certified free.
class ExactStateValidityChecker : public ClearanceChecker {
 public:
  ExactStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : ClearanceChecker(si, checker) {}
  bool isValid(const ompl::base::State* state) const override;
};

}  // namespace corridor
