#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {
namespace {

/// Pins the complete text of every message about joints, states and robots.
class ArmFaults : public ArmTest {
 protected:
  std::string start(const std::string& value) const {
    return complaintOf(armHead + "start: " + value + "\ngoal: ready\n");
  }
  std::string goal(const std::string& value) const {
    return complaintOf(armHead + "start: ready\ngoal: " + value + "\n");
  }
  std::string with(const std::string& lines) const {
    return complaintOf(armHead + armStates + lines);
  }
  /// Returns the complaint about a robot file with these lines from line 3 on.
  std::string robot(const std::string& lines) const {
    write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\n" + lines);
    return complaintOf(armHead +
                       "start: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 1, lift: 0, "
                       "slide: 0.02}\n");
  }
};

TEST_F(ArmFaults, States) {
  EXPECT_EQ(start("redy"),
            "problem.yaml:5: start: there is no state \"redy\" (did you mean \"ready\"?) (known: "
            "ready)");
  EXPECT_EQ(start("{from: home, pan: 1}"),
            "problem.yaml:5: start.from: there is no state \"home\" (known: ready)");
  EXPECT_EQ(
      start("{pan: 1}"),
      "problem.yaml:5: start: has no value for lift; all joints that are planned for need one");
  EXPECT_EQ(
      start("{pan: 1, lfit: 0}"),
      "problem.yaml:5: start.lfit: there is no joint \"lfit\" (did you mean \"lift\"?) (known: "
      "pan, lift, slide)");
  EXPECT_EQ(
      start("{pan: 1, lift: 0, slide: 0.02, wrist: 1, follow: 0}"),
      "problem.yaml:5: start.slide: is held at 0.01, and not planned for; give it another value by "
      "hold in the robot's file, or plan for it by joints or group\n"
      "problem.yaml:5: start.wrist: is fixed\n"
      "problem.yaml:5: start.follow: follows slide (mimic); give only that joint");
  EXPECT_EQ(start("{pan: 1, lift: 0, slide: 0.01}"), "no complaint") << "its held value";
  EXPECT_THAT(start("{pan: 1, lift: 0, slide: 0.01000001}"),
              testing::HasSubstr("start.slide: is held at 0.01, and not planned for"));
  EXPECT_EQ(start("{pan: 0,5, lift: 0}"),
            "problem.yaml:5: start.5: there is no joint \"5\" (known: pan, lift, slide); decimals "
            "need a point, not a comma");
  EXPECT_EQ(start("{pan: 1, lift: 0, 5: 1}"),
            "problem.yaml:5: start.5: there is no joint \"5\" (known: pan, lift, slide)");
  EXPECT_EQ(start("{pan: 1, lift: 3.2}"),
            "problem.yaml:5: start.lift: 3.2 is outside of its limits, [-3.14159, 3.14159]");
  EXPECT_EQ(start("{pan: 1, pan_deg: 2, lift: 0}"),
            "problem.yaml:5: start.pan_deg: say pan (radians) or pan_deg (degrees), not both");
  EXPECT_EQ(start("{pan: x, lift: 0}"), "problem.yaml:5: start.pan: a number is needed, not \"x\"");
  EXPECT_EQ(start("{pan: 1, slide_deg: 2, lift: 0}"),
            "problem.yaml:5: start.slide_deg: slide is prismatic; use slide, in metres");
  EXPECT_EQ(start("[1, 2]"),
            "problem.yaml:5: start: a named state or joint values, such as {pan: 0.3, lift_deg: "
            "20}, are needed, not a list");
  EXPECT_EQ(complaintOf(armHead + "goal: ready\n"),
            "problem.yaml: missing key \"start\": the robot's joint values at the start, such as "
            "start: ready");
}

TEST_F(ArmFaults, Goals) {
  EXPECT_EQ(goal("[]"),
            "problem.yaml:6: goal: a list of at least one goal is needed, not an empty "
            "one");
  EXPECT_EQ(goal("[ready, redy]"),
            "problem.yaml:6: goal[1]: there is no state \"redy\" (did you mean \"ready\"?) (known: "
            "ready)");
  EXPECT_EQ(goal("[{from: ready, within: {joints: 1}}]"),
            "problem.yaml:6: goal[0].within: several goals share one region; write goal: {any: "
            "[…], within: {…}}");
  EXPECT_EQ(goal("{from: ready, within: {at: 1}}"),
            "problem.yaml:6: goal.within.at: there is no rigid body and no planar or floating "
            "joint here; use joints (rad, or m for prismatic joints)");
}

TEST_F(ArmFaults, Bounds) {
  EXPECT_EQ(with("bounds: {lift: [-4, 1]}\n"),
            "problem.yaml:7: bounds.lift: -4 is outside of its limits, [-3.14159, 3.14159]");
  EXPECT_EQ(
      with("bounds: {lift: [1, -1]}\n"),
      "problem.yaml:7: bounds.lift: the lower bound first, then the upper one: 1 is not below "
      "-1");
  EXPECT_EQ(with("bounds: {lift: [-1e308, 1e308]}\n"),
            "problem.yaml:7: bounds.lift: the range from -1e+308 to 1e+308 is larger than any "
            "double");
  EXPECT_EQ(with("bounds: {slide: [0.02, 0.03]}\n"),
            "problem.yaml:7: bounds.slide: is not planned for; remove its bounds");
  EXPECT_EQ(with("bounds: {pan: [-0.5, 0.5]}\n"),
            "problem.yaml:6: goal.pan: 1 is outside of its limits, [-0.5, 0.5]");
}

TEST_F(ArmFaults, AllowAndTube) {
  EXPECT_EQ(with("allow: [[base, psot]]\n"),
            "problem.yaml:7: allow: there is no body \"psot\" (did you mean \"post\"?) "
            "(known: base, upper, lower, finger, thumb, post)");
  EXPECT_EQ(with("allow: [[base]]\n"),
            "problem.yaml:7: allow: two bodies are needed, as in allow: [[hand, table]], not 1");
  EXPECT_EQ(with("allow: [base, post]\n"),
            "problem.yaml:7: allow: a list of names is needed, as in allow: [[hand, table]], not "
            "\"base\"\n"
            "problem.yaml:7: allow: a list of names is needed, as in allow: [[hand, table]], not "
            "\"post\"");
  EXPECT_EQ(with("allow: base\n"),
            "problem.yaml:7: allow: a list of pairs of bodies is needed, such as [[hand, table]], "
            "not \"base\"");
  EXPECT_EQ(
      complaintOf(
          "format: corridor-problem-1\nrobot: arm.yaml\nworld: {upper: {sphere: 1, at: [0, 0, "
          "9]}}\n" +
          armStates + "allow: [[upper, base]]\n"),
      "problem.yaml:6: allow: \"upper\" names a link and an obstacle; write \"arm7/upper\" or "
      "\"world/upper\"");
  EXPECT_EQ(with("tube: 0.1\n"),
            "problem.yaml:7: tube: a map such as {joints: 0.001} is needed, not \"0.1\"");
  EXPECT_EQ(with("tube: {position: 0.1}\n"),
            "problem.yaml:7: tube.position: there is no rigid body and no planar or floating joint "
            "here; use joints (rad, or m for prismatic joints)");
}

/// Values in radians that are plainly meant in degrees.
TEST_F(ArmFaults, AnglesInDegrees) {
  const auto complaint = [&](const std::string& values) {
    return complaintOf(armHead + "start: {pan: 0, " + values + "}\ngoal: ready\n");
  };
  EXPECT_EQ(complaint("lift: 60"),
            "problem.yaml:5: start.lift: 60 is outside of its limits, [-3.14159, 3.14159]; in "
            "degrees, write lift_deg: 60");
  EXPECT_EQ(complaint("lift: 4"),
            "problem.yaml:5: start.lift: 4 is outside of its limits, [-3.14159, 3.14159]");
  EXPECT_EQ(complaint("lift_deg: 400"),
            "problem.yaml:5: start.lift_deg: 6.981317007977318 is outside of its limits, "
            "[-3.14159, 3.14159]");
  EXPECT_THAT(textsOf(read(armHead + "start: {pan: 90, lift: 0}\ngoal: ready\n").source.notes),
              testing::Contains("start.pan: 90 is read as 2.035405699485789, the same angle up to "
                                "full turns; in degrees, write pan_deg: 90"));
  EXPECT_THAT(complaintOf(armHead + "start: ready\ngoal: {pose: {at: [0, 0, 1]}}\n"),
              testing::HasSubstr("; poses of links are not supported: give the joints' values"));
}

/// Parts of an SRDF that can't be made are faults only if the problem names them.
TEST_F(ArmFaults, PartsOfAnSrdfThatCannotBeMade) {
  std::string text = srdf;
  text.insert(text.find("<disable_collisions"),
              "<group name='torso'><joint name='waist'/></group>\n"
              "<group name='most'><joint name='pan'/><joint name='waist'/></group>\n"
              "<group_state name='odd' group='arm'><joint name='pan' value='x'/></group_state>\n");
  write("arm.srdf", text);
  EXPECT_EQ(start("ready"), "no complaint") << "the problem names none of them";
  EXPECT_EQ(start("odd"),
            "problem.yaml:5: start: the state \"odd\" can't be used: arm.srdf:7: state \"odd\": "
            "joint \"pan\": joint value: a number is needed, not \"x\"");
  EXPECT_EQ(robot("srdf: arm.srdf\ngroup: torso\n"),
            "arm.yaml:4: group: the group \"torso\" can't be used: arm.srdf:5: group \"torso\" has "
            "no joint of this robot: the URDF lacks waist");
  EXPECT_THAT(robot("srdf: arm.srdf\ngroup: most\n"),
              testing::HasSubstr("start.slide: is held at 0.01, and not planned for"))
      << "the group is its joint pan alone";
}

/// A prismatic joint may move a link as far as its limits, so these must not be too large either.
TEST_F(ArmFaults, TravelBeyondAllArithmetic) {
  std::string text = urdf;
  text.replace(text.find("upper='0.05' effort"), 12, "upper='1e155'");
  write("arm.urdf", text);
  write("arm.yaml", "format: corridor-robot-1\nname: a\nurdf: arm.urdf\n");
  EXPECT_EQ(complaintOf(armHead + "start: {pan: 0, lift: 0, slide: 0.02}\n"
                                  "goal: {pan: 1, lift: 0, slide: 0.02}\n"),
            "problem.yaml: frame finger: a coordinate of 1e+155 m is too large; at most 1e+100 m "
            "is allowed\n"
            "problem.yaml: frame thumb: a coordinate of 1e+155 m is too large; at most 1e+100 m "
            "is allowed");
}

TEST_F(ArmFaults, SizesBeyondAllArithmetic) {
  const std::string problem =
      "format: corridor-problem-1\nrobot: arm.yaml\nworld:\n  floor: {box: [1e200, 1, 1]}\n" +
      armStates;
  EXPECT_EQ(complaintOf(problem),
            "problem.yaml: floor: a coordinate of 5e+199 m is too large; at most 1e+100 m is "
            "allowed");
}

TEST_F(ArmFaults, AStateThatSeveralGroupsHave) {
  const auto home = [](const std::string& group, const std::string& joint) {
    return "<group name='" + group + "'><joint name='" + joint +
           "'/></group>\n<group_state name='home' group='" + group + "'><joint name='" + joint +
           "' value='0.02'/></group_state>\n";
  };
  write("two.srdf",
        "<robot name='armbot'>\n" + home("lower", "lift") + home("hand", "slide") + "</robot>\n");
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: two.srdf\njoints: [lift]\n");
  EXPECT_EQ(complaintOf(armHead + "start: home\ngoal: lower/home\n"),
            "problem.yaml:5: start: several groups have a state \"home\"; write the group, too: "
            "hand/home, lower/home");
  EXPECT_EQ(complaintOf(armHead + "start: lower/home\ngoal: lower/home\n"), "no complaint");
}

TEST_F(ArmFaults, RobotFiles) {
  EXPECT_EQ(robot("joints: [pan, lfit, wrist, follow, pan]\n"),
            "arm.yaml:3: joints: there is no joint \"lfit\" (did you mean \"lift\"?) (known: pan, "
            "lift, slide)\n"
            "arm.yaml:3: joints: wrist is fixed\n"
            "arm.yaml:3: joints: follow follows slide (mimic); give only that joint\n"
            "arm.yaml:3: joints: pan is named twice");
  EXPECT_EQ(robot("joints: pan\n"),
            "arm.yaml:3: joints: a list of names is needed, such as [pan, lift], not \"pan\"");
  EXPECT_EQ(robot("group: arm\n"),
            "arm.yaml:3: group: a group needs an SRDF; add srdf: FILE, or use joints: [NAME, …]");
  EXPECT_EQ(robot("srdf: arm.srdf\ngroup: amr\n"),
            "arm.yaml:4: group: there is no group \"amr\" in the SRDF (did you mean \"arm\"?) "
            "(known: arm, nothing)");
  write("bare.srdf", "<robot name='armbot'/>\n");
  EXPECT_EQ(robot("srdf: bare.srdf\ngroup: amr\n"),
            "arm.yaml:4: group: bare.srdf names no group, so there is no \"amr\"; use joints: "
            "[NAME, …]");
  write("other.srdf",
        "<robot name='armbot'><group name='legs'><joint name='hip'/></group></robot>\n");
  EXPECT_EQ(
      robot("srdf: other.srdf\ngroup: arm\n"),
      "arm.yaml:4: group: there is no group \"arm\" in the SRDF, and none of its groups can be "
      "used");
  EXPECT_EQ(robot("srdf: arm.srdf\ngroup: nothing\n"),
            "arm.yaml:4: group: the group \"nothing\" has no joint that can be planned for");
  EXPECT_EQ(robot("srdf: arm.srdf\ngroup: arm\njoints: [pan]\n"),
            "arm.yaml:5: joints: one of group and joints is needed, not both");
  EXPECT_EQ(robot("joints: [pan, lift]\nhold: {pan: 1, slide: 2, wirst: 0, follow: 1}\n"),
            "arm.yaml:4: hold.slide: 2 is outside of its limits, [0.01, 0.05]\n"
            "arm.yaml:4: hold.wirst: there is no joint \"wirst\" (known: pan, lift, slide)\n"
            "arm.yaml:4: hold.follow: follows slide (mimic); give only that joint\n"
            "arm.yaml:4: hold: pan is planned for, and can't be held; remove it from hold");
  EXPECT_EQ(
      robot("states: {home: {pna: 1}}\nallow: [[base, hand]]\nweights: {joints: {tilt: 1, "
            "pan: 0}}\n"),
      "arm.yaml:3: states.home.pna: there is no joint \"pna\" (did you mean \"pan\"?) (known: "
      "pan, lift, slide)\n"
      "arm.yaml:4: allow: there is no link \"hand\" (known: base, upper, lower, flange, finger, "
      "thumb)\n"
      "arm.yaml:5: weights.joints.tilt: there is no joint \"tilt\" (known: pan, lift, slide)\n"
      "arm.yaml:5: weights.joints.pan: must be above 0, not 0");
  EXPECT_EQ(robot("srdf: gone.srdf\npackages: {a: gone}\nreference: centroid\n"),
            "arm.yaml:3: srdf: gone.srdf: no such file\n"
            "arm.yaml:4: packages.a: gone: no such folder\n"
            "arm.yaml:5: reference: is for rigid robots; this one's shapes are in its URDF");
  EXPECT_EQ(robot("rigid: SE3\n"),
            "arm.yaml:2: urdf: one of rigid and urdf is needed, and rigid is given already; leave "
            "one out");
  write("statue.urdf", "<robot name='statue'><link name='stone'/></robot>");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: statue.urdf\nstart: {}\ngoal: {}\n"),
            "statue.urdf: has no joint that can be planned for; for a vehicle, add a planar or "
            "floating joint on an empty link to the URDF, or use rigid: SE3 in a robot.yaml");
}

