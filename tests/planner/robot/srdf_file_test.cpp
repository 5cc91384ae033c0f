#include "tests/planner/robot/urdf_fixture.h"

namespace corridor::test {
namespace {

/// A trunk with two arms of two joints each, on a base with a planar joint.
class SrdfFile : public UrdfTest {
 protected:
  void SetUp() override {
    UrdfTest::SetUp();
    model_ = modelOf(link("ground") + link("trunk") + link("l1") + link("l2") + link("r1") +
                     link("r2") + link("tool") + joint("base", "planar", "ground", "trunk") +
                     joint("left1", "revolute", "trunk", "l1", limit) +
                     joint("left2", "revolute", "l1", "l2", limit) +
                     joint("right1", "revolute", "trunk", "r1", limit) +
                     joint("right2", "revolute", "r1", "r2", limit + "<mimic joint=\"right1\"/>") +
                     joint("weld", "fixed", "l2", "tool"));
  }

  std::string complaintOfSrdf(const std::string& parts, const std::string& name = "r") {
    std::vector<Fault> faults;
    readSrdf(write("r.srdf", "<robot name=\"" + name + "\">\n" + parts + "\n</robot>\n"), model_,
             faults);
    return textOf(faults);
  }
  /// Returns the notes of an SRDF without faults, one a line, without the folder.
  std::string notesOf(const std::string& parts, const std::string& name = "r") {
    model_.notes.clear();
    EXPECT_EQ(complaintOfSrdf(parts, name), "no complaint");
    std::string text;
    for (const std::string& note : textsOf(model_.notes))
      text += note.substr(folder_.string().size() + 1) + "\n";
    return text;
  }
  std::string group(const std::string& name) const {
    std::string text;
    for (const std::string& joint : model_.groups.at(name).joints) text += joint + " ";
    return text;
  }

