#pragma once

#include <ompl/base/StateValidityChecker.h>

#include "planner/checker/checker.h"

namespace corridor {

/// Valid is: in bounds, and certified free with tolerance, margin and tube (an edge of zero
/// length). Undecided is not valid.
class CertifiedStateValidityChecker : public ompl::base::StateValidityChecker {
 public:
  CertifiedStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : StateValidityChecker(si), checker_(checker) {}
  bool isValid(const ompl::base::State* state) const override;

 private:
  const Checker& checker_;
};

/// For the discrete yardstick. Valid is: in bounds, and nothing touches, exactly. Where a margin
/// is asked for, it is kept, and certified.
class ExactStateValidityChecker : public ompl::base::StateValidityChecker {
 public:
  ExactStateValidityChecker(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : StateValidityChecker(si), checker_(checker) {}
  bool isValid(const ompl::base::State* state) const override;

 private:
  const Checker& checker_;
};

}  // namespace corridor
