// The traversal of two wide trees, for every SIMD target: included once per target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_WIDE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_WIDE_WALK_INL_H_
#undef CORRIDOR_WIDE_WALK_INL_H_
#else
#define CORRIDOR_WIDE_WALK_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "hwy/highway.h"

#include "collision/core/query_context.h"
#include "collision/hierarchy/wide_obb_tree.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Which lanes of a node hold a box, and which of these are leaves.
struct Lanes {
  unsigned held, leaves;
  explicit Lanes(const WideObbTree::Node& node) {
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

/// Walks pairs of nodes of two trees. An item is a node of a and one of b, and which of the sixteen
/// pairs of their boxes are asked about (bit 4·i + j); these are tested at once. Then both nodes
/// are descended, or the one of clearly larger boxes, or the one that still has parts.
///
/// A Query says
///   bool skip(const Item&): is an item, whose least key is told, of no interest any more?
///   unsigned boxes(const Item&, const Node& a, const Node& b, float* keys): which of the item's
///     pairs are to be looked at, and a key for each; of others it may say anything;
///   kSorted: are all that were pushed together looked at in the order of their keys, or only the
///     one of the least key first?
///   bool leaves(const Item&, const Node& a, const Node& b, unsigned pairs, const float* keys):
///     looks at pairs of leaves; true: enough.
///
/// The stack is the context's, so that no query allocates once it has grown; what is on it already
/// is where the walk starts. Where it is told enough, what it did not come to stays there: with the
/// item at hand, of which some pairs may have been looked at, on top. What is pushed is written
/// first and kept if it counts, without branches: which boxes overlap can't be predicted.
///
/// @param count of the items to start from.
/// @return how many are left.
template <class Query>
std::size_t walkWide(const WideObbTree& a, const WideObbTree& b, float scaleB,
                     QueryContext& context, Query& query, std::size_t count) {
  using Item = QueryContext::WideItem;
  constexpr unsigned kAll = 15, kAllPairs = 0xffff;
  constexpr std::size_t kMostPushed = 16 + 1;  // and one that is written and not kept
  // Two nodes whose boxes differ by less than this are descended together. Measured: 1.3 to 2.5
  // cost the same near contact; the less, the better for a small body far inside a large one.
  constexpr float kLarger = 1.3F;
  const auto size = [](const WideObbTree::Node& node) {
    return std::max(std::max(node.half[0][0], node.half[0][1]),
                    std::max(node.half[0][2], node.half[0][3]));
  };
  // Bit r of four, fourfold: all pairs of a's r-th box.
  const auto rowsOf = [](unsigned lanes) {
    return (lanes & 1) * 0xfU | (lanes & 2) * 0x78U | (lanes & 4) * 0x3c0U | (lanes & 8) * 0x1e00U;
  };
  auto& stack = context.wideStack;
  std::size_t top = count;
  const auto makeRoom = [&] {
    if (stack.size() < top + kMostPushed) stack.resize(2 * (top + kMostPushed));
  };
  makeRoom();
  while (top > 0) {
    Item item = stack[--top];
    if (query.skip(item)) continue;
    const WideObbTree::Node &na = a.nodes()[item.a], &nb = b.nodes()[item.b];
    const Lanes lanesA(na), lanesB(nb);
    item.pairs &= rowsOf(lanesA.held) & lanesB.held * 0x1111U;
    context.counters.boxTests += static_cast<unsigned>(std::popcount(item.pairs));
    alignas(64) float keys[16];
    const unsigned open = query.boxes(item, na, nb, keys) & item.pairs;
    if (!open) continue;
    const unsigned leafRows = rowsOf(lanesA.leaves), leafColumns = lanesB.leaves * 0x1111U;
    if (const unsigned pairs = open & leafRows & leafColumns)
      if (query.leaves(item, na, nb, pairs, keys)) return top + 1;
    const float sizeA = size(na), sizeB = size(nb) * scaleB;
    const unsigned splitA = sizeB > kLarger * sizeA ? 0 : ~0U,
                   splitB = sizeA > kLarger * sizeB ? 0 : ~0U;
    // Of which both boxes are descended, only a's, only b's; those of one row or column go on
    // together.
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
  return 0;
}

/// The same for the whole of both trees.
template <class Query>
void walkWide(const WideObbTree& a, const WideObbTree& b, float scaleB, QueryContext& context,
              Query& query) {
  context.startAtRoots();
  walkWide(a, b, scaleB, context, query, 1);
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