  RobotDescription model_;
};

TEST_F(SrdfFile, Groups) {
  EXPECT_EQ(complaintOfSrdf(R"(
<group name="left"><chain base_link="trunk" tip_link="tool"/></group>
<group name="across"><chain base_link="tool" tip_link="r1"/></group>
<group name="links"><link name="r2"/><link name="ground"/><link name="l1"/></group>
<group name="all"><group name="left"/><group name="links"/><joint name="base"/><joint name="world"/></group>
<virtual_joint name="world" type="floating" parent_frame="world" child_link="ground"/>
<passive_joint name="right2"/><passive_joint name="world"/>
<end_effector name="nobody" group="looks" parent_link="here"/>)"),
            "no complaint");
  EXPECT_EQ(group("left"), "left1 left2 weld ");
  EXPECT_EQ(group("across"), "left1 left2 weld right1 ");
  EXPECT_EQ(group("links"), "left1 right2 ");
  EXPECT_EQ(group("all"), "base left1 left2 weld right2 ");
}

TEST_F(SrdfFile, States) {
  EXPECT_EQ(complaintOfSrdf(R"(
<group name="left"><joint name="left1"/></group>
<group name="right"><joint name="right1"/></group>
<group_state name="up" group="left"><joint name="left1" value="0.5"/><joint name="weld" value="0"/></group_state>
<group_state name="home" group="left"><joint name="left1" value="1"/></group_state>
<group_state name="home" group="right"><joint name="right1" value="-1e-1"/></group_state>
<group_state name="there"><joint name="base" value="1 2 3"/></group_state>)"),
            "no complaint");
  EXPECT_EQ(model_.states.at("up").values, (std::map<std::string, double>{{"left1", 0.5}}));
  EXPECT_EQ(model_.states.at("up").group, "left");
  EXPECT_EQ(model_.states.at("left/home").values.at("left1"), 1);
  EXPECT_EQ(model_.states.at("right/home").values.at("right1"), -0.1);
  EXPECT_EQ(model_.states.at("right/home").group, "right");
  EXPECT_FALSE(model_.states.contains("home"));
  EXPECT_EQ(model_.states.at("there").values,
            (std::map<std::string, double>{{"base/x", 1}, {"base/y", 2}, {"base/yaw", 3}}));
  EXPECT_EQ(model_.states.at("there").group, "");
  const std::string file = (folder_ / "r.srdf").string();
  EXPECT_THAT(textsOf(model_.notes),
              testing::ElementsAre(
                  file + ":5: state \"up\": the values of fixed joints and mimics are "
                         "ignored: weld",
                  file + ":8: state \"there\" names no group; its values are taken as they are"));
}

TEST_F(SrdfFile, EnabledPairsThatAreNotTested) {
  const AllowedPair adjacent = model_.allowed.front();
  EXPECT_EQ(complaintOfSrdf("<disable_collisions link1=\"l2\" link2=\"r2\" reason=\"Never\"/>"
                            "<enable_collisions link1=\"r2\" link2=\"l2\"/>"
                            "<enable_collisions link1=\"" +
                            adjacent.a + "\" link2=\"" + adjacent.b + "\"/>"),
            "no complaint");
  EXPECT_THAT(textsOf(model_.notes),
              testing::Contains(testing::HasSubstr(
                  "not tested, although <enable_collisions> names them: " + adjacent.a + " ~ " +
                  adjacent.b + " (adjacent), l2 ~ r2 (SRDF: Never)")));
}

TEST_F(SrdfFile, Pairs) {
  const std::size_t adjacent = model_.allowed.size();
  EXPECT_EQ(complaintOfSrdf(R"(
<disable_collisions link1="l2" link2="r2" reason="Never"/>
<disable_collisions link1="r2" link2="l2" reason="Again"/>
<disable_collisions link1="l2" link2="l1" reason="Adjacent"/>
<disable_collisions link1="l2" link2="trunk"/>
<disable_default_collisions link="tool"/><enable_collisions link1="ground" link2="tool"/>)"),
            "no complaint");
  std::vector<std::string> pairs;
  for (std::size_t i = adjacent; i < model_.allowed.size(); ++i)
    pairs.push_back(model_.allowed[i].a + "~" + model_.allowed[i].b + " " +
                    model_.allowed[i].reason);
  EXPECT_THAT(pairs, testing::ElementsAre("l2~r2 SRDF: Never", "l2~trunk SRDF",
                                          "tool~trunk SRDF: disable_default_collisions",
                                          "tool~l1 SRDF: disable_default_collisions",
                                          "tool~r1 SRDF: disable_default_collisions",
                                          "tool~r2 SRDF: disable_default_collisions"));
}

TEST_F(SrdfFile, OfAnotherRobotIsReported) {
  EXPECT_EQ(complaintOfSrdf("", "q"), "no complaint");
  EXPECT_THAT(textsOf(model_.notes),
              testing::ElementsAre((folder_ / "r.srdf").string() +
                                   ":1: is for robot \"q\", and is used for \"r\""));
}

TEST_F(SrdfFile, UnknownElements) {
  EXPECT_EQ(notesOf(R"(<disable_collision link1="l1" link2="r1"/>
<group name="a"><jont name="left1"/><joint name="left2"/></group>
<link_sphere_approximation link="l1"/>
<mask/>)"),
            R"(r.srdf:5: robot "r": <mask> is not known, and is ignored
r.srdf:2: robot "r": <disable_collision> is not known (did you mean <disable_collisions>?)
r.srdf:3: group "a": <jont> is not known (did you mean <joint>?)
)");
  EXPECT_THAT(model_.groups.at("a").unusable, testing::HasSubstr("<jont> is not known"));
}

/// Each of forty groups contains the next one three times, so there are 3^40 paths through them.
TEST_F(SrdfFile, NestedGroupsTakeNoExponentialTime) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const std::string inner = "<group name=\"g" + std::to_string(i + 1) + "\"/>";
    text += "<group name=\"g" + std::to_string(i) + "\">" + inner + inner + inner + "</group>\n";
  }
  EXPECT_EQ(complaintOfSrdf(text + "<group name=\"g40\"><joint name=\"left1\"/></group>"),
            "no complaint");
  EXPECT_EQ(group("g0"), "left1 ");
}

/// Names that the URDF lacks are left out, as in other readers of SRDF.
TEST_F(SrdfFile, UnknownNamesAreCountedInNotes) {
  EXPECT_EQ(
      notesOf(R"(<group name="a"><joint name="left1"/><joint name="left3"/><link name="l2"/></group>
<group name="b"><chain base_link="trunk" tip_link="nowhere"/><group name="a"/></group>
<group_state name="s" group="a"><joint name="left1" value="1"/><joint name="lft1" value="1"/></group_state>
<disable_collisions link1="l1" link2="r1" reason="Never"/>
<disable_collisions link1="l3" link2="r1"/>
<disable_collisions link1="l4" link2="l5"/>
<disable_collisions link1="l6" link2="l2"/>
<passive_joint name="right1"/>
<passive_joint name="right2"/>
<disable_collisions link1="ground" link2="tool"/>
<disable_collisions link1="r2" link2="tool"/>)"),
      R"(r.srdf:9: <passive_joint>: these joints are held, unless joints names them or they mimic others: right1, right2
r.srdf:2: 2 members of groups are left out, because the URDF lacks left3, nowhere
r.srdf:4: 1 value of a state is left out, because the URDF lacks lft1 (did you mean "left1"?)
r.srdf:6: 3 pairs name links that the URDF lacks: l3, l4, l5 and 1 more
)");
  EXPECT_EQ(group("a"), "left1 left2 ");
  EXPECT_EQ(group("b"), "left1 left2 ");
  EXPECT_THAT(model_.groups.at("b").missing, testing::ElementsAre("nowhere", "left3"));
  EXPECT_EQ(model_.states.at("s").values, (std::map<std::string, double>{{"left1", 1}}));
  std::string allowed;
  for (const AllowedPair& pair : model_.allowed) allowed += pair.a + "~" + pair.b + " ";
  EXPECT_THAT(allowed, testing::EndsWith(" l1~r1 ground~tool r2~tool "));
  EXPECT_EQ(model_.groups.at("a").unusable, "");
}

