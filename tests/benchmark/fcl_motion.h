#pragma once

#ifdef CORRIDOR_WITH_FCL

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <fcl/math/bv/RSS.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/narrowphase/continuous_collision.h>

#include "planner/benchmark/fcl_scene.h"

/// FCL's continuous tests of motions of rigid meshes. Each body moves as an fcl::InterpMotion; the
/// result is the earliest contact of all pairs.
namespace corridor::bench {

using FclMotion = fcl::InterpMotion<double>;

/// Returns the FCL motion that equals the motion of our edges: the frame's origin moves on a
/// straight line, and the body rotates the shorter way at constant speed. Two other constructors of
/// this FCL class don't work: one leaves the reference point unset, the other the velocities.
inline FclMotion fclMotion(const Transform& from, const Transform& to) {
  return FclMotion(from.m, from.t, to.m, to.t, fcl::Vector3d::Zero());
}

/// FCL's own advancement on trees of RSSs, which its continuousCollide never calls.
/// continuousCollide uses FCL's variant for volumes without axes instead. That variant moves the
/// stored vertices in every step, and its bounds apply the motion once more. FCL reports contact
/// when a step of t is below a fixed limit. `leastStep` replaces this limit. It is a static member
/// because FCL constructs the object of this class.
struct FclAdvancementNode : fcl::detail::MeshConservativeAdvancementTraversalNodeRSS<double> {
  /// Contact is reported when a step of t is below this limit.
  static inline thread_local double leastStep = 1e-5;
  FclAdvancementNode() { t_err = leastStep; }
};

class FclMotions {
 public:
  /// Returns the models of the scene's bodies, or nullptr if not all bodies are meshes.
  static std::shared_ptr<const FclMotions> of(const Scene& scene) {
    for (const Scene::Placed& placed : scene.bodies())
      if (!placed.body.isMesh()) return nullptr;
    return std::make_shared<const FclMotions>(scene);
  }
  /// @pre all bodies of `scene` are meshes.
  explicit FclMotions(const Scene& scene) : pairs_(scene.pairs()) {
    for (const Scene::Placed& placed : scene.bodies())
      bodies_.push_back({placed.frame, placed.body.radius(),
                         fclMesh<fcl::RSS<double>>(placed.body.mesh()),
                         fclMesh(placed.body.mesh())});
  }

  /// Returns the motion of each body, from the poses of its frame at both ends.
  std::vector<FclMotion> motions(std::span<const Transform> from,
                                 std::span<const Transform> to) const {
    std::vector<FclMotion> all;
    all.reserve(bodies_.size());
    for (const FclBody& body : bodies_) all.push_back(fclMotion(from[body.frame], to[body.frame]));
    return all;
  }
  /// Returns whether the bodies, on frames that move as `poses` says, move as FCL's motions do, to
  /// within `tolerance` metres. This is tested at five times. (Links of arms move along arcs, so
  /// they differ from FCL's motions.)
  /// @param poses a function that is called as poses(t, X_WF), and stores the poses of all frames
  /// at t in X_WF.
  template <class Poses>
  bool moveAs(const Poses& poses, double tolerance) const {
    std::vector<Transform> from, to, X_WF;
    poses(0, from);
    poses(1, to);
    const std::vector<FclMotion> all = motions(from, to);
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      poses(t, X_WF);
      for (std::size_t i = 0; i < bodies_.size(); ++i) {
        fcl::Transform3d at;
        all[i].integrate(t);
        all[i].getCurrentTransform(at);
        const Transform& X = X_WF[bodies_[i].frame];
        const double turned = (at.linear() - X.m).norm() * bodies_[i].reach;
        if (!((at.translation() - X.t).norm() + turned <= tolerance)) return false;
      }
    }
    return true;
  }

  /// Returns the time of first contact in [0, 1] that fcl::continuousCollide reports, or nullopt.
  template <class Volume>
  std::optional<double> continuousCollide(std::span<const FclMotion> motions,
                                          const fcl::ContinuousCollisionRequestd& request) const {
    return earliest(motions, [&](std::size_t a, std::size_t b) -> std::optional<double> {
      fcl::ContinuousCollisionResultd result;
      fcl::continuousCollide(bodies_[a].template model<Volume>(), &motions[a],
                             bodies_[b].template model<Volume>(), &motions[b], request, result);
      if (!result.is_collide) return std::nullopt;
      return result.time_of_contact;
    });
  }
  /// Returns the time of first contact in [0, 1] that FclAdvancementNode reports, or nullopt.
  /// Contact is reported when a step of t is below `leastStep`.
  std::optional<double> advance(std::span<const FclMotion> motions, double leastStep) const {
    FclAdvancementNode::leastStep = leastStep;
    return earliest(motions, [&](std::size_t a, std::size_t b) -> std::optional<double> {
      double time = 0;
      fcl::CollisionResultd result;
      const bool contact =
          fcl::detail::conservativeAdvancementMeshOriented<fcl::RSS<double>, FclAdvancementNode>(
              *bodies_[a].rss, &motions[a], *bodies_[b].rss, &motions[b], {}, result, time);
      if (!contact) return std::nullopt;
      return time;
    });
  }

 private:
  struct FclBody {
    std::size_t frame = 0;
    double reach = 0;  ///< largest distance of the body's points from the origin of its frame,
                       ///< metres
    std::shared_ptr<fcl::BVHModel<fcl::RSS<double>>> rss;
    std::shared_ptr<fcl::BVHModel<fcl::OBBRSS<double>>> obbrss;

    template <class Volume>
    const fcl::CollisionGeometryd* model() const {
      if constexpr (std::is_same_v<Volume, fcl::RSS<double>>)
        return rss.get();
      else
        return obbrss.get();
    }
  };

  template <class Ask>
  std::optional<double> earliest(std::span<const FclMotion> motions, const Ask& ask) const {
    std::optional<double> first;
    for (const Scene::Pair& pair : pairs_) {
      motions[pair.a].integrate(0);  // back to the start: otherwise FCL would begin at the time at
                                     // which the previous pair ended
      motions[pair.b].integrate(0);
      if (const auto t = ask(pair.a, pair.b); t && (!first || *t < *first)) first = t;
    }
    return first;
  }

  std::vector<Scene::Pair> pairs_;
  std::vector<FclBody> bodies_;
};

}  // namespace corridor::bench

#endif  // CORRIDOR_WITH_FCL
