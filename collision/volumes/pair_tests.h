#pragma once

/// Includes `PairTest` of every volume.
#include "collision/volumes/overlap_aabb_aabb.h"
#include "collision/volumes/overlap_kdop_kdop.h"
#include "collision/volumes/overlap_obb_obb.h"
#include "collision/volumes/overlap_obb_obb_variants.h"
#include "collision/volumes/overlap_rss_rss.h"
#include "collision/volumes/overlap_sphere_sphere.h"

// Lists for explicit instantiation: every volume, and every volume with each of its overlap tests.
// clang-format off
#define CORRIDOR_EACH_VOLUME(F) \
  F(Obb) F(Aabb) F(BoundingSphere) F(Rss) F(Kdop<14>) F(Kdop<18>) F(Kdop<26>)
#define CORRIDOR_EACH_OVERLAP(F)                                                         \
  F(Obb, StandardOverlap) F(Obb, Gjk) F(Obb, LinearProgram) F(Obb, EdgeFace)             \
  F(Aabb, StandardOverlap) F(BoundingSphere, StandardOverlap) F(Rss, StandardOverlap)    \
  F(Kdop<14>, StandardOverlap) F(Kdop<18>, StandardOverlap) F(Kdop<26>, StandardOverlap)
// clang-format on
