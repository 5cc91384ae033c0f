#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "planner/checker/checker.h"

/// What the tests of a problem leave out. All outputs that say "free", "certified" or "proved" take
/// it from here.
namespace corridor {

struct Problem;

/// Why a user may expect that a pair is tested, although it is not.
enum class LeftOutReason {
  touchesAtRest,      ///< only fixed joints are between the two bodies, and they touch
  isCloseAtRest,      ///< the same, but they are apart, by at most margin plus padding
  allowed,            ///< `allow` of the problem
  allowedInTheScene,  ///< `allowed_collision_matrix` of a planning scene
};

/// Returns "touch at rest", "within the margin at rest", "allow" or "allowed_collision_matrix".
const char* nameOf(LeftOutReason reason);

/// A pair that no proof covers, although the problem allows it, one of the two bodies is an
/// obstacle, or they belong to two robots.
struct LeftOutPair {
  std::size_t a = 0, b = 0;  ///< bodies of the model, by index; a < b
  LeftOutReason reason = LeftOutReason::touchesAtRest;
};

struct LeftOut {
  /// The pairs that stand beside every proof ("proved, except 2 pairs …"), in ascending order.
  /// Pairs of one robot's links are not among them, unless the problem allows them: what SRDF,
  /// robot.yaml, a scene's matrix or adjacency exclude there, or fixed joints join, is the robot's
  /// own construction.
  std::vector<LeftOutPair> except;
  /// The number of pairs that are not tested, by the reason of the model's filter. Pairs that are
  /// tested once (kTestedAtRest) are not counted.
  std::map<std::string, std::size_t> reasons;
  std::size_t tested = 0;        ///< number of pairs that are tested in every query
  std::size_t testedAtRest = 0;  ///< number of pairs that are tested once (kTestedAtRest)
};

/// @throws as `closeFixedPairs`.
LeftOut leftOutOf(const Checker& checker);
/// Makes a checker, unless no pair needs it.
LeftOut leftOutOf(const Problem& problem);

/// Returns ", except 2 pairs that touch at rest or are allowed to: base ~ table, hand ~ box", to be
/// put after the word of a proof, or "" if there are no such pairs. Names at most four pairs, and
/// counts the rest.
std::string exceptText(const Model& model, const LeftOut& leftOut);

/// Returns the number of pairs that are not tested, by groups of reasons: "adjacent", "SRDF",
/// "never_in_contact", "allow", … The reasons of an SRDF are one group, and so are those of a
/// robot.yaml and a problem that have the same key.
std::map<std::string, std::size_t> reasonGroups(const LeftOut& leftOut);

/// Returns one line, such as "14 pairs: 6 adjacent, 5 SRDF, 2 never_in_contact (proved), 1 allow",
/// the largest group first, or "no pair".
std::string notTestedText(const LeftOut& leftOut);

}  // namespace corridor
