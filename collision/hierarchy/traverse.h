#pragma once

#include <cstdint>
#include <vector>

namespace corridor {

/// The one traversal of two trees that every query uses, from the pairs of nodes on its own stack
/// (of Query::Item, which has the nodes' numbers as `a` and `b`): no call stack, no allocation once
/// the stack has grown. The larger of two inner nodes is opened. What is on the stack in the end
/// was not looked at.
///
/// A query says what is looked at and in which order:
/// * `bool enter(const Item&, const NodeA&, const NodeB&)`: go on with this pair? The overlap
///   test, or a look at what has been found since the pair was pushed.
/// * `bool leaves(const NodeA&, const NodeB&)`: two leaves; true ends the traversal.
/// * `void push(std::vector<Item>&, std::uint32_t a, std::uint32_t b)` for each pair to go on with,
///   and `void opened(std::vector<Item>&, std::size_t first)` after all of one node's children
///   were pushed, the last one first: those from `first` on may be reordered; the top is looked
///   at first.
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

/// The same from one pair.
template <class TreeA, class TreeB, class Item, class Query>
void traverse(const TreeA& a, const TreeB& b, const Item& root, std::vector<Item>& stack,
              Query& query) {
  stack.clear();
  stack.push_back(root);
  traverseFrom(a, b, stack, query);
}

}  // namespace corridor
