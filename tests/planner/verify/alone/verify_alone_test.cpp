/// The verifier, linked without the checker, its trees and its kinematics (tests/CMakeLists.txt).
#include <gtest/gtest.h>

#include "planner/verify/verify_path.h"

namespace corridor {
namespace {

/// A ball of radius 0.1 moves on a slide along x; a post of radius 0.2 is at the origin.
TEST(VerifyAlone, ProvesAndRefutes) {
  ConfigurationSpace space;
  space.add({Coordinate::Kind::line, "slide", 0, -2, 2, false, 1});
  Frame slide;
  slide.name = "ball";
  slide.joint = Frame::Joint::prismatic;
  slide.axis = Vec3::UnitX();
  slide.variable = 0;
  KinematicTree tree;
  tree.add(slide);
  const ConvexPart ball{{Vec3::Zero()}, 0.1, false},
      post{{Vec3(0, 0, -1), Vec3(0, 0, 1)}, 0.2, true};
  PathProblem problem;
  problem.tree = &tree;
  problem.space = &space;
  problem.bodies = {{"ball", nullptr, {&ball, 1}, false, 1},
                    {"post", nullptr, {&post, 1}, false, 0}};
  problem.pairs = {{0, 1}};
  problem.tube = Configuration::Constant(1, 1e-9);
  problem.tolerance = 1e-6;
  const auto at = [](double x) { return Configuration::Constant(1, x); };
  EXPECT_EQ(verifyPath(problem, {at(-1), at(-0.301)}).verdict, PathVerdict::proved);
  const PathReport through = verifyPath(problem, {at(-1), at(1)});
  EXPECT_EQ(through.verdict, PathVerdict::refuted);
  EXPECT_EQ(through.findings.at(0).reason, "contact");
}

}  // namespace
}  // namespace corridor
