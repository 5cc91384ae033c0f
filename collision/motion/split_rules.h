#pragma once

#include <cstddef>

namespace corridor {

/// Limits on the work in one interval. A pair that is not separated in an interval is *left* to the
/// interval's two halves. An interval that is far too wide should be halved before all of its pairs
/// are tested.
struct SplitThresholds {
  /// Once this many pairs of boxes of two bodies are left, all other pairs of boxes of these bodies
  /// are left as well, without a test.
  unsigned boxPairsLeft;
  /// Once at least this many pairs of bodies are left, as a whole or in part, and they are more
  /// than three quarters of the pairs of bodies counted so far, all other pairs of bodies are left
  /// untested. Pairs of bodies whose bounds are separated are neither counted
  /// nor left.
  std::size_t bodyPairsLeft;
};

/// The constants that decide when a query halves an interval. No value can make `free` or `contact`
/// wrong. Other values change the cost of a query, and therefore which motions are undecided at the
/// work limit. `kLeastHalfWidth` also limits which motions can be decided at all.
struct SplitRules {
  /// `kFirst` applies to the interval [0, 1] if body b of the pair rotates, since that interval is
  /// usually too wide. `kLater` applies in all other cases: for a translation the first-order term
  /// is exact in any interval.
  static constexpr SplitThresholds kFirst = {1, 1}, kLater = {8, 4};
  /// b counts as rotating if it turns by more than this angle, radians, from the middle of the
  /// interval to its end.
  static constexpr double kTurns = 0.02;
  /// A body moves far if its bounding sphere's centre may move, from its place at the middle of the
  /// interval, by more than this multiple of the sphere's radius.
  static constexpr double kFar = 2;
  /// In intervals with a smaller half width, a pair is never left untested for the reason that its
  /// body b moves far (`IntervalMotions::Separation`). The constant is necessary because pairs that
  /// are left untested count no work. A joint may make any number of turns, so without this least
  /// half width the query might never reach its work limit.
  static constexpr double kLeastHalfWidthFar = 0x1p-8;
  /// In intervals with a smaller half width, the trees of a pair are walked even if the test of its
  /// hulls may succeed in shorter intervals.
  static constexpr double kLeastHalfWidthHulls = 0x1p-11;
  /// The same limit for pairs without hulls, where only their bounds are tested
  /// (`pairsLeftByHulls`).
  static constexpr double kLeastHalfWidthBounds = 0x1p-5;
  /// If only the verdict is requested, this many levels of halving are walked level by level. A
  /// contact anywhere is then found early.
  static constexpr int kFirstLevels = 4;
  /// On this many levels below the whole motion, the remaining pairs are tested for contact at the
  /// middles of the intervals. On the edges that planners test, one more level costs more time than
  /// it saves (measured).
  static constexpr int kSampledLevels = 2;
  /// Intervals with this half width are not halved. The middles of much shorter intervals would not
  /// be exact.
  static constexpr double kLeastHalfWidth = 0x1p-48;
};

}  // namespace corridor
