// Corners of leaves for the SIMD tests, for every SIMD target: included once per target by
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

#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/predicates/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// Corners of a tree's leaves under x ↦ matrix·(p − origin) + offset, those asked for last. The
/// leaves of a node are together, floats relative to a corner of one of them, so that they are off
/// by 2^-24 of the node, not of the mesh.
class LeafCache {
 public:
  LeafCache(const WideObbTree& tree, const Mat3& matrix, const Vec3& offset)
      : tree_(tree), matrix_(matrix), offset_(offset) {
    std::fill_n(held_, kSize, WideObbTree::kNone);
  }

  /// Of the leaves that are these lanes of a node: the i-th triangle of a lane's is 4·lane + i.
  /// What else it holds means nothing.
  const TriangleCorners& get(const WideObbTree::Node& node, unsigned lanes) {
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
  void fill(std::uint32_t slot, const WideObbTree::Node& node, unsigned lane) {
    TriangleCorners& corners = corners_[slot];
    const std::uint32_t first = WideObbTree::leafFirst(node.child[lane]),
                        count = WideObbTree::leafCount(node.child[lane]);
    const Vec3& o = tree_.origin();
    alignas(64) double raw[3][12];  // triangles that are missing repeat the first one
    for (std::uint32_t i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) {
        const Vec3& p = tree_.corner(first + (i < count ? i : 0), k);
        for (int c = 0; c < 3; ++c) raw[c][4 * k + i] = p[c] - o[c];
      }
    if (!filled_[slot])
      for (int c = 0; c < 3; ++c)
        corners.center[c] = (matrix_(c, 0) * raw[0][0] + matrix_(c, 1) * raw[1][0]) +
                            (matrix_(c, 2) * raw[2][0] + offset_[c]);
    filled_[slot] |= 1U << lane;
    const hn::CappedTag<double, 4> d;
    const hn::Rebind<float, decltype(d)> f;
    for (std::size_t at = 0; at < 12; at += hn::Lanes(d)) {
      const auto x = hn::Load(d, raw[0] + at), y = hn::Load(d, raw[1] + at),
                 z = hn::Load(d, raw[2] + at);
      for (int c = 0; c < 3; ++c) {
        const auto s = hn::MulAdd(
            z, hn::Set(d, matrix_(c, 2)),
            hn::MulAdd(y, hn::Set(d, matrix_(c, 1)),
                       hn::MulAdd(x, hn::Set(d, matrix_(c, 0)), hn::Set(d, offset_[c]))));
        hn::Store(hn::DemoteTo(f, hn::Sub(s, hn::Set(d, corners.center[c]))), f,
                  &corners.x[at / 4][c][4 * lane + at % 4]);
      }
    }
  }

  static constexpr int kBits = 4, kSize = 1 << kBits;
  const WideObbTree& tree_;
  Mat3 matrix_;
  Vec3 offset_;
  std::uint32_t held_[kSize];
  unsigned filled_[kSize];  // which lanes
  TriangleCorners corners_[kSize];
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
