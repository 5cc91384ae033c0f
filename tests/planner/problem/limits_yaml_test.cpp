#include "planner/problem/limits_yaml.h"

#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Reads `limits` for an arm with the joints pan (no velocity in the URDF), lift and slide (1
/// rad/s, 1 m/s), and follow, which mimics slide by −1. All of them are planned for.
class LimitsTest : public ArmTest {
 protected:
  void SetUp() override {
    ArmTest::SetUp();
    write("arm.yaml", "format: corridor-robot-1\nname: arm7\nurdf: arm.urdf\n");
    model_ = read(armHead +
                  "start: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 1, lift: 0.3, "
                  "slide: 0.03}\n")
                 .model;
  }

  LimitSpec specOf(const std::string& limits) {
    const YamlValue document = parseYaml("problem.yaml", "limits:\n" + limits);
    FaultList faults("problem.yaml");
    YamlSource source{"problem.yaml", faults, {}};
    const YamlMap map(document, "", nullptr, source);
    std::vector<std::filesystem::path> files;
    LimitSpec spec = readLimits(map, folder_, model_, true, files);
    notes_ = source.notes;
    faults.throwIfAny();
    return spec;
  }
  std::string complaintOfLimits(const std::string& limits) {
    try {
      specOf(limits);
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.string() + '/';
      for (auto at = text.find(prefix); at != text.npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      return text;
    }
    return "no complaint";
  }
  std::string complaintOfFile(const std::string& text) {
    write("joint_limits.yaml", text);
    return complaintOfLimits("  file: joint_limits.yaml\n");
  }

  Model model_;
  std::vector<Note> notes_;
};

TEST_F(LimitsTest, NamedValuesReplaceOthers) {
  const LimitSpec spec = specOf(
      "  default: {velocity: 2, acceleration_deg: 180}\n  slides: {acceleration: 0.5}\n"
      "  joints: {lift: {velocity: 0.4, jerk: 9}, follow: {velocity: 0.1}}\n"
      "  acceleration_scale: 0.5\n");
  const JointLimits limits = limitsOf(model_, spec);
  ASSERT_EQ(limits.velocity.size(), 3);
  EXPECT_EQ(limits.velocity[0], 2);
  EXPECT_EQ(limits.velocity[1], 0.4);
  EXPECT_EQ(limits.velocity[2], 0.1);  // the limit of follow, divided by |−1|
  EXPECT_NEAR(limits.acceleration[0], 1.5707963267948966, 1e-15);
  EXPECT_NEAR(limits.acceleration[1], 1.5707963267948966, 1e-15);
  EXPECT_EQ(limits.acceleration[2], 0.25);
  EXPECT_EQ(limits.jerk[0], kNone);
  EXPECT_EQ(limits.jerk[1], 9);
  EXPECT_TRUE(limits.notes.empty());
}

TEST_F(LimitsTest, AccelerationIsAssumed) {
  const JointLimits limits = limitsOf(model_);
  EXPECT_EQ(limits.acceleration, Configuration(Eigen::Vector3d(1, 1, 1)));
  ASSERT_EQ(limits.notes.size(), 1);
  EXPECT_EQ(limits.notes[0],
            "limits: no acceleration is given for pan, lift, slide; 1 rad/s² or m/s² is assumed");
}

TEST_F(LimitsTest, MoveitFile) {
  write(
      "joint_limits.yaml",
      "default_velocity_scaling_factor: 0.1\ndefault_acceleration_scaling_factor: 0.5\n"
      "joint_limits:\n"
      "  pan: {has_velocity_limits: true, max_velocity: 2.5, has_acceleration_limits: true, "
      "max_acceleration: 3, has_deceleration_limits: true, max_deceleration: -2}\n"
      "  lift: {has_velocity_limits: false, max_velocity: 0, has_jerk_limits: true, max_jerk: 7}\n"
      "  other: {has_velocity_limits: true, max_velocity: 1}\n");
  const LimitSpec spec = specOf("  file: joint_limits.yaml\n  velocity_scale: 0.2\n");
  EXPECT_EQ(spec.velocityScale, 0.2);
  EXPECT_EQ(spec.accelerationScale, 0.5);
  EXPECT_EQ(spec.named.at("pan").velocity, 2.5);
  EXPECT_EQ(spec.named.at("pan").acceleration, 2);
  EXPECT_FALSE(spec.named.at("lift").velocity.has_value());
  EXPECT_EQ(spec.named.at("lift").jerk, 7);
  ASSERT_EQ(notes_.size(), 2);
  EXPECT_THAT(notes_[0].text, testing::EndsWith(": no robot here has the joint \"other\""));
  EXPECT_EQ(notes_[0].weight, NoteWeight::motion);
  EXPECT_EQ(notes_[1].text,
            "the file's default factor makes acceleration_scale 0.5; limits: {acceleration_scale: "
            "1} replaces it");
}

/// Files as drivers ship them: capitals, tags, quotes, soft limits, and keys that MoveIt ignores.
TEST_F(LimitsTest, FilesOfDrivers) {
  write(
      "joint_limits.yaml",
      "joint_limits:\n"
      "  pan: {has_velocity_limits: True, max_velocity: !!float 2, has_acceleration_limits: TRUE, "
      "max_acceleration: '3', max_deceleration: -2, has_soft_limits: true, k_position: 1, "
      "k_velocity: 10, soft_lower_limit: -1, soft_upper_limit: 1}\n"
      "  lift: {has_velocity_limits: true, max_velocity: \"0.5\", has_soft_limits: false, "
      "has_effort_limits: true, max_effort: 100.0}\n");
  const LimitSpec spec = specOf("  file: joint_limits.yaml\n");
  EXPECT_EQ(spec.named.at("pan").velocity, 2);
  EXPECT_EQ(spec.named.at("pan").acceleration, 3);
  EXPECT_EQ(spec.named.at("lift").velocity, 0.5);
  ASSERT_EQ(notes_.size(), 2);
  EXPECT_THAT(notes_[0].text,
              testing::EndsWith("joint_limits.pan.max_deceleration is not used without "
                                "has_deceleration_limits: true (MoveIt's rule)"));
  EXPECT_THAT(notes_[1].text, testing::EndsWith(": soft limits of pan are not used; set bounds in "
                                                "the problem instead"));
}

TEST_F(LimitsTest, MisspeltJointsOfMoveitsFile) {
  write("joint_limits.yaml",
        "joint_limits:\n  pan: {has_velocity_limits: true, max_velocity: 2}\n"
        "  lfit: {has_velocity_limits: true, max_velocity: 2}\n");
  specOf("  file: joint_limits.yaml\n");
  ASSERT_EQ(notes_.size(), 1);
  EXPECT_THAT(notes_[0].text, testing::EndsWith(": no robot here has the joint \"lfit\" (did you "
                                                "mean \"lift\"?)"));
}

/// The forms in which people have MoveIt's file: the plain one, that of launch files, and
/// parameters of ROS 2.
TEST_F(LimitsTest, EveryFormOfMoveitsFile) {
  const std::string limits =
      "default_velocity_scaling_factor: 0.1\n"
      "default_acceleration_scaling_factor: 0.1\n"
      "# Specific joint properties can be changed with the keys [max_position, …]\n"
      "joint_limits:\n"
      "  pan:\n"
      "    has_velocity_limits: true\n"
      "    max_velocity: 2.1750\n"
      "    has_acceleration_limits: false\n"
      "    max_acceleration: 0\n"
      "  lift:\n"
      "    has_velocity_limits: false\n"
      "    max_velocity: 0.0\n"
      "    has_acceleration_limits: true\n"
      "    max_acceleration: 3.75\n"
      "    has_position_limits: false\n";
  const auto indented = [](const std::string& text) {
    std::string all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) all += "  " + line + "\n";
    return all;
  };
  const std::string planning = "robot_description_planning:\n" + indented(limits),
                    parameters = "  ros__parameters:\n";
  for (const std::string& text :
       {limits, planning, "robot_description_semantic: none\n" + planning,
        "/**:\n" + parameters + indented(indented(planning)),
        "/**:\n" + parameters + indented(indented(limits)),
        "/move_group:\n" + parameters + "    use_sim_time: true\n" + indented(indented(planning)),
        "/joint_states:\n" + parameters + "    rate: 50\n/move_group:\n" + parameters +
            indented(indented(planning))}) {
    write("joint_limits.yaml", text);
    SCOPED_TRACE(text);
    const LimitSpec spec = specOf("  file: joint_limits.yaml\n");
    EXPECT_EQ(spec.velocityScale, 0.1);
    EXPECT_EQ(spec.accelerationScale, 0.1);
    EXPECT_EQ(spec.named.at("pan").velocity, 2.175);
    EXPECT_FALSE(spec.named.at("pan").acceleration);
    EXPECT_FALSE(spec.named.at("lift").velocity);
    EXPECT_EQ(spec.named.at("lift").acceleration, 3.75);
    EXPECT_EQ(notes_.size(), 2u);  // on the two factors
  }
  // Limits of Pilz's planner may stand in the same file.
  write("joint_limits.yaml", limits + "cartesian_limits: {max_trans_vel: 1, max_rot_vel: 1.57}\n");
  specOf("  file: joint_limits.yaml\n");
  ASSERT_EQ(notes_.size(), 3u);
  EXPECT_THAT(notes_[0].text,
              testing::HasSubstr("cartesian_limits are not used; set link_speed in the "
                                 "problem instead"));
  EXPECT_THAT(complaintOfFile("/**:\n" + parameters + "    joint_limit: {}\n"),
              testing::HasSubstr("joint_limits.yaml:3: unknown key \"joint_limit\" (did you mean "
                                 "\"joint_limits\"?)"));
}

