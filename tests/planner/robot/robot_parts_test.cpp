// Tests of robots that a program describes by links and joints.
#include "planner/robot/robot_parts.h"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/model/model_builder.h"
#include "planner/robot/rpy.h"
#include "planner/robot/urdf_file.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Returns a base, an arm on a revolute joint with a rotated origin, and a finger whose joint
/// mimics this joint.
RobotParts fingered() {
  RobotParts parts;
  parts.links = {{"base", {}}, {"arm", {shapeOf("arm", Sphere{0.1})}}, {"finger", {}}};
  RobotParts::Joint turn, follow;
  turn.name = "turn";
  turn.type = JointType::revolute;
  turn.parent = "base";
  turn.child = "arm";
  turn.X_PJ = {Vec3(0.1, 0.2, 0.3), quaternionFromRpy({0.4, 0.5, 0.6})};
  turn.axis = Vec3(0.3, -2.5, 0.1);
  turn.lower = -1;
  turn.upper = 1.5;
  turn.velocity = 2;
  follow.name = "follow";
  follow.type = JointType::prismatic;
  follow.parent = "arm";
  follow.child = "finger";
  follow.mimic = {"turn", 0.5, 0.25};
  parts.joints = {follow, turn};
  return parts;
}

std::vector<std::string> faultsOf(RobotParts parts) {
  std::vector<Fault> faults;
  EXPECT_FALSE(makeRobot(std::move(parts), faults));
  std::vector<std::string> texts;
  for (const Fault& fault : faults) texts.push_back(fault.str());
  return texts;
}

TEST(RobotParts, AreTheRobotOfTheUrdf) {
  const std::filesystem::path folder = test::newFolder();
  std::ofstream(folder / "r.urdf") << R"(<robot name="r"><link name="base"/>
    <link name="arm"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    <link name="finger"/>
    <joint name="follow" type="prismatic"><parent link="arm"/><child link="finger"/>
      <mimic joint="turn" multiplier="0.5" offset="0.25"/></joint>
    <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
      <origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><axis xyz="0.3 -2.5 0.1"/>
      <limit lower="-1" upper="1.5" velocity="2" effort="3"/></joint></robot>)";
  std::vector<Fault> faults;
  std::vector<std::filesystem::path> files;
  const auto urdf = readUrdf(folder / "r.urdf", {}, faults, files);
  const auto built = makeRobot(fingered(), faults);
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(urdf && built) << testing::PrintToString(faults.size());
  ASSERT_EQ(built->joints.size(), urdf->joints.size());
  EXPECT_EQ(built->root, urdf->root);
  for (std::size_t j = 0; j < urdf->joints.size(); ++j) {
    const JointModel &a = urdf->joints[j], &b = built->joints[j];
    EXPECT_EQ(b.name, a.name);
    EXPECT_EQ(b.type, a.type);
    EXPECT_EQ(b.parent, a.parent);
    EXPECT_EQ(b.child, a.child);
    EXPECT_EQ(b.X_PJ.p, a.X_PJ.p);
    EXPECT_EQ(b.X_PJ.q.coeffs(), a.X_PJ.q.coeffs());
    EXPECT_EQ(b.axis, a.axis);
    EXPECT_EQ(b.lower, a.lower);
    EXPECT_EQ(b.upper, a.upper);
    EXPECT_EQ(b.velocity, a.velocity);
    ASSERT_EQ(b.mimic.has_value(), a.mimic.has_value());
    if (!a.mimic) continue;
    EXPECT_EQ(b.mimic->joint, a.mimic->joint);
    EXPECT_EQ(b.mimic->multiplier, a.mimic->multiplier);
    EXPECT_EQ(b.mimic->offset, a.mimic->offset);
  }
  ASSERT_EQ(built->allowed.size(), urdf->allowed.size());
  for (std::size_t i = 0; i < urdf->allowed.size(); ++i) {
    EXPECT_EQ(built->allowed[i].a, urdf->allowed[i].a);
    EXPECT_EQ(built->allowed[i].b, urdf->allowed[i].b);
    EXPECT_EQ(built->allowed[i].reason, urdf->allowed[i].reason);
  }
}

TEST(RobotParts, FaultsAreReportedTogether) {
  RobotParts parts = fingered();
  parts.name = "left";
  parts.links[0].name = "";
  parts.links[1].shapes = {shapeOf("arm", Sphere{NAN})};
  parts.joints[1].axis = Vec3::Zero();
  parts.joints[1].upper.reset();
  parts.joints[0].mimic->offset = INFINITY;
  parts.joints[0].X_PJ.q.coeffs().setZero();
  parts.allow = {{"arm", "fingr"}};
  EXPECT_THAT(
      faultsOf(parts),
      testing::ElementsAre(
          "robot \"left\": link number 0 has no name",
          "robot \"left\": joint \"follow\": the quaternion of its origin is zero",
          "robot \"left\": joint \"follow\": the numbers of its mimic must be finite",
          "robot \"left\": joint \"turn\": its axis is zero; a direction is needed, such as (0, 0, "
          "1)",
          "robot \"left\": joint \"turn\": a lower and an upper limit are needed; a joint without "
          "limits is of type continuous",
          "robot \"left\": link \"arm\": a sphere's radius must be positive and finite, not nan",
          "robot \"left\": allow: \"fingr\" is not a link of this robot (did you mean \"finger\"?)",
          "robot \"left\": joint \"turn\": its parent \"base\" is not a link of this robot"));
}

TEST(RobotParts, ABuilderTakesThem) {
  RobotParts left = fingered(), right = fingered();
  left.name = "left";
  right.name = "right";
  const Model model = ModelBuilder()
                          .addRobot(left)
                          .addRobot(right, {Vec3(2, 0, 0)}, {"turn"})
                          .addObstacle("ball", Sphere{0.1}, {Vec3(5, 0, 0)})
                          .build();
  EXPECT_THAT(model.space.numberNames(), testing::ElementsAre("left/turn", "right/turn"));
  ASSERT_EQ(model.bodies.size(), 3U);
  EXPECT_EQ(model.bodies[1].name, "right/arm");
  left.links[2].shapes = {shapeOf("finger", Sphere{0.1})};
  left.links[0].shapes = left.links[2].shapes;
  const Model touching = ModelBuilder().addRobot(left).build();
  EXPECT_EQ(touching.filter.whyNotTested(0, 2, Required::beyondProofs()), "");
  left.allow = {{"finger", "base"}};
  EXPECT_EQ(
      ModelBuilder().addRobot(left).build().filter.whyNotTested(0, 2, Required::beyondProofs()),
      "allow");
  try {
    ModelBuilder().addRobot(fingered(), {}, {"follow"}).build();
    FAIL() << "a joint that mimics can't be planned for";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "ModelBuilder: \"follow\" is no joint of robot that can be planned for (it is "
                 "fixed, a mimic, or missing), or it is "
                 "named twice");
  }
}

}  // namespace
}  // namespace corridor
