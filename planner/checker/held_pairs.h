#pragma once

#include <cstddef>
#include <vector>

#include "collision/world/scene.h"
#include "planner/model/model.h"

namespace corridor {

/// Two bodies of a model, by index, that stand still relative to each other because the joints
/// between them are held. a < b.
struct HeldPair {
  std::size_t a = 0, b = 0;
};

/// Returns the pairs of bodies with the filter's reason kTestedAtRest that are not proved free: the
/// two bodies touch, are not farther apart than margin plus padding, or are too close to be
/// decided. This holds in every state. The answers are those that `Scene::certify` gives for a
/// state, so a pair that is not returned is proved free for all states, in real arithmetic.
///
/// If the processor's floating-point mode makes the bounds invalid, all pairs are returned.
/// @param scene as `makeScene` makes it from the model. Its pairs are ignored.
/// @param options its `pairMargins` are ignored; the padding is that of `need`.
std::vector<HeldPair> heldPairsNotFree(const Model& model, const Scene& scene, const Required& need,
                                       MotionOptions options);

/// Returns a scene that also tests `more` pairs. It shares the bodies' meshes and trees.
Scene withPairs(const Model& model, const Scene& scene, const std::vector<HeldPair>& more);

/// Returns a configuration whose numbers are 0, and whose rotations are the identity. Bodies that
/// stand still relative to each other have the same relative pose there as everywhere.
Configuration zeroConfiguration(const ConfigurationSpace& space);

/// Returns the padding of each pair of a scene, metres, in the order of its pairs.
PairMargins paddingsOf(const Model& model, const Padding& padding, const Scene& scene);

}  // namespace corridor
