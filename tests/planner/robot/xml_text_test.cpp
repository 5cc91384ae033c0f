// Parts of URDF and SRDF files that the readers know nothing of: text, other formats, included
// files. Each of them is a fault or a note, never dropped in silence.
#include <gmock/gmock.h>

#include "tests/planner/robot/urdf_fixture.h"

namespace corridor::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class XmlText : public UrdfTest {
 protected:
  /// Returns the faults of a robot whose only link, on line 2, has this content.
  std::string inLink(const std::string& content) { return complaintOfParts(link("a", content)); }
  /// Returns the notes on a robot with these parts, the most important first, without the folder.
  std::vector<std::string> notesOn(const std::string& parts) {
    std::vector<std::string> texts = textsOf(modelOf(parts).notes);
    for (std::string& text : texts) text.erase(0, folder_.string().size() + 1);
    return texts;
  }
  inline static const std::string ball = R"(<sphere radius="1"/>)";
  inline static const std::string of = "r.urdf:2: link \"a\": ";
};

TEST_F(XmlText, TextWithoutItsBracketIsAFault) {
  EXPECT_EQ(
      inLink("<collision>origin xyz=\"0 0 1\"/&gt;<geometry>" + ball + "</geometry></collision>"),
      of + "the text \"origin xyz=\"0 0 1\"/>\" in <collision> is not read; has an element "
           "lost its \"<\"?");
  EXPECT_EQ(inLink("<collision><geometry>" + ball + "box size=\"1\"</geometry></collision>"),
            of + "the text \"box size=\"1\"\" in <geometry> is not read; has an element lost its "
                 "\"<\"?");
  EXPECT_EQ(complaintOfParts(link("a") + link("b") +
                             joint("j", "fixed", "a", "b", "<![CDATA[origin xyz='1 0 0']]>")),
            "r.urdf:4: joint \"j\": the text \"origin xyz='1 0 0'\" in <joint> is not read; has an "
            "element lost its \"<\"?");
}

TEST_F(XmlText, OtherTextIsASeriousNoteOnEachKindOfElement) {
  EXPECT_THAT(notesOn(link("a", "\n height =\n 3 " + collision(ball)) + "-->" + link("b", "x") +
                      joint("j", "fixed", "a", "b", "/>")),
              ElementsAre("r.urdf:5: robot \"r\": the text \"-->\" in <robot> is not read",
                          "r.urdf:3: link \"a\": the text \"height = 3\" in <link> is not read",
                          "r.urdf:6: joint \"j\": the text \"/>\" in <joint> is not read"));
  const RobotDescription model = modelOf("x" + link("a"));
  ASSERT_EQ(model.notes.size(), 1u);
  EXPECT_EQ(model.notes[0].weight, NoteWeight::coverage);
  EXPECT_THAT(notesOn("<!-- x=1 -->\n" + link("a", "<!-- y=2 --> \t" + collision(ball))),
              IsEmpty());
}

TEST_F(XmlText, ValuesThatAreNotAttributesAreFaults) {
  const auto inOrigin = [&](const std::string& content) {
    return inLink("<collision><origin>" + content + "</origin><geometry>" + ball +
                  "</geometry></collision>");
  };
  EXPECT_EQ(inOrigin("0 .5 0"),
            of + "<origin>: the text \"0 .5 0\" is not read; values are attributes: xyz, rpy");
  EXPECT_EQ(inOrigin("<xyz>0 .5 0</xyz>"),
            of + "<origin>: <xyz> is not read; values are attributes: xyz, rpy");
  EXPECT_EQ(inLink(collision("<sphere radius=\"1\">2</sphere>")),
            of + "<sphere>: the text \"2\" is not read; values are attributes: radius");
  EXPECT_EQ(inLink(collision("<mesh filename=\"wedge.obj\"><scale>2 2 2</scale></mesh>")),
            of + "<mesh>: <scale> is not read; values are attributes: filename, scale");
  const auto inJoint = [&](const std::string& content) {
    return complaintOfParts(link("a") + link("b") + joint("j", "continuous", "a", "b", content));
  };
  const std::string ofJoint = "r.urdf:4: joint \"j\": ";
  EXPECT_EQ(inJoint("<axis xyz=\"1 0 0\">0 1 0</axis>"),
            ofJoint + "<axis>: the text \"0 1 0\" is not read; values are attributes: xyz");
  EXPECT_EQ(inJoint("<limit effort=\"0\" velocity=\"0\"><velocity>1</velocity></limit>"),
            ofJoint +
                "<limit>: <velocity> is not read; values are attributes: lower, upper, "
                "effort, velocity");
  EXPECT_EQ(inJoint("<mimic joint=\"k\">2</mimic>"),
            ofJoint +
                "<mimic>: the text \"2\" is not read; values are attributes: joint, "
                "multiplier, offset");
}

