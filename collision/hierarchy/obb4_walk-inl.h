// The traversal of two 4-wide OBB trees. Included once per SIMD target by foreach_target.h.

// clang-format off
#if defined(CORRIDOR_OBB4_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_OBB4_WALK_INL_H_
#undef CORRIDOR_OBB4_WALK_INL_H_
#else
#define CORRIDOR_OBB4_WALK_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "hwy/highway.h"

#include "collision/core/counters.h"
#include "collision/hierarchy/node_pair4.h"
#include "collision/hierarchy/obb4_tree.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The lanes of a node that hold a box, and the lanes that hold a leaf; one bit each.
struct Lanes {
  unsigned held, leaves;
  explicit Lanes(const Obb4Tree::Node& node) {
    const hn::CappedTag<std::int32_t, 4> d;
    alignas(16) std::uint8_t bits[8] = {};
    const auto child = hn::BitCast(d, hn::Load(hn::CappedTag<std::uint32_t, 4>(), node.child));
    hn::StoreMaskBits(d, hn::Lt(child, hn::Zero(d)), bits);
    const unsigned top = bits[0];
    hn::StoreMaskBits(d, hn::Ne(child, hn::Set(d, -1)), bits);
    held = bits[0];
    leaves = top & held;
  }
};

/// Traverses node pairs of two trees. An item is a node of a, a node of b, and some of the sixteen
/// pairs of their boxes (bit 4·i + j). These pairs are tested at once. Below each pair that is not
/// separated, the walk descends both nodes, or only the one with clearly larger boxes, or only the
/// one that is not a leaf.
///
/// A Query has
///   bool skip(const Item&): returns true to drop an item. The item's `key` is already set.
///   unsigned boxes(const Item&, const Node& a, const Node& b, float* keys): returns the item's
///     pairs to continue with, and sets a key for each. The bits of other pairs are ignored.
///   kSorted: if true, items that were pushed together are visited in the order of their keys. If
///     false, the item with the least key comes first, and the others in any order.
///   bool leaves(const Item&, const Node& a, const Node& b, unsigned pairs, const float* keys):
///     handles pairs of leaves. Returns true to end the walk.
///
/// Every new item is written to the stack, but kept only if it has a pair. This avoids a branch,
/// which would often be mispredicted. Once the stack is large enough, no walk allocates memory.
///
/// @param start the items to start from, the last one first. They are copied, so the query may
/// change them while the walk runs. @pre They are not part of `memory`.
/// @return the items that were not visited, if `leaves` ended the walk; otherwise nothing. The last
/// of these items is the current item; some of its pairs may have been handled. Valid until the
/// stack is used again.
template <class Query>
std::span<const NodePair4> walkObb4(const Obb4Tree& a, const Obb4Tree& b, float scaleB,
                                    std::span<const NodePair4> start, Obb4Stack& memory,
                                    Counters& counters, Query& query) {
  using Item = NodePair4;
  constexpr unsigned kAll = 15, kAllPairs = 0xffff;
  constexpr std::size_t kMostPushed = 16 + 1;  // the last item is written but not kept
  // Two nodes whose sizes differ by at most this factor are descended together. Measured: near
  // contact, 1.3 to 2.5 cost the same. For a small body far inside a large one, a smaller factor is
  // better.
  constexpr float kLarger = 1.3F;
  const auto size = [](const Obb4Tree::Node& node) {
    return std::max(std::max(node.half[0][0], node.half[0][1]),
                    std::max(node.half[0][2], node.half[0][3]));
  };
  // Returns all pairs of a's boxes in these lanes: bit r becomes the four bits of row r.
  const auto rowsOf = [](unsigned lanes) {
    return (lanes & 1) * 0xfU | (lanes & 2) * 0x78U | (lanes & 4) * 0x3c0U | (lanes & 8) * 0x1e00U;
  };
  std::vector<Item>& stack = memory.items;
  std::size_t top = start.size();
  const auto makeRoom = [&] {
    if (stack.size() < top + kMostPushed) stack.resize(2 * (top + kMostPushed));
  };
  makeRoom();
  std::copy(start.begin(), start.end(), stack.begin());
  while (top > 0) {
    Item item = stack[--top];
    if (query.skip(item)) continue;
    const Obb4Tree::Node &na = a.nodes()[item.a], &nb = b.nodes()[item.b];
    const Lanes lanesA(na), lanesB(nb);
    item.pairs &= rowsOf(lanesA.held) & lanesB.held * 0x1111U;
    counters.boxTests += static_cast<unsigned>(std::popcount(item.pairs));
    alignas(64) float keys[16];
    const unsigned open = query.boxes(item, na, nb, keys) & item.pairs;
    if (!open) continue;
    const unsigned leafRows = rowsOf(lanesA.leaves), leafColumns = lanesB.leaves * 0x1111U;
    if (const unsigned pairs = open & leafRows & leafColumns)
      if (query.leaves(item, na, nb, pairs, keys)) return {stack.data(), top + 1};
    const float sizeA = size(na), sizeB = size(nb) * scaleB;
    const unsigned splitA = sizeB > kLarger * sizeA ? 0 : ~0U,
                   splitB = sizeA > kLarger * sizeB ? 0 : ~0U;
    // The pairs of boxes below which the walk descends both nodes, only a's, or only b's. Pairs of
    // one row (only a's) or one column (only b's) become one item.
    const unsigned inner = open & ~leafRows & ~leafColumns;
    const unsigned both = inner & splitA & splitB;
    const unsigned onlyA = (open & ~leafRows & leafColumns) | (inner & ~splitB);
    const unsigned onlyB = (open & leafRows & ~leafColumns) | (inner & ~splitA);
    if (!(both | onlyA | onlyB)) continue;
    makeRoom();
    Item* const begin = stack.data() + top;
    Item* end = begin;
    for (unsigned rest = both; rest; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      *end++ = {na.child[bit / 4], nb.child[bit % 4], keys[bit], kAllPairs};
    }
    if (onlyA | onlyB) {
      const auto keyOf = [&](unsigned pairs, unsigned pair) {
        return pairs >> pair & 1 ? keys[pair] : HUGE_VALF;
      };
      for (unsigned r = 0; r < 4; ++r) {
        const unsigned row = onlyA >> 4 * r & kAll;
        const float key = std::min(std::min(keyOf(onlyA, 4 * r), keyOf(onlyA, 4 * r + 1)),
                                   std::min(keyOf(onlyA, 4 * r + 2), keyOf(onlyA, 4 * r + 3)));
        *end = {na.child[r], item.b, key, row * 0x1111U};
        end += row != 0;
      }
      for (unsigned c = 0; c < 4; ++c) {
        const unsigned column = onlyB >> c & 0x1111U;
        const unsigned rows = (column | column >> 3 | column >> 6 | column >> 9) & kAll;
        const float key = std::min(std::min(keyOf(onlyB, c), keyOf(onlyB, c + 4)),
                                   std::min(keyOf(onlyB, c + 8), keyOf(onlyB, c + 12)));
        *end = {item.a, nb.child[c], key, rowsOf(rows)};
        end += rows != 0;
      }
    }
    if constexpr (Query::kSorted) {
      std::sort(begin, end, [](const Item& x, const Item& y) { return x.key > y.key; });
    } else {
      Item* least = begin;
      for (Item* i = begin + 1; i < end; ++i) least = i->key < least->key ? i : least;
      std::swap(*least, end[-1]);
    }
    top += static_cast<std::size_t>(end - begin);
  }
  return {};
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
