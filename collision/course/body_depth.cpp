#include "collision/course/body_depth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "collision/core/rounding.h"
#include "collision/course/penetration.h"
#include "collision/hierarchy/traverse.h"
#include "collision/motion/certify_motion.h"
#include "collision/motion/rigid_motion.h"
#include "collision/queries/surface_distance.h"
#include "collision/queries/touching_pairs.h"
#include "collision/world/body_queries.h"

namespace corridor {
namespace {

/// The touching pair of primitives whose lower bound of the depth is largest.
struct Deepest {
  Penetration depth;
  std::optional<PrimitivePair> pair;
};

Deepest deepestPair(const Posed<Body>& a, const Posed<Body>& b, QueryContext& context) {
  const ObbTree &treeA = a.shape.binaryTree(), &treeB = b.shape.binaryTree();
  const Posed posedA(treeA), posedB(treeB, b.X_W);
  const auto test = pairTestOf<Obb>(posedA, posedB);
  Deepest deepest;
  const auto found = [&](std::uint32_t s, std::uint32_t t) {
    // The lower bound is proved for every accuracy, so a coarse accuracy is enough.
    const Penetration depth =
        penetration({convexSetOf(treeA, s), a.X_W}, {convexSetOf(treeB, t), b.X_W}, 0x1p-20);
    if (!deepest.pair || depth.lower > deepest.depth.lower)
      deepest = {depth, PrimitivePair{treeA.meshTriangle(s), treeB.meshTriangle(t)}};
    return false;
  };
  TouchingPairs query(posedA, posedB, test, context.counters, found);
  traverse(treeA, treeB, NodePair{0, 0}, *context.scratch.use<NodePairs>(), query);
  return deepest;
}

/// Returns an upper bound of the depth along a direction: b approaches a from `far` metres away.
/// Returns infinity if nothing is proved.
double depthAlong(const Body& a, const Body& b, const Transform& X_AB, const Vec3& direction,
                  double far, double accuracy, QueryContext& context) {
  const Vec3 start = far * direction;
  RigidEdge approach(RigidMotion::translation({X_AB.m, X_AB.t + start}, -start));
  const MotionPair pair{&a, &b, 0, 0, 1};
  MotionOptions options;
  options.earliest = true;
  options.timeTolerance = accuracy;
  // In the time `accuracy`, b approaches by accuracy·far metres: four tolerances, unless the
  // rounding of motions requires a larger tolerance.
  const double size = a.radius() + b.radius() + X_AB.t.stableNorm() + far;
  options.tolerance = std::max(accuracy * far / 4, RigidMotion::roundingTolerance(size));
  if (!(options.tolerance > 0)) return HUGE_VAL;  // flushed to zero
  const MotionResult result = certifyMotion(approach, {&pair, 1}, options, context);
  // If not even the start of the approach is proved free, the bodies are too small or too large for
  // the bounds.
  if (!(result.certifiedUntil > 0)) return HUGE_VAL;
  // All of [0, certifiedUntil] is free. The last term covers the rounding of `start` and of `X_AB.t
  // + start` along the direction. `RigidMotion::translation` covers the rounding orthogonal to the
  // direction.
  return roundedUp((1 - result.certifiedUntil) * far * (1 + 8 * kUnit) + 8 * kUnit * size);
}

}  // namespace

DepthBounds depthBounds(const Body& a, const Body& b, const Transform& X_AB,
                        const DepthOptions& options, QueryContext& context) {
  if (!(options.accuracy >= 0x1p-40 && options.accuracy <= 0.25))
    throw std::invalid_argument("the accuracy of a depth must be from 2^-40 to 1/4");
  if (!(orthonormalityDefect(X_AB.m) <= 0x1p-20))
    throw std::invalid_argument("a depth needs a map within 2^-20 of a rotation");
  for (const Vec3& d : options.directions)
    if (!d.allFinite() || d.isZero(0))
      throw std::invalid_argument("a direction must be finite, and not 0");
  const Posed<Body> posedA(a), posedB(b, X_AB);
  if (!interference(posedA, posedB, context)) return {};  // throws for maps that are not finite

  DepthBounds bounds;
  const Deepest deepest = deepestPair(posedA, posedB, context);
  bounds.deepest = deepest.pair;
  if (deepest.pair) {
    bounds.lower = deepest.depth.lower;
  } else {
    const Distance apart = surfaceDistance(posedA, posedB, {}, context);
    bounds.lower = distanceLowerBound(posedA, posedB, apart, {}, context);
  }

  const Vec3 centerB = X_AB.m * b.sphereCenter() + X_AB.t;
  std::vector<Vec3> directions = options.directions;
  if (directions.empty()) {
    directions = {deepest.depth.direction_W, centerB - a.sphereCenter()};
    for (int i = 0; i < 3; ++i)
      for (const double sign : {-1.0, 1.0}) {
        directions.push_back(sign * Vec3::Unit(i));
        directions.push_back(sign * X_AB.m.col(i));
      }
  }
  // A translation of b by `far` metres separates the bounding spheres. The 1 % covers rounding, and
  // the difference of the map from a rotation.
  const double far =
      1.01 * (a.sphereRadius() + b.sphereRadius() + (centerB - a.sphereCenter()).stableNorm());
  bounds.upper = HUGE_VAL;
  if (!(far < 0x1p1000)) return bounds;  // doubles could not hold a position so far away
  for (const Vec3& d : directions) {
    const Vec3 direction = d.stableNormalized();
    if (!(direction.squaredNorm() > 0.5))
      continue;  // the vector has length 0, so it is no direction
    const double upper = depthAlong(a, b, X_AB, direction, far, options.accuracy, context);
    if (upper < bounds.upper) bounds.upper = upper, bounds.direction_A = direction;
  }
  return bounds;
}

}  // namespace corridor