/// Limits beside those that are read are not dropped.
TEST_F(LimitsTest, TwoSetsOfLimits) {
  const std::string pan = "joint_limits: {pan: {has_velocity_limits: true, max_velocity: 2}}",
                    lift = "joint_limits: {lift: {has_velocity_limits: true, max_velocity: 1}}",
                    why = ": a second joint_limits, which is not read; keep one of them";
  EXPECT_EQ(complaintOfFile("robot_description_planning: {" + pan + "}\n" + lift + "\n"),
            "joint_limits.yaml:2" + why);
  EXPECT_EQ(complaintOfFile("/**: {ros__parameters: {robot_description_planning: {" + pan + "},\n" +
                            lift + "}}\n"),
            "joint_limits.yaml:2" + why);
  EXPECT_EQ(complaintOfFile("/**: {ros__parameters: {" + pan + "}}\n" + lift + "\n"),
            "joint_limits.yaml:2" + why);
  EXPECT_EQ(complaintOfFile("/**: {ros__parameters: {" + pan + "}}\nrobot_description_planning: {" +
                            lift + "}\n"),
            "joint_limits.yaml:2" + why);
}

/// MoveIt reads the factors only beside joint_limits.
TEST_F(LimitsTest, FactorsBesideOtherLimits) {
  write("joint_limits.yaml",
        "robot_description_planning:\n  joint_limits: {pan: {has_velocity_limits: true, "
        "max_velocity: 2}}\ndefault_velocity_scaling_factor: 0.1\n");
  EXPECT_EQ(specOf("  file: joint_limits.yaml\n").velocityScale, 1);
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_THAT(
      notes_[0].text,
      testing::HasSubstr("joint_limits.yaml:3: default_velocity_scaling_factor is not used, "
                         "because it does not stand beside joint_limits"));
}