TEST_F(SrdfFile, AnSrdfOfAnotherRobotIsNotedFirst) {
  EXPECT_EQ(
      notesOf(R"(<group name="arm"><joint name="j1"/><joint name="left1"/><link name="k1"/></group>
<passive_joint name="waist"/>
<disable_collisions link1="k2" link2="k3"/>)",
              "q"),
      R"(r.srdf:1: 5 of the 6 links and joints that it names are not in the URDF; it seems to be the SRDF of another robot
r.srdf:1: is for robot "q", and is used for "r"
r.srdf:2: 2 members of groups are left out, because the URDF lacks j1, k1
r.srdf:3: 1 passive joint is not in the URDF: waist
r.srdf:4: 1 pair names links that the URDF lacks: k2, k3
)");
  EXPECT_EQ(notesOf("<passive_joint name=\"nowhere\"/>"),
            "r.srdf:2: 1 passive joint is not in the URDF: nowhere\n")
      << "a few unknown names don't make another robot";
}

TEST_F(SrdfFile, GroupsThatCannotBeMade) {
  EXPECT_EQ(notesOf(R"(<group name="b"><group name="aa"/><joint name="left1"/></group>
<group name="c"><link name="ground"/></group>
<group name="d"/>
<group/>
<group name="e"><joint name="left1"/><group name="f"/></group>
<group name="f"><group name="e"/></group>
<group name="a"><joint name="left1"/><group name="b"/></group>
<group name="f"/>
<group name="g"><joint name="left1"/><group name="e"/></group>
<group name="h"><joint name="left9"/></group>
<group name="i"><joint name="left1"/><joint/></group>
<group name="j"><joint name="left1"/><jont name="left2"/></group>
<disable_collisions link1="l2"/>
<group name="up"><chain base_link="tool" tip_link="trunk"/></group>)"),
            R"(r.srdf:5: <group> has no name
r.srdf:9: group "f" is already defined on line 7; this definition is ignored
r.srdf:12: group "i": <joint> has no name
r.srdf:13: group "j": <jont> is not known (did you mean <joint>?)
r.srdf:11: 1 member of a group is left out, because the URDF lacks left9 (did you mean "left1"?)
r.srdf:14: <disable_collisions> has no link2
)");
  std::map<std::string, std::string> reasons;
  for (const auto& [name, group] : model_.groups) {
    EXPECT_EQ(group.joints.empty(), !group.unusable.empty()) << name;
    if (!group.unusable.empty()) reasons[name] = group.unusable.substr(folder_.string().size() + 1);
  }
  EXPECT_THAT(
      reasons,
      testing::ElementsAre(
          testing::Pair("a",
                        "r.srdf:2: group \"b\": there is no group \"aa\" in the SRDF (did you "
                        "mean \"a\"?)"),
          testing::Pair("b",
                        "r.srdf:2: group \"b\": there is no group \"aa\" in the SRDF (did you "
                        "mean \"a\"?)"),
          testing::Pair("c", "r.srdf:3: group \"c\" has no joint"),
          testing::Pair("d", "r.srdf:4: group \"d\" has no joint"),
          testing::Pair("e", "r.srdf:6: group \"e\" contains itself: e, f, e"),
          testing::Pair("f", "r.srdf:7: group \"f\" contains itself: f, e, f"),
          testing::Pair("g", "r.srdf:6: group \"e\" contains itself: e, f, e"),
          testing::Pair("h",
                        "r.srdf:11: group \"h\" has no joint of this robot: the URDF lacks "
                        "left9"),
          testing::Pair("i", "r.srdf:12: group \"i\": <joint> has no name"),
          testing::Pair("j",
                        "r.srdf:13: group \"j\": <jont> is not known (did you mean "
                        "<joint>?)")));
  EXPECT_EQ(group("up"), "left1 left2 weld ");
}

