// Pairs of leaves of two wide trees, for every SIMD target: included once per target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_WIDE_LEAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_WIDE_LEAVES_INL_H_
#undef CORRIDOR_WIDE_LEAVES_INL_H_
#else
#define CORRIDOR_WIDE_LEAVES_INL_H_
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
#include "collision/hierarchy/wide_pose.h"
#include "collision/predicates/triangle_filter-inl.h"
#include "collision/queries/triangle_pair.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// For pairs of leaves of which b's has count triangles: of the k-th pair of triangles a's is
/// kFirst[count − 1][k] = k / count, b's kSecond[count − 1][k] = k % count.
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

/// Calls `found(leaves, s, t)` for each pair of items, numbered in leaf order, of each of these
/// pairs of leaves of two nodes, until it returns true; returns whether it did. For trees of which
/// one holds a solid.
template <class Found>
bool forEachItem(const WideObbTree::Node& na, const WideObbTree::Node& nb, unsigned leaves,
                 Found&& found) {
  for (; leaves; leaves &= leaves - 1) {
    const auto pair = static_cast<unsigned>(std::countr_zero(leaves));
    const std::uint32_t a = na.child[pair / 4], b = nb.child[pair % 4];
    for (std::uint32_t i = 0; i < WideObbTree::leafCount(a); ++i)
      for (std::uint32_t k = 0; k < WideObbTree::leafCount(b); ++k)
        if (found(1U << pair, WideObbTree::leafFirst(a) + i, WideObbTree::leafFirst(b) + k))
          return true;
  }
  return false;
}

/// Pairs of triangles of the leaves of two nodes: the i-th triangle of a lane's leaf is 4·lane + i.
class LeafPairs {
 public:
  LeafPairs(const WideObbTree::Node& na, const WideObbTree::Node& nb) : na_(na), nb_(nb) {}

  /// How many pairs of triangles a pair of leaves has, bit 4·i + j for lanes i and j.
  unsigned sizeOf(unsigned pair) const {
    return WideObbTree::leafCount(na_.child[pair / 4]) *
           WideObbTree::leafCount(nb_.child[pair % 4]);
  }
  void add(unsigned pair) {
    const unsigned i = pair / 4, j = pair % 4;
    const std::uint32_t countB = WideObbTree::leafCount(nb_.child[j]);
    // What is written beyond the pairs that there are, the next one writes over.
    put(kFirst[countB - 1], i, a_ + count_);
    put(kSecond[countB - 1], j, b_ + count_);
    count_ += sizeOf(pair);
    lanesA_ |= 1U << i;
    lanesB_ |= 1U << j;
  }
  /// To be called when all are added: what is read beyond the last is one of these.
  void finish() {
    std::fill_n(a_ + count_, 16, a_[0]);
    std::fill_n(b_ + count_, 16, b_[0]);
  }
  const WideObbTree::Node& a() const { return na_; }
  const WideObbTree::Node& b() const { return nb_; }
  unsigned count() const { return count_; }
  unsigned lanesA() const { return lanesA_; }  ///< whose leaves are among them
  unsigned lanesB() const { return lanesB_; }
  /// The k-th and up to fifteen more.
  TriangleNumbers from(unsigned k) const { return {a_ + k, b_ + k}; }
  /// The k-th pair's leaves: bit 4·i + j for lanes i and j.
  unsigned leavesOf(unsigned k) const { return 1U << (a_[k] / 4 * 4 + b_[k] / 4); }
  /// The k-th pair's triangles in the trees' leaf order.
  TrianglePair triangles(unsigned k) const { return {triangle(na_, a_[k]), triangle(nb_, b_[k])}; }

 private:
  static std::uint32_t triangle(const WideObbTree::Node& node, unsigned number) {
    return WideObbTree::leafFirst(node.child[number / 4]) + number % 4;
  }
  static void put(const std::array<std::uint8_t, 16>& pattern, unsigned lane, std::uint8_t* to) {
    const hn::CappedTag<std::uint8_t, 16> d;
    const auto base = hn::Set(d, static_cast<std::uint8_t>(4 * lane));
    for (std::size_t at = 0; at < 16; at += hn::Lanes(d))
      hn::StoreU(hn::Add(hn::Load(d, pattern.data() + at), base), d, to + at);
  }

  const WideObbTree::Node &na_, &nb_;
  unsigned count_ = 0, lanesA_ = 0, lanesB_ = 0;
  std::uint8_t a_[16 * 16 + 16], b_[16 * 16 + 16];
};

/// The triangles of two trees' leaves under one relative pose, filtered in float.
class WideLeaves {
 public:
  WideLeaves(const WideObbTree& a, const WideObbTree& b, const WidePose& pose, Counters& counters)
      : a_(a), b_(b), pose_(pose), counters_(counters) {}

  /// Finishes the pairs; calls `near(corners_a, corners_b, first, open)` for sixteen at a time,
  /// from `first`, of which some (`open`'s bits) aren't proved to be farther apart than `pad()`
  /// (a's unit), until it returns true; returns whether it did.
  template <class Pad, class Near>
  bool forEachNearSixteen(LeafPairs& pairs, Pad&& pad, Near&& near) {
    pairs.finish();
    if (!leavesA_) {  // most queries that the boxes decide never come here
      leavesA_.emplace(a_, Mat3::Identity() * pose_.unitA, Vec3::Zero());
      leavesB_.emplace(b_, pose_.m() * pose_.unitA, pose_.t());
    }
    const TriangleCorners &a = leavesA_->get(pairs.a(), pairs.lanesA()),
                          &b = leavesB_->get(pairs.b(), pairs.lanesB());
    for (unsigned first = 0; first < pairs.count(); first += 16) {
      const unsigned count = std::min(pairs.count() - first, 16U);
      counters_.triangleTests += count;
      const unsigned open =
          touchingTriangles(a, b, pairs.from(first), pose_.leafError, pad()) & ((1U << count) - 1);
      if (open && near(a, b, first, open)) return true;
    }
    return false;
  }
  /// The same with `found(s, t)` for each pair of triangles, numbered in leaf order, of these pairs
  /// of leaves. (Not inlined: the traversal is a sixth faster without it.)
  template <class Pad, class Found>
  HWY_NOINLINE bool forEachNear(const WideObbTree::Node& na, const WideObbTree::Node& nb,
                                unsigned leaves, Pad&& pad, Found&& found) {
    LeafPairs pairs(na, nb);
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
  const WideObbTree &a_, &b_;
  const WidePose& pose_;
  Counters& counters_;
  std::optional<LeafCache> leavesA_, leavesB_;
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
