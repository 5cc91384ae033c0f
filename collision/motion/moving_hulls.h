#pragma once

#include <cstdint>

#include "collision/convex/convex_cache.h"
#include "collision/hierarchy/body.h"
#include "collision/motion/relative_motion.h"

namespace corridor {

/// What the tests of one pair of hulls in one motion query have found so far. It decides only where
/// the next test begins, and whether there is one. It belongs to one query, so a verdict does not
/// depend on earlier queries.
struct HullGuess {
  ConvexCache cache;           ///< of the last search
  Vec3 normal = Vec3::Zero();  ///< the direction that separated the hulls last; 0: none did
  /// The hulls met, or nearly, in some interval. The trees are walked from then on: a hull covers
  /// its body's dents, so the next test would rarely succeed.
  bool met = false;
};

/// The result of testing two hulls in a time interval.
struct MovingHullsAnswer {
  bool separated = false;  ///< proved farther apart than the margin throughout the interval
  double clearance = 0;    ///< `separated`: proved distance beyond the margin, metres
  /// Not `separated`: at the middle, the hulls are farther apart than the margin.
  bool apart = false;
  bool shorter = false;  ///< `apart`, and a few times shorter intervals may be separated
};

/// Reports whether a test of the hulls of two bodies is worth its time: both have a hull that fits
/// them (`Body::hull`), and one of them is a mesh. (Two convex parts are their own hulls, and the
/// walk of their trees is that test.) Builds the hulls if necessary.
bool haveHulls(const Body& a, const Body& b);

/// Tests the hulls of two bodies in a time interval: b moves by the relative motion `relative`.
/// Separated hulls prove that the bodies are separated, also if the bodies are surfaces.
///
/// Method: a separating direction, that of the last test or one that GJK finds, and the gap of all
/// points of both hulls along it, with the motion bound along this direction
/// (`MovingSets`, moving_sets.h, which has the derivation). This needs one or two passes over the
/// hulls for a pair of bodies, where the walk of their trees takes many tests of boxes.
/// @pre `haveHulls(a, b)`, and the pose and the bounds of `relative` are finite.
MovingHullsAnswer decideMovingHulls(const Body& a, const Body& b, const RelativeMotion& relative,
                                    double margin, HullGuess& guess);

}  // namespace corridor