TEST_F(SrdfFile, LongerNamesOfGroupsAreSuggested) {
  EXPECT_EQ(complaintOfSrdf(R"(<group name="left_arm"><joint name="left1"/></group>
<group name="both"><group name="left"/></group>)"),
            "no complaint");
  EXPECT_THAT(model_.groups.at("both").unusable,
              testing::EndsWith("there is no group \"left\" in the SRDF (did you mean "
                                "\"left_arm\"?)"));
}

TEST_F(SrdfFile, ValuesOfStatesAreGivenOnce) {
  EXPECT_EQ(notesOf(R"(<group name="e"><joint name="left1"/></group>
<group_state name="s" group="e"><joint name="left1" value="1"/><joint name="left1" value="1"/></group_state>
<group_state name="t" group="e"><joint name="left1" value="1" unit="deg"/></group_state>
<group_state name="u" group="e"><joint name="left1" valu="1"/></group_state>)"),
            R"(r.srdf:3: state "s": joint "left1" is given twice
r.srdf:4: state "t": joint "left1": joint: unit is not known, and is ignored
r.srdf:5: state "u": joint "left1": <joint> has no value
r.srdf:5: state "u": joint "left1": joint: valu is not known (did you mean "value"?)
)");
  EXPECT_NE(model_.states.at("s").unusable, "");
}

TEST_F(SrdfFile, StatesThatCannotBeMade) {
  EXPECT_EQ(
      notesOf(R"(<group name="e"><joint name="left1"/></group>
<group_state name="s" group="g"><joint name="left1" value="x"/></group_state>
<group_state name="t" group="e"><joint name="left2"/></group_state>
<group_state name="u" group="e"><joint name="base" value="1"/></group_state>
<group_state name="v" group="e"><joint name="left1" value="1"/></group_state>
<group_state name="v" group="e"><joint name="left1" value="2"/></group_state>
<group_state name="w" group="e"/>
<group_state name="x" group="e"><joint name="left9" value="0"/></group_state>
<group_state name="home" group="e"><joint name="left1" value="0"/></group_state>
<group_state name="home" group="f"><joint name="left1" value="1"/></group_state>
<group_state name="e/home" group="e"><joint name="left1" value="2"/></group_state>)"),
      R"(r.srdf:3: state "s" names the group "g", which the SRDF lacks; its values are taken as they are
r.srdf:3: state "s": joint "left1": joint value: a number is needed, not "x"
r.srdf:4: state "t": joint "left2": <joint> has no value
r.srdf:5: state "u": joint "base": joint value: 3 numbers are needed, not "1"
r.srdf:7: state "v" is already defined on line 6; this definition replaces it, as in MoveIt
r.srdf:11: state "home" names the group "f", which the SRDF lacks; its values are taken as they are
r.srdf:12: there is already a state "e/home"; this definition is ignored
r.srdf:9: 1 value of a state is left out, because the URDF lacks left9 (did you mean "left1"?)
)");
  std::map<std::string, std::string> reasons;
  for (const auto& [name, state] : model_.states)
    if (!state.unusable.empty()) reasons[name] = state.unusable.substr(folder_.string().size() + 1);
  EXPECT_THAT(
      reasons,
      testing::ElementsAre(
          testing::Pair("s",
                        "r.srdf:3: state \"s\": joint \"left1\": joint value: a number is "
                        "needed, not \"x\""),
          testing::Pair("t", "r.srdf:4: state \"t\": joint \"left2\": <joint> has no value"),
          testing::Pair("u",
                        "r.srdf:5: state \"u\": joint \"base\": joint value: 3 numbers are "
                        "needed, not \"1\""),
          testing::Pair("w", "r.srdf:8: state \"w\" has no value"),
          testing::Pair("x",
                        "r.srdf:9: state \"x\" gives no joint of this robot a value: the URDF "
                        "lacks left9")));
  EXPECT_EQ(model_.states.at("v").values.at("left1"), 2) << "the last one counts, as in MoveIt";
  EXPECT_EQ(model_.states.at("e/home").values.at("left1"), 0);
}

TEST_F(SrdfFile, AUrdfIsNoSrdf) {
  EXPECT_THAT(notesOf("<link name=\"trunk\"/>"),
              testing::HasSubstr("r.srdf:2: it has <link> elements; it seems to be a URDF, not an "
                                 "SRDF"));
}

