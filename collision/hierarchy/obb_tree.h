#pragma once

#include "collision/hierarchy/volume_tree.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// The OBBTree of Gottschalk, Lin, Manocha 1996, binary and in double.
using ObbTree = VolumeTree<Obb>;

}  // namespace corridor
