#include "planner/checker/state_validity_checkers.h"

#include <cmath>

#include "planner/checker/problem_state_space.h"

namespace corridor {

ClearanceChecker::ClearanceChecker(const ompl::base::SpaceInformationPtr& si,
                                   const Checker& checker)
    : StateValidityChecker(si), checker_(checker) {
  requireProblemStateSpace(*si, checker.space());
  specs_.clearanceComputationType = ompl::base::StateValidityCheckerSpecs::EXACT;
}

double ClearanceChecker::clearance(const ompl::base::State* state) const {
  const Configuration q = configurationOf(*si_, state);
  return checker_.space().isFinite(q) ? checker_.clearance(q) : -HUGE_VAL;
}

bool CertifiedStateValidityChecker::isValid(const ompl::base::State* state) const {
  return checker_.isProvedFree(configurationOf(*si_, state));
}

bool ExactStateValidityChecker::isValid(const ompl::base::State* state) const {
  const Configuration q = configurationOf(*si_, state);
  if (checker_.options().largestMargin() > 0) return checker_.isProvedFree(q);
  return checker_.inBounds(q) && !checker_.interference(q);
}

}  // namespace corridor
