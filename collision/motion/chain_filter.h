#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "collision/convex/convex_set.h"
#include "collision/core/transform.h"
#include "collision/motion/motion_query.h"

namespace corridor {

struct ChainTables;
struct ChainScratch;

/// Bodies on the links of kinematic chains, bodies at rest, and the pairs of them that are tested.
/// Metres and radians. The hulls are views; what they view must outlive all users.
struct ChainScene {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::size_t kMostObstacles = 1024;  ///< that a filter takes

  /// A revolute or prismatic joint, moved by one number.
  struct Joint {
    std::uint32_t parent = kNone;  ///< the joint above, of lower index; kNone: the world
    bool slides = false;           ///< prismatic
    /// The matrix of a revolute joint at the angle φ is fixed + sin φ·sine + (1 − cos φ)·versine;
    /// of a prismatic one, `fixed`. `axis` is the joint's axis in the frame of the joint above.
    Mat3 fixed = Mat3::Identity(), sine = Mat3::Zero(), versine = Mat3::Zero();
    Vec3 axis = Vec3::UnitZ();
  };
  struct Link {
    std::uint32_t joint = kNone;  ///< the joint that moves it; kNone: it is at rest in the world
    Transform X_JB;               ///< the body's frame in the frame after the joint
    Vec3 center = Vec3::Zero();   ///< of a ball that contains the body, in the body's frame
    double radius = 0;
    const ConvexSet* hull = nullptr;  ///< contains the body, in its frame; null: none
  };
  /// A box that contains a body at rest, or a cylinder about the z axis of its pose.
  struct Obstacle {
    bool isCylinder = false;
    Transform X_WO;
    Vec3 half =
        Vec3::Zero();  ///< half lengths of the box; twice the cylinder's radius, half length
    Transform X_WB;    ///< the body's frame in the world
    const ConvexSet* hull = nullptr;  ///< contains the body, in its frame; null: none
  };
  struct Pair {
    bool isWorld = false;        ///< whether `a` is an obstacle; otherwise it is a link
    std::uint32_t a = 0, b = 0;  ///< by index; b is a link
    std::uint32_t number = 0;    ///< of the pair in the query
    bool testsHulls = true;      ///< false for hulls that mostly meet: a test is then in vain
  };

  std::vector<Joint> joints;
  std::vector<Link> links;
  std::vector<Obstacle> obstacles;
  std::vector<Pair> pairs;
};

/// The motion of one joint on an edge: at t ∈ [0, 1] its pose in the frame of the joint above has
/// the translation shift + t·slide, and a revolute joint has the angle angle + t·rate.
struct JointMotion {
  Vec3 shift = Vec3::Zero(), slide = Vec3::Zero();  ///< metres
  double angle = 0, rate = 0;                       ///< radians (`rate`: metres if prismatic)
  double largestRate = 0;                           ///< an upper bound of the real |rate|
  double tube = 0;                                  ///< largest perturbation, radians or metres
  double length = 0;  ///< an upper bound of the real translation's length on the edge
  /// Upper bounds of the errors of the matrix (operator norm) and of the translation (metres).
  double rotationError = 0, shiftError = 0;
};

/// Tests two bodies for contact at one time of an edge.
class TouchTest {
 public:
  virtual ~TouchTest() = default;
  /// @param number the pair, in the query. @param t in [0, 1]
  virtual bool touches(std::uint32_t number, double t) = 0;
};

/// Proves pairs of bodies apart on a whole edge of kinematic chains, many at once and quickly: the
/// first test of edges of arms. The pairs that it does not prove apart are left to `certifyMotion`.
///
/// Method. The edge is cut into 8 to 64 equal intervals, eight of which are tested together in
/// SIMD lanes, in float, by the motion bounds of relative_motion.h. First, each body is a ball: the
/// displacement of its centre is bounded in all directions (Schwarzer, Saha, Latombe 2005), or to
/// first order along the direction between the two bodies. Where balls are too large, a direction
/// that separates the hulls is tested on all points of the hull of b (moving_sets.h has the
/// derivation), as GJK finds it.
///
/// Guarantee: a pair that is not returned keeps its margin, the clearance slack and the tolerance
/// on the whole edge, for every curve in the tube, and neither body is inside the other. So
/// `certifyMotion` would prove it, too. All rounding is included; chain_filter.cpp has the
/// derivation. The answers are the same on every instruction set.
///
/// The object does not change after construction, so threads may share it.
class ChainFilter {
 public:
  /// @throws std::invalid_argument unless `isUsable(scene)`.
  explicit ChainFilter(ChainScene scene);
  ~ChainFilter();
  ChainFilter(ChainFilter&&) noexcept;

  /// Returns whether the filter is made for a scene: at most 64 joints, the parent of each joint
  /// before it, at most `kMostObstacles` obstacles, and all coordinates below 2^20 m.
  static bool isUsable(const ChainScene& scene);

  /// The memory that the queries of one thread write to. No answer depends on earlier queries.
  class Scratch {
   public:
    Scratch();
    ~Scratch();

   private:
    friend class ChainFilter;
    std::unique_ptr<ChainScratch> memory_;
  };

  /// Sets `left` to the numbers of the pairs that are not proved to keep their margins, in
  /// ascending order. If a number of the motions is not finite or of a size that the filter is not
  /// made for, these are all pairs.
  /// @param motions one for each joint.
  /// @param test if not null, called for some pairs whose hulls meet at the middle of an interval.
  /// If it returns true, the query ends, and `left` is empty.
  /// @param proved for each pair of two links, by its number in the query, whether it is proved
  /// already, so that it is not tested, and `left` does not have it. Empty: none is.
  void pairsLeft(std::span<const JointMotion> motions, const MotionOptions& options,
                 Scratch& scratch, std::vector<std::uint32_t>& left, TouchTest* test = nullptr,
                 std::span<const std::uint8_t> proved = {}) const;

 private:
  std::unique_ptr<const ChainTables> tables_;
};

}  // namespace corridor
