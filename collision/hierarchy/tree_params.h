#pragma once

#include "collision/volumes/obb.h"

namespace corridor {

/// How a node's leaf primitives are split in two: by the side of a plane on which their centroids
/// are. The plane is orthogonal to the longest axis of the node's box for which both sides get
/// some.
enum class SplitRule {
  mean,    ///< the plane through the mean of the content (as the fit weighs it)
  median,  ///< the plane through the median centroid: balanced trees
};

enum class TreeBuilding {
  topDown,   ///< by splitting
  bottomUp,  ///< by clustering (hierarchy/cluster.h); one leaf primitive per leaf
};

/// How a `VolumeTree` is built. No choice changes an answer.
struct TreeParams {
  ObbFit fit = ObbFit::triangles;  ///< the fit that gives the axes of oriented volumes
  SplitRule split = SplitRule::mean;
  TreeBuilding building = TreeBuilding::topDown;
};

}  // namespace corridor
