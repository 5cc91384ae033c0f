// Tests of the limits and mimics of a URDF's joints, wherever the file states them.
#include <limits>

#include "tests/planner/robot/urdf_fixture.h"

namespace corridor::test {
namespace {

class UrdfLimits : public UrdfTest {};

TEST_F(UrdfLimits, OnlyTheLeadersLimitsCountForAMimic) {
  const auto range = [&](const std::string& leader, const std::string& limits,
                         const std::string& mimic) {
    const RobotDescription model =
        modelOf(link("a") + link("b") + link("c") +
                joint("pan", leader, "a", "b", leader == "continuous" ? "" : limit) +
                joint("tilt", "revolute", "b", "c",
                      "<limit " + limits + " effort=\"0\" velocity=\"0\"/>\n<mimic joint=\"pan\" " +
                          mimic + "/>"));
    std::string text =
        std::to_string(model.joints[0].lower) + " to " + std::to_string(model.joints[0].upper);
    for (const std::string& note : textsOf(model.notes))
      text += "; " + note.substr(folder_.string().size() + 1);
    return text;
  };
  const auto ignored = [](const std::string& own, const std::string& reach) {
    return "; r.urdf:7: joint \"tilt\": its limits, " + own +
           ", are ignored: it mimics \"pan\", which " + reach;
  };
  const auto within = [](const std::string& reach) { return "moves it in " + reach; };
  const std::string same = "-1.000000 to 2.000000";
  EXPECT_EQ(range("revolute", R"(lower="-1" upper="2")", ""), same) << "limits are inclusive";
  EXPECT_EQ(range("revolute", R"(lower="0" upper="3")", R"(multiplier="2" offset="1")"),
            same + ignored("[0, 3]", within("[-1, 5]")));
  EXPECT_EQ(range("revolute", R"(lower="0" upper="0.5")", R"(multiplier="-1")"),
            same + ignored("[0, 0.5]", within("[-2, 1]")));
  EXPECT_EQ(range("revolute", R"(lower="-1" upper="2")", R"(offset="3.5")"),
            same + ignored("[-1, 2]", within("[2.5, 5.5]")));
  EXPECT_EQ(range("revolute", R"(lower="-1" upper="2")", R"(multiplier="0" offset="-2")"),
            same + ignored("[-1, 2]", within("[-2, -2]")));
  EXPECT_EQ(range("revolute", R"(lower="-1" upper="2")", R"(multiplier="0" offset="2")"), same);
  EXPECT_EQ(range("continuous", R"(lower="-2" upper="8")", R"(multiplier="2")"),
            "-inf to inf" + ignored("[-2, 8]", "is continuous, without limits"));
  EXPECT_EQ(range("revolute", R"(lower="3" upper="1")", ""),
            same + ignored("[3, 1]", within("[-1, 2]")));
  EXPECT_EQ(range("revolute", R"(lower="-1e308" upper="1e308")", ""), same);
  EXPECT_EQ(range("revolute", "", ""), same) << "no limits of its own";
}

TEST_F(UrdfLimits, EffortAndVelocityMayBeMissing) {
  const RobotDescription model = modelOf(link("a") + link("b") + link("c") +
                                         joint("j", "revolute", "a", "b", "<limit upper=\"2\"/>") +
                                         joint("k", "revolute", "b", "c", "<mimic joint=\"j\"/>"));
  EXPECT_EQ(model.joints[0].lower, 0);
  EXPECT_EQ(model.joints[0].upper, 2);
  EXPECT_TRUE(model.joints[1].mimic) << "a mimic needs no <limit>";
  EXPECT_THAT(
      textsOf(model.notes),
      testing::ElementsAre(
          (folder_ / "r.urdf").string() + ":5: joint \"j\": <limit> has no lower, so it is 0",
          (folder_ / "r.urdf").string() + ":5: joint \"j\": <limit> has no effort, velocity"));
}

TEST_F(UrdfLimits, SoftLimits) {
  const auto safety = [](const std::string& values) {
    return limit + "<safety_controller k_velocity=\"1\" " + values + "/>";
  };
  const std::string parts =
      link("a") + link("b") + link("c") + link("d") + link("e") +
      joint("both", "revolute", "a", "b",
            safety(R"(soft_lower_limit="-0.5" soft_upper_limit="1")")) +
      joint("one", "prismatic", "b", "c", safety(R"(soft_upper_limit="1.5")")) +
      joint("wide", "revolute", "c", "d", safety(R"(soft_lower_limit="-3" soft_upper_limit="3")")) +
      joint("free", "continuous", "d", "e",
            R"(<safety_controller k_velocity="1" soft_lower_limit="0"/>)");
  const RobotDescription hard = modelOf(parts);
  EXPECT_EQ(hard.joints[0].lower, -1);
  EXPECT_EQ(hard.joints[1].upper, 2);
  EXPECT_THAT(textsOf(hard.notes),
              testing::ElementsAre((folder_ / "r.urdf").string() +
                                   ":7: 2 joints are used without the soft limits, which are "
                                   "narrower (limits: soft in robot.yaml applies them): both, "
                                   "one"));
  rules_.softLimits = true;
  const RobotDescription soft = modelOf(parts);
  EXPECT_THAT(textsOf(soft.notes),
              testing::ElementsAre(testing::HasSubstr(
                  "joint \"one\": a soft limit is missing, so the joint's own limit is used")));
  EXPECT_EQ(soft.joints[0].lower, -0.5);
  EXPECT_EQ(soft.joints[0].upper, 1);
  EXPECT_EQ(soft.joints[1].lower, -1);
  EXPECT_EQ(soft.joints[1].upper, 1.5);
  EXPECT_EQ(soft.joints[2].lower, -1);
  EXPECT_EQ(soft.joints[2].upper, 2);
  EXPECT_EQ(soft.joints[3].upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(complaintOfParts(link("a") + link("b") +
                             joint("j", "revolute", "a", "b",
                                   safety(R"(soft_lower_limit="3" soft_upper_limit="x")"))),
            "r.urdf:4: joint \"j\": safety_controller soft_upper_limit: a number is needed, not "
            "\"x\"\n"
            "r.urdf:4: joint \"j\": its soft limits leave no range: from 3 to 2");
}

/// Nothing of a <safety_controller> is dropped, nor are limits in <ros2_control>.
TEST_F(UrdfLimits, LimitsInOtherElements) {
  const auto complaintOn = [&](const std::string& more) {
    return complaintOfParts(link("a") + link("b") + joint("j", "revolute", "a", "b", limit + more));
  };
  const std::string safety = "<safety_controller k_velocity=\"1\" soft_lower_limit=\"-3\"";
  EXPECT_THAT(complaintOn(safety + "/>" + safety + "/>"),
              testing::HasSubstr("joint \"j\": a second <safety_controller>"));
  EXPECT_THAT(complaintOn(safety + ">soft_upper_limit=\"0\"</safety_controller>"),
              testing::HasSubstr("<safety_controller>: the text"));
  for (const char* const control :
       {"<command_interface name=\"position\"><param name=\"min\">-1</param></command_interface>",
        "<state_interface name=\"position\"><param name=\"max\">1</param></state_interface>",
        "<limits enable=\"true\"/>"})
    EXPECT_THAT(textsOf(modelOf(link("a") + link("b") + joint("j", "revolute", "a", "b", limit) +
                                "<ros2_control name=\"c\" type=\"system\"><joint name=\"j\">" +
                                control + "</joint></ros2_control>")
                            .notes),
                testing::ElementsAre((folder_ / "r.urdf").string() +
                                     ":5: limits of joints in <ros2_control> are not used, only "
                                     "those of their <limit>"));
}

TEST_F(UrdfLimits, MimicsInOtherElements) {
  for (const char* const other :
       {"<ros2_control name=\"c\" type=\"system\"><joint name=\"j\"><param name=\"mimic\">k"
        "</param></joint></ros2_control>",
        "<gazebo><plugin name=\"m\" filename=\"libgazebo_mimic_joint_plugin.so\"/></gazebo>",
        "<gazebo><plugin name=\"m\"><mimicJoint>j</mimicJoint></plugin></gazebo>"})
    EXPECT_THAT(
        textsOf(
            modelOf(link("a") + link("b") + joint("j", "revolute", "a", "b", limit) + other).notes),
        testing::ElementsAre(testing::HasSubstr(
            ":5: a joint mimics another in <ros2_control> or <gazebo>, which is not used")));
}

}  // namespace
}  // namespace corridor::test
