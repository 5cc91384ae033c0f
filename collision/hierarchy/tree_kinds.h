#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/volumes/obb.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// The kind of trees that a query walks, and the overlap test of their volumes. It changes what a
/// query costs, never its verdict.
///
/// `obb4` are 4-wide OBB trees (obb4_tree.h): sixteen pairs per test, the fast ones. All others are
/// binary trees (volume_tree.h) of a volume with one of its overlap tests, in the order of the list
/// CORRIDOR_EACH_OVERLAP: obbBinary, obbGjk, …, kdop26.
enum class TreeKind {
  obb4,
#define CORRIDOR_KIND(kind, Volume, Overlap, volumeName, overlapName) kind,
  CORRIDOR_EACH_OVERLAP(CORRIDOR_KIND)
#undef CORRIDOR_KIND
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

/// Returns whether a kind has its volume's first overlap test. Distance queries use no other.
bool hasFirstOverlap(TreeKind trees);

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
