// Tests of leaf pairs of two 4-wide OBB trees, for every SIMD target: foreach_target.h includes
// this file once per target.

// clang-format off
#if defined(CORRIDOR_OBB4_LEAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_OBB4_LEAVES_INL_H_
#undef CORRIDOR_OBB4_LEAVES_INL_H_
#else
#define CORRIDOR_OBB4_LEAVES_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "hwy/highway.h"

#include "collision/core/counters.h"
#include "collision/hierarchy/leaf_cache-inl.h"
#include "collision/hierarchy/obb4_tree_pose.h"
#include "collision/predicates/triangle_filter-inl.h"
#include "collision/queries/triangle_pair.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// Numbers the pairs of triangles of a leaf pair whose leaf of b has `count` triangles. The k-th
/// pair has a's triangle kFirst[count − 1][k] = k / count and b's triangle kSecond[count − 1][k] =
/// k % count.
using PairPatterns = std::array<std::array<std::uint8_t, 16>, 4>;
constexpr PairPatterns pairPatterns(bool second) {
  PairPatterns patterns{};
  for (unsigned count = 1; count <= 4; ++count)
    for (unsigned k = 0; k < 16; ++k)
      patterns[count - 1][k] = static_cast<std::uint8_t>(second ? k % count : k / count & 3);
  return patterns;
}
alignas(16) inline constexpr PairPatterns kFirst = pairPatterns(false), kSecond =
                                                                            pairPatterns(true);

/// Calls `found(leaf_pair, s, t)` for each pair of leaf primitives in the leaf pairs `leaves` of
/// two nodes, until `found` returns true. Returns whether `found` returned true. Leaf pairs are
/// bits (4·i + j for lanes i and j); s and t are numbered in leaf order. Used if at least one of
/// the two trees has a convex part.
template <class Found>
bool forEachLeafPrimitivePair(const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned leaves,
                              Found&& found) {
  for (; leaves; leaves &= leaves - 1) {
    const auto pair = static_cast<unsigned>(std::countr_zero(leaves));
    const std::uint32_t a = na.child[pair / 4], b = nb.child[pair % 4];
    for (std::uint32_t i = 0; i < Obb4Tree::leafCount(a); ++i)
      for (std::uint32_t k = 0; k < Obb4Tree::leafCount(b); ++k)
        if (found(1U << pair, Obb4Tree::leafFirst(a) + i, Obb4Tree::leafFirst(b) + k)) return true;
  }
  return false;
}

/// Returns the number (0 to 15) of the pair with the least key among the pairs of this mask (bits
/// as in `walkObb4`). @pre pairs != 0.
inline unsigned leastOf(unsigned pairs, const float* keys) {
  auto least = static_cast<unsigned>(std::countr_zero(pairs));
  for (unsigned rest = pairs & (pairs - 1); rest; rest &= rest - 1) {
    const auto bit = static_cast<unsigned>(std::countr_zero(rest));
    if (keys[bit] < keys[least]) least = bit;
  }
  return least;
}

/// Pairs of triangles in leaves of two nodes. The i-th triangle of a lane's leaf has the number
/// 4·lane + i.
class NodeLeafPairs {
 public:
  NodeLeafPairs(const Obb4Tree::Node& na, const Obb4Tree::Node& nb) : na_(na), nb_(nb) {}

  /// Returns how many pairs of triangles a leaf pair has; `pair` is 4·i + j for lane i of a and
  /// lane j of b.
  unsigned sizeOf(unsigned pair) const {
    return Obb4Tree::leafCount(na_.child[pair / 4]) * Obb4Tree::leafCount(nb_.child[pair % 4]);
  }
  /// Adds all pairs of triangles of the leaf pair `pair`, numbered as for `sizeOf`.
  void add(unsigned pair) {
    const unsigned i = pair / 4, j = pair % 4;
    const std::uint32_t countB = Obb4Tree::leafCount(nb_.child[j]);
    // `put` writes sixteen entries; the next call overwrites those beyond the pairs that exist.
    put(kFirst[countB - 1], i, a_ + count_);
    put(kSecond[countB - 1], j, b_ + count_);
    count_ += sizeOf(pair);
    lanesA_ |= 1U << i;
    lanesB_ |= 1U << j;
  }
  /// Must be called after the last `add`. It fills the entries beyond the last pair, which `from`
  /// may read.
  void finish() {
    std::fill_n(a_ + count_, 16, a_[0]);
    std::fill_n(b_ + count_, 16, b_[0]);
  }
  const Obb4Tree::Node& a() const { return na_; }
  const Obb4Tree::Node& b() const { return nb_; }
  unsigned count() const { return count_; }
  unsigned lanesA() const { return lanesA_; }  ///< bits: lanes whose leaves are among the pairs
  unsigned lanesB() const { return lanesB_; }
  /// Returns the k-th pair and the fifteen entries after it.
  TriangleNumbers from(unsigned k) const { return {a_ + k, b_ + k}; }
  /// Returns the leaf pair of the k-th pair: the bit 4·i + j for lanes i and j.
  unsigned leavesOf(unsigned k) const { return 1U << (a_[k] / 4 * 4 + b_[k] / 4); }
  /// Returns the k-th pair's triangles, numbered in the trees' leaf order.
  PrimitivePair triangles(unsigned k) const { return {triangle(na_, a_[k]), triangle(nb_, b_[k])}; }

