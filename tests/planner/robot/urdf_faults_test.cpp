#include <console_bridge/console.h>
#include <tinyxml2.h>

#include "collision/core/spelling.h"
#include "planner/robot/urdfdom.h"
#include "tests/planner/robot/urdf_fixture.h"

namespace corridor::test {
namespace {

class UrdfFaults : public UrdfTest {
 protected:
  /// Returns the faults of two links and a joint on line 4.
  std::string complaintOfJoint(const std::string& type, const std::string& content) {
    return complaintOfParts(link("a") + link("b") + joint("j", type, "a", "b", content));
  }
  /// Returns the faults of a collision element on line 2.
  std::string complaintOfCollision(const std::string& content) {
    return complaintOfParts(link("a", "<collision>" + content + "</collision>"));
  }
  std::string complaintOfShape(const std::string& shape) {
    return complaintOfParts(link("a", collision(shape)));
  }
};

TEST_F(UrdfFaults, Files) {
  std::vector<Fault> faults;
  EXPECT_FALSE(readUrdf(folder_ / "none.urdf", {}, faults, files_));
  EXPECT_EQ(textOf(faults), "none.urdf: no such file");
  EXPECT_EQ(complaintOf(" \n"), "r.urdf: is empty; a robot (URDF) is needed");
  EXPECT_EQ(complaintOf(std::string("<robot>\n\0", 9)),
            "r.urdf:2: is not text: it has a byte 0; UTF-8 is needed");
  EXPECT_EQ(complaintOf("<robot name=\"r\">\n<link name=\"a\">\n</robot>\n"),
            "r.urdf:2: is not valid XML: the element that begins here has no end tag of its own "
            "name");
  EXPECT_EQ(complaintOf("<robot name=\"r\">\n<link name=a/>\n</robot>\n"),
            "r.urdf:2: is not valid XML: an attribute cannot be read; name=\"value\" is needed");
  EXPECT_EQ(complaintOf("<!DOCTYPE robot [\n<!ATTLIST origin xyz CDATA \"1 0 0\">]>\n<robot/>"),
            "r.urdf:1: a DOCTYPE with declarations is not read; save the file without it");
  EXPECT_EQ(complaintOf("<!DOCTYPE robot SYSTEM \"a>b\" [<!ATTLIST origin xyz CDATA \"1 0 0\">]>\n"
                        "<robot/>"),
            "r.urdf:1: a DOCTYPE with declarations is not read; save the file without it");
  EXPECT_EQ(complaintOf("<!DOCTYPE robot PUBLIC \"it's\" 'x><robot/><!--'><robot/><!-- -->"),
            "r.urdf:1: a DOCTYPE with declarations is not read; save the file without it");
  EXPECT_EQ(complaintOf("<!-- nothing -->"),
            "r.urdf: <robot> is missing; a robot (URDF) is needed");
  EXPECT_EQ(complaintOf("<?xml version=\"1.0\"?>\n<mujoco/>"),
            "r.urdf:2: the root element is <mujoco>, not <robot>; a robot (URDF) is needed");
  EXPECT_EQ(complaintOf("<robot name=\"r\"><link name=\"a\"/></robot>\n<robot name=\"s\"/>\n"),
            "r.urdf:2: another element follows </robot>; only one root is allowed");
  EXPECT_EQ(complaintOf("<robot/>"),
            "r.urdf:1: <robot> has no name\nr.urdf:1: the robot has no <link>; at least one is "
            "needed");
  EXPECT_EQ(complaintOfParts("<group name=\"arm\"><joint name=\"j\"/></group>"),
            "r.urdf:1: the robot has no <link>; it seems to be an SRDF, not a URDF");
  EXPECT_EQ(complaintOf("<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"b\">\n"),
            "r.urdf:3: is not valid XML: text, an element or an end tag is misplaced; there is no "
            "</robot>, so the file may end early");
  EXPECT_EQ(complaintOf("<robot name=r/>\n"),
            "r.urdf:1: is not valid XML: an attribute cannot be read; name=\"value\" is needed");
  EXPECT_EQ(complaintOfParts(link("a", "\n<xacro:if value=\"1\"/>\n")),
            "r.urdf:3: <xacro:if>: this is a xacro file; expand it first: xacro FILE > "
            "robot.urdf");
}

TEST_F(UrdfFaults, Names) {
  EXPECT_EQ(complaintOfParts("<link/>\n<joint/>"),
            "r.urdf:2: <link> has no name\n"
            "r.urdf:3: <joint> has no name\n"
            "r.urdf:3: joint \"\": <joint> has no type\n"
            "r.urdf:3: joint \"\": <parent link=\"…\"/> is missing\n"
            "r.urdf:3: joint \"\": <child link=\"…\"/> is missing");
  EXPECT_EQ(complaintOfParts(link("a") + link("b") + link("a") + joint("j", "fixed", "a", "b") +
                             joint("j", "fixed", "a", "b")),
            "r.urdf:4: link \"a\" is already defined on line 2; names must be unique\n"
            "r.urdf:6: joint \"j\" is already defined on line 5; names must be unique");
  // The child of a joint that was left out isn't reported as a second root.
  EXPECT_EQ(complaintOfParts(link("a") + link("b") + link("c") + joint("j", "fixed", "a", "b") +
                             joint("j", "fixed", "b", "c")),
            "r.urdf:6: joint \"j\" is already defined on line 5; names must be unique");
}

TEST_F(UrdfFaults, Trees) {
  EXPECT_EQ(complaintOfParts(link("base") + link("hand") + joint("j", "fixed", "bse", "hnd") +
                             joint("k", "fixed", "elsewhere", "hand")),
            "r.urdf:4: joint \"j\": its parent \"bse\" is not a link of this robot (did you mean "
            "\"base\"?)\n"
            "r.urdf:4: joint \"j\": its child \"hnd\" is not a link of this robot (did you mean "
            "\"hand\"?)\n"
            "r.urdf:5: joint \"k\": its parent \"elsewhere\" is not a link of this robot");
  EXPECT_EQ(complaintOfParts(link("a") + link("b") + joint("j", "fixed", "a", "a")),
            "r.urdf:4: joint \"j\": its parent and its child are the same link \"a\"");
  EXPECT_EQ(complaintOfParts(link("a") + link("b") + link("c") + joint("j", "fixed", "a", "c") +
                             joint("k", "fixed", "b", "c")),
            "r.urdf:6: joint \"k\": its child \"c\" is already the child of joint \"j\" on line "
            "5; a link can have only one parent");
  EXPECT_EQ(
      complaintOfParts(link("a") + link("b") + link("c") + joint("j", "fixed", "a", "c")),
      "r.urdf:3: link \"b\" is not a child of any joint, and neither is \"a\" on line 2; a robot "
      "can have only one root");
  // First a cycle of links beside the root, which urdfdom accepts; then a cycle without any root.
  EXPECT_EQ(complaintOfParts(link("a") + link("b") + link("c") + link("d") +
                             joint("i", "fixed", "c", "d") + joint("j", "fixed", "b", "c") +
                             joint("k", "fixed", "c", "b")),
            "r.urdf:7: the links b, c, b form a cycle; a tree is needed");
  EXPECT_EQ(complaintOfParts(link("a") + link("b") + joint("j", "fixed", "a", "b") +
                             joint("k", "fixed", "b", "a")),
            "r.urdf:4: the links a, b, a form a cycle; a tree is needed");
}

TEST_F(UrdfFaults, HintsOnlyForTheFirstHundredFaults) {
  std::string parts = link("base");
  for (int i = 0; i < 101; ++i) parts += joint("j" + std::to_string(i), "fixed", "bse", "base");
  const std::string text = complaintOfParts(parts);
  const std::string line = "its parent \"bse\" is not a link of this robot";
  EXPECT_THAT(text, testing::HasSubstr("joint \"j99\": " + line + " (did you mean \"base\"?)\n"));
  EXPECT_THAT(text, testing::EndsWith("joint \"j100\": " + line));
}

TEST_F(UrdfFaults, LongCyclesListTheirFirstJoints) {
  std::string parts = link("l0");
  for (int i = 0; i < 40; ++i) {
    parts += link("l" + std::to_string(i + 1));
    parts += joint("j" + std::to_string(i), "revolute", "l" + std::to_string(i),
                   "l" + std::to_string(i + 1),
                   limit + "<mimic joint=\"j" + std::to_string((i + 1) % 40) + "\"/>");
  }
  EXPECT_THAT(
      complaintOfParts(parts),
      testing::MatchesRegex("r.urdf:4: the joints j0, j1, .*, j28, j29 and 11 more mimic each "
                            "other in a cycle"));
}

TEST_F(UrdfFaults, Joints) {
  EXPECT_EQ(complaintOfJoint("revolut", limit),
            "r.urdf:4: joint \"j\": unknown type \"revolut\" (did you mean \"revolute\"?)");
  EXPECT_EQ(complaintOfJoint("ball", limit),
            "r.urdf:4: joint \"j\": unknown type \"ball\"; one of fixed, revolute, continuous, "
            "prismatic, planar, floating is needed");
  EXPECT_EQ(complaintOfJoint("revolute", ""),
            "r.urdf:4: joint \"j\": <limit lower=\"…\" upper=\"…\"/> is missing; a joint without "
            "limits is of type continuous");
  EXPECT_EQ(complaintOfJoint("prismatic", ""),
            "r.urdf:4: joint \"j\": <limit lower=\"…\" upper=\"…\"/> is missing");
  EXPECT_EQ(complaintOfJoint("revolute", R"(<limit lower="1" upper="-1"/>)"),
            "r.urdf:4: joint \"j\": the lower limit 1 is above the upper limit -1");
  EXPECT_EQ(complaintOfJoint("revolute", R"(<limit lower="1" effort="0" velocity="0"/>)"),
            "r.urdf:4: joint \"j\": the lower limit 1 is above the upper limit 0");
  EXPECT_EQ(complaintOfJoint("prismatic", R"(<limit lower="-1e308" upper="1e308"/>)"),
            "r.urdf:4: joint \"j\": the range from -1e+308 to 1e+308 is larger than any double");
  EXPECT_EQ(complaintOfJoint("continuous", R"(<axis xyz="0 0 0"/>)"),
            "r.urdf:4: joint \"j\": the axis is zero; a direction is needed, such as xyz=\"0 0 "
            "1\"");
  EXPECT_EQ(complaintOfJoint("planar", "<axis/>"), "r.urdf:4: joint \"j\": <axis> has no xyz");
  EXPECT_EQ(
      complaintOfJoint("fixed", "<origin/>\n<origin/>"),
      "r.urdf:5: joint \"j\": a second <origin>; the first is on line 4; only one is allowed");
  EXPECT_EQ(complaintOfParts(link("a") + link("b") +
                             "<joint name=\"j\" type=\"fixed\"><parent/></joint>"),
            "r.urdf:4: joint \"j\": <parent> has no link\n"
            "r.urdf:4: joint \"j\": <child link=\"…\"/> is missing");
}

TEST_F(UrdfFaults, Numbers) {
  const auto origin = [&](const std::string& xyz) {
    return complaintOfJoint("fixed", "<origin\nxyz=\"" + xyz + "\"/>");
  };
  const std::string head = "r.urdf:5: joint \"j\": origin xyz: ";
  EXPECT_EQ(origin("0 0"), head + "3 numbers are needed, not \"0 0\"");
  EXPECT_EQ(origin("0 0 0 0"), head + "3 numbers are needed, not \"0 0 0 0\"");
  EXPECT_EQ(origin("0 0 1.0abc"), head + "a number is needed, not \"1.0abc\"");
  EXPECT_EQ(origin("0 0 1,5"), head + "a number is needed, not \"1,5\"");
  EXPECT_EQ(origin("0 0 0x10"), head + "a number is needed, not \"0x10\"");
  EXPECT_EQ(origin("0 nan 0"), head + "a finite number is needed, not \"nan\"");
  EXPECT_EQ(origin("0 -inf 0"), head + "a finite number is needed, not \"-inf\"");
  EXPECT_EQ(origin("0 1e999 0"), head + "a finite number is needed, not \"1e999\"");
  EXPECT_EQ(origin("\t0 +1.5e0\n1e-999 "), "no complaint");
  EXPECT_EQ(
      complaintOfJoint("revolute", R"(<limit lower="a" upper="1 2" effort="" velocity="fast"/>)"),
      "r.urdf:4: joint \"j\": limit lower: a number is needed, not \"a\"\n"
      "r.urdf:4: joint \"j\": limit upper: a number is needed, not \"1 2\"\n"
      "r.urdf:4: joint \"j\": limit velocity: a number is needed, not \"fast\"");
  EXPECT_EQ(complaintOfJoint("continuous", R"(<limit effort="1" velocity="-2"/>)"),
            "r.urdf:4: joint \"j\": its velocity must not be below 0, but is -2");
}

TEST_F(UrdfFaults, Mimics) {
  const auto complaint = [&](const std::string& leader, const std::string& follower,
                             const std::string& mimic) {
    const std::string limits = leader == "continuous" ? "" : limit;
    return complaintOfParts(link("a") + link("b") + link("c") +
                            joint("pan", leader, "a", "b", limits) +
                            joint("tilt", follower, "b", "c", limit + "\n<mimic " + mimic + "/>"));
  };
  EXPECT_EQ(complaint("revolute", "revolute", ""),
            "r.urdf:7: joint \"tilt\": <mimic> has no joint");
  EXPECT_EQ(complaint("revolute", "revolute", R"(joint="tilt")"),
            "r.urdf:7: joint \"tilt\" mimics itself");
  EXPECT_EQ(complaint("revolute", "revolute", R"(joint="pam" multiplier="x")"),
            "r.urdf:7: joint \"tilt\": mimic multiplier: a number is needed, not \"x\"");
  EXPECT_EQ(complaint("revolute", "floating", R"(joint="pan")"),
            "r.urdf:7: joint \"tilt\" is floating, and only a joint of one variable can mimic "
            "another");
  EXPECT_EQ(complaint("continuous", "revolute", R"(joint="pan" multiplier="0.5")"),
            "r.urdf:7: joint \"tilt\" mimics \"pan\", which is continuous and repeats after a "
            "full turn, by the multiplier 0.5; use a whole multiplier or a revolute \"pan\"");
  EXPECT_EQ(complaint("continuous", "prismatic", R"(joint="pan")"),
            "r.urdf:7: joint \"tilt\" is prismatic and mimics \"pan\", which is continuous and "
            "repeats after a full turn; change the type of one of them");
  EXPECT_EQ(complaint("continuous", "revolute", R"(joint="pan" multiplier="-2")"), "no complaint");
  EXPECT_EQ(complaintOfParts(link("a") + link("b") + link("c") + link("d") +
                             joint("j", "revolute", "a", "b", limit + "<mimic joint=\"k\"/>") +
                             joint("k", "revolute", "b", "c", limit + "<mimic joint=\"l\"/>") +
                             joint("l", "revolute", "c", "d", limit + "<mimic joint=\"k\"/>")),
            "r.urdf:7: the joints k, l, k mimic each other in a cycle");
}

/// The joint f mimics c, and c would mimic a joint that the file lacks. So c counts as a joint
/// without mimic, and f must keep the rules for a joint that mimics c.
TEST_F(UrdfFaults, MimicsBehindALostLeader) {
  const auto complaint = [&](const std::string& c, const std::string& f,
                             const std::string& multiplier) {
    const std::string limits = c == "continuous" ? "" : limit;
    return complaintOfParts(
        link("l") + link("m") + link("n") +
        joint("c", c, "l", "m", limits + "<mimic joint=\"x\"/>") +
        joint("f", f, "m", "n", limit + "<mimic joint=\"c\" multiplier=\"" + multiplier + "\"/>"));
  };
  EXPECT_EQ(complaint("revolute", "revolute", "0.5"), "no complaint");
  EXPECT_EQ(complaint("continuous", "revolute", "0.5"),
            "r.urdf:6: joint \"f\" mimics \"c\", which is continuous and repeats after a full "
            "turn, by the multiplier 0.5; use a whole multiplier or a revolute \"c\"");
  EXPECT_EQ(complaint("continuous", "prismatic", "1"),
            "r.urdf:6: joint \"f\" is prismatic and mimics \"c\", which is continuous and repeats "
            "after a full turn; change the type of one of them");
  EXPECT_EQ(complaint("planar", "revolute", "1"),
            "r.urdf:5: joint \"c\" is planar, and only a joint of one variable can mimic another");
  EXPECT_EQ(
      complaint("revolute", "floating", "1"),
      "r.urdf:6: joint \"f\" is floating, and only a joint of one variable can mimic another");
}

TEST_F(UrdfFaults, AJointWithoutLeaderNeedsLimitsOfItsOwn) {
  const auto complaint = [&](const std::string& content) {
    return complaintOfParts(link("l") + link("m") +
                            joint("c", "revolute", "l", "m", content + "<mimic joint=\"x\"/>"));
  };
  const std::string lacking =
      "r.urdf:4: joint \"c\" mimics \"x\", which is not a joint of this robot; and it has no lower "
      "or upper limit with which it could be used as a joint of its own";
  EXPECT_EQ(complaint(""), lacking);
  EXPECT_EQ(complaint(R"(<limit effort="1" velocity="1"/>)"), lacking);
  EXPECT_EQ(complaint(R"(<limit lower="2" upper="1"/>)"),
            "r.urdf:4: joint \"c\": the lower limit 2 is above the upper limit 1");
  EXPECT_EQ(complaint(R"(<limit lower="1" upper="2"/>)"), "no complaint");
}

TEST_F(UrdfFaults, ChainsOfMimicsBeyondDoubles) {
  EXPECT_EQ(
      complaintOfParts(
          link("a") + link("b") + link("c") + link("d") + joint("j", "revolute", "a", "b", limit) +
          joint("k", "revolute", "b", "c", "<mimic joint=\"j\" multiplier=\"1e200\"/>") +
          joint("l", "revolute", "c", "d", "<mimic joint=\"k\" multiplier=\"-1e200\"/>")),
      "r.urdf:8: joint \"l\" mimics \"j\" by a multiplier of -inf and an offset of 0, which "
      "is out of the range of doubles");
}

TEST_F(UrdfFaults, Geometry) {
  const std::string of = "r.urdf:2: link \"a\": ";
  EXPECT_EQ(complaintOfCollision(""),
            of + "<collision> has no <geometry>; <box>, <cylinder>, <sphere> or <mesh> is needed");
  EXPECT_EQ(complaintOfShape(""),
            of + "<geometry> is empty; <box>, <cylinder>, <sphere> or <mesh> is needed");
  EXPECT_EQ(complaintOfShape("<spher radius=\"1\"/>"),
            of + "unknown geometry <spher> (did you mean <sphere>?)");
  EXPECT_EQ(complaintOfShape("<torus/>"),
            of + "unknown geometry <torus>; <box>, <cylinder>, <capsule>, <sphere> or <mesh> is "
                 "needed");
  EXPECT_EQ(complaintOfShape("<capsule radius=\"1\"/>"), of + "<capsule> has no length");
  EXPECT_EQ(complaintOfShape("<capsule radius=\"0\" length=\"1\"/>"),
            of + "capsule radius must be above 0, not 0");
  EXPECT_EQ(complaintOfShape("<sphere radius=\"1\"/>\n<sphere radius=\"2\"/>"),
            "r.urdf:3: link \"a\": a second shape in one <geometry>; it needs a <collision> of "
            "its own");
  EXPECT_EQ(complaintOfShape("<box/>"), of + "<box> has no size");
  EXPECT_EQ(complaintOfShape("<box size=\"1 2\"/>"),
            of + "box size: 3 numbers are needed, not \"1 2\"");
  EXPECT_EQ(complaintOfShape("<box size=\"1 0 2\"/>"), of + "box size must be above 0, not 1 0 2");
  EXPECT_EQ(complaintOfShape("<cylinder radius=\"-1\"/>"),
            of + "cylinder radius must be above 0, not -1\n" + of + "<cylinder> has no length");
  EXPECT_EQ(complaintOfShape("<mesh/>"), of + "<mesh> has no filename");
  EXPECT_EQ(complaintOfShape("<mesh filename=\"wedge.obj\" scale=\"1 0 1\"/>"),
            of + "mesh scale must not be 0, which makes the mesh flat");
  EXPECT_EQ(complaintOfShape("<mesh filename=\"wedge.obj\" scale=\"1e300 1 1e300\"/>"),
            "no complaint");
  EXPECT_EQ(complaintOfShape("<mesh filename=\"wedge.obj\" scale=\"1 1 1e308\"/>"),
            "r.urdf:2: shape \"a\": its origin, size or scale is out of the range of doubles");
}

TEST_F(UrdfFaults, ElementsThatWouldBeIgnored) {
  const std::string of = "r.urdf:2: link \"a\": ",
                    move = "; move it into the <collision> of its link, or remove it";
  EXPECT_EQ(complaintOfParts(link("a", "<colision/>") + "<lnk name=\"b\"/>"),
            of + "<colision> is not known (did you mean <collision>?)\n"
                 "r.urdf:3: robot \"r\": <lnk> is not known (did you mean <link>?)");
  EXPECT_EQ(
      complaintOfParts(link("a", "<group>" + collision("<box size=\"1 1 1\"/>") + "</group>")),
      of + "<group> is not known, and the collision geometry in it would be lost" + move);
  EXPECT_EQ(
      complaintOfParts(link("a") + collision("<box size=\"1 1 1\"/>")),
      "r.urdf:3: robot \"r\": <collision> is not known, and the collision geometry in it would "
      "be lost" +
          move);
  EXPECT_EQ(
      complaintOfParts(link("a",
                            "<collision_model><geometry><box size=\"1 1 1\"/></geometry>"
                            "</collision_model>")),
      of + "<collision_model> is not known, and the collision geometry in it would be lost" + move);
  EXPECT_EQ(complaintOfParts(link("a", "<self_filter><geometry/></self_filter>")), "no complaint")
      << "other geometry is for other programs";
  EXPECT_EQ(
      complaintOfCollision("<orgin xyz=\"1 0 0\"/><geometry><box size=\"1 1 1\"/></geometry>"),
      of + "<orgin> is not known (did you mean <origin>?)");
  EXPECT_EQ(complaintOfShape("<mesh filename=\"wedge.obj\" scael=\"2 2 2\"/>"),
            of + "mesh: scael is not known (did you mean \"scale\"?)");
  EXPECT_EQ(complaintOfJoint("fixed", "<origin xyz=\"0 0 1\" ryp=\"0 0 1\"/>"),
            "r.urdf:4: joint \"j\": origin: ryp is not known (did you mean \"rpy\"?)");
  EXPECT_EQ(complaintOfJoint("fixed", "<origin quat_xyzw=\"0 0 0 1\"/>"),
            "r.urdf:4: joint \"j\": origin quat_xyzw is not supported; use rpy");
  EXPECT_EQ(complaintOfJoint("continuous", "<axes xyz=\"0 0 1\"/>"),
            "r.urdf:4: joint \"j\": <axes> is not known (did you mean <axis>?)");
  EXPECT_EQ(complaintOfJoint("revolute", R"(<limit lowr="-1" upper="2" effort="0" velocity="0"/>)"),
            "r.urdf:4: joint \"j\": limit: lowr is not known (did you mean \"lower\"?)");
}

TEST_F(UrdfFaults, MeshFiles) {
  const auto complaint = [&](const std::string& name) {
    return complaintOfShape("<mesh filename=\"" + name + "\"/>");
  };
  const std::string of = "r.urdf:2: link \"a\": mesh ";
  EXPECT_EQ(complaint("none.stl"), of + "\"none.stl\": none.stl: no such file");
  EXPECT_EQ(complaint("package://none.stl"),
            of + "\"package://none.stl\": package://NAME/FILE is needed");
  EXPECT_EQ(complaint("package:///"), of + "\"package:///\": package://NAME/FILE is needed");
  EXPECT_EQ(complaint("package:////none/a.stl"),
            of + "\"package:////none/a.stl\": package://NAME/FILE is needed");
  EXPECT_THAT(
      complaint("package://a_package_of_a_very_very_long_name/meshes/collision/left/link5.stl"),
      testing::StartsWith(of + "\"…/meshes/collision/left/link5.stl\": "));
  EXPECT_EQ(complaint("file://none.stl"),
            of + "\"file://none.stl\": file:///FOLDER/FILE is needed");
  EXPECT_EQ(complaint("http://x.org/a.stl"),
            of + "\"http://x.org/a.stl\": a file beside the URDF, package://NAME/FILE or "
                 "file:///FILE is needed");
  rules_.packages["arm_description"] = folder_;
  EXPECT_EQ(complaint("package://arm_description/none.stl"),
            of + "\"package://arm_description/none.stl\": none.stl: no such file");
  EXPECT_EQ(
      complaint("package://arm_descripton/a.stl"),
      of + "\"package://arm_descripton/a.stl\": arm_descripton/a.stl is not a file, and "
           "no folder of package \"arm_descripton\" was found (did you mean \"arm_description\"?)");
  std::filesystem::create_directories(folder_ / "claw");
  EXPECT_EQ(
      complaint("package://claw/a.stl"),
      of + "\"package://claw/a.stl\": package \"claw\" is found at " + "claw, but has no a.stl");
  EXPECT_EQ(
      complaint("package://hand/a.stl"),
      of + "\"package://hand/a.stl\": hand/a.stl is not a file, and no folder of package \"hand\" "
           "was found; add packages: {hand: FOLDER} to robot.yaml, or set ROS_PACKAGE_PATH or "
           "AMENT_PREFIX_PATH");
  // A missing package is reported once.
  EXPECT_EQ(
      complaintOfParts(link("a", collision("<mesh filename=\"package://hand/a.stl\"/>") +
                                     collision("<mesh filename=\"package://hand/b.stl\"/>") +
                                     collision("<mesh filename=\"package://foot/b.stl\"/>"))),
      of +
          "\"package://hand/a.stl\": hand/a.stl is not a file, and no folder of package \"hand\" "
          "was found; add packages: {hand: FOLDER} to robot.yaml, or set ROS_PACKAGE_PATH or "
          "AMENT_PREFIX_PATH\n" +
          of +
          "\"package://foot/b.stl\": foot/b.stl is not a file, and no folder of package \"foot\" "
          "was found; add packages: {foot: FOLDER} to robot.yaml, or set "
          "ROS_PACKAGE_PATH or AMENT_PREFIX_PATH");
  // An unreadable mesh file is reported once, at the place where the URDF names it first.
  write("bad.obj", "v 0 0 0\nv 1 0 nan\n");
  EXPECT_EQ(complaintOfParts(link("a", collision("<mesh filename=\"bad.obj\"/>") +
                                           collision("<mesh filename=\"bad.obj\"/>")) +
                             link("b")),
            of + "\"bad.obj\": bad.obj:2: coordinate \"nan\" is not finite\n"
                 "r.urdf:3: link \"b\" is not a child of any joint, and neither is \"a\" on line "
                 "2; a robot can have only one root");
  write("worse.obj", "v 0 0 0\nv 1 0 nan\nv 1 0 inf\n");
  EXPECT_EQ(complaint("worse.obj"),
            of + "\"worse.obj\": worse.obj:2: coordinate \"nan\" is not finite (and 1 more)");
  std::filesystem::create_directory(folder_ / "folder.stl");
  EXPECT_EQ(complaint("folder.stl"),
            of + "\"folder.stl\": folder.stl: is a folder; a file is needed");
}

/// Corridor takes only shapes and frames from urdfdom, which stays quiet and leaves no trace.
TEST_F(UrdfFaults, UrdfdomsErrorsAreReturned) {
  class Other final : public console_bridge::OutputHandler {
    void log(const std::string&, console_bridge::LogLevel, const char*, int) override { ++lines; }

   public:
    int lines = 0;
  } other;
  console_bridge::useOutputHandler(&other);
  const auto level = console_bridge::getLogLevel();
  const auto errorsOf = [](const std::string& text) {
    tinyxml2::XMLDocument document;
    document.Parse(text.c_str());
    std::vector<std::string> errors;
    EXPECT_EQ(parseByUrdfdom(*document.RootElement(), errors), nullptr);
    return joined(errors);
  };
  const std::string wrong =
      "<robot name='r'><link name='b'/><link name='a%s%n'><collision/></link></robot>";
  EXPECT_THAT(errorsOf(wrong),
              testing::HasSubstr("Could not parse collision element for Link [a?s?n]"));
  EXPECT_EQ(console_bridge::getOutputHandler(), &other);
  EXPECT_EQ(console_bridge::getLogLevel(), level);
  EXPECT_EQ(other.lines, 0);
  console_bridge::noOutputHandler();
  errorsOf(wrong);
  EXPECT_EQ(console_bridge::getOutputHandler(), nullptr);
  console_bridge::useOutputHandler(&other);
  console_bridge::restorePreviousOutputHandler();
}

TEST_F(UrdfFaults, Versions) {
  const auto version = [&](const std::string& text) {
    return complaintOf("<robot name=\"r\" version=\"" + text + "\">\n<link name=\"a\"/></robot>");
  };
  for (const std::string text : {"1.0", "1.1", "1.2", "1", ""})
    EXPECT_EQ(version(text), "no complaint") << text;
  for (const std::string text : {"2.0", "10.0", "two"})
    EXPECT_EQ(version(text), "r.urdf:1: URDF of version \"" + text +
                                 "\" is not known; versions 1.0 to 1.2 are read");
}

TEST_F(UrdfFaults, AllKindsAreReportedAtOnceInOrder) {
  write("bad.obj", "f 1 2 3\n");
  const std::string text = complaintOfParts(
      link("a", collision("<mesh filename=\"bad.obj\"/>")) + link("b", collision("<torus/>")) +
      joint("j", "revolute", "a", "b",
            "<axis xyz=\"0 0 0\"/><limit lower=\"2\" upper=\"1\"/><mimic joint=\"j\"/>"));
  EXPECT_THAT(text, testing::MatchesRegex(
                        "r.urdf:2: .*bad.obj:1: .*\nr.urdf:3: .*<torus>.*\nr.urdf:4: .*zero.*\n"
                        "r.urdf:4: .*mimics itself\nr.urdf:4: .*lower limit.*"));
}

}  // namespace
}  // namespace corridor::test
