#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace corridor {

/// A pair of nodes of 4-wide trees. `pairs` selects the pairs of their boxes to test: bit 4·i + j
/// for the i-th box of a and the j-th of b. `key` is the least key of these pairs, by which a
/// traversal orders them. For binary trees only `a` and `b` have a meaning.
struct NodePair4 {
  std::uint32_t a, b;
  float key;
  std::uint32_t pairs;
};

/// The start of a traversal of two whole trees: the pair of both roots.
inline constexpr std::array<NodePair4, 1> kWholeTrees = {{{0, 0, -HUGE_VALF, 0xffff}}};

/// The stack of `walkObb4`. It only grows, so that a traversal need not clear it.
struct Obb4Stack {
  std::vector<NodePair4> items;
};

}  // namespace corridor
