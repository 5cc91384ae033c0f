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

/// Walks pairs of nodes of two trees. An item is a node of a and one of b, and which of their boxes
/// are still asked about; their sixteen pairs are tested at once. Then both nodes are descended, or
/// the one of clearly larger boxes, or the one that still has parts.
///
/// A Query says
///   bool skip(float key): is an item, whose least key was this, of no interest any more?
///   unsigned boxes(const Node& a, const Node& b, float* keys): which of the sixteen pairs are to
///   be
///     looked at (bit 4·i + j), and a key for each; the least is looked at first;
///   bool leaves(const Node& a, const Node& b, unsigned pairs): looks at pairs of leaves; true:
///   enough.
/// The stack is the context's, so that no query allocates.
template <class Query>
void walkWide(const WideObbTree& a, const WideObbTree& b, float scaleB, QueryContext& context,
              Query& query) {
  constexpr unsigned kAll = 15;
  // Two nodes whose boxes differ by less than this are descended together. Measured: 1.3 to 2.5
  // cost the same near contact; the less, the better for a small body far inside a large one.
  constexpr float kLarger = 1.3F;
  const auto size = [](const WideObbTree::Node& node) {
    return std::max(std::max(node.half[0][0], node.half[0][1]),
                    std::max(node.half[0][2], node.half[0][3]));
  };
  auto& stack = context.wideStack;
  stack.clear();
  stack.push_back({0, 0, -HUGE_VALF, kAll << 4 | kAll});
  while (!stack.empty()) {
    const auto item = stack.back();
    stack.pop_back();
    if (query.skip(item.key)) continue;
    const WideObbTree::Node &na = a.nodes()[item.a], &nb = b.nodes()[item.b];
    const Lanes lanesA(na), lanesB(nb);
    const unsigned heldA = item.masks >> 4 & lanesA.held, heldB = item.masks & lanesB.held;
    unsigned wanted = 0, rowsOfLeaves = 0;
    for (unsigned r = 0; r < 4; ++r) {
      wanted |= (heldA >> r & 1 ? heldB : 0) << 4 * r;
      rowsOfLeaves |= (lanesA.leaves >> r & 1 ? kAll : 0) << 4 * r;
    }
    context.counters.boxTests += static_cast<unsigned>(std::popcount(wanted));
    alignas(64) float keys[16];
    unsigned open = query.boxes(na, nb, keys) & wanted;
    if (!open) continue;
    if (const unsigned pairs = open & rowsOfLeaves & lanesB.leaves * 0x1111U) {
      if (query.leaves(na, nb, pairs)) return;
      open &= ~pairs;
      if (!open) continue;
    }
    const float sizeA = size(na), sizeB = size(nb) * scaleB;
    const bool splitA = !(sizeB > kLarger * sizeA), splitB = !(sizeA > kLarger * sizeB);
    const std::size_t begin = stack.size();
    const auto push = [&](std::uint32_t i, std::uint32_t j, unsigned pairs, unsigned masks) {
      float key = HUGE_VALF;
      for (; pairs; pairs &= pairs - 1) key = std::min(key, keys[std::countr_zero(pairs)]);
      stack.push_back({i, j, key, masks});
    };
    unsigned waiting = 0;  // pairs of which only b's box is descended
    for (unsigned r = 0; r < 4; ++r) {
      const unsigned row = open & kAll << 4 * r;
      if (!row) continue;
      if (lanesA.leaves >> r & 1) {
        waiting |= row;
        continue;
      }
      // Pairs of which only a's box is descended; b's go on together.
      const unsigned alone = splitB ? row & lanesB.leaves * 0x1111U : splitA ? row : 0;
      if (alone) push(na.child[r], item.b, alone, kAll << 4 | alone >> 4 * r);
      if (!splitA) {
        waiting |= row & ~alone;
        continue;
      }
      for (unsigned rest = row & ~alone; rest; rest &= rest - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(rest));
        push(na.child[r], nb.child[bit % 4], 1U << bit, kAll << 4 | kAll);
      }
    }
    for (unsigned c = 0; c < 4; ++c) {
      const unsigned column = waiting & 0x1111U << c;
      if (!column) continue;
      unsigned rows = 0;
      for (unsigned r = 0; r < 4; ++r) rows |= (column >> 4 * r & kAll ? 1U : 0U) << r;
      push(item.a, nb.child[c], column, rows << 4 | kAll);
    }
    query.order(stack, begin);
  }
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
