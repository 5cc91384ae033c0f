#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/checker/never_in_contact.h"

namespace corridor {

struct PairSurveyOptions {
  NeverInContactOptions proof;
  std::size_t samples = 1000;  ///< how many random states are tested
  std::uint64_t seed = 1;      ///< seed of the random states
};

/// The result of a survey for one pair of bodies that the model's filter does not exclude.
struct SurveyedPair {
  std::size_t a = 0, b = 0;  ///< bodies of the model, by index
  std::size_t contacts = 0;  ///< number of random states in which the two are not proved free
  /// True if a planar or floating joint lies between the two. Then nothing is proved, and the
  /// count has no meaning.
  bool movesFreely = false;
  /// The answer of `NeverInContact`; unset if no proof was tried.
  std::optional<NeverInContactResult> proof;
};

/// Returns a random configuration within the bounds: uniform in lines and circles. A rotation is
/// the identity, and a line without bounds is at 0. The result depends on the state of `next` only,
/// not on the platform.
/// @param next returns random 64-bit numbers.
Configuration randomConfiguration(const ConfigurationSpace& space,
                                  const std::function<std::uint64_t()>& next);

/// Tests all pairs that the model's filter does not exclude, and returns them in ascending order.
/// All pairs are tested at random states. For pairs that were free in all these states, a proof is
/// tried. The result depends on the model and the options only.
/// @param checker its margin must be 0: then a pair that is not free is in contact, or closer than
/// twice the tolerance. Its model must have bounds for all positions.
/// @param wantsProof decides for which pairs a proof is tried.
std::vector<SurveyedPair> surveyPairs(
    const Checker& checker, const PairSurveyOptions& options,
    const std::function<bool(std::size_t a, std::size_t b)>& wantsProof);

}  // namespace corridor
