#pragma once

#include "collision/volumes/obb.h"

namespace corridor {

/// Where a node's items are cut, along the longest axis of its box that separates any: by the
/// sides on which their centroids lie, …
enum class SplitRule {
  mean,    ///< … of the plane through the mean of the content (as the fit weighs it)
  median,  ///< … of the median centroid: balanced trees
};

enum class TreeBuilding {
  topDown,   ///< by splits
  bottomUp,  ///< by clustering (hierarchy/cluster.h); one item a leaf
};

/// How a VolumeTree is built. Any choice gives the same answers.
struct TreeParams {
  ObbFit fit = ObbFit::triangles;  ///< of the axes of oriented volumes
  SplitRule split = SplitRule::mean;
  TreeBuilding building = TreeBuilding::topDown;
};

}  // namespace corridor
