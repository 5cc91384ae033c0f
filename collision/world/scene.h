#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/hierarchy/body.h"
#include "collision/hierarchy/box_tree.h"
#include "collision/motion/edge_method.h"
#include "collision/queries/distance.h"

namespace corridor {

class BroadPhase;

/// Bodies on frames that move, and the pairs of bodies that are tested. Frame 0 is the world.
///
/// A scene does not depend on what moves the frames. Queries of a state take the transform of each
/// frame. Queries of a motion take a `MotionSource`, which describes for each pair of frames how
/// one frame moves as seen from the other. A scene is const after construction, except that trees
/// are built when first needed. Threads may run any query in parallel, with one `QueryContext` (and
/// one `MotionSource`) per thread.
class Scene {
 public:
  struct Placed {
    Body body;
    std::size_t frame = 0;
    /// The pose of the frame in the world. Set only if the frame is at rest in the world. If it is
    /// set, the broad phase finds the body as it finds bodies on frame 0. Queries of states use
    /// this pose, and ignore the transform that the caller passes for the frame. In queries of
    /// motions, the pose of the frame in the `MotionSource` may differ from this pose a little:
    /// each point of the body must be within 2^-46·(r + |t|) metres of where this pose places it.
    /// Here r is the body's radius, and t is the translation of this pose.
    std::optional<Transform> restX_WF = std::nullopt;
  };
  struct Pair {
    std::size_t a = 0, b = 0;  ///< bodies, by index
  };
  /// A pair of frames. It identifies one motion: the motion of frame b as seen from frame a. The
  /// number of this motion is the index of the pair in `framePairs()`.
  struct FramePair {
    std::size_t a = 0, b = 0;
  };

  /// Only `pairs` are ever tested. In each pair of `pairs()`, a is a body on frame 0 or on a frame
  /// at rest, if the pair has such a body. Otherwise a is the body on the frame of lower index. The
  /// constructor exchanges the two bodies of a pair if necessary. It also sorts the pairs, once:
  /// `pairs()`, `motionPairs()` and everything that has one entry for each pair are in one order.
  /// @throws std::invalid_argument if a pair names a body that does not exist, or the map of a
  /// frame at rest is not finite.
  Scene(std::vector<Placed> bodies, std::vector<Pair> pairs);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const std::vector<Placed>& bodies() const { return bodies_; }
  /// The tested pairs. Their order may differ from the order that the constructor was given.
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// Returns the pairs of frames whose motions a `MotionSource` has to supply: the distinct pairs
  /// of the frames of bodies in `pairs()`, and for each of these frames that moves, the pair of the
  /// world and that frame.
  const std::vector<FramePair>& framePairs() const { return framePairs_; }
  /// Returns a tolerance in metres: 1e-7 of the smallest radius of a frame, or the tolerance that
  /// the rounding of rigid motions requires (`RigidMotion::roundingTolerance`) if that is larger.
  /// The radius of a frame is half the diagonal of one box around all of its bodies. Bodies at rest
  /// count as bodies of the world (frame 0); frames in no pair do not count.
  /// @param farthest metres; the poses of frames are at most this far from the origin.
  double defaultTolerance(double farthest = 0) const;

  /// All queries build the trees that they need. They throw std::invalid_argument:
  /// * if an option is not finite or out of range;
  /// * if the transform of a frame in a pair is missing or not finite, unless the frame is at rest.

  /// Returns the first contact found under the maps X_WF of the frames, or nullopt. Exact for
  /// meshes (collision/PROMISES.md, promise 1); with a convex part, contact may be reported for
  /// gaps below 2^-44 of the largest coordinate. A body inside a solid body is in contact with it.
  /// @param trees the kind of trees to walk (motion queries take `MotionOptions::trees`). The trees
  /// of bodies whose bounds are separated are not walked.
  std::optional<Contact> interference(std::span<const Transform> X_WF, QueryContext& context,
                                      TreeKind trees = TreeKind::obb4) const;

  /// Returns the least distance over all pairs, metres. The result is 0 if and only if
  /// `interference` reports contact. Otherwise the errors of the result are those of `distance` in
  /// queries/distance.h. The result is infinite if the scene has no pairs.
  double clearance(std::span<const Transform> X_WF, QueryContext& context,
                   TreeKind trees = TreeKind::obb4) const;

