#pragma once

#include <optional>
#include <string>

#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/volume_tree.h"

/// The invariants of trees, proved in rational arithmetic.
namespace corridor::test {

/// Every box contains every triangle or part below it. Each triangle or part is in exactly one
/// leaf. Every node except the root is the child of exactly one box. Also checks what obb4.h
/// assumes about boxes. Returns the first violation, or nothing.
std::optional<std::string> treeFault(const Obb4Tree& tree);

/// Every node's volume, as the set that its doubles define, contains every triangle of the node, or
/// its parts with their spheres or discs. Each leaf primitive is in exactly one leaf. The children
/// of a node partition its leaf primitives. Returns the first violation, or nothing.
template <BoundingVolume Volume>
std::optional<std::string> treeFault(const VolumeTree<Volume>& tree);

}  // namespace corridor::test
