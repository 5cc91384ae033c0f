#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "collision/queries/distance.h"
#include "tests/support/meshes.h"
#include "tests/support/reference_distance.h"
#include "tests/support/workload.h"

namespace corridor::test {

/// Tests distances, witness points and tolerance queries, on trees of the meshes of a workload,
/// against the true distances that the workload contains.
/// @returns the number of tested poses with a known true distance.
template <class Tree>
int expectTrueDistances(const Workload& w, const Tree& a, const Tree& b,
                        const std::vector<std::size_t>& poses, const std::string& built,
                        QueryContext& context) {
  int checked = 0;
  for (const std::size_t i : poses) {
    const double truth = w.distance[i];
    if (std::isnan(truth)) continue;
    SCOPED_TRACE(w.name + ", " + built + ", pose " + std::to_string(i));
    const bool hit = w.hit[i] == 1;
    const Transform& X = w.poses[i];
    const Distance d = distance(Posed(a), Posed(b, X), {}, context);
    EXPECT_EQ(d.distance == 0, hit);
    const double size =
        std::max({errorScale(corners(w.a, d.a), {}), errorScale(corners(w.b, d.b), X), a.reach()});
    const double allowed = 1e-12 * truth + 4 * kUnit * size;
    EXPECT_NEAR(d.distance, truth, allowed);
    // The witness points are on the reported triangles, and their distance is the reported one.
    EXPECT_LE(referenceDistance(d.p_WA, corners(w.a, d.a), {}), 4 * kUnit * size);
    EXPECT_LE(referenceDistance(d.p_WB, corners(w.b, d.b), X), 4 * kUnit * size);
    EXPECT_NEAR((d.p_WA - d.p_WB).norm(), d.distance, allowed + 4 * kUnit * size);
    // Tests the tolerance query just above and just below the distance. For a tolerance of 0 the
    // answer must be that of `interference`.
    EXPECT_TRUE(closerThan(Posed(a), Posed(b, X), d.distance + allowed, context));
    if (d.distance > 4 * allowed) {
      EXPECT_FALSE(closerThan(Posed(a), Posed(b, X), d.distance - 4 * allowed, context));
    }
    EXPECT_EQ(closerThan(Posed(a), Posed(b, X), 0, context), hit);
    ++checked;
  }
  return checked;
}

}  // namespace corridor::test
