#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/hierarchy/obb4_build.h"
#include "collision/volumes/part_obb.h"

namespace corridor {

/// The layout has one node. Its first lane has the part's enclosing box {c + U x : |x_k| ≤ e_k}, in
/// floats. The tree's origin is the centre c of this box. In the tree's frame the box is therefore
/// {U x}, and no centre is rounded.
Obb4Layout layOutObb4(const ConvexPart& part) {
  Obb4Layout tree;
  tree.order = {0};
  const Obb box = enclosingObb(part);
  tree.frame.origin = box.center;
  // |U x| ≤ (1 + 2^-38)|e|, since the axes are orthonormal to 2^-40.
  const double size = roundedUp(box.half.stableNorm() * (1 + 0x1p-30));
  const bool usable = size > 0 && std::isfinite(size);
  if (usable) tree.frame.length = std::ldexp(1.0, std::clamp(std::ilogb(size) + 1, -1000, 1000));
  tree.frame.radius = size;

  std::array<int, 3> order = {0, 1, 2};  // the longest side first
  for (const auto& [i, k] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)})
    if (box.half[order[i]] < box.half[order[k]]) std::swap(order[i], order[k]);
  Obb4Tree::Node& node = tree.nodes.emplace_back();
  std::fill_n(node.child, Obb4Tree::kWidth, Obb4Tree::kNone);
  node.child[0] = std::uint32_t{1} << 31;  // a leaf: it holds leaf primitive 0 only
  double reach[3], sum = 0;
  for (int j = 0; j < 3; ++j) {
    // û_j is axis j in floats. |û_j·U x| ≤ Σ_k |û_j·u_k| e_k.
    float axis[3];
    for (int k = 0; k < 3; ++k) {
      axis[k] = static_cast<float>(box.axes(k, order[j]));
      node.vectors[k][j][0] = axis[k];
    }
    reach[j] = 0;
    for (int i = 0; i < 3; ++i)
      reach[j] +=
          std::abs(axis[0] * box.axes(0, i) + axis[1] * box.axes(1, i) + axis[2] * box.axes(2, i)) *
          (box.half[i] / tree.frame.length);
    sum += reach[j];
  }
  // As in obb4_build.cpp, |Û⁻¹d − Ûᵀd| ≤ η·Σ|y|/(1 − 3η) per coordinate, η ≤ 2.1·2^-24. A sum of
  // nine products of numbers below 2 rounds by less than 32u.
  const double pad = 2 * 2.1 * 0x1p-24 * sum + 64 * kUnit;
  for (int j = 0; j < 3; ++j) {
    node.half[j][0] = static_cast<float>((reach[j] + pad) * (1 + 0x1p-23));
    // Side 0 must be the longest (`Obb4Tree::Node`), but rounding may have made another side
    // longer.
    node.half[0][0] = std::max(node.half[0][0], node.half[j][0]);
  }
  tree.root = boxOf(node, 0);
  return tree;
}

}  // namespace corridor
