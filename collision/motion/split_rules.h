#pragma once

#include <cstddef>

namespace corridor {

/// Limits on the work in one interval. An interval that is far too wide should be halved before all
/// of its pairs are tested.
struct SplitThresholds {
  /// Once this many pairs of boxes of two bodies are left to the halves, all other pairs of boxes
  /// of these bodies are left, too.
  unsigned boxPairsLeft;
  /// The other pairs of bodies are left untested once two things hold. At least this many pairs of
  /// bodies are left to the halves, whole or in part. And these are more than three quarters of the
  /// pairs of bodies counted so far. Pairs of bodies whose bounds are separated are neither counted
  /// nor left.
  std::size_t bodyPairsLeft;
};

/// The constants that decide when a query halves an interval. No value can make `free` or `contact`
/// wrong. Other values change the cost of a query, and therefore which motions are undecided at the
/// work limit. `kLeastHalfWidth` also limits which motions can be decided at all.
struct SplitRules {
  /// `kFirst` applies to the interval [0, 1] if b rotates, since that interval is usually too wide.
  /// `kLater` applies in all other cases. A translation is described exactly to first order in any
  /// interval.
  static constexpr SplitThresholds kFirst = {1, 1}, kLater = {8, 4};
  /// Half of an interval's angle, radians, above which b counts as rotating.
  static constexpr double kTurns = 0.02;
  /// A body moves far if its bounding sphere's centre may move, from its place at the middle of the
  /// interval, by more than this multiple of the sphere's radius.
  static constexpr double kFar = 2;
  /// The least half width at which a pair is left untested to the halves of the interval because
  /// its body b moves far (`IntervalMotions::Separation`). In shorter intervals this reason does
  /// not apply. The constant is necessary because pairs that are left untested count no work. A
  /// joint may make any number of turns, so without this least half width the query might never
  /// reach its work limit.
  static constexpr double kLeastHalfWidthFar = 0x1p-8;
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
