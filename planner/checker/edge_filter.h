#pragma once

#include <memory>
#include <vector>

#include "collision/motion/chain_filter.h"
#include "collision/world/scene.h"
#include "planner/checker/pair_grids.h"
#include "planner/model/model.h"
#include "planner/robot/moving_joint.h"

namespace corridor {

/// Proves most pairs of bodies of a model apart on an edge, before the checker tests the others by
/// their trees: by grids, if the model's cache has them (pair_grids.h), then by balls and hulls
/// (collision/motion/chain_filter.h). For models whose planned joints are revolute or
/// prismatic: arms. The object does not change after construction, so threads may share it.
class EdgeFilter {
 public:
  /// Returns the filter of a model and its scene (`makeScene`), or null if a joint has another type
  /// or the scene is too large.
  /// @param tube as in EdgeMotion.
  static std::unique_ptr<const EdgeFilter> make(const Model& model, const Scene& scene,
                                                const Configuration& tube);

  /// The memory of one thread.
  struct Workspace {
    explicit Workspace(const EdgeFilter* filter);  ///< empty for null

    std::vector<std::uint32_t> left;  ///< numbers of pairs, in ascending order

   private:
    friend class EdgeFilter;
    std::vector<MovingJoint> joints_;
    std::vector<JointMotion> motions_;
    std::vector<std::uint8_t> proved_;  // by grids
    ChainFilter::Scratch scratch_;
  };

  /// Sets `workspace.left` to the scene's pairs that are not proved to keep their margins on the
  /// edge. Calls `test`, which may be null, for some pairs whose hulls meet (`ChainFilter`); if it
  /// found a contact, `left` is empty. Returns false, without a call of `test`, if the edge defines
  /// no curve.
  bool prove(const Configuration& from, const Configuration& to, const MotionOptions& options,
             Workspace& workspace, TouchTest* test) const;

 private:
  EdgeFilter(std::vector<MovingJoint> joints, PairGrids grids, ChainFilter filter)
      : joints_(std::move(joints)), grids_(std::move(grids)), filter_(std::move(filter)) {}

  std::vector<MovingJoint> joints_;
  PairGrids grids_;
  ChainFilter filter_;
};

}  // namespace corridor