  /// A part of the search for near pairs.
  struct NearSearch {
    const std::vector<std::uint32_t>* pairs = nullptr;  ///< by number; null: all pairs
    double scale = 1;  ///< a factor of the lengths within which pairs are near, at most 1
  };
  /// A pair of bodies that are near each other.
  struct NearPair {
    std::size_t pair = 0;  ///< its index in `pairs()`
    Distance distance;     ///< with witness points in the world
  };
  /// Returns the pairs whose measured distance is at most the length that `within` states for the
  /// pair, with these distances, in the order of `pairs()`. The errors of the distances are
  /// those of `distance` in queries/distance.h; the option `upTo` is ignored.
  /// @param within metres, one length for each pair, in the order of `pairs()`.
  std::vector<NearPair> pairsWithin(std::span<const Transform> X_WF, const PairMargins& within,
                                    const DistanceOptions& options, QueryContext& context,
                                    const NearSearch& search,
                                    TreeKind trees = TreeKind::obb4) const;
  /// Returns the pairs that bounds and hulls do not prove to keep their margins on the whole
  /// motion, in ascending order (`pairsLeftByHulls`, motion/certify_motion.h).
  std::vector<std::uint32_t> pairsLeftByHulls(MotionSource& motion, const MotionOptions& options,
                                              QueryContext& context) const;

  /// Decides whether the motion is free, by the given method (`certifyMotion` describes the
  /// answers). If the surfaces are proved apart at first, but a body is inside a solid body, the
  /// answer is a contact at t = 0. Motion number i of `motion` is the motion of frame pair
  /// `framePairs()[i]`.
  MotionResult certify(MotionSource& motion, const MotionOptions& options, QueryContext& context,
                       EdgeMethod method = EdgeMethod::certified) const;
  /// Decides whether the motion is free, by the method `EdgeMethod::certified`, and writes a
  /// certificate. `checkCertificate` (motion/check_certificate.h) can check the certificate later,
  /// given `motionPairs()`. The certificate is about surfaces: it is empty if the answer follows
  /// from containment in a solid mesh, or if containment cannot be decided.
  MotionResult certify(MotionSource& motion, const MotionOptions& options, QueryContext& context,
                       MotionCertificate& certificate) const;
  /// Returns a contact of pair number `pair`, at the rounded pose at t ∈ [0, 1], as a query of
  /// `certify` that found it would: the pair and the time are set. Returns nullopt if there is
  /// none, or if the counters reach `workEnd` before.
  std::optional<MotionResult> contactAt(MotionSource& motion, std::size_t pair, double t,
                                        const MotionOptions& options, std::uint64_t workEnd,
                                        QueryContext& context) const;
  /// Returns `pairs()` in the form in which motion queries take them: entry i is pair i of
  /// `pairs()`. A certificate numbers its pairs in this order. The span is valid as long as the
  /// scene exists and is not moved.
  std::span<const MotionPair> motionPairs() const { return motionPairs_; }
  /// Returns the answer of `certify` for each pair of bodies alone, in the order of `pairs()`. The
  /// counters of the context count all pairs together as one query.
  std::vector<MotionResult> certifyEachPair(MotionSource& motion, const MotionOptions& options,
                                            QueryContext& context) const;

 private:
  MotionResult certifyPairs(MotionSource& motion, const MotionOptions& options,
                            QueryContext& context, EdgeMethod method,
                            MotionCertificate* certificate = nullptr) const;
  /// Returns `result`, the answer about surfaces, corrected if a body of these pairs (by index) is
  /// inside a solid mesh, or if this cannot be decided. In both cases also clears the certificate.
  MotionResult withContainment(MotionResult result, std::span<const std::uint32_t> pairs,
                               MotionSource& motion, QueryContext& context,
                               MotionCertificate* certificate) const;
  /// Returns the frame of a body, or the world if the frame is at rest.
  std::size_t frameOrWorld(std::size_t body) const {
    return bodies_[body].restX_WF ? 0 : bodies_[body].frame;
  }
  /// Returns the map of a body. @pre the body's frame is at rest, or `X_WF` has a transform for it.
  const Transform& mapOf(std::size_t body, std::span<const Transform> X_WF) const {
    const Placed& placed = bodies_[body];
    return placed.restX_WF ? *placed.restX_WF : X_WF[placed.frame];
  }
  template <class Visit>
  void forNearPairs(std::span<const Transform> X_WF, const double& within, QueryContext& context,
                    Visit visit, const std::vector<std::uint32_t>* only = nullptr) const;

  std::vector<Placed> bodies_;
  std::vector<Pair> pairs_;
  std::map<std::size_t, BoundingBox> restBoxes_;  // in the world, for each body with `restX_WF`
  std::vector<MotionPair> motionPairs_;           // entry i is pair i of `pairs_`
  std::vector<FramePair> framePairs_;
  // The frames of bodies in pairs. Frames at rest are left out; the world stands for them.
  std::vector<std::size_t> posedFrames_;
  std::unique_ptr<const BroadPhase> broadPhase_;  // of `motionPairs_`
  bool solidMeshes_ = false;  // true if a pair has a solid mesh: then containment must be decided
};

}  // namespace corridor