TEST_F(ArmFaults, RobotsThatCannotMove) {
  const auto stiff = [](const std::string& name, const std::string& child,
                        const std::string& limit) {
    return "<link name='" + child + "'/>" +
           joint(name, "revolute", "stone", child,
                 "<limit lower='" + limit + "' upper='" + limit + "' effort='1' velocity='1'/>");
  };
  const std::string problem =
      "format: corridor-problem-1\nrobot: stiff.urdf\nstart: {}\ngoal: {}\n";
  const std::string begin = "<robot name='stiff'><link name='stone'/>";
  write("stiff.urdf", begin + stiff("j1", "a", "0") + stiff("j2", "b", "0") + "</robot>");
  EXPECT_EQ(complaintOf(problem),
            "stiff.urdf: has no joint that can be planned for: j1, j2: lower = upper = 0");
  write("stiff.urdf", begin + stiff("j1", "a", "0") + stiff("j2", "b", "0.5") + "</robot>");
  EXPECT_EQ(complaintOf(problem),
            "stiff.urdf: has no joint that can be planned for: j1, j2: lower = upper");
  EXPECT_EQ(robot("hold: {pan: 0, lift: 0, slide: 0.02}\n"),
            "arm.yaml:2: urdf: has no joint that can be planned for, except those in hold");
}

