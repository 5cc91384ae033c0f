#include "planner/model/held_joints.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/model/model_builder.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A tree of balls on joints of all types. Only `turn` is planned.
class HeldJoints : public testing::Test {
 protected:
  HeldJoints() : folder_(test::newFolder()) {
    std::ofstream urdf(folder_ / "tree.urdf");
    urdf << "<robot name='tree'><link name='base'/>";
    const auto add = [&](const std::string& link, const std::string& type,
                         const std::string& parent, const std::string& more = "") {
      urdf << "<link name='" << link
           << "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>"
           << "<joint name='to_" << link << "' type='" << type << "'><parent link='" << parent
           << "'/><child link='" << link << "'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>" << more
           << "</joint>";
    };
    const std::string limits = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";
    add("foot", "fixed", "base");
    add("mast", "revolute", "foot", limits);
    add("lamp", "fixed", "mast");
    add("stuck", "prismatic", "foot", "<limit lower='0' upper='0' effort='1' velocity='1'/>");
    add("wheel", "continuous", "foot");
    add("copy", "revolute", "foot", limits + "<mimic joint='to_mast' multiplier='0.5'/>");
    add("still_copy", "revolute", "foot", limits + "<mimic joint='to_mast' multiplier='0'/>");
    add("stuck_copy", "prismatic", "foot", limits + "<mimic joint='to_stuck'/>");
    add("drone", "floating", "foot");
    add("turn", "revolute", "lamp", limits);
    add("claw", "revolute", "turn", limits);
    urdf << "</robot>";
    urdf.close();
    builder_.addRobot(folder_ / "tree.urdf", {.joints = {"to_turn"}})
        .addObstacle("table", Sphere{0.1});
  }
  ~HeldJoints() override { std::filesystem::remove_all(folder_); }

  static std::size_t bodyNamed(const Model& model, const std::string& name) {
    std::size_t i = 0;
    while (model.bodies.at(i).name != name) ++i;
    return i;
  }

  std::filesystem::path folder_;
  ModelBuilder builder_;
};

TEST_F(HeldJoints, DivideARobotIntoParts) {
  const Model model = builder_.build();
  const std::vector<std::size_t> parts = fixedPartsOf(model);
  const auto partOf = [&](const std::string& name) { return parts.at(bodyNamed(model, name)); };
  for (const char* name : {"foot", "stuck", "still_copy", "stuck_copy", "table"})
    EXPECT_EQ(partOf(name), 0u) << name;
  for (const char* name : {"mast", "wheel", "copy", "drone", "turn", "claw"})
    EXPECT_NE(partOf(name), 0u) << name;
  EXPECT_EQ(partOf("lamp"), partOf("mast"));
  EXPECT_NE(partOf("turn"), partOf("claw"));
  EXPECT_NE(partOf("wheel"), partOf("mast"));
}

TEST_F(HeldJoints, AreTheReasonOfTheFilter) {
  const Model model = builder_.build();
  const auto why = [&](const std::string& a, const std::string& b) {
    return model.filter.whyNotTested(bodyNamed(model, a), bodyNamed(model, b), {});
  };
  for (const char* name : {"mast", "lamp", "wheel", "copy", "drone"})
    EXPECT_EQ(why(name, "table"), kTestedAtRest) << name;
  for (const char* name : {"foot", "stuck", "still_copy", "stuck_copy"})
    EXPECT_EQ(why(name, "table"), kNeverMove) << name;
  EXPECT_EQ(why("wheel", "drone"), kTestedAtRest);
  EXPECT_EQ(why("claw", "table"), "");
}

TEST_F(HeldJoints, AreNamed) {
  const Model model = builder_.build();
  const auto between = [&](const std::string& a, const std::string& b) {
    return jointsBetween(model, bodyNamed(model, a), bodyNamed(model, b));
  };
  EXPECT_THAT(between("lamp", "table"), ElementsAre("to_mast"));
  EXPECT_THAT(between("table", "claw"), ElementsAre("to_mast", "to_turn", "to_claw"));
  EXPECT_THAT(between("claw", "lamp"), ElementsAre("to_turn", "to_claw"));
  EXPECT_THAT(between("wheel", "drone"), ElementsAre("to_wheel", "to_drone"));
  EXPECT_THAT(between("copy", "table"), ElementsAre("to_mast")) << "the joint that it mimics";
  EXPECT_THAT(between("stuck", "table"), IsEmpty());
  EXPECT_EQ(adviceAtRest(model, bodyNamed(model, "lamp"), bodyNamed(model, "table")),
            "the joint between them, \"to_mast\", is held; hold it at another value, or add allow: "
            "[[lamp, table]] if this is intended");
  EXPECT_EQ(adviceAtRest(model, bodyNamed(model, "wheel"), bodyNamed(model, "drone")),
            "the joints between them, \"to_wheel\", \"to_drone\", are held; hold them at other "
            "values, or add allow: [[wheel, drone]] if this is intended");
}

TEST_F(HeldJoints, OfSeveralRobotsHavePrefixes) {
  ModelBuilder two;
  two.addRobot(folder_ / "tree.urdf", {.name = "left", .joints = {"to_turn"}})
      .addRobot(folder_ / "tree.urdf", {.name = "right", .joints = {"to_turn"}});
  const Model model = two.build();
  EXPECT_THAT(jointsBetween(model, bodyNamed(model, "left/wheel"), bodyNamed(model, "right/mast")),
              ElementsAre("left/to_wheel", "right/to_mast"));
  EXPECT_EQ(
      model.filter.whyNotTested(bodyNamed(model, "left/mast"), bodyNamed(model, "right/foot"), {}),
      kTestedAtRest);
  EXPECT_EQ(
      model.filter.whyNotTested(bodyNamed(model, "left/foot"), bodyNamed(model, "right/foot"), {}),
      kNeverMove);
}

}  // namespace
}  // namespace corridor
