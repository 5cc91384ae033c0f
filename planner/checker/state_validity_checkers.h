#pragma once

#include <ompl/base/StateValidityChecker.h>

#include "planner/checker/checker.h"

namespace corridor {

/// Base of the state validity checkers: provides `clearance` for OMPL's samplers and objectives. It
/// is `Checker::clearance`, metres: positive beyond the margin, 0 − margin if bodies touch (no
/// depth is computed), −∞ for a state that is not finite. Bounds are ignored.
class ClearanceChecker : public ompl::base::StateValidityChecker {
 public:
  double clearance(const ompl::base::State* state) const final;

 protected:
  ClearanceChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker);

  const Checker& checker_;
};

/// Calls a state valid if it is in bounds and certified free, with tolerance, margin and tube.
/// Undecided is not valid.
class CertifiedStateValidityChecker : public ClearanceChecker {
 public:
  CertifiedStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : ClearanceChecker(si, checker) {}
  bool isValid(const ompl::base::State* state) const override;
};

/// Calls a state valid if it is in bounds and nothing touches, by an exact test. With a margin the
/// state must be certified instead. For the discrete baseline.
class ExactStateValidityChecker : public ClearanceChecker {
 public:
  ExactStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : ClearanceChecker(si, checker) {}
  bool isValid(const ompl::base::State* state) const override;
};

}  // namespace corridor
