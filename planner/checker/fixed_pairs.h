#pragma once

#include <vector>

#include "planner/checker/checker.h"
#include "planner/robot/note.h"

namespace corridor {

/// Two bodies that never move relative to each other, because the joints between them are fixed.
/// The indices are those of the model. (Pairs with held joints between them: held_pairs.h.)
struct FixedPair {
  std::size_t a = 0, b = 0;
  bool touches = false;  ///< false: the bodies are apart, but by at most margin plus padding
};

/// Returns whether the model has a pair of bodies that is not tested because only fixed joints are
/// between the two, and that are not links of one robot.
bool hasFixedPairs(const Model& model);

/// Returns pairs of bodies that are not tested, because only fixed joints are between the two
/// (kNeverMove). The returned pairs touch, or are not farther apart than margin plus padding, in
/// every state. Such a pair may be a base on its table, or result from a wrong pose of a base or an
/// obstacle. Pairs of one robot are left out: their overlap is part of the robot.
///
/// The bodies are tested at their rounded poses for `q`. @pre `q` is finite.
/// @throws std::runtime_error as `Checker::interference` does; std::invalid_argument if a pose is
/// not finite.
std::vector<FixedPair> closeFixedPairs(const Checker& checker, const Configuration& q);

/// Returns notes on the pairs of `closeFixedPairs`: one on the pairs that touch, and one on the
/// others. Each note names at most six pairs, and counts the rest.
std::vector<Note> notesOnFixedPairs(const Checker& checker, const Configuration& q);

}  // namespace corridor