TEST_F(XmlText, OtherFormatsAreNotedWhereTheyUseOurNames) {
  EXPECT_THAT(
      notesOn(link("a",
                   "<collision u:name=\"x\"><origin other:xyz=\"0 0 1\" other:other=\"2\"/>"
                   "<other:geometry/><other:other/><geometry>" +
                       ball + "</geometry></collision>")),
      testing::UnorderedElementsAre(
          "r.urdf:2: link \"a\": collision: u:name belongs to another format, and is not read; "
          "name would be",
          "r.urdf:2: link \"a\": origin: other:xyz belongs to another format, and is not read; xyz "
          "would be",
          "r.urdf:2: link \"a\": <other:geometry> belongs to another format, and is not read; "
          "<geometry> would be"));
}

TEST_F(XmlText, IncludedFilesAreFaults) {
  const std::string end = ": files are not included; put the elements of that file into this one";
  EXPECT_EQ(complaintOfParts(link("a") + "<xi:include href=\"b.urdf\"/>"),
            "r.urdf:3: robot \"r\": <xi:include>" + end);
  EXPECT_EQ(inLink("<include filename=\"b.urdf\"/>"), of + "<include>" + end);
  EXPECT_EQ(
      inLink("<collision><xi:include href=\"b\"/><geometry>" + ball + "</geometry></collision>"),
      of + "<xi:include>" + end);
}

TEST_F(XmlText, CollisionsOfGazeboAreNotedIfTheyHaveAShape) {
  EXPECT_THAT(notesOn(link("a") + "<gazebo><link name=\"b\"><collision name=\"c\"><geometry><box/>"
                                  "</geometry></collision></link></gazebo>"),
              ElementsAre("r.urdf:3: robot \"r\": the <collision> in <gazebo> is not read; move it "
                          "into its <link>"));
  EXPECT_THAT(notesOn(link("a") + "<gazebo reference=\"a\"><collision><surface/></collision>"
                                  "<sensor><contact><collision>c</collision></contact></sensor>"
                                  "</gazebo>"),
              IsEmpty());
}

TEST_F(XmlText, SrdfFilesToo) {
  RobotDescription model = modelOf(link("a") + link("b") + joint("j", "revolute", "a", "b", limit));
  model.notes.clear();
  std::vector<Fault> faults;
  readSrdf(write("r.srdf",
                 "<robot name=\"r\">\n<group name=\"g\">joint j</group>\n<xi:include href=\"x\"/>\n"
                 "<disable_collisions link1=\"a\" link2=\"b\">never</disable_collisions>\n"
                 "</robot>\n"),
           model, faults);
  EXPECT_EQ(textOf(faults), "no complaint");
  const std::string file = (folder_ / "r.srdf").string();
  EXPECT_THAT(textsOf(model.notes),
              testing::IsSupersetOf(
                  {file + ":2: group \"g\": the text \"joint j\" in <group> is not read",
                   file + ":3: robot \"r\": <xi:include>: files are not included; put the elements "
                          "of that file into this one",
                   file + ":4: pair: <disable_collisions>: the text \"never\" is not read; values "
                          "are attributes: link1, link2, reason"}));
}

/// Limits and extensions that are not used are in notes.
TEST_F(XmlText, LimitsAndExtensionsThatAreNotUsed) {
  EXPECT_THAT(notesOn(link("a") + link("b") +
                      joint("j", "revolute", "a", "b",
                            "<limit lower='0' upper='1' effort='1' velocity='1' "
                            "acceleration='0.1' jerk='2'/>")),
              testing::IsSupersetOf({testing::HasSubstr("limit: acceleration is not known"),
                                     testing::HasSubstr("limit: jerk is not known")}));
  EXPECT_THAT(notesOn(link("a") + link("b") +
                      joint("j", "continuous", "a", "b",
                            "<limit lower='-1' upper='1' effort='1' velocity='1'/>")),
              testing::Contains(testing::HasSubstr(
                  "is continuous, so lower and upper of its <limit> are not used")));
  EXPECT_THAT(notesOn(link("a", collision("<sphere radius='1'><drake:declare_convex/></sphere>"))),
              testing::Contains(testing::HasSubstr(
                  "<sphere>: <drake:declare_convex> belongs to another format, and is not read")));
}

}  // namespace
}  // namespace corridor::test
