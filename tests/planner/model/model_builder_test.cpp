#include "planner/model/model_builder.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::HasSubstr;

const std::filesystem::path robots = std::filesystem::path(CORRIDOR_SOURCE_DIR) / "robots";

std::string complaintOf(ModelBuilder& builder) {
  try {
    builder.build();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs testedPairs(const Model& model) {
  Pairs pairs;
  forEachTestedPair(model, Required::beyondProofs(),
                    [&](std::size_t a, std::size_t b) { pairs.emplace_back(a, b); });
  return pairs;
}

/// A `ModelBuilder` must make the same model as the reader of problem files.
TEST(ModelBuilder, MakesWhatTheReaderMakes) {
  const Model model =
      ModelBuilder()
          .addRobot(robots / "arm6/arm6.urdf", {.name = "left", .base = {Vec3(0, 1, 0)}})
          .addRobot(robots / "arm7/arm7.urdf", {.name = "right"})
          .addObstacle("post", Cylinder{0.1, 2}, {Vec3(2, 0, 1)})
          .addObstacle("ball", Sphere{0.1}, {Vec3(3, 0, 0)})
          .allow("left/hand", "post")
          .build();
  std::string state = "{";
  for (const ModelRobot& robot : model.robots) {
    state += robot.name + ": {";
    for (const PlannedJoint& planned : robot.plannedJoints) state += planned.name + ": 0, ";
    state += "}, ";
  }
  state += "}\n";
  const std::filesystem::path folder = test::newFolder();
  std::ofstream(folder / "problem.yaml")
      << "format: corridor-problem-1\nrobots:\n  left: {file: " << (robots / "arm6/arm6.urdf")
      << ", base: {at: [0, 1, 0]}}\n  right: {file: " << (robots / "arm7/arm7.urdf")
      << "}\nworld:\n  post: {cylinder: {radius: 0.1, length: 2}, at: [2, 0, 1]}\n"
         "  ball: {sphere: 0.1, at: [3, 0, 0]}\n"
         "allow: [[left/hand, post]]\nstart: "
      << state << "goal: " << state;
  const Model read = readProblem(folder).model;
  std::filesystem::remove_all(folder);
  EXPECT_EQ(model.space.numberNames(), read.space.numberNames());
  EXPECT_EQ(model.space.size(), 13u);
  ASSERT_EQ(model.tree.frames.size(), read.tree.frames.size());
  const Configuration q = Configuration::Constant(13, 0.3);
  EXPECT_TRUE(framePoses(model.tree, q) == framePoses(read.tree, q));
  ASSERT_EQ(model.bodies.size(), read.bodies.size());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    EXPECT_EQ(model.bodies[i].name, read.bodies[i].name);
    EXPECT_EQ(model.bodies[i].frame, read.bodies[i].frame);
  }
  EXPECT_EQ(testedPairs(model), testedPairs(read));
  // `forEachPair` must visit all pairs except those of two obstacles, in ascending order, and none
  // twice.
  Pairs all, expected;
  const Required need = Required::beyondProofs();
  forEachPair(model, need, [&](std::size_t a, std::size_t b, std::string_view why) {
    all.emplace_back(a, b);
    EXPECT_EQ(why, model.filter.whyNotTested(b, a, need)) << "in either order";
  });
  for (std::size_t a = 0; a < model.bodies.size(); ++a)
    for (std::size_t b = a + 1; b < model.bodies.size(); ++b)
      if (model.bodies[a].robot || model.bodies[b].robot) expected.emplace_back(a, b);
  EXPECT_EQ(all, expected);
  EXPECT_EQ(static_cast<double>(all.size()), pairCount(model));
  EXPECT_LT(testedPairs(model).size(), all.size());
  const auto bodyNamed = [&](const std::string& name) {
    std::size_t i = 0;
    while (model.bodies.at(i).name != name) ++i;
    return i;
  };
  EXPECT_EQ(model.filter.whyNotTested(bodyNamed("left/hand"), bodyNamed("post"), need), "allow");
  EXPECT_EQ(model.filter.whyNotTested(bodyNamed("left/base"), bodyNamed("left/shoulder"), need),
            "adjacent");
  EXPECT_EQ(model.filter.whyNotTested(bodyNamed("left/base"), bodyNamed("right/base"), need),
            kNeverMove);
  EXPECT_EQ(model.filter.whyNotTested(bodyNamed("left/hand"), bodyNamed("right/hand"), need), "");
}

/// A checker of a model in memory, without a problem.
TEST(ModelBuilder, RigidBodiesInMemory) {
  const Corners bounds{Vec3(-2, -2, -2), Vec3(2, 2, 2)};
  const Model model = ModelBuilder()
                          .addRigidBody("crate", JointType::floating,
                                        {shapeOf("crate", test::boxMesh({1, 1, 1}))}, bounds)
                          .addObstacle("ball", Sphere{0.5})
                          .build();
  EXPECT_EQ(model.space.numberNames(),
            (std::vector<std::string>{"crate/x", "crate/y", "crate/z", "crate/qx", "crate/qy",
                                      "crate/qz", "crate/qw"}));
  const Checker checker(model, {.margin = 0.1});
  const auto at = [](double x) {
    Configuration q = Configuration::Zero(7);
    q[0] = x, q[6] = 1;
    return q;
  };
  EXPECT_EQ(checker.tube(), tubeOf(model.space));
  EXPECT_TRUE(checker.isProvedFree(at(1.2), at(2)));
  EXPECT_FALSE(checker.isProvedFree(at(1.05), at(2))) << "closer than the margin";
  EXPECT_FALSE(checker.isProvedFree(at(-2), at(2)));
  EXPECT_FALSE(checker.isProvedFree(at(2.5))) << "out of bounds";
}

TEST(ModelBuilder, ReportsAllFaultsAtOnce) {
  ModelBuilder builder;
  builder.addRobot("none.urdf")
      .addRigidBody("a", JointType::planar, {}, {Vec3(1, 0, 0), Vec3(0, 1, 0)})
      .addObstacle("ball", Sphere{-1})
      .bound("b", {})
      .allow("x", "y");
  const std::string complaint = complaintOf(builder);
  EXPECT_THAT(complaint, HasSubstr("none.urdf: "));
  EXPECT_THAT(complaint, HasSubstr("ModelBuilder: ball: "));
  EXPECT_THAT(complaint, HasSubstr("bounds of \"a\": lower corner first"));
  EXPECT_THAT(complaint, HasSubstr("bounds of \"b\": there is no"));
  EXPECT_THAT(complaint, HasSubstr("allow: there is no body \"x\""));
  ModelBuilder twice;
  twice.addRobot(robots / "arm6/arm6.urdf").addRobot(robots / "arm6/arm6.urdf");
  EXPECT_THAT(complaintOf(twice), HasSubstr("two robots have the name \"\""));
  ModelBuilder late;
  late.addObstacle("ball", Sphere{1}).addRobot(robots / "arm6/arm6.urdf");
  EXPECT_THAT(complaintOf(late), HasSubstr("robots must be added before obstacles"));
  ModelBuilder wrong;
  wrong.addRobot(robots / "arm6/arm6.urdf", {.joints = {"nose"}});
  EXPECT_THAT(complaintOf(wrong), HasSubstr("\"nose\" is no joint of "));
}

TEST(CheckerOptions, AreChecked) {
  const Problem problem = test::hallProblem(test::Rigid::SE2);
  const auto refused = [&](const CheckerOptions& options) {
    try {
      const Checker checker(problem.model, options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_THAT(refused({.margin = -1}), HasSubstr("margin"));
  EXPECT_THAT(refused({.tube = Configuration::Zero(2)}), HasSubstr("tube"));
  EXPECT_THAT(refused({.tolerance = 0}), HasSubstr("tolerance"));
  TreeChoice gjk;
  gjk.trees = TreeKind::obbGjk;
  EXPECT_THAT(refused({.method = EdgeMethod::advancement, .trees = gjk}),
              HasSubstr("measure distances"));
}

}  // namespace
}  // namespace corridor
