#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/hierarchy/node_pair4.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/motion/moving_triangles.h"
#include "collision/motion/relative_motion.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// The result of one time interval for node pairs of two trees.
struct Descent {
  enum class Kind {
    done,  ///< all that is not deferred to shorter intervals is separated throughout the interval
    contact,  ///< `s` and `t` touch, or are within the margin, at the rounded pose at the middle
    /// `s` and `t` are neither separated nor proved to touch, and shorter intervals would not help,
    /// are not needed, or are not allowed.
    undecided,
    workLimit,  ///< the work limit was reached
  };
  Kind kind = Kind::done;
  std::uint32_t s = 0, t = 0;  ///< numbers of the leaf primitives in their meshes
  double gap = 0;              ///< `undecided`: distance at the middle beyond the margin, metres
  bool wide = false;           ///< `undecided`: the motion bound exceeds the tolerance
  /// If requested, the proved clearance of all pairs that were separated: throughout the interval,
  /// their distance is at least the margin plus `clearance`. The motion bound and all errors of the
  /// relative motion (rounding, tube, clearance slack) are already subtracted. Metres; infinite if
  /// nothing was separated.
  double clearance = HUGE_VAL;
};

struct DescentOptions {
  double margin = 0, tolerance = 0;  ///< metres
  bool shortest = false;             ///< the interval must not be halved
  std::uint64_t workEnd = 0;         ///< `Counters::work` at which the walk stops
  /// Once this many pairs of boxes are deferred to the halves, all others are deferred, too.
  unsigned deferAllAfter = 0;
  bool clearance = false;  ///< whether `Descent::clearance` is requested, which costs time
};

/// The result for a pair of leaf primitives. `apart`: the pair is separated throughout the
/// interval. `deferred`: the pair is left to shorter intervals. `last`: the walk ends, for the
/// reason in `Descent::kind`.
enum class LeafOutcome { apart, deferred, last };

/// Adds the result for two leaf primitives to the result of the interval, and returns what becomes
/// of the pair. `s` and `t` are the numbers of the two primitives in their meshes.
inline LeafOutcome outcomeOf(const MovingPairAnswer& answer, std::uint32_t s, std::uint32_t t,
                             const DescentOptions& options, Descent& descent) {
  if (answer.separated) {
    descent.clearance = std::min(descent.clearance, answer.clearance);
    return LeafOutcome::apart;
  }
  descent.s = s;
  descent.t = t;
  if (answer.contact) {
    descent.kind = Descent::Kind::contact;
    return LeafOutcome::last;
  }
  // Shorter intervals would not help, are not needed (for this tolerance), or are not allowed.
  if (answer.stuck || !(answer.bound > options.tolerance) || options.shortest) {
    descent.kind = Descent::Kind::undecided;
    descent.gap = answer.gap;
    descent.wide = answer.bound > options.tolerance;
    return LeafOutcome::last;
  }
  return LeafOutcome::deferred;
}

/// Walks the trees below the node pairs `start` in a time interval. b moves by the relative motion
/// `relative`. Appends the node pairs that cannot be separated in this interval to `later`. `start`
/// may be a part of `later`.
///
/// Two boxes are separated if, along one of 15 axes, their gap exceeds the motion bound along this
/// axis for the whole interval (overlap_obb4_moving-inl.h). Pairs of leaf primitives are separated
/// along the direction of their closest points (`decideMovingTriangles`, `decideMovingParts`). Time
/// is split before space: if b's box moves far, compared with the sizes of both boxes, the pair is
/// deferred to shorter intervals.
///
/// @return the result of the interval. If its kind is `contact`, `later` also receives the pair
/// that touches and everything that was not tested. If the kind is `undecided` or `workLimit`, the
/// node pairs appended to `later` have no meaning.
Descent descend(std::span<const NodePair4> start, const Obb4Tree& a, const Obb4Tree& b,
                const RelativeMotion& relative, const DescentOptions& options,
                std::vector<NodePair4>& later, QueryContext& context);
/// The same function for code that is generic over the kinds of trees (`withTrees`). 4-wide trees
/// have only one overlap test.
template <std::same_as<StandardOverlap> Overlap>
Descent descend(std::span<const NodePair4> start, const Obb4Tree& a, const Obb4Tree& b,
                const RelativeMotion& relative, const DescentOptions& options,
                std::vector<NodePair4>& later, QueryContext& context) {
  return descend(start, a, b, relative, options, later, context);
}

}  // namespace corridor
