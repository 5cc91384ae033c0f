#include "collision/hierarchy/tree_kinds.h"

#include <algorithm>
#include <stdexcept>

#include "collision/core/spelling.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {
namespace {

using Words = std::vector<std::string>;

bool has(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Returns the volume of this name, or null. An empty name stands for the default volume.
const VolumeKind* kindNamed(const std::string& name) {
  if (name.empty()) return &volumeKinds().front();
  for (const VolumeKind& kind : volumeKinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

/// Returns the complaint about `word`, or nothing. If other volumes have this word, the complaint
/// names these volumes.
std::optional<InvalidName> wrongOf(const VolumeKind& volume, const std::string& key,
                                   const std::string& word, Words VolumeKind::*variants) {
  const Words& own = volume.*variants;
  if (word.empty() || has(own, word)) return std::nullopt;
  Words others;
  for (const VolumeKind& kind : volumeKinds())
    if (has(kind.*variants, word)) others.push_back(kind.name);
  const std::string choices = "; volume " + volume.name + " has: " + joined(own);
  if (!others.empty())
    return InvalidName{key, quotedWord(word) +
                                (others.size() == 1 ? " is for volume " : " is for volumes ") +
                                joined(others) + choices};
  return InvalidName{key,
                     "unknown " + key + " " + quotedWord(word) + didYouMean(word, own) + choices};
}

}  // namespace

const std::vector<VolumeKind>& volumeKinds() {
  static const Words oriented = {"triangles", "vertices", "hull"}, plain = {"plain"},
                     builds = {"top-down", "median", "bottom-up"};
  static const std::vector<VolumeKind> kinds = [] {
    std::vector<VolumeKind> all = {{"obb", oriented, {"sat"}, TreeKind::obb4, {builds.front()}}};
    const auto add = [&](TreeKind kind, bool isOriented, const char* volume, const char* overlap) {
      if (all.back().name != volume)
        all.push_back({volume, isOriented ? oriented : plain, {}, kind, builds});
      all.back().overlaps.push_back(overlap);
    };
#define CORRIDOR_ADD(kind, Volume, Overlap, volumeName, overlapName) \
  add(TreeKind::kind, Volume::kOriented, volumeName, overlapName);
    CORRIDOR_EACH_OVERLAP(CORRIDOR_ADD)
#undef CORRIDOR_ADD
    return all;
  }();
  return kinds;
}

bool hasDefaultOverlap(TreeKind trees) {
  const auto& kinds = volumeKinds();
  return std::any_of(kinds.begin(), kinds.end(),
                     [&](const VolumeKind& kind) { return kind.trees == trees; });
}

std::optional<InvalidName> invalidNameIn(const TreeNames& words) {
  const VolumeKind* volume = kindNamed(words.volume);
  if (!volume) {
    Words names;
    for (const VolumeKind& kind : volumeKinds()) names.push_back(kind.name);
    return InvalidName{"volume", "unknown volume " + quotedWord(words.volume) +
                                     didYouMean(words.volume, names) +
                                     "; there are: " + joined(names)};
  }
  if (auto wrong = wrongOf(*volume, "fit", words.fit, &VolumeKind::fits)) return wrong;
  if (auto wrong = wrongOf(*volume, "overlap", words.overlap, &VolumeKind::overlaps)) return wrong;
  return wrongOf(*volume, "build", words.build, &VolumeKind::builds);
}

TreeNames withDefaults(const TreeNames& words) {
  if (const auto wrong = invalidNameIn(words))
    throw std::invalid_argument(wrong->key + ": " + wrong->text);
  const VolumeKind& volume = *kindNamed(words.volume);
  return {volume.name, words.fit.empty() ? volume.fits.front() : words.fit,
          words.overlap.empty() ? volume.overlaps.front() : words.overlap,
          words.build.empty() ? volume.builds.front() : words.build};
}

TreeChoice treesNamed(const TreeNames& words) {
  const TreeNames all = withDefaults(words);
  const VolumeKind& volume = *kindNamed(all.volume);
  const auto overlap = std::find(volume.overlaps.begin(), volume.overlaps.end(), all.overlap);
  const auto after = static_cast<int>(overlap - volume.overlaps.begin());
  // A volume without axes of its own has one fit, "plain". This is no `ObbFit`. Such volumes ignore
  // the fit, so `ObbFit::triangles` only fills the place.
  return {static_cast<TreeKind>(static_cast<int>(volume.trees) + after),
          {obbFitNamed(all.fit).value_or(ObbFit::triangles),
           all.build == "median" ? SplitRule::median : SplitRule::mean,
           all.build == "bottom-up" ? TreeBuilding::bottomUp : TreeBuilding::topDown}};
}

}  // namespace corridor
