#pragma once

#include <cstddef>

namespace corridor {

/// Limits on the work in one interval, since an interval that is far too wide should be halved
/// before all of its pairs are tested.
struct SplitThresholds {
  unsigned pairsOfNodes;  ///< the walk of a pair of bodies stops once it has left this many
  /// The test of an interval leaves the remaining bodies untested once this many pairs of bodies
  /// have left something, and these are more than three quarters of the pairs tested.
  std::size_t pairsOfBodies;
};

/// What decides when a query halves an interval. No value can make `free` or `contact` wrong.
/// Another value changes what a query costs, and so what it leaves undecided at the work limit;
/// `kShortest` also bounds what can be decided at all.
struct SplitRules {
  /// The whole motion is mostly too wide, so its thresholds are the lowest, but only if b rotates:
  /// a translation is described exactly to first order in any interval.
  static constexpr SplitThresholds kFirst = {1, 1}, kLater = {8, 4};
  /// Half of an interval's angle, radians, above which b counts as rotating.
  static constexpr double kTurns = 0.02;
  /// A motion is far if it is longer than this multiple of the radius of b's bounding sphere.
  static constexpr double kFar = 2;
  /// The least half width at which a body that moves far (`IntervalMotions::Separation`) is left to
  /// the interval's halves untested. Below it every body is tested: pairs that are left untested
  /// count no work, and a joint may make any number of turns, so the query might otherwise never
  /// reach its work limit.
  static constexpr double kShortestFar = 0x1p-8;
  /// The number of levels of halving that are walked level by level if only the verdict is
  /// requested, so that a contact anywhere is found early.
  static constexpr int kFirstLevels = 4;
  /// The number of levels below the whole motion at whose middles the remaining pairs are tested
  /// for contact. Measured on the edges that plans test: one more level costs more than it finds.
  static constexpr int kSampledLevels = 2;
  /// Intervals with a half width of 2^-48 of the motion are not halved: much below, their middles
  /// would no longer be exact.
  static constexpr double kShortest = 0x1p-48;
};

}  // namespace corridor
