#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/volumes/obb.h"

namespace corridor {

/// Which trees a query walks, and how two volumes of theirs are tested. No verdict depends on it,
/// only what it costs.
enum class TreeKind {
  wideObb,  ///< boxes, four a node, sixteen pairs a test (wide_obb_tree.h): the fast one
  obb,      ///< binary from here on (volume_tree.h): boxes by separating axes, …
  obbGjk,   ///< … by closest features, …
  obbLinearProgram,
  obbEdgeFace,
  aabb,
  sphere,
  rss,
  kdop14,
  kdop18,
  kdop26,
};

/// A kind of bounding volume by the name that users write. Of its fits and overlap tests the first
/// is the default.
struct VolumeKind {
  std::string name;
  std::vector<std::string> fits, overlaps;
  TreeKind trees;  ///< by the first overlap test; those by the others follow in their order
};
/// All of them, the default first.
const std::vector<VolumeKind>& volumeKinds();

/// The words that choose trees, as users write them; an empty one stands for the first that there
/// is.
struct TreeWords {
  std::string volume, fit, overlap;
};
/// What they choose.
struct TreeChoice {
  TreeKind trees = TreeKind::wideObb;
  ObbFit fit = ObbFit::triangles;
};

/// The word that is unknown, or is none of its volume's.
struct WrongWord {
  std::string key;   ///< "volume", "fit" or "overlap"
  std::string text;  ///< what is wrong, and what there is
};
std::optional<WrongWord> wrongWordIn(const TreeWords& words);

// Both throw std::invalid_argument where there is a wrong word among them.

TreeChoice treesNamed(const TreeWords& words);
/// With what the empty ones stand for.
TreeWords spelledOut(const TreeWords& words);

}  // namespace corridor
