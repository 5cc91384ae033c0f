#pragma once

#include <vector>

#include "planner/checker/checker.h"
#include "planner/robot/note.h"

namespace corridor {

/// A body inside the closed surface of a mesh that is not solid: free, because meshes are surfaces,
/// but perhaps not what the user means. The indices are those of the model's bodies.
struct EnclosedBody {
  std::size_t outer = 0, inner = 0;
};

/// Returns the enclosed bodies at a configuration, among the pairs that are tested. Pairs whose
/// surfaces touch are left out. The poses are rounded, so this is for notes only.
/// @throws std::invalid_argument if the configuration is not finite.
std::vector<EnclosedBody> enclosedBodies(const Checker& checker, const Configuration& q);

/// Returns the notes on what the bodies' poses at a start imply for every state or every free path:
/// those of `notesOnFixedPairs`, and one on enclosed bodies.
std::vector<Note> notesOnStart(const Checker& checker, const Configuration& q);

}  // namespace corridor
