#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/volumes/part_obb.h"

namespace corridor {

/// Builds one node. Its first lane has the part's enclosing box {c + U x : |x_k| ≤ e_k}, in floats.
/// The tree's origin is the centre c of this box. In the tree's frame the box is therefore {U x},
/// and no centre is rounded.
Obb4Tree::Obb4Tree(const ConvexPart& part) : meshTriangle_{0}, part_(part) {
  requireStandardFloatingPoint();
  const Obb box = enclosingObb(part);
  origin_ = box.center;
  // |U x| ≤ (1 + 2^-38)|e|, since the axes are orthonormal to 2^-40.
  const double size = roundedUp(box.half.stableNorm() * (1 + 0x1p-30));
  const bool usable = size > 0 && std::isfinite(size);
  if (usable) length_ = std::ldexp(1.0, std::clamp(std::ilogb(size) + 1, -1000, 1000));
  radius_ = size;
  reach_ = roundedUp(origin_.stableNorm() + radius_);

  std::array<int, 3> order = {0, 1, 2};  // the longest side first
  for (const auto& [i, k] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 1)})
    if (box.half[order[i]] < box.half[order[k]]) std::swap(order[i], order[k]);
  Node& node = nodes_.emplace_back();
  std::fill_n(node.child, kWidth, kNone);
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
          (box.half[i] / length_);
    sum += reach[j];
  }
  // As in obb4_build.cpp, |Û⁻¹d − Ûᵀd| ≤ η·Σ|y|/(1 − 3η) per coordinate, η ≤ 2.1·2^-24. A sum of
  // nine products of numbers below 2 rounds by less than 32u.
  const double pad = 2 * 2.1 * 0x1p-24 * sum + 64 * kUnit;
  for (int j = 0; j < 3; ++j) {
    node.half[j][0] = static_cast<float>((reach[j] + pad) * (1 + 0x1p-23));
    // Side 0 must be the longest (`Obb4Tree::Node`). Rounding may have made another side longer.
    node.half[0][0] = std::max(node.half[0][0], node.half[j][0]);
  }
  root_ = boxOf(node, 0);
}

}  // namespace corridor
