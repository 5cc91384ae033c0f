#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/motion/chain_filter.h"

/// The SIMD kernels of `ChainFilter`, and their data.
namespace corridor {

/// The constants of a filter. The kernels take all floats as exact; chain_filter.cpp bounds how far
/// they are from the scene's numbers.
struct ChainTables {
  static constexpr std::uint32_t kNone = ChainScene::kNone;

  struct Joint {
    std::uint32_t parent = kNone;
    bool slides = false;
    float fixed[9], sine[9], versine[9], axis[3];
  };
  struct Link {
    std::uint32_t joint = kNone;
    float center[3], radius = 0;  ///< of the ball, in the joint's frame
    float core = 0;               ///< largest distance of a point of the hull from the centre
    double reach = 0;             ///< of the points of ball and hull, from the joint's origin
    /// The points of the hull, in the joint's frame: three columns, filled up to eights. Empty:
    /// there is no hull.
    std::vector<float> points;
    float swept = 0;            ///< radius of the sphere or disc that sweeps the points
    bool hasObstacles = false;  ///< whether a pair has the link and an obstacle
  };
  struct Obstacle {
    bool isCylinder = false;
    float center[3], axes[9], half[3];  ///< axes: the columns of a matrix, row by row
    float pad = 0;                      ///< metres: the error of a distance from the floats above
  };

  std::vector<Joint> joints;
  std::vector<Link> links;
  std::vector<Obstacle> obstacles;
  std::array<std::vector<float>, 3> lower, upper;  ///< boxes of obstacles, filled up to eights
  /// The joints between the bodies of pair i, from b to a, are
  /// `pathJoints[pathEnds[i] … pathEnds[i + 1])`.
  std::vector<std::uint32_t> pathJoints, pathEnds = {0};
  std::vector<std::uint32_t> linkPairs;   ///< indices of the pairs of two links
  std::vector<std::uint32_t> worldPairs;  ///< for each link and obstacle, a pair's index, or kNone
  ChainScene scene;

  std::span<const std::uint32_t> pathOf(std::uint32_t pair) const {
    return std::span(pathJoints).subspan(pathEnds[pair], pathEnds[pair + 1] - pathEnds[pair]);
  }
};

/// One edge. Bounds are rounded up.
struct ChainEdge {
  struct Joint {
    float shift[3], slide[3];
    double angle = 0, rate = 0;
    float largestRate = 0;
  };
  std::vector<Joint> joints;
  int sets = 1;          ///< how many times eight intervals; a power of two
  bool still = false;    ///< one state: a single set, whose intervals are all the state
  float pad = 0;         ///< metres: errors of the positions of two bodies, and their tubes
  float lever = 0;       ///< metres: error of the distance of a point from an axis
  float firstOrder = 0;  ///< metres per radian or metre of joint motion: error of displacements
  std::vector<float> margins;  ///< metres, for each pair
  float largestMargin = 0;
  std::span<const std::uint8_t> proved;  ///< see `ChainFilter::pairsLeft`
};

constexpr int kMostChainSets = 8;

/// The unit roundoff of float.
constexpr double kFloatUnit = 0x1p-24;

/// Returns the smallest float that is at least x.
inline float upToFloat(double x) {
  const auto rounded = static_cast<float>(x);
  return double{rounded} >= x ? rounded : std::nextafterf(rounded, HUGE_VALF);
}

/// Returns the middle of an interval.
inline double timeOf(const ChainEdge& edge, int set, int lane) {
  return edge.still ? 0 : (16 * set + 2 * lane + 1) * 0.0625 / edge.sets;
}

struct ChainScratch {
  struct alignas(32) JointLanes {
    float m[9][8], t[3][8], axis[3][8], angular[3][8], linear[3][8];
    float amount;  ///< half of the joint's motion in an interval
    float sum;     ///< of the amounts of this joint and those above
  };
  struct alignas(32) LinkLanes {
    float center[3][8], velocity[3][8], second[8], isotropic[8];
  };
  using Masks = std::array<std::uint8_t, kMostChainSets>;

  ChainEdge edge;
  std::vector<JointLanes> joints;  ///< of all sets
  std::vector<LinkLanes> links;    ///< of one set
  std::vector<Masks> open;         ///< for each pair: the intervals that are not proved
  /// A pair with open intervals. Pairs with a smaller `closeness` are tested first: it is the least
  /// square of a distance of centres, or from an obstacle to a centre, in balls' radii.
  struct OpenPair {
    std::uint32_t pair = 0;
    float closeness = 0;
  };
  std::vector<OpenPair> openPairs;
};

/// Tests the balls of all bodies in all intervals of the edge. Fills `open` and `openPairs`.
void separateBalls(const ChainTables& tables, ChainScratch& scratch);

/// Returns the lanes of a set in which the hull of b is proved apart from all points x of a with
/// n·x ≤ highest.
/// @param n in the frame of a's joint (the world's, if it has none); |n| ≤ 1 + 2^-22.
unsigned separateHull(const ChainTables& tables, const ChainScratch& scratch, std::uint32_t pair,
                      int set, const std::array<float, 3>& n, float highest);

enum class HullsAnswer { apart, open, touching };
/// Decides whether the hulls of a pair are proved apart in the intervals that its balls left open.
/// If they meet at the middle of one, `test` is called; `touching` if it returned true.
/// @param test may be null.
HullsAnswer decideHulls(const ChainTables& tables, const ChainScratch& scratch, std::uint32_t pair,
                        TouchTest* test);

}  // namespace corridor
