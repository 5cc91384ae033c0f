#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace corridor {

/// A pair of nodes of two 4-wide trees. `pairs` selects the pairs of their boxes to test: bit 4·i +
/// j stands for box i of a and box j of b. Each traversal gives a pair of boxes a key, such as
/// a lower bound of the distance. `key` is the least key of these pairs; a traversal prefers node
/// pairs with lower keys. For binary trees only `a` and `b` are used.
struct NodePair4 {
  std::uint32_t a, b;
  float key;
  std::uint32_t pairs;
};

/// The start of a traversal of two whole trees: the pair of both roots.
inline constexpr std::array<NodePair4, 1> kWholeTrees = {{{0, 0, -HUGE_VALF, 0xffff}}};

/// The stack of `walkObb4`. It is never shrunk or cleared, so that traversals reuse its memory.
struct Obb4Stack {
  std::vector<NodePair4> items;
};

}  // namespace corridor
