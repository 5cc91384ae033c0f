#pragma once

#include "collision/volumes/obb.h"

namespace corridor {

/// How a node's leaf primitives are split in two: by a plane that separates their centroids. The
/// plane is orthogonal to an axis of the node's box: the longest one for which neither side of the
/// plane is empty.
enum class SplitRule {
  mean,    ///< the plane through the mean that the fit computes: of area, corners or hull (ObbFit)
  median,  ///< the plane through the median centroid: balanced trees
};

enum class TreeBuilding {
  topDown,   ///< by splitting
  bottomUp,  ///< by clustering (cluster.h); each leaf has one leaf primitive
};

/// How a `VolumeTree` is built. No choice changes a verdict.
struct TreeParams {
  ObbFit fit = ObbFit::triangles;  ///< the fit that gives the axes of oriented volumes
  SplitRule split = SplitRule::mean;
  TreeBuilding building = TreeBuilding::topDown;
};

}  // namespace corridor