 private:
  static std::uint32_t triangle(const Obb4Tree::Node& node, unsigned number) {
    return Obb4Tree::leafFirst(node.child[number / 4]) + number % 4;
  }
  static void put(const std::array<std::uint8_t, 16>& pattern, unsigned lane, std::uint8_t* to) {
    const hn::CappedTag<std::uint8_t, 16> d;
    const auto base = hn::Set(d, static_cast<std::uint8_t>(4 * lane));
    for (std::size_t at = 0; at < 16; at += hn::Lanes(d))
      hn::StoreU(hn::Add(hn::Load(d, pattern.data() + at), base), d, to + at);
  }

  const Obb4Tree::Node &na_, &nb_;
  unsigned count_ = 0, lanesA_ = 0, lanesB_ = 0;
  std::uint8_t a_[16 * 16 + 16], b_[16 * 16 + 16];
};

/// Filters pairs of triangles in the leaves of two trees, in float, under one relative pose.
class Obb4Leaves {
 public:
  Obb4Leaves(const Obb4Tree& a, const Obb4Tree& b, const Obb4TreePose& pose, Counters& counters)
      : a_(a), b_(b), pose_(pose), counters_(counters) {}

  /// Finishes `pairs` and filters them sixteen at a time. Let `open` be the pairs, among the
  /// sixteen from `first` on, that are not proved to be farther apart than `pad()` (in a's unit);
  /// one bit each. If there are any, calls `near(corners_a, corners_b, first, open)`. Ends when
  /// `near` returns true; returns whether `near` returned true.
  template <class Pad, class Near>
  bool forEachNearSixteen(NodeLeafPairs& pairs, Pad&& pad, Near&& near) {
    pairs.finish();
    if (!leavesA_) {  // built only now: queries that the boxes decide don't need it
      leavesA_.emplace(a_, Mat3::Identity() * pose_.unitA, Vec3::Zero());
      leavesB_.emplace(b_, pose_.m() * pose_.unitA, pose_.t());
    }
    const TriangleCorners &a = leavesA_->get(pairs.a(), pairs.lanesA()),
                          &b = leavesB_->get(pairs.b(), pairs.lanesB());
    for (unsigned first = 0; first < pairs.count(); first += 16) {
      const unsigned count = std::min(pairs.count() - first, 16U);
      counters_.primitiveTests += count;
      const unsigned open =
          touchingTriangles(a, b, pairs.from(first), pose_.leafError, pad()) & ((1U << count) - 1);
      if (open && near(a, b, first, open)) return true;
    }
    return false;
  }
  /// Calls `found(s, t)` for each pair of triangles in the leaf pairs `leaves` that isn't proved to
  /// be farther apart than `pad()`; s and t are numbered in leaf order. Ends when `found` returns
  /// true; returns whether `found` returned true. Not inlined: this makes the traversal a sixth
  /// faster.
  template <class Pad, class Found>
  HWY_NOINLINE bool forEachNear(const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned leaves,
                                Pad&& pad, Found&& found) {
    NodeLeafPairs pairs(na, nb);
    for (; leaves; leaves &= leaves - 1) pairs.add(static_cast<unsigned>(std::countr_zero(leaves)));
    return forEachNearSixteen(
        pairs, pad,
        [&](const TriangleCorners&, const TriangleCorners&, unsigned first, unsigned open) {
          for (; open; open &= open - 1) {
            const auto [s, t] =
                pairs.triangles(first + static_cast<unsigned>(std::countr_zero(open)));
            if (found(s, t)) return true;
          }
          return false;
        });
  }

 private:
  const Obb4Tree &a_, &b_;
  const Obb4TreePose& pose_;
  Counters& counters_;
  std::optional<LeafCache> leavesA_, leavesB_;
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
