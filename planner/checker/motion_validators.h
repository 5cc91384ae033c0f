#pragma once

#include <cstdint>
#include <optional>

#include <ompl/base/MotionValidator.h>

#include "planner/checker/checker.h"

namespace corridor {

/// What both validators share: counting, and the writing of `lastValid`.
///
/// The contract, of which OMPL's own classes break parts: on failure lastValid.second = t0 and
/// lastValid.first, where given, is a state such that the edge from s1 to it is valid by this very
/// validator (t0 = 0: s1 itself, bit for bit); on success neither is touched. lastValid.first may
/// be s1 or s2: both are read before anything is written. As everywhere in OMPL, s1 is taken to be
/// valid. Safe for many threads at once.
class CountingMotionValidator : public ompl::base::MotionValidator {
 public:
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2) const final;
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2,
                   std::pair<ompl::base::State*, double>& lastValid) const final;
  /// As getCheckedMotionCount, which isn't safe to call while motions are checked.
  std::uint64_t checkedMotions() const;

 protected:
  CountingMotionValidator(const ompl::base::SpaceInformationPtr& si, const Checker& checker);

  /// How far a motion that isn't valid can be followed.
  struct Progress {
    double t = 0;
    Configuration state;  ///< at t > 0
  };
  virtual bool isFree(const Configuration& from, const Configuration& to) const = 0;
  /// nullopt: the motion is free.
  virtual std::optional<Progress> lastFree(const Configuration& from,
                                           const Configuration& to) const = 0;

  void write(const Configuration& q, ompl::base::State* state) const;

  const Checker& checker_;

 private:
  bool count(bool valid) const;
};

/// Valid is: certified free for the whole continuous edge.
class CertifiedMotionValidator final : public CountingMotionValidator {
 public:
  CertifiedMotionValidator(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : CountingMotionValidator(si, checker) {}

 protected:
  bool isFree(const Configuration& from, const Configuration& to) const override;
  std::optional<Progress> lastFree(const Configuration& from,
                                   const Configuration& to) const override;
};

/// OMPL's rule, as a yardstick: the space's `validSegmentCount` says into how many steps an edge is
/// cut (of longest_valid_segment_fraction of each subspace's extent at most), and the states
/// between the steps are asked for contact, exactly. What lies between two of them is not looked
/// at.
class DiscreteMotionValidator final : public CountingMotionValidator {
 public:
  DiscreteMotionValidator(const ompl::base::SpaceInformationPtr& si, const Checker& checker)
      : CountingMotionValidator(si, checker) {}

 protected:
  bool isFree(const Configuration& from, const Configuration& to) const override;
  std::optional<Progress> lastFree(const Configuration& from,
                                   const Configuration& to) const override;

 private:
  bool isValid(const Configuration& state) const;
  unsigned steps(const Configuration& from, const Configuration& to) const;
};

}  // namespace corridor
