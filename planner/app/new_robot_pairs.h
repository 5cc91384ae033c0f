#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "planner/app/new_file.h"
#include "planner/checker/pair_survey.h"
#include "planner/problem/proof_digest.h"

namespace corridor::app {

/// The pairs of links of a new robot, by what is known about them.
struct SortedPairs {
  std::vector<SurveyedPair> proved;
  /// In contact in at least 95 % of the random states; those with the most contacts come first.
  std::vector<SurveyedPair> nearlyAlways;
  std::vector<SurveyedPair> tested;  ///< all others
  /// Pairs that the SRDF excludes from tests, although they were in contact in some of the random
  /// states and free in others. Each has the reason that the SRDF gives.
  std::vector<std::pair<SurveyedPair, std::string>> contradicted;
  /// The numbers of pairs of adjacent links, and of pairs that the SRDF excludes from tests.
  std::size_t adjacent = 0, bySrdf = 0;
};

/// Surveys the pairs, and shows the progress if stderr is a terminal.
/// @param allowed the pairs that the SRDF excludes from tests.
/// @pre the filter of the model does not contain the pairs in `allowed`.
/// @returns the sorted pairs. If `interrupted` is true at the end, they are incomplete and must not
/// be used.
SortedPairs sortedPairs(const Checker& checker, const std::vector<AllowedPair>& allowed,
                        const NewRobotArguments& arguments, const std::atomic<bool>& interrupted);

/// Returns the part of the robot's file on pairs of links.
/// @param robot of the robot's description, before the model was made of it.
std::string pairsText(const NewRobotArguments& arguments, const Model& model,
                      const SortedPairs& pairs, const RobotDigest& robot);

}  // namespace corridor::app
