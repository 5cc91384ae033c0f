// A cache of the corners of leaves, for the SIMD tests. Included once per SIMD target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_LEAF_CACHE_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_LEAF_CACHE_INL_H_
#undef CORRIDOR_LEAF_CACHE_INL_H_
#else
#define CORRIDOR_LEAF_CACHE_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <bit>
#include <cstdint>

#include "hwy/highway.h"

#include "collision/hierarchy/obb4_tree.h"
#include "collision/predicates/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// A direct-mapped cache of the corners of the leaves of up to 16 recently requested nodes. The
/// corners are mapped by x ↦ matrix·(x − origin) + offset, where `origin` is that of the tree. The
/// corners of a node's leaves are floats relative to one of these corners. They are therefore
/// rounded by 2^-24 of the node's size, not of the mesh's size.
class LeafCache {
 public:
  LeafCache(const Obb4Tree& tree, const Mat3& matrix, const Vec3& offset) : tree_(tree) {
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 4; ++c) columns_[k][c] = c == 3 ? 0 : k == 3 ? offset[c] : matrix(c, k);
    std::fill_n(held_, kSize, Obb4Tree::kNone);
  }

  /// Returns the corners of the leaves in these lanes of a node (one bit each). The i-th triangle
  /// of a lane is at index 4·lane + i. All other entries are unspecified.
  const TriangleCorners& get(const Obb4Tree::Node& node, unsigned lanes) {
    const auto number = static_cast<std::uint32_t>(&node - tree_.nodes().data());
    const std::uint32_t slot = number * 0x9e3779b1U >> (32 - kBits);  // Knuth's multiplicative hash
    if (held_[slot] != number) {
      held_[slot] = number;
      filled_[slot] = 0;
    }
    for (unsigned missing = lanes & ~filled_[slot]; missing; missing &= missing - 1)
      fill(slot, node, static_cast<unsigned>(std::countr_zero(missing)));
    return corners_[slot];
  }

 private:
  void fill(std::uint32_t slot, const Obb4Tree::Node& node, unsigned lane) {
    TriangleCorners& corners = corners_[slot];
    const std::uint32_t first = Obb4Tree::leafFirst(node.child[lane]),
                        count = Obb4Tree::leafCount(node.child[lane]);
    // Maps one point at a time: its coordinates are the lanes of one vector. (Several points at a
    // time would leave most lanes empty, since most leaves have one or two triangles.)
    const hn::CappedTag<double, 4> d;
    const hn::Rebind<float, decltype(d)> f;
    const Vec3& o = tree_.origin();
    const auto map = [&](const Vec3& p, std::size_t at) {
      const auto of = [&](int k) { return hn::Load(d, columns_[k] + at); };
      return hn::MulAdd(hn::Set(d, p[2] - o[2]), of(2),
                        hn::MulAdd(hn::Set(d, p[1] - o[1]), of(1),
                                   hn::MulAdd(hn::Set(d, p[0] - o[0]), of(0), of(3))));
    };
    if (!filled_[slot])
      for (std::size_t at = 0; at < 4; at += hn::Lanes(d))
        hn::Store(map(tree_.corner(first, 0), at), d, corners.center + at);
    filled_[slot] |= 1U << lane;
    alignas(16) float relative[4];
    for (std::uint32_t i = 0; i < count; ++i)
      for (int k = 0; k < 3; ++k) {
        for (std::size_t at = 0; at < 4; at += hn::Lanes(d))
          hn::Store(hn::DemoteTo(f, hn::Sub(map(tree_.corner(first + i, k), at),
                                            hn::Load(d, corners.center + at))),
                    f, relative + at);
        for (int c = 0; c < 3; ++c) corners.x[k][c][4 * lane + i] = relative[c];
      }
  }

  static constexpr int kBits = 4, kSize = 1 << kBits;
  const Obb4Tree& tree_;
  alignas(32) double columns_[4][4];  // columns of the matrix, then the offset; the last row is 0
  std::uint32_t held_[kSize];
  unsigned filled_[kSize];  // which lanes are filled, one bit each
  TriangleCorners corners_[kSize];
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
