#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "collision/core/swept_sphere.h"
#include "collision/hierarchy/box_tree.h"
#include "collision/motion/certify_motion.h"
#include "collision/motion/interval_motions.h"
#include "collision/motion/may_meet.h"

namespace corridor {

/// Finds the pairs of bodies that may come close to each other, without a test of each pair.
/// * If a moving body has many partners at rest in the world, a tree of the partners' boxes gives
///   the partners that the swept sphere of this body may reach. Successive moving bodies with the
///   same partners share one tree.
/// * If there are many pairs of two moving bodies, the extents of all swept spheres along one axis
///   are sorted, and only pairs whose extents overlap are tested: sweep and prune (D. Baraff,
///   Dynamic simulation of non-penetrating rigid bodies, 1992). The sort begins anew in each query,
///   because the states of a planner do not follow each other in small steps.
///
/// All other pairs are reported without a test.
///
/// The object does not change after construction, so threads may share it.
class BroadPhase {
 public:
  /// @param pairs the pairs of a scene, in the order of `Scene::motionPairs()`: the pairs of a body
  /// b with all bodies at rest are adjacent. The span must stay valid as long as the object exists.
  explicit BroadPhase(std::span<const MotionPair> pairs);

  /// Calls visit(k) for each pair k that may come closer than `within` metres, and for some pairs
  /// that cannot. Stops if `visit` returns true; `visit` may lower `within`.
  /// @param sphereOf returns the swept sphere of body b of a pair, as seen from the world.
  template <class SphereOf, class Visit>
  void forEach(const SphereOf& sphereOf, const double& within, const Visit& visit) const {
    for (const Run& run : runs_) {
      if (run.tree) {
        const SweptSphere sphere = sphereOf(pairs_[run.begin]);
        const auto bound = [&](const BoundingBox& box) {
          return clearanceBound(box, sphere, within);
        };
        if (run.tree->walk(bound, within, [&](std::size_t i) { return visit(run.begin + i); }))
          return;
        continue;
      }
      for (std::size_t k = run.begin; k < run.end; ++k)
        if (visit(k)) return;
    }
    if (movers_.empty()) return;
    std::vector<SweptSphere> spheres;
    spheres.reserve(movers_.size());
    for (const MotionPair& mover : movers_) spheres.push_back(sphereOf(mover));
    for (const std::uint32_t k : overlappingMovers(spheres, within))
      if (visit(k)) return;
  }

  /// Writes to `found`, in ascending order, the numbers of all pairs that may come closer than
  /// `within` metres in the selected interval, and of some other pairs.
  void find(IntervalMotions& motions, double within, std::vector<std::uint32_t>& found) const;

  /// Returns one more than the largest index of a body in the pairs whose `worldMotionB` is known;
  /// 0 if there is no such pair.
  std::size_t bodies() const { return bodies_; }

 private:
  /// Fills `movers_` and `partners_`.
  void addMovers();
  /// Returns the numbers of the pairs of moving bodies that may come closer than `within`, in
  /// ascending order. @param spheres the swept spheres of `movers_`.
  std::vector<std::uint32_t> overlappingMovers(std::span<const SweptSphere> spheres,
                                               double within) const;

  /// A moving body that has a pair with another one.
  struct Partner {
    std::uint32_t mover = 0, pair = 0;
  };

  /// The adjacent pairs [begin, end). If there is a tree, all of them have the same body b, and
  /// item i of the tree is the box of body a of pair begin + i.
  struct Run {
    std::size_t begin = 0, end = 0;
    std::shared_ptr<const BoxTree> tree;
  };

  std::span<const MotionPair> pairs_;
  std::vector<Run> runs_;
  std::size_t bodies_ = 0;
  bool hasTrees_ = false;
  // The bodies of all pairs of two moving bodies, each as body b of a pair; empty if these pairs
  // are few, so that runs cover them. `partners_[i]` are the partners of mover i with numbers above
  // i, in ascending order.
  std::vector<MotionPair> movers_;
  std::vector<std::vector<Partner>> partners_;
};

}  // namespace corridor
