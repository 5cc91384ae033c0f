#pragma once

/// `PairTest` of every volume.
#include "collision/volumes/overlap_aabb_aabb.h"
#include "collision/volumes/overlap_kdop_kdop.h"
#include "collision/volumes/overlap_obb_obb.h"
#include "collision/volumes/overlap_obb_obb_variants.h"
#include "collision/volumes/overlap_rss_rss.h"
#include "collision/volumes/overlap_sphere_sphere.h"
