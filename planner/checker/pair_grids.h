#pragma once

#include <cstdint>
#include <vector>

#include "collision/motion/motion_query.h"
#include "collision/world/scene.h"
#include "planner/checker/pair_grid.h"
#include "planner/model/model.h"

namespace corridor {

/// The grids of the pairs of a scene (`PairGrid`): of pairs of links between which one or two
/// numbers of a Configuration move. On most arms these pairs are close together, and the most
/// expensive ones to test. A grid depends only on the two bodies and the frames between them, so it
/// serves all problems with the robot. It takes some 0.1 s to compute, so a checker only uses those
/// that the model's cache has.
class PairGrids {
 public:
  /// The clearances for which grids are computed, metres: for margin 0, and for the clearance that
  /// paths of arms prefer. The small part covers tolerances.
  static constexpr double kClearances[] = {2e-5, 0.005 + 2e-5};

  /// The grids that the cache of the model has. @param tube as in EdgeMotion.
  PairGrids(const Model& model, const Scene& scene, const Configuration& tube);

  /// Computes the grids that the cache of the model does not have, and offers them to it. Returns
  /// their number. @pre the model has a cache.
  static std::size_t compute(const Model& model, const Scene& scene);

  bool empty() const { return pairs_.empty(); }
  /// Sets `proved` to 1 for each pair, by its number in `Scene::motionPairs()`, that a grid proves
  /// to keep its margin, the clearance slack and the tolerance on the edge; to 0 for the others.
  void prove(const Configuration& from, const Configuration& to, const MotionOptions& options,
             std::vector<std::uint8_t>& proved) const;

 private:
  friend struct PairGridsAccess;  // of the tests
  struct OfPair {
    std::uint32_t pair = 0;
    std::vector<PairGrid> grids;  ///< by increasing clearance
  };
  std::vector<OfPair> pairs_;
  std::size_t count_ = 0;  ///< of the scene's pairs
};

}  // namespace corridor
