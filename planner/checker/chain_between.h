#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "collision/world/scene.h"
#include "planner/model/model.h"

namespace corridor {

/// The frames between two bodies of a model, as a separate tree, and the values of the joints that
/// move one body against the other. For proofs that hold wherever the rest of the robot is. The
/// root of the tree is the lowest common ancestor of the two frames. All coordinates have the kind
/// `line`, and are numbered in the order of their first use.
struct ChainBetween {
  struct Range {
    double lower = 0, upper = 0;
  };

  KinematicTree tree;
  ConfigurationSpace space;
  Scene::FramePair pair;
  std::vector<std::size_t> variables;  ///< of the moving frames, in order from a to b
  /// For each coordinate, the values that a proof must cover. [−π, π], rounded outward, if the
  /// joints return to the same pose after a full turn, and may make one.
  std::vector<Range> box;
  std::vector<std::size_t> numbers;  ///< for each coordinate, its number in a Configuration
  std::vector<char> isTurn;  ///< for each coordinate, whether values that differ by 2π are equal
};

/// Returns the chain between the frames a and b of a model; nullopt if nothing moves between them,
/// a joint is planar or floating, or the values that must be covered are not bounded.
/// @param beyond how far the values must reach beyond each limit, rad or m.
std::optional<ChainBetween> chainBetween(const Model& model, std::size_t a, std::size_t b,
                                         double beyond);

}  // namespace corridor
