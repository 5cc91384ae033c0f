#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/motion/motion_window.h"
#include "collision/motion/moving_triangles.h"

namespace corridor {

/// What one window of time makes of pairs of nodes of two trees.
struct Descent {
  enum class Kind {
    done,       ///< what is not among the leftovers is apart all along the window
    contact,    ///< `s` and `t` touch at the rounded pose of the window's middle
    undecided,  ///< of `s` and `t` nothing is known, and no shorter window would tell
    workLimit,  ///< out of work
  };
  Kind kind = Kind::done;
  std::uint32_t s = 0, t = 0;  ///< by their numbers in their meshes
  double gap = 0;              ///< `undecided`: metres beyond the margin at the middle
  bool wide = false;           ///< `undecided`, and b goes farther in the window than the tolerance
  /// Where asked for: what was told apart is proved to stay at least this much farther apart than
  /// margin and pads, metres; nothing was: infinite.
  double clearance = HUGE_VAL;
};

struct DescentOptions {
  double margin = 0, tolerance = 0;  ///< metres
  bool shortest = false;             ///< the window is not to be halved
  std::uint64_t workEnd = 0;         ///< box and triangle tests of the counters, to stop at
  unsigned mostLeft = 0;             ///< pairs that may be left to halves before all the rest is
  bool clearance = false;            ///< asked for: costs time
};

/// What a pair of leaves' items says: they are apart all along the window, left to shorter ones, or
/// the last that has to be looked at (`Descent::kind` says why).
enum class LeafPair { apart, left, last };

/// Takes the answer for the items `s` and `t`, by their numbers in their meshes, into the window's.
inline LeafPair judged(const MovingTrianglesAnswer& answer, std::uint32_t s, std::uint32_t t,
                       const DescentOptions& options, Descent& descent) {
  if (answer.separated) {
    descent.clearance = std::min(descent.clearance, answer.clearance);
    return LeafPair::apart;
  }
  descent.s = s;
  descent.t = t;
  if (answer.contact) {
    descent.kind = Descent::Kind::contact;
    return LeafPair::last;
  }
  // Refining does not help, or need not.
  if (answer.stuck || !(answer.travel > options.tolerance) || options.shortest) {
    descent.kind = Descent::Kind::undecided;
    descent.gap = answer.gap;
    descent.wide = answer.travel > options.tolerance;
    return LeafPair::last;
  }
  return LeafPair::left;
}

/// Walks the trees below pairs of nodes, b moving as the window says; what the window can't tell
/// apart goes to `later`, after what that holds.
///
/// Boxes are told apart with what they travel in the whole window (overlap_obb4_moving-inl.h), leaf
/// pairs along the direction of their closest points (`decideMovingTriangles`,
/// `decideMovingParts`). Time before space: a pair of boxes that travel farther than they are large
/// is left to shorter windows.
///
/// @param count how many items of `context.wideStack` to start from. For `contact` all that was not
/// looked at, and the pair that touches, are in `later`, too; for `undecided` and `workLimit`
/// nothing is to be made of it.
Descent descend(const WideObbTree& a, const WideObbTree& b, const MotionWindow& window,
                const DescentOptions& options, std::size_t count,
                std::vector<QueryContext::WideItem>& later, QueryContext& context);

}  // namespace corridor
