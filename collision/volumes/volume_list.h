#pragma once

// The list of all volumes, and the list of all volumes with each of their overlap tests. These
// lists generate the explicit instantiations, `TreeKind`, the trees of a `Body`, the dispatch, and
// the names that users write.
//
// CORRIDOR_EACH_OVERLAP(F) expands F(name in TreeKind, Volume, Overlap, the volume's name for
// users, the test's name for users). The tests of one volume are adjacent; the first of them is the
// volume's default.
// clang-format off
#define CORRIDOR_EACH_VOLUME(F) \
  F(Obb) F(Aabb) F(BoundingSphere) F(Rss) F(Kdop<14>) F(Kdop<18>) F(Kdop<26>) \
  F(Shell) F(Ellipsoid) F(Hull)
#define CORRIDOR_EACH_OVERLAP(F)                                        \
  F(obbBinary, Obb, StandardOverlap, "obb-binary", "sat")               \
  F(obbGjk, Obb, Gjk, "obb-binary", "gjk")                              \
  F(obbLinearProgram, Obb, LinearProgram, "obb-binary", "lp")           \
  F(obbEdgeFace, Obb, EdgeFace, "obb-binary", "edge-face")              \
  F(aabb, Aabb, StandardOverlap, "aabb", "sat")                         \
  F(sphere, BoundingSphere, StandardOverlap, "sphere", "centers")       \
  F(rss, Rss, StandardOverlap, "rss", "rectangles")                     \
  F(kdop14, Kdop<14>, StandardOverlap, "kdop14", "intervals")           \
  F(kdop18, Kdop<18>, StandardOverlap, "kdop18", "intervals")           \
  F(kdop26, Kdop<26>, StandardOverlap, "kdop26", "intervals")           \
  F(shell, Shell, StandardOverlap, "shell", "distances")                \
  F(ellipsoid, Ellipsoid, StandardOverlap, "ellipsoid", "contact")      \
  F(hull, Hull, StandardOverlap, "hull", "gjk")
// clang-format on
