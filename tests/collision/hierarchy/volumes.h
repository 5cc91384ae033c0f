#pragma once

#include <string>

#include <gtest/gtest.h>

#include "collision/hierarchy/volume_tree.h"
#include "collision/volumes/aabb.h"
#include "collision/volumes/bounding_sphere.h"
#include "collision/volumes/kdop.h"
#include "collision/volumes/rss.h"

namespace corridor::test {

/// What the abstract suites run over: every volume …
using Volumes = testing::Types<Obb, Aabb, BoundingSphere, Rss, Kdop<14>, Kdop<18>, Kdop<26>>;
struct VolumeNames {
  template <class Volume>
  static std::string GetName(int) {
    if (std::is_same_v<Volume, Obb>) return "Obb";
    if (std::is_same_v<Volume, Aabb>) return "Aabb";
    if (std::is_same_v<Volume, BoundingSphere>) return "BoundingSphere";
    if (std::is_same_v<Volume, Rss>) return "Rss";
    if (std::is_same_v<Volume, Kdop<14>>) return "Kdop14";
    return std::is_same_v<Volume, Kdop<18>> ? "Kdop18" : "Kdop26";
  }
};

/// … and every way of building.
inline constexpr TreeParams kParams[] = {
    {ObbFit::triangles, SplitRule::mean, TreeBuilding::topDown},
    {ObbFit::vertices, SplitRule::median, TreeBuilding::topDown},
    {ObbFit::hull, SplitRule::mean, TreeBuilding::topDown},
    {ObbFit::triangles, SplitRule::mean, TreeBuilding::bottomUp},
};
inline std::string str(const TreeParams& p) {
  return std::string(p.fit == ObbFit::hull       ? "hull"
                     : p.fit == ObbFit::vertices ? "vertices"
                                                 : "triangles") +
         (p.split == SplitRule::mean ? ", mean" : ", median") +
         (p.building == TreeBuilding::topDown ? ", top-down" : ", bottom-up");
}

}  // namespace corridor::test
