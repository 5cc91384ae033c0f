#pragma once

/// Includes the `PairTest` of every volume. A new volume needs an #include here, and an entry in
/// each list of volume_list.h (planner/ARCHITECTURE.md, "A new bounding volume").
#include "collision/volumes/overlap_aabb_aabb.h"
#include "collision/volumes/overlap_ellipsoid_ellipsoid.h"
#include "collision/volumes/overlap_hull_hull.h"
#include "collision/volumes/overlap_kdop_kdop.h"
#include "collision/volumes/overlap_obb_obb.h"
#include "collision/volumes/overlap_obb_obb_variants.h"
#include "collision/volumes/overlap_rss_rss.h"
#include "collision/volumes/overlap_shell_shell.h"
#include "collision/volumes/overlap_sphere_sphere.h"
#include "collision/volumes/volume_list.h"
