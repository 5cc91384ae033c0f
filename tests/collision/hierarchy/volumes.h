#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "collision/hierarchy/volume_tree.h"
#include "collision/volumes/aabb.h"
#include "collision/volumes/bounding_sphere.h"
#include "collision/volumes/ellipsoid.h"
#include "collision/volumes/hull.h"
#include "collision/volumes/kdop.h"
#include "collision/volumes/rss.h"
#include "collision/volumes/shell.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor::test {

/// The kinds of volumes on which the test suites for all volumes run.
using Volumes = testing::Types<Obb, Aabb, BoundingSphere, Rss, Kdop<14>, Kdop<18>, Kdop<26>, Shell,
                               Ellipsoid, Hull>;
struct VolumeNames {
  template <class Volume>
  static std::string GetName(int) {
    if (std::is_same_v<Volume, Obb>) return "Obb";
    if (std::is_same_v<Volume, Aabb>) return "Aabb";
    if (std::is_same_v<Volume, BoundingSphere>) return "BoundingSphere";
    if (std::is_same_v<Volume, Rss>) return "Rss";
    if (std::is_same_v<Volume, Kdop<14>>) return "Kdop14";
    if (std::is_same_v<Volume, Shell>) return "Shell";
    if (std::is_same_v<Volume, Ellipsoid>) return "Ellipsoid";
    if (std::is_same_v<Volume, Hull>) return "Hull";
    return std::is_same_v<Volume, Kdop<18>> ? "Kdop18" : "Kdop26";
  }
};

/// The fits of oriented boxes with which these suites run.
inline constexpr std::pair<ObbFit, const char*> kFits[] = {
    {ObbFit::triangles, "triangles"}, {ObbFit::vertices, "vertices"}, {ObbFit::hull, "hull"}};
/// The ways of building a tree with which these suites run.
inline constexpr TreeParams kParams[] = {
    {ObbFit::triangles, SplitRule::mean, TreeBuilding::topDown},
    {ObbFit::vertices, SplitRule::mean, TreeBuilding::topDown},
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

/// Returns the indices of the poses of a workload on which the `fit`-th fit is tested. Fit 0, the
/// default, is tested on every step-th pose. Each other fit is tested on every (4·step)-th pose:
/// from pose 0 if `fit + turn` is even, else from pose 2·step. If the workload has few poses, fits
/// other than 0 get none, because building their trees would take longer than the queries. Builds
/// with sanitizers, which are slow, test fewer poses. With CORRIDOR_STRESS every fit is tested on
/// all poses.
/// @param turn the index of the workload, so that successive workloads test different poses.
inline std::vector<std::size_t> posesOfFit(const Workload& w, std::size_t step, std::size_t fit,
                                           std::size_t turn) {
  if (fit > 0 && w.poses.size() < 100 && !isStressRun()) return {};
  return fit == 0 ? posesInTurn(w, step, 0, 1) : posesInTurn(w, 2 * step, fit + turn, 2);
}

}  // namespace corridor::test