/// Limits at other places of the file are not dropped in silence.
TEST_F(LimitsTest, LimitsElsewhere) {
  const std::string limits = "joint_limits: {pan: {has_velocity_limits: true, max_velocity: 2}}}";
  const auto notesOn = [&](const std::string& text) {
    notes_.clear();
    write("joint_limits.yaml", text);
    EXPECT_EQ(specOf("  file: joint_limits.yaml\n").named.at("pan").velocity, 2);
    return textsOf(notes_);
  };
  EXPECT_THAT(
      notesOn("robot_description_planning: {" + limits + "\narm: {" + limits + "\n"),
      testing::ElementsAre(testing::HasSubstr(
          "joint_limits.yaml:2: the limits of joints in \"arm.joint_limits\" are not read")));
  EXPECT_THAT(
      notesOn("/**:\n  ros__parameters:\n    robot_description_planning: {" + limits +
              "\n    robot_description_planning.joint_limits.pan.max_velocity: 0.5\n"),
      testing::ElementsAre(testing::HasSubstr("joint_limits.yaml:4: the limits of joints")));
  EXPECT_THAT(
      notesOn("move_group: {ros__parameters: {" + limits +
              "}\nns: {move_group: {ros__parameters: {" + limits + "}}\n"),
      testing::ElementsAre(testing::HasSubstr("joint_limits.yaml:2: the limits of joints")));
}

