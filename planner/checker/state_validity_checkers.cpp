#include "planner/checker/state_validity_checkers.h"

#include "planner/checker/rigid_state_space.h"

namespace corridor {

bool CertifiedStateValidityChecker::isValid(const ompl::base::State* state) const {
  return checker_.certifiedState(readState(checker_.space(), state));
}

bool ExactStateValidityChecker::isValid(const ompl::base::State* state) const {
  const RigidState at = readState(checker_.space(), state);
  if (checker_.options().margin > 0) return checker_.certifiedState(at);
  return checker_.inBounds(at) && !checker_.interference(at);
}

}  // namespace corridor
