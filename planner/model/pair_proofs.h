#pragma once

#include <cstddef>
#include <optional>

#include "planner/model/model.h"
#include "planner/robot/curve.h"

/// Proofs that two links of a robot are never in contact: what they say about a model, and for
/// which configurations they hold.
namespace corridor {

/// Returns what a proof for two links of a robot says in a model, or nullopt if it says nothing
/// there. The proof is one as `corridor new robot` makes it: for all values of all joints within
/// their limits, beyond which it goes by `proof.beyondLimits`. So it also holds if some of the
/// joints are held, at any values within these ranges.
/// @param robot its `plannedJoints` are set. @param a, b indices of links.
/// @returns nullopt also if a planar or floating joint lies between the links, or a joint that
/// mimics a continuous one and does not return to its pose after a turn: there is no such proof.
std::optional<PairProof> proofBetween(const ModelRobot& robot, const ConfigurationSpace& space,
                                      std::size_t a, std::size_t b,
                                      const AllowedPair::Proof& proof);

/// The configurations for which every pair that is left out because of a proof is proved, with the
/// whole tube around them. A configuration that is within the limits of all joints is always among
/// them.
struct ProvedBox {
  /// One entry for each number of a configuration, inclusive; infinite where it does not matter.
  Configuration lower, upper;

  bool contains(const Configuration& q) const;
  /// Returns whether the whole curve, widened by the piece's error, is in the box. `true` is never
  /// wrong. `false` is returned, too, if the curve comes closer to a face of the box than about
  /// 2^-10 of the range of its coefficients and leaves nothing to rounding.
  bool contains(const CurvePiece& piece) const;
};

/// Returns the configurations for which the tests of the other pairs are enough, or nullopt if no
/// pair is left out because of a proof.
/// @param need what the tests have to cover.
std::optional<ProvedBox> provedBox(const Model& model, const Required& need);

}  // namespace corridor
