#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/node_pair4.h"

namespace corridor {

/// A pair of nodes of two binary trees.
struct NodePair {
  std::uint32_t a, b;
};
/// The stack of a traversal whose items are only pairs of nodes.
using NodePairs = std::vector<NodePair>;

/// Replaces the stack's contents by the node pairs `start`, the last one on top.
inline void fillStack(std::span<const NodePair4> start, NodePairs& stack) {
  stack.clear();
  for (const NodePair4& pair : start) stack.push_back({pair.a, pair.b});
}

/// Traverses two trees from the node pairs on `stack`. All queries that walk two binary trees use
/// this function. An Item has the nodes' numbers as `a` and `b`. If both nodes are inner nodes, the
/// one of larger radius is descended. The traversal is not recursive, and allocates nothing once
/// `stack` has grown. Pairs that are left on the stack at the end were not visited.
///
/// A query decides which pairs are visited, and in which order:
/// * `bool enter(const Item&, const NodeA&, const NodeB&)` returns true to continue with this pair.
///   It makes the overlap test, or compares the pair with results found since the pair was pushed.
/// * `bool leaves(const NodeA&, const NodeB&)` handles two leaves, and returns true to end the
///   traversal.
/// * `void push(std::vector<Item>&, std::uint32_t a, std::uint32_t b)` pushes a pair to continue
///   with.
/// * `void opened(std::vector<Item>&, std::size_t first)` is called after all children of one node
///   were pushed, the last child first. It may reorder the items from `first` on. The item on top
///   is visited first.
template <class TreeA, class TreeB, class Item, class Query>
void traverseFrom(const TreeA& a, const TreeB& b, std::vector<Item>& stack, Query& query) {
  while (!stack.empty()) {
    const Item item = stack.back();
    stack.pop_back();
    const auto& na = a.node(item.a);
    const auto& nb = b.node(item.b);
    if (!query.enter(item, na, nb)) continue;
    if (na.isLeaf() && nb.isLeaf()) {
      if (query.leaves(na, nb)) return;
      continue;
    }
    const std::size_t first = stack.size();
    if (nb.isLeaf() || (!na.isLeaf() && na.radius >= nb.radius))
      a.forEachChildBackwards(item.a,
                              [&](std::uint32_t child) { query.push(stack, child, item.b); });
    else
      b.forEachChildBackwards(item.b,
                              [&](std::uint32_t child) { query.push(stack, item.a, child); });
    query.opened(stack, first);
  }
}

/// Traverses two trees as `traverseFrom` does, starting from the pair `root`.
template <class TreeA, class TreeB, class Item, class Query>
void traverse(const TreeA& a, const TreeB& b, const Item& root, std::vector<Item>& stack,
              Query& query) {
  stack.clear();
  stack.push_back(root);
  traverseFrom(a, b, stack, query);
}

}  // namespace corridor
