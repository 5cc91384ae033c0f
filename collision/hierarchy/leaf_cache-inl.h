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

#include "hwy/highway.h"

#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/predicates/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// Corners of a tree's leaves under x ↦ matrix·(p − origin) + offset, those asked for last. Each
/// leaf's are floats relative to one of its corners, so that they are off by 2^-24 of the leaf, not
/// of the mesh.
class LeafCache {
 public:
  LeafCache(const WideObbTree& tree, const Mat3& matrix, const Vec3& offset)
      : tree_(tree), matrix_(matrix), offset_(offset) {
    std::fill_n(held_, kSize, WideObbTree::kNone);
  }

  /// Of the leaf that is a node's `child`.
  const LeafCorners& get(std::uint32_t child) {
    const std::uint32_t slot = child * 0x9e3779b1U >> (32 - kBits);  // Knuth's multiplicative hash
    LeafCorners& corners = corners_[slot];
    if (held_[slot] == child) return corners;
    held_[slot] = child;
    const std::uint32_t first = WideObbTree::leafFirst(child),
                        count = WideObbTree::leafCount(child);
    const Vec3& o = tree_.origin();
    alignas(64) double raw[3][12];  // lanes that are left repeat the first triangle
    for (std::uint32_t i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) {
        const Vec3& p = tree_.corner(first + (i < count ? i : 0), k);
        for (int c = 0; c < 3; ++c) raw[c][4 * k + i] = p[c] - o[c];
      }
    for (int c = 0; c < 3; ++c)
      corners.center[c] = (matrix_(c, 0) * raw[0][0] + matrix_(c, 1) * raw[1][0]) +
                          (matrix_(c, 2) * raw[2][0] + offset_[c]);
    const hn::CappedTag<double, 4> d;
    const hn::Rebind<float, decltype(d)> f;
    for (std::size_t at = 0; at < 12; at += hn::Lanes(d)) {
      const auto x = hn::Load(d, raw[0] + at), y = hn::Load(d, raw[1] + at),
                 z = hn::Load(d, raw[2] + at);
      for (int c = 0; c < 3; ++c) {
        const auto s = hn::Add(
            hn::Add(hn::Mul(x, hn::Set(d, matrix_(c, 0))), hn::Mul(y, hn::Set(d, matrix_(c, 1)))),
            hn::Add(hn::Mul(z, hn::Set(d, matrix_(c, 2))), hn::Set(d, offset_[c])));
        hn::Store(hn::DemoteTo(f, hn::Sub(s, hn::Set(d, corners.center[c]))), f,
                  &corners.x[at / 4][c][at % 4]);
      }
    }
    return corners;
  }

 private:
  static constexpr int kBits = 5, kSize = 1 << kBits;
  const WideObbTree& tree_;
  Mat3 matrix_;
  Vec3 offset_;
  std::uint32_t held_[kSize];
  LeafCorners corners_[kSize];
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