TEST_F(ArmFaults, SeveralRobots) {
  const std::string two =
      "format: corridor-problem-1\nrobots: {left: {file: arm.yaml}, right: {file: arm.yaml}}\n";
  EXPECT_EQ(
      complaintOf(two + "start: {left: ready}\ngoal: ready\n"),
      "problem.yaml:3: missing key \"right\" in start: where this robot is\n"
      "problem.yaml:4: goal: a map from robot names to states is needed, such as {left: …}, not "
      "\"ready\"");
  EXPECT_EQ(
      complaintOf(two + "start: {left: ready, rihgt: ready}\ngoal: {left: ready, right: redy}\n"),
      "problem.yaml:3: unknown key \"rihgt\" in start (did you mean \"right\"?) (known: left, "
      "right)\n"
      "problem.yaml:4: goal.right: there is no state \"redy\" (did you mean \"ready\"?) (known: "
      "ready)");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobots: {left: {file: gone.yaml}, a/b: {base: "
                        "{at: [0, 0, 0]}}}\nbase: {at: [0, 0, 0]}\nrobot: arm.yaml\n"),
            "problem.yaml:2: robots: one of robot and robots is needed, and robot is given "
            "already; leave one out");
  EXPECT_EQ(
      complaintOf("format: corridor-problem-1\nrobots: {left: {file: gone.yaml}, a/b: {base: "
                  "{at: [0, 0, 0]}}}\nbase: {at: [0, 0, 0]}\nworld: {a: {sphere: 1}}\n"),
      "problem.yaml:2: robots.left.file: gone.yaml: no such file\n"
      "problem.yaml:2: robots.a/b: can't be the name of a robot\n"
      "problem.yaml:2: missing key \"file\" in robots.a/b: the robot's file, such as file: "
      "../../robots/arm6/robot.yaml\n"
      "problem.yaml:3: base: each of several robots has its own: robots: {left: {file: …, base: "
      "…}}");
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nweights: {rotation: 0}\n");
  EXPECT_EQ(complaintOf(two + "start: {left: ready}\ngoal: ready\nworld: {a: {sphere: 1}}\n"),
            "arm.yaml:3: weights.rotation: must be above 0, not 0")
      << "a file that is named twice is faulted once";
}

}  // namespace
}  // namespace corridor::test
