#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/volumes/obb.h"

namespace corridor {

/// The kind of trees that a query walks, and the overlap test of their volumes. It changes what a
/// query costs, never its verdict.
enum class TreeKind {
  obb4,       ///< 4-wide OBB trees (obb4_tree.h): sixteen pairs per test, the fast one
  obbBinary,  ///< from here on binary trees (volume_tree.h): boxes by separating axes, …
  obbGjk,     ///< … by closest features, …
  obbLinearProgram,
  obbEdgeFace,
  aabb,
  sphere,
  rss,
  kdop14,
  kdop18,
  kdop26,
};

/// A kind of bounding volume under the name that users write, with its fits and overlap tests. The
/// first of each is the default.
struct VolumeKind {
  std::string name;
  std::vector<std::string> fits, overlaps;
  /// The kind for the first overlap test. The kinds for the others follow in their order.
  TreeKind trees;
};
/// Returns all kinds of volume, the default first.
const std::vector<VolumeKind>& volumeKinds();

/// The words with which users choose trees. An empty word stands for the default.
struct TreeNames {
  std::string volume, fit, overlap;
};
/// The choice that `TreeNames` name.
struct TreeChoice {
  TreeKind trees = TreeKind::obb4;
  ObbFit fit = ObbFit::triangles;
};

/// A word that is unknown, or that its volume doesn't have.
struct InvalidName {
  std::string key;   ///< "volume", "fit" or "overlap"
  std::string text;  ///< what is wrong, and which words are possible
};
std::optional<InvalidName> invalidNameIn(const TreeNames& words);

// Both throw std::invalid_argument if one of the words is wrong.

TreeChoice treesNamed(const TreeNames& words);
/// Returns the words with the empty ones replaced by their default names.
TreeNames withDefaults(const TreeNames& words);

}  // namespace corridor
