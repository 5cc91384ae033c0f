#pragma once

#include <ompl/base/StateValidityChecker.h>

#include "planner/checker/checker.h"

namespace corridor {

/// What both checkers share: `clearance`, which samplers and objectives of OMPL ask for. It is
/// `Checker::clearance`, in metres of the workspace: positive is beyond the margin; minus the
/// margin where bodies touch, since nobody measures how deep; −∞ of what isn't finite. Bounds don't
/// count.
class ClearanceChecker : public ompl::base::StateValidityChecker {
 public:
  double clearance(const ompl::base::State* state) const final;

 protected:
  ClearanceChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker);

  const Checker& checker_;
};

/// Valid is: in bounds, and certified free with tolerance, margin and tube (an edge of zero
/// length). Undecided is not valid.
class CertifiedStateValidityChecker : public ClearanceChecker {
 public:
  CertifiedStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : ClearanceChecker(si, checker) {}
  bool isValid(const ompl::base::State* state) const override;
};

/// For the discrete yardstick. Valid is: in bounds, and nothing touches, exactly. Where a margin
/// is asked for, it is kept, and certified.
class ExactStateValidityChecker : public ClearanceChecker {
 public:
  ExactStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : ClearanceChecker(si, checker) {}
  bool isValid(const ompl::base::State* state) const override;
};

}  // namespace corridor
