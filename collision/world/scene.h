#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/hierarchy/body.h"
#include "collision/motion/edge_method.h"

namespace corridor {

/// Bodies on frames that move, and which of them are tested against which. Frame 0 is the world. It
/// knows nothing of why frames move: a `MotionSource` says how each pair of frames does, or a list
/// of transforms where they are. All const after construction, trees apart (built at first need):
/// with one QueryContext (and one MotionSource) a thread every query may be called in parallel.
class Scene {
 public:
  struct Placed {
    Body body;
    std::size_t frame = 0;
  };
  struct Pair {
    std::size_t a = 0, b = 0;  ///< bodies, by index
  };
  /// Of frames; b is seen from a. The index in `framePairs()` is the motion's number.
  struct FramePair {
    std::size_t a = 0, b = 0;
  };

  /// Only `pairs` are ever tested. Within a pair the order is kept where the frames differ in rank:
  /// a is on the frame of lower index.
  Scene(std::vector<Placed> bodies, std::vector<Pair> pairs);

  const std::vector<Placed>& bodies() const { return bodies_; }
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// What a MotionSource has to tell the motion of: the distinct pairs of frames among `pairs()`,
  /// and where both of one move, each of the two as the world sees it.
  const std::vector<FramePair>& framePairs() const { return framePairs_; }
  /// Metres: 1e-7 of the smallest of the frames' radii (each frame's bodies in one sphere; frames
  /// in no pair don't count), or what the rounding of rigid motions needs, if that is larger
  /// (`RigidMotion::roundingTolerance`).
  /// @param farthest  metres; poses of frames are at most so far from the origin.
  double defaultTolerance(double farthest = 0) const;

  /// All queries throw std::invalid_argument for transforms that are not finite (the world's, frame
  /// 0's, and those of frames in pairs) and options that are not finite or out of range; they build
  /// the trees that they need.

  /// Exact for meshes under the maps X_WF of the frames (contract 1), in the band of 2^-44 for
  /// primitives; solids included. First contact found.
  /// @param trees  which are walked; of motions, `MotionOptions::trees`. Bodies whose bounds are
  /// apart have none walked, whatever the kind.
  std::optional<Contact> interference(std::span<const Transform> X_WF, QueryContext& context,
                                      TreeKind trees = TreeKind::wideObb) const;

  /// The least distance of all pairs, metres: 0 if and only if `interference` says contact; else
  /// with the errors of `queries/distance.h`. Infinite without pairs.
  double clearance(std::span<const Transform> X_WF, QueryContext& context,
                   TreeKind trees = TreeKind::wideObb) const;

  /// Is the motion free? (`certifyMotion`, by any method; a solid that has another body inside is a
  /// contact at t = 0.) `motion` numbers its motions as `framePairs()`.
  MotionResult certify(MotionSource& motion, const MotionOptions& options, QueryContext& context,
                       EdgeMethod method = EdgeMethod::certified) const;
  /// The same by the method `certified`, and why: `checkEvidence` (motion/check_evidence.h) proves
  /// it anew with `motionPairs()`. Of surfaces: a solid that has another body inside needs no
  /// evidence.
  MotionResult certify(MotionSource& motion, const MotionOptions& options, QueryContext& context,
                       MotionEvidence& evidence) const;
  /// `pairs()` as motion queries take them, in another order; evidence numbers its pairs by it.
  /// Good as long as the scene, and as long as that is not moved.
  std::span<const MotionPair> motionPairs() const { return motionPairs_; }
  /// What `certify` says of each pair of bodies on its own, in the order of `pairs()`.
  std::vector<MotionResult> certifyEachPair(MotionSource& motion, const MotionOptions& options,
                                            QueryContext& context) const;

 private:
  MotionResult certifyPairs(std::span<const MotionPair> pairs, MotionSource& motion,
                            const MotionOptions& options, QueryContext& context, EdgeMethod method,
                            MotionEvidence* evidence = nullptr) const;
  template <class Visit>
  void forNearPairs(std::span<const Transform> X_WF, const double& within, QueryContext& context,
                    Visit visit) const;

  std::vector<Placed> bodies_;
  std::vector<Pair> pairs_;
  std::vector<std::size_t> order_;       // of the pairs: those of one motion together,
  std::vector<MotionPair> motionPairs_;  // and in that order
  std::vector<FramePair> framePairs_;
  bool solidMeshes_ = false;  // any in a pair: then what is inside them matters
};

}  // namespace corridor
