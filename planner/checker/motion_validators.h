#pragma once

#include <cstdint>
#include <optional>

#include <ompl/base/MotionValidator.h>

#include "planner/checker/checker.h"

namespace corridor {

/// Base of the motion validators: counts motions and writes `lastValid`. It guarantees OMPL's
/// contract of `lastValid`, parts of which OMPL's own classes break:
/// - On success neither member of `lastValid` is written.
/// - On failure, lastValid.second is set to the t0 up to which this validator finds the edge free.
///   If lastValid.first is given, a state is written to it, such that this validator finds the edge
///   from s1 to this state valid. For t0 = 0 the state is s1 itself, bit for bit.
/// - lastValid.first may be s1 or s2: both are read before anything is written.
/// As everywhere in OMPL, s1 is assumed to be valid. Several threads may use one validator at once.
///
/// The state space of `si` must be a ProblemStateSpace, made of the space of the checker's model.
/// The checker must outlive the validator.
/// @throws std::invalid_argument from the constructors if the space is of another class, or if its
/// configurations have another length than the checker's.
class CountingMotionValidator : public ompl::base::MotionValidator {
 public:
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2) const final;
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2,
                   std::pair<ompl::base::State*, double>& lastValid) const final;
  /// Returns the number of motions that were checked so far, valid or not. Unlike OMPL's
  /// getCheckedMotionCount(), it may be called while motions are checked.
  std::uint64_t checkedMotions() const;

 protected:
  CountingMotionValidator(const ompl::base::SpaceInformationPtr& si, const Checker& checker);

  /// The part [0, t] of an invalid motion. This validator finds the part free.
  struct FreePart {
    double t = 0;
    Configuration state;  ///< the state at t; set only if t > 0
  };
  virtual bool isFree(const Configuration& from, const Configuration& to) const = 0;
  /// Returns nullopt if the whole motion is free. Otherwise returns a part that is free; t = 0 if
  /// no part was found free.
  virtual std::optional<FreePart> lastFree(const Configuration& from,
                                           const Configuration& to) const = 0;

  void write(const Configuration& q, ompl::base::State* state) const;

  const Checker& checker_;

 private:
  bool count(bool valid) const;
};

/// A motion is valid if s2 is in bounds and the whole continuous edge is certified free.
class CertifiedMotionValidator final : public CountingMotionValidator {
 public:
  CertifiedMotionValidator(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : CountingMotionValidator(si, checker) {}

 protected:
  bool isFree(const Configuration& from, const Configuration& to) const override;
  std::optional<FreePart> lastFree(const Configuration& from,
                                   const Configuration& to) const override;
};

/// A motion is valid if the sampled states on it are valid: OMPL's rule, as a baseline. A motion
/// that defines no curve (`ConfigurationSpace::ambiguous`) is not valid. The space's
/// `validSegmentCount` cuts the edge into steps of at most longest_valid_segment_fraction of each
/// subspace's extent. The state at the end of each step is tested by the state validity checker of
/// the SpaceInformation (in `corridor solve` an ExactStateValidityChecker). Nothing is tested
/// between two such states.
class DiscreteMotionValidator final : public CountingMotionValidator {
 public:
  DiscreteMotionValidator(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : CountingMotionValidator(si, checker) {}

 protected:
  bool isFree(const Configuration& from, const Configuration& to) const override;
  std::optional<FreePart> lastFree(const Configuration& from,
                                   const Configuration& to) const override;

 private:
  bool isValid(const Configuration& state) const;
  unsigned steps(const Configuration& from, const Configuration& to) const;
};

}  // namespace corridor