/// An unreadable <enable_collisions> must not leave a pair untested.
TEST_F(SrdfFile, DefaultsAreIgnoredIfAnEnabledPairIsLost) {
  const std::size_t adjacent = model_.allowed.size();
  const std::string defaults = "<disable_default_collisions link=\"tool\"/>\n";
  for (const char* const lost : {R"(<enable_collisions link1="tool" link2="grund"/>)",
                                 R"(<enable_collisions link1="tool"/>)",
                                 R"(<enable_colisions link1="tool" link2="ground"/>)"}) {
    EXPECT_THAT(notesOf(defaults + lost),
                testing::HasSubstr("r.srdf:2: <disable_default_collisions> is ignored, because not "
                                   "every <enable_collisions> can be read; all of its pairs are "
                                   "tested"))
        << lost;
    EXPECT_EQ(model_.allowed.size(), adjacent) << lost;
  }
}

TEST_F(SrdfFile, AVirtualJointHidesNoJointOfTheRobot) {
  EXPECT_EQ(complaintOfSrdf(R"(<virtual_joint name="left1" child_link="ground" type="fixed"/>
<group name="a"><joint name="left1"/></group>)"),
            "no complaint");
  EXPECT_EQ(group("a"), "left1 ");
}

TEST_F(SrdfFile, VirtualJointsThatMoveAreNoted) {
  EXPECT_EQ(
      notesOf(R"(<virtual_joint name="world" type="planar" parent_frame="odom" child_link="ground"/>
<virtual_joint name="root" type="floating" parent_frame="odom" child_link="ground"/>
<virtual_joint name="weld0" type="fixed" parent_frame="odom" child_link="ground"/>
<virtual_joint name="base" type="planar" parent_frame="odom" child_link="ground"/>
<virtual_joint name="again" type="planar" parent_frame="odom" child_link="trunk"/>)"),
      R"(r.srdf:2: virtual joint "world" (planar) is not used: the robot stands still at the problem's base; for a base that moves, add a planar joint on an empty link to the URDF
r.srdf:3: virtual joint "root" (floating) is not used: the robot stands still at the problem's base; for a base that moves, add a floating joint on an empty link to the URDF
)") << "not for fixed ones, nor for a link or name of the URDF's own planar joint";
}

TEST_F(SrdfFile, GroupsWithVirtualJoints) {
  EXPECT_EQ(complaintOfSrdf(R"(
<virtual_joint name="world" type="planar" parent_frame="odom" child_link="ground"/>
<virtual_joint name="weld0" type="fixed" parent_frame="odom" child_link="ground"/>
<group name="mobile"><joint name="world"/></group>
<group name="all"><group name="mobile"/><joint name="left1"/><joint name="weld0"/></group>
<group name="fixed"><joint name="weld0"/><joint name="left1"/></group>)"),
            "no complaint");
  EXPECT_EQ(group("all"), "left1 ");
  EXPECT_THAT(model_.groups.at("all").virtualJoints, testing::ElementsAre("world"));
  EXPECT_TRUE(model_.groups.at("fixed").virtualJoints.empty());
  EXPECT_THAT(model_.groups.at("mobile").unusable,
              testing::EndsWith("r.srdf:5: group \"mobile\" has no joint of the URDF; virtual "
                                "joints are not used: world"));
}

/// Many SRDF files give root_joint a value without a <virtual_joint>.
TEST_F(SrdfFile, ValuesOfVirtualJointsGetNoSuggestion) {
  model_.joints[0].name = "foot_joint";
  EXPECT_EQ(notesOf(R"(<group name="left"><joint name="left1"/></group>
<group_state name="up" group="left"><joint name="root_joint" value="0 0 1 0 0 0 1"/><joint name="left1" value="1"/></group_state>)"),
            "r.srdf:3: 1 value of a state is left out, because the URDF lacks root_joint\n");
  EXPECT_EQ(
      notesOf(R"(<virtual_joint name="world" type="fixed" parent_frame="odom" child_link="ground"/>
<group name="left"><joint name="left1"/></group>
<group_state name="high" group="left"><joint name="world" value="1 2 3"/></group_state>)"),
      "");
  EXPECT_THAT(
      model_.states.at("high").unusable,
      testing::EndsWith(
          "r.srdf:4: state \"high\" has values of virtual joints only, which are not used"));
}

TEST_F(SrdfFile, AFileThatCannotBeReadIsAFault) {
  std::vector<Fault> faults;
  readSrdf(folder_ / "none.srdf", model_, faults);
  EXPECT_EQ(textOf(faults), "none.srdf: no such file");
  EXPECT_THAT(complaintOfSrdf("<group"), testing::HasSubstr("r.srdf:"));
}

}  // namespace
}  // namespace corridor::test
