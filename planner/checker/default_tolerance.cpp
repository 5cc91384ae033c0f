#include "planner/checker/default_tolerance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/core/rounding.h"

/// Derivation. With u = 2^-53, V_j the largest angle of joint j in radians, and S the lengths of
/// both chains from the world to the farthest points of two bodies, stretched and added,
/// `EdgeMotion` states rotation and position errors, each at most u·S times the sum over the joints
/// of both of
///   103 + 12·V_j  for a turn     (sine and matrix 40, fixed pose 2, value 12·V_j, product 10 + 11;
///                                 an axis 40),
///   51            for a slide or a shift  (value and sum 24 + 12, product 10 + 11 of S),
///   575           for a rotation  (2^-44 = 512, and the products).
/// The pose has both, turned into one body's frame: twice that; so have points and axes of joints:
/// four times that together, of which w_j below has two, and the sum the factor 2. Leaf triangles
/// and parts are compared with an error of 64u·(2|t| + L) ≤ 64u·3S: 300. With E = u·S·(300 + 2·Σ
/// w_j), a clearance of 2τ is proved where a window's travel is under τ, the direction of the
/// closest points is tilted by at most a quarter of the gap, and so 0.75·2τ > τ + 2E: τ = 4E.
namespace corridor {
namespace {

constexpr double kLeaves = 300;
constexpr double kTurn = 250, kPerRadian = 30, kSlide = 110, kRotation = 1250;

/// The largest magnitude of a number of a configuration.
double largestOf(const ConfigurationSpace& space, std::size_t number) {
  for (const Coordinate& c : space.coordinates()) {
    if (c.first > number || number >= c.first + c.size()) continue;
    if (c.kind == Coordinate::Kind::circle) return 3.2;
    return c.kind == Coordinate::Kind::line ? std::max(std::abs(c.lower), std::abs(c.upper)) : 1;
  }
  return 0;
}

/// What a frame adds to the length and to the roundings of the chains that it is in.
struct Share {
  double length = 0, roundings = 0;
};

Share shareOf(const Problem& problem, const Frame& frame) {
  Share share{frame.fixed.p.stableNorm(), kSlide};
  const bool held = frame.variable == Frame::noVariable;
  const double value =
      std::abs(frame.offset) +
      (held ? 0 : std::abs(frame.multiplier) * largestOf(problem.space, frame.variable));
  switch (frame.joint) {
    case Frame::Joint::none:
      break;
    case Frame::Joint::turn:
      if (!held) share.roundings = kTurn + kPerRadian * value;
      break;
    case Frame::Joint::slide:
      share.length += value;
      break;
    case Frame::Joint::shift:
      for (std::size_t k = 0; k < frame.count; ++k)
        share.length += largestOf(problem.space, frame.variable + k);
      break;
    case Frame::Joint::rotate:
      share.roundings = kRotation;
      break;
  }
  return share;
}

double farthestPoint(const ProblemBody& body) {
  double farthest = 0;
  for (const PlacedShape& shape : body.shapes) {
    const double radius = shape.part ? shape.part->radius : 0;
    for (const Vec3& p : shape.part ? shape.part->points : shape.mesh->mesh.vertices)
      farthest = std::max(farthest, p.stableNorm() + radius);
  }
  return farthest;
}

}  // namespace

double roundingTolerance(const Problem& problem) {
  std::vector<Share> chains(problem.tree.frames.size());  // from the world to each frame
  for (std::size_t f = 1; f < chains.size(); ++f) {
    const Frame& frame = problem.tree.frames[f];
    const Share share = shareOf(problem, frame), parent = chains[frame.parent];
    chains[f] = {parent.length + share.length, parent.roundings + share.roundings};
  }
  double largest = 0;
  for (const ProblemPair& pair : problem.pairs) {
    if (!pair.skipped.empty()) continue;
    double size = 0, roundings = kLeaves;
    for (const std::size_t b : {pair.a, pair.b}) {
      const ProblemBody& body = problem.bodies[b];
      size += chains[body.frame].length + farthestPoint(body);
      roundings += 2 * chains[body.frame].roundings;
    }
    const double error = kUnit * size * roundings;
    if (std::isfinite(error)) largest = std::max(largest, error);
  }
  return 4 * largest;
}

double defaultTolerance(const Problem& problem, double usual) {
  return std::clamp(roundingTolerance(problem), usual, 1000 * usual);
}

}  // namespace corridor
