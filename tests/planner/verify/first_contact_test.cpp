// Tests of the first contact that the verifier reports, against closed forms.
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/planner/verify/rigid_world.h"

namespace corridor {
namespace {

using test::boxMesh;
using test::poseOf;

PathReport verified(const TriangleMesh& body, const TriangleMesh& obstacle,
                    const std::vector<RigidPose>& path) {
  test::RigidWorld world(false);
  world.moving = {{"body", &body}};
  world.fixed = {{"obstacle", &obstacle}};
  return test::verifyRigid(world, path);
}

/// The report has the first contact of the first refuted edge, and the edge is proved free before
/// this contact.
TEST(FirstContact, IsFoundAndProvedFreeBefore) {
  for (const double wall : {1.0, 1.0 + 1e-3, 2.2345678}) {
    // The cube goes through a thin wall to a large box, which bisection meets first.
    TriangleMesh obstacle = boxMesh(Vec3(wall, -1, -1), Vec3(wall + 1e-3, 1, 1));
    const TriangleMesh box = boxMesh(Vec3(3.5, -1, -1), Vec3(9, 1, 1));
    for (const auto& t : box.triangles)
      obstacle.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    obstacle.vertices.insert(obstacle.vertices.end(), box.vertices.begin(), box.vertices.end());
    const PathReport report =
        verified(boxMesh(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)), obstacle,
                 {poseOf({-6, 0, 0}), poseOf({-5, 0, 0}), poseOf({5, 0, 0})});
    EXPECT_EQ(report.verdict, PathVerdict::refuted);
    ASSERT_EQ(report.findings.size(), 1u);
    const PathFinding& finding = report.findings[0];
    const double truth = (wall - 0.5 + 5) / 10;
    EXPECT_EQ(finding.edge, 1);
    EXPECT_EQ(finding.reason, "contact");
    ASSERT_TRUE(finding.freeUntil);
    EXPECT_LE(*finding.freeUntil, truth);
    EXPECT_GE(finding.t, truth - 1e-15);
    EXPECT_LE(finding.t - *finding.freeUntil, 2e-8);
    EXPECT_LE(finding.point.x(), wall + 1e-3);
  }
}

/// A blade rotates into a post. The time of the first contact has a closed form.
TEST(FirstContact, OfARotation) {
  const PathReport report =
      verified(boxMesh({0, -0.01, -0.1}, {1, 0, 0.1}), boxMesh({-0.1, 0.5, -1}, {0, 0.6, 1}),
               {poseOf({0, 0, 0}, 0), poseOf({0, 0, 0}, 3)});
  ASSERT_EQ(report.findings.size(), 1u);
  const PathFinding& finding = report.findings[0];
  // The blade's edge is along x; the post begins at x = 0.
  const double truth = std::numbers::pi / 2 / 3;
  ASSERT_TRUE(finding.freeUntil);
  EXPECT_LE(*finding.freeUntil, truth);
  EXPECT_GE(finding.t, truth - 1e-15);
  EXPECT_LE(finding.t - *finding.freeUntil, 1e-6);
}

}  // namespace
}  // namespace corridor
