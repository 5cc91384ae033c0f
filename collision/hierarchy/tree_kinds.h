#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/hierarchy/tree_params.h"
#include "collision/volumes/volume_list.h"

namespace corridor {

/// The kind of trees that a query walks, with the overlap test of their volumes. The kind changes
/// the cost of a query, never its verdict.
///
/// `obb4` stands for 4-wide OBB trees (obb4_tree.h): sixteen pairs per test, the fastest kind.
/// Every other kind stands for binary trees (volume_tree.h) of one volume with one of its overlap
/// tests. These kinds have the names and the order of the list CORRIDOR_EACH_OVERLAP
/// (volume_list.h), which begins with obbBinary, obbGjk.
enum class TreeKind {
  obb4,
#define CORRIDOR_KIND(kind, Volume, Overlap, volumeName, overlapName) kind,
  CORRIDOR_EACH_OVERLAP(CORRIDOR_KIND)
#undef CORRIDOR_KIND
};

/// A kind of bounding volume under the name that users write, with the names of its fits, of its
/// overlap tests, and of the ways to build its trees. The first of each is the default.
struct VolumeKind {
  std::string name;
  std::vector<std::string> fits, overlaps;
  /// The kind of trees for the first overlap test. The kinds for the other tests follow in their
  /// order.
  TreeKind trees;
  std::vector<std::string> builds = {};
};
/// Returns all kinds of bounding volume, the default first.
const std::vector<VolumeKind>& volumeKinds();

/// Reports whether a kind has its volume's default overlap test, the first in
/// `VolumeKind::overlaps`. Distance queries make no overlap test. The program and the checker
/// therefore refuse all other kinds for methods that measure distances.
bool hasDefaultOverlap(TreeKind trees);

/// The words by which users choose trees. An empty word stands for the default word.
struct TreeNames {
  std::string volume, fit, overlap;
  /// `top-down`: nodes are split at the mean. `median`: nodes are split at the median. `bottom-up`:
  /// nodes are clustered.
  std::string build = {};
};
/// The kind of trees that `TreeNames` stand for, and how they are built.
struct TreeChoice {
  TreeKind trees = TreeKind::obb4;
  TreeParams params = {};
};

/// The complaint about a word that is unknown, or that the chosen volume doesn't have.
struct InvalidName {
  std::string key;   ///< "volume", "fit", "overlap" or "build"
  std::string text;  ///< what is wrong, and which words are possible
};
/// Returns the complaint about the first wrong word, or nothing.
std::optional<InvalidName> invalidNameIn(const TreeNames& words);

/// Returns the choice for the words. @throws std::invalid_argument if a word is wrong.
TreeChoice treesNamed(const TreeNames& words);
/// Returns the words, with the names of the defaults instead of empty words. @throws
/// std::invalid_argument if a word is wrong.
TreeNames withDefaults(const TreeNames& words);

}  // namespace corridor
