#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "collision/core/query_context.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/motion/rigid_motion.h"

namespace corridor {

/// Two triangles of two bodies, by the bodies' indices in the scene and the triangles' numbers in
/// their meshes.
struct Contact {
  std::size_t movingBody = 0, fixedBody = 0;
  std::uint32_t movingTriangle = 0, fixedTriangle = 0;
};

enum class MotionVerdict { free, contact, undecided };
enum class UndecidedReason { none, clearance, workLimit, ambiguous };

/// The answer of a motion query (design: contract 2). `free` is never wrong. `contact` has an exact
/// contact at the rounded pose at `contactTime`. `undecided` means a clearance under the tolerance
/// somewhere, the work limit, or a half turn.
struct MotionResult {
  MotionVerdict verdict = MotionVerdict::free;
  UndecidedReason reason = UndecidedReason::none;
  /// [0, certifiedUntil] is proved free (for `free`: 1), but where it is 0, which claims nothing.
  /// Not asked for: 0.
  double certifiedUntil = 1;
  double contactTime =
      -1;  ///< t1 of `contact`, else −1; for `undecided` the middle of the undecided interval
  bool grazing = false;         ///< `contact`, and over all of [certifiedUntil, contactTime] the
                                ///< clearance stays under twice the tolerance, rounding and tube
  std::optional<Contact> pair;  ///< of `contact`, and of `undecided` for want of clearance
  double gap = 0;  ///< `undecided` for want of clearance: distance beyond the margin found at
                   ///< contactTime, metres
};

/// Parameters of a motion query.
struct MotionOptions {
  double tolerance = 0;   ///< metres, > 0; below this clearance the answer may be `undecided`
  double margin = 0;      ///< metres kept from every obstacle; 0: touching is contact
  double reserve = 0;     ///< metres that `free` leaves beyond margin and tube; less is `undecided`
  Tube tube;              ///< what the proof covers beside the nominal curve
  bool earliest = false;  ///< find `certifiedUntil` too, not just the verdict
  double timeTolerance = 1.0 / 1024;  ///< of [0, 1]; how narrow a bracket `earliest` asks for
  std::uint64_t workLimit =
      20'000'000;  ///< box and triangle tests, after which the answer is `undecided`
};

/// A moving and a fixed body's trees, with their indices in the scene.
struct TreePair {
  const ObbTree* moving;
  const ObbTree* fixed;
  std::size_t movingBody = 0, fixedBody = 0;
};

/// Is the motion free of contact of every pair, for all t in [0, 1], for the tube around it, and
/// with the margin kept? The fixed bodies are at the identity, all moving ones move together.
/// Surfaces only: a body inside another touches nothing.
///
/// Method (design: «The certified edge»): a window of time is halved where boxes or triangles can't
/// be told apart; each window hands the undecided pairs of nodes down to its halves. At a window's
/// middle, boxes are separated with the margin that covers what the body does in the whole window
/// (`BoxTravel`), leaf pairs along the direction of their closest points, every corner with its own
/// travel.
MotionResult certifyMotion(const RigidMotion& motion, std::span<const TreePair> pairs,
                           const MotionOptions& options, QueryContext& context);

}  // namespace corridor
