#include "planner/checker/default_tolerance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/core/rounding.h"

/// Derivation. Let u = 2^-53. Let V_j be the largest angle of joint j in radians. Let S be the sum
/// of the lengths of both stretched chains, from the world to the farthest points of the two
/// bodies.
///
/// `EdgeMotion` bounds the errors of rotation and position. Each bound is at most u·S times a sum
/// over the joints of both chains. The summands are:
///   revolute: 103 + 12·V_j  (sine and matrix 40, fixed pose 2, value 12·V_j, product 10 + 11;
///     an axis 40)
///   prismatic, translation: 57  (value and sum 24 + 12, product 10 + 11 of S). The error of the
///     constant poses before a prismatic joint is part of their own summands.
///   rotation: 575  (2^-44 = 512u, and the products)
///
/// A relative pose has the errors of both bodies' poses, transformed into one body's frame: twice
/// that sum. The points and axes of joints have errors up to twice the sum, too. Together these
/// errors are four times the sum. The constants w_j (`kTurn` + `kPerRadian`·V_j, `kSlide`,
/// `kRotation`) contain a factor 2, and E contains the other factor 2.
///
/// Leaf triangles and parts are compared with an error of 64u·(2|t| + L) ≤ 192u·S; the 300 in E
/// (`kLeaves`) covers it.
///
/// With E = u·S·(300 + 2·Σ w_j), a clearance of 2τ is proved in a time interval whose motion bound
/// is below τ. The direction between the closest points may be off, which loses at most a quarter
/// of the gap. So 0.75·2τ > τ + 2E is needed, that is, τ > 4E. With τ = 4E the two sides are equal.
/// This is enough, because E is larger than the error (300 > 192).
namespace corridor {
namespace {

constexpr double kLeaves = 300;
constexpr double kTurn = 250, kPerRadian = 30, kSlide = 120, kRotation = 1250;

/// Returns the largest magnitude that a number of a configuration can have.
double largestOf(const ConfigurationSpace& space, std::size_t number) {
  for (const Coordinate& c : space.coordinates()) {
    if (c.first > number || number >= c.first + c.size()) continue;
    if (c.kind == Coordinate::Kind::circle) return 3.2;
    return c.kind == Coordinate::Kind::line ? std::max(std::abs(c.lower), std::abs(c.upper)) : 1;
  }
  return 0;
}

/// The contribution of a frame to the length and to the roundings of its chain.
struct Share {
  double length = 0, roundings = 0;
};

Share shareOf(const Model& model, const Frame& frame) {
  Share share{frame.fixed.p.stableNorm(), kSlide};
  const bool held = frame.variable == Frame::noVariable;
  const double value =
      std::abs(frame.offset) +
      (held ? 0 : std::abs(frame.multiplier) * largestOf(model.space, frame.variable));
  switch (frame.joint) {
    case Frame::Joint::none:
      break;
    case Frame::Joint::revolute:
      if (!held) share.roundings = kTurn + kPerRadian * value;
      break;
    case Frame::Joint::prismatic:
      share.length += value;
      break;
    case Frame::Joint::translation:
      for (std::size_t k = 0; k < frame.count; ++k)
        share.length += largestOf(model.space, frame.variable + k);
      break;
    case Frame::Joint::rotation:
      share.roundings = kRotation;
      break;
  }
  return share;
}

/// Returns the largest distance of a point of the body from its frame's origin, metres.
double farthestPoint(const ModelBody& body) {
  double square = 0, largestRadius = 0;
  const auto each = [&](const auto& visit) {
    for (const PlacedShape& shape : body.shapes) forEachPoint(shape, visit);
  };
  each([&](const Vec3& p, double radius) {
    square = std::max(square, p.squaredNorm());
    largestRadius = std::max(largestRadius, radius);
  });
  // In this range, squares of lengths neither overflow nor vanish.
  if (0x1p-400 < square && square < 0x1p1000) return std::sqrt(square) + largestRadius;
  double farthest = 0;
  each([&](const Vec3& p, double) { farthest = std::max(farthest, p.stableNorm()); });
  return farthest + largestRadius;
}

}  // namespace

double roundingTolerance(const Model& model, const Required& need) {
  std::vector<Share> chains(model.tree.frames.size());  // from the world to each frame
  for (std::size_t f = 1; f < chains.size(); ++f) {
    const Frame& frame = model.tree.frames[f];
    const Share share = shareOf(model, frame), parent = chains[frame.parent];
    chains[f] = {parent.length + share.length, parent.roundings + share.roundings};
  }
  std::vector<double> farthest;  // for each body
  for (const ModelBody& body : model.bodies) farthest.push_back(farthestPoint(body));
  double largest = 0;
  forEachTestedPair(model, need, [&](std::size_t a, std::size_t b) {
    double size = 0, roundings = kLeaves;
    for (const std::size_t i : {a, b}) {
      const ModelBody& body = model.bodies[i];
      size += chains[body.frame].length + farthest[i];
      roundings += 2 * chains[body.frame].roundings;
    }
    const double error = kUnit * size * roundings;
    if (std::isfinite(error)) largest = std::max(largest, error);
  });
  return 4 * largest;
}

double defaultTolerance(const Model& model, const Required& need, double usual) {
  return std::clamp(roundingTolerance(model, need), usual, 1000 * usual);
}

}  // namespace corridor
