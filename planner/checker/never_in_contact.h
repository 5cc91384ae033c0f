#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/world/scene.h"
#include "planner/model/model.h"

namespace corridor {

/// The options of a proof that two bodies never come into contact.
struct NeverInContactOptions {
  double margin = 0;  ///< metres that the two bodies must keep apart; 0: they must not touch
  /// How far the proof reaches beyond each limit of a joint: rad, or m for a prismatic joint. With
  /// this reach, the proof also covers a tube around paths. The option has no effect on a joint
  /// that covers the whole circle.
  double beyondLimits = 0;
  /// Work limit: at most this many boxes of joint values are tested.
  std::uint64_t boxes = 20000;
  /// A second work limit: at most about this many tests of volumes and triangles. Without it, a
  /// pair of detailed meshes could take a thousand times as long as a pair of boxes.
  std::uint64_t tests = 20'000'000;
  /// If this flag becomes true, the proof ends before the next box, with `workLimit`. May be null.
  const std::atomic<bool>* interrupted = nullptr;
};

/// The answer of a proof, and its work.
struct NeverInContactResult {
  enum class Verdict {
    proved,     ///< the bodies never come into contact, and always keep the margin
    tooClose,   ///< at tested joint values, the bodies touch or are closer than the margin
    workLimit,  ///< a work limit was reached, or the proof was interrupted
    /// No proof was tried, for one of these reasons: a body has a solid mesh; no joint moves one
    /// body against the other; a joint between the two is planar or floating, has no limits, or
    /// mimics a continuous joint (except a revolute joint that mimics it by a whole multiplier).
    notTried,
  };
  Verdict verdict = Verdict::notTried;
  std::uint64_t boxes = 0;  ///< number of boxes of joint values that were tested
  std::uint64_t tests = 0;  ///< number of tests of volumes and triangles
  /// The fraction, from 0 to 1, of the box of all joint values in which the pair is proved. If a
  /// work limit was reached, this fraction shows how far the proof got. Only the verdict `proved`
  /// is a proof.
  double provedShare = 0;
  /// True if the proof ended with `workLimit` for another reason than the options `boxes`, `tests`
  /// and `interrupted`. The reason is that the boxes that are not proved yet hold too many pairs of
  /// shapes for the memory, or a box is too small to be halved. Larger limits don't help then.
  bool exhausted = false;
};

/// Proves for pairs of bodies of a model that they never come into contact, whatever the values of
/// the joints.
///
/// `proved` is never wrong: for all joint values within the limits, or beyond them by at most
/// `beyondLimits`, in real arithmetic, the two bodies keep more than the margin. This holds for the
/// shapes of the links as the model stores them. It does not depend on the pose of the robot's
/// base. If the range of a joint is a full turn or more, the proof is for all angles of the joint.
/// (This holds if the joint is revolute or continuous, and every joint between the bodies that
/// mimics it is revolute, with a whole multiplier.) The other verdicts prove nothing.
///
/// Only the joints between the two bodies count: those on the path between the bodies' frames in
/// the tree of frames. The ranges of these joints form a box of joint values. A box is proved by
/// motion queries in which nothing moves, one for each pair of shapes. The queries are made at the
/// middle of the box, with the half widths of the box as the tube (collision/PROMISES.md, promise
/// 2: `free` holds for every configuration within the tube, with all rounding). A box that is not
/// proved is halved along the joint that can displace the second body the most. Only the pairs of
/// shapes that were not separated are tested in the halves. The boxes are tested breadth first, so
/// that a contact is soon found at the middle of a box.
///
/// A proof needs more boxes if more joints are between the bodies, or if the bodies come closer to
/// each other. If they come as close as the margin anywhere, no proof succeeds.
///
/// Thread safety: `prove` may be called from several threads, each with its own context.
class NeverInContact {
 public:
  /// @param model the robots and obstacles. Its planned joints move, and all others are held. Must
  /// outlive the object.
  /// @param scene as `makeScene` makes it from the model (`Checker::scene`). Its pairs are ignored.
  /// Must outlive the object.
  /// @throws std::invalid_argument if the scene has another number of bodies than the model has
  /// shapes.
  NeverInContact(const Model& model, const Scene& scene);

  /// Tries to prove that two bodies never come into contact.
  /// @param a, b bodies of the model, by index, in either order.
  /// @throws std::invalid_argument if an option is negative or not finite.
  NeverInContactResult prove(std::size_t a, std::size_t b, const NeverInContactOptions& options,
                             QueryContext& context) const;

 private:
  const Model& model_;
  const Scene& scene_;
  std::vector<std::size_t> firstShape_;  // for each body of the model, its first body in the scene
};

/// Returns whether a planar or floating joint that moves lies between the frames of two bodies.
/// Then no limits of joints keep the bodies apart, and a proof is not tried.
bool movesFreely(const Model& model, std::size_t a, std::size_t b);

}  // namespace corridor