TEST_F(LimitsTest, PositionsWithoutTheirFlag) {
  const auto notesOn = [&](const std::string& keys) {
    notes_.clear();
    write("joint_limits.yaml",
          "joint_limits: {pan: {has_velocity_limits: true, max_velocity: 2, " + keys + "}}\n");
    specOf("  file: joint_limits.yaml\n");
    return textsOf(notes_);
  };
  EXPECT_THAT(notesOn("max_position: 1"),
              testing::ElementsAre(testing::HasSubstr(": limits of the position of pan are not")));
  EXPECT_THAT(notesOn("soft_lower_limit: 1"),
              testing::ElementsAre(testing::HasSubstr(": soft limits of pan are not used")));
  EXPECT_THAT(notesOn("has_position_limits: false, max_position: 1"), testing::IsEmpty());
}

TEST_F(LimitsTest, LinkSpeedLimitsTheBoxOfTheLink) {
  const JointLimits limits = limitsOf(model_, specOf("  link_speed: {finger: 0.25}\n"));
  ASSERT_EQ(limits.links.size(), 1);
  EXPECT_EQ(limits.links[0].speed, 0.25);
  EXPECT_EQ(model_.tree.frames[limits.links[0].frame].name, "finger");
  EXPECT_EQ(limits.links[0].points.size(), 9);  // the origin and the corners
  EXPECT_EQ(limits.links[0].points[1].cwiseAbs(), Vec3(0.009, 0.009, 0.009));
}

TEST_F(LimitsTest, Faults) {
  EXPECT_EQ(complaintOfLimits("  velocity_scale: 1.5\n"),
            "problem.yaml:2: limits.velocity_scale: at most 1 is needed: it is a share of the "
            "limits");
  EXPECT_THAT(complaintOfLimits("  joints: {lift: {velocity: 0}}\n"),
              testing::HasSubstr("problem.yaml:2: limits.joints.lift.velocity: "));
  EXPECT_THAT(complaintOfLimits("  joints: {lifd: {velocity: 1}}\n"),
              testing::HasSubstr("limits.joints.lifd: no planned joint has this name (did "
                                 "you mean \"lift\"?)"));
  EXPECT_THAT(
      complaintOfLimits("  lift: {velocity: 1}\n"),
      testing::HasSubstr("unknown key \"lift\" in limits (did you mean limits: {joints: {lift: "
                         "{velocity: …}}}?)"));
  EXPECT_EQ(complaintOfLimits("  joints: {slide: {velocity_deg: 1}}\n"),
            "problem.yaml:2: limits.joints.slide.velocity_deg: slide is a length; use velocity, in "
            "metres");
  EXPECT_THAT(complaintOfLimits("  link_speed: {fingr: 1}\n"),
              testing::HasSubstr("limits.link_speed.fingr: there is no link of that name (did you "
                                 "mean \"finger\"?)"));
  EXPECT_EQ(complaintOfLimits("  position: {velocity: 1}\n"),
            "problem.yaml:2: limits.position: there is no rigid body and no planar or floating "
            "joint here; use default or joints");
  EXPECT_THAT(complaintOfLimits("  file: missing.yaml\n"),
              testing::HasSubstr("problem.yaml:2: limits.file: missing.yaml: "));
  EXPECT_EQ(complaintOfFile("joint_limits: {pan: {max_velocity: 2}}\n"),
            "joint_limits.yaml:1: joint_limits.pan.max_velocity: MoveIt ignores this limit without "
            "has_velocity_limits; add has_velocity_limits: true (or false)");
  EXPECT_THAT(
      complaintOfFile("joint_limits: {pan: {has_velocity_limits: true}}\n"),
      testing::HasSubstr(
          "joint_limits.yaml:1: missing key \"max_velocity\" in joint_limits.pan: the limit"));
  EXPECT_EQ(complaintOfFile("joint_limits: {pan2: {has_velocity_limits: true, max_velocity: 1}}\n"),
            "joint_limits.yaml:1: joint_limits: no joint of this file is planned for: pan2");
}

}  // namespace
}  // namespace corridor::test
