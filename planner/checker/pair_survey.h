#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/checker/never_in_contact.h"

namespace corridor {

/// The progress of a survey.
struct PairSurveyProgress {
  std::size_t samples = 0;  ///< random states tested
  /// The work of the proofs, in the unit of `PairSurveyOptions::work`; 0 until all states are
  /// tested.
  std::uint64_t work = 0;
  std::size_t proved = 0;     ///< pairs proved never in contact
  std::size_t undecided = 0;  ///< pairs that wait for their first or another attempt at a proof
};

struct PairSurveyOptions {
  double margin = 0;        ///< as `NeverInContactOptions::margin`, metres
  double beyondLimits = 0;  ///< as `NeverInContactOptions::beyondLimits`, rad or m
  /// Work limit for the proofs of all pairs together: the number of boxes of joint values that are
  /// tested, where 100 tests of volumes and triangles count as one more box. 0: no proof is tried.
  std::uint64_t work = 250'000;
  std::size_t samples = 1000;  ///< number of random states to test
  std::uint64_t seed = 1;      ///< seed of the random states
  /// Called after each random state and each attempt at a proof. May be empty.
  std::function<void(const PairSurveyProgress&)> progress;
  /// If this flag becomes true, the survey ends soon, and its result is incomplete. May be null.
  const std::atomic<bool>* interrupted = nullptr;
};

/// The result of a survey for one pair of bodies that the checker tests.
struct SurveyedPair {
  std::size_t a = 0, b = 0;  ///< bodies of the model, by index
  std::size_t contacts = 0;  ///< number of random states in which the pair is not proved free
  /// True if a planar or floating joint lies between the two bodies. Then nothing is proved, and
  /// `contacts` has no meaning.
  bool movesFreely = false;
  /// The answer of the last attempt by `NeverInContact`; unset if no proof was tried.
  std::optional<NeverInContactResult> proof;
};

/// Returns a random configuration within the bounds. Coordinates of the kinds `line` and `circle`
/// (configuration_space.h) are uniform; a line without bounds is at 0, and a rotation is the
/// identity. The result depends on the state of `next` only, not on the platform.
/// @param next returns random 64-bit numbers.
Configuration randomConfiguration(const ConfigurationSpace& space,
                                  const std::function<std::uint64_t()>& next);

/// Tests all pairs that the checker tests, and returns them in ascending order.
/// All pairs are tested at random states. A proof is tried for each pair that was free in all these
/// states and between whose bodies no planar or floating joint lies, if `wantsProof` returns true.
/// Unless the survey is interrupted, the result depends on the model and the options only.
///
/// The proofs share the work limit. First, each pair gets an attempt of a few boxes. An attempt
/// that does not decide its pair is repeated with four times the boxes, up to 20,480. The next
/// attempt is always the one with the smallest product of two factors: the number of its boxes, and
/// the fraction of joint values that the previous attempt at the same pair left unproved. So pairs
/// that are nearly proved come first. The last attempt before the work limit gets at most the boxes
/// that are left.
/// @param checker its margin must be 0: then a pair that is not free is in contact, or closer than
/// twice the tolerance. Its model must have bounds for all positions.
/// @param wantsProof returns whether a proof is wanted for a pair.
/// @throws std::invalid_argument as NeverInContact::prove does.
std::vector<SurveyedPair> surveyPairs(
    const Checker& checker, const PairSurveyOptions& options,
    const std::function<bool(std::size_t a, std::size_t b)>& wantsProof);

}  // namespace corridor
