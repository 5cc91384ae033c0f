// Robots that are too large, or that were made to exhaust memory, are refused quickly.
#include "tests/planner/robot/urdf_fixture.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;

class RobotLimits : public UrdfTest {
 protected:
  /// A chain of this many links with revolute joints.
  static std::string chain(int links) {
    std::string parts = link("l0");
    for (int i = 1; i < links; ++i) {
      const std::string n = std::to_string(i);
      parts += link("l" + n) + joint("j" + n, "continuous", "l" + std::to_string(i - 1), "l" + n);
    }
    return parts;
  }
  std::string complaintOfSrdf(const std::string& parts) {
    RobotDescription model = modelOf(link("a") + link("b") + joint("j", "continuous", "a", "b"));
    std::vector<Fault> faults;
    readSrdf(write("r.srdf", "<robot name=\"r\">\n" + parts + "</robot>\n"), model, faults);
    return textOf(faults);
  }
};

TEST_F(RobotLimits, Links) {
  const RobotDescription model = modelOf(chain(10'000));
  EXPECT_EQ(model.links.size(), 10'000u);
  EXPECT_EQ(model.joints.size(), 9'999u);
  EXPECT_EQ(complaintOfParts(chain(10'001)),
            "r.urdf:1: the robot has 10001 <link>; at most 10000 are read");
  std::string joints;
  for (int i = 0; i < 1'000'000; ++i) joints += "<joint/>\n";
  EXPECT_EQ(complaintOfParts(link("a") + joints),
            "r.urdf:1: the robot has 1000000 <joint>; at most 10000 are read");
}

TEST_F(RobotLimits, Shapes) {
  std::string shapes;
  for (int i = 0; i < 100'001; ++i) shapes += "<collision/>\n";
  EXPECT_EQ(complaintOfParts(link("a", shapes)),
            "r.urdf:1: the robot has 100001 <collision>; at most 100000 are read");
}

/// Each shape has a copy of its mesh, so the sum of all triangles is limited.
TEST_F(RobotLimits, Triangles) {
  std::string fan = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2";
  for (int i = 0; i < 59'998; ++i) fan += " 3";
  write("fan.obj", fan);
  std::string shapes;
  for (int i = 0; i < 100'000; ++i) shapes += collision("<mesh filename=\"fan.obj\"/>") + "\n";
  EXPECT_THAT(complaintOfParts(link("a", shapes)),
              HasSubstr("r.urdf:1668: link \"a\": the shapes up to this one have more than "
                        "100000000 triangles in all; use coarser meshes"));
}

TEST_F(RobotLimits, Faults) {
  std::string joints;
  for (int i = 0; i < 5'000; ++i) joints += "<joint/>\n";
  const std::string message = complaintOfParts(link("a") + joints);
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1000);
  EXPECT_THAT(message, testing::EndsWith("more faults"));
}

TEST_F(RobotLimits, Xml) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(complaintOfParts(deep), HasSubstr("is not valid XML: elements are nested too deep"));
  std::string many;
  for (int i = 0; i < 10'000'000; ++i) many += "<a/>";
  EXPECT_EQ(complaintOfParts(many), "r.urdf: has more than 10000000 tags and attributes");
  std::string attributes = "<link";
  for (int i = 0; i < 1'000'000; ++i) attributes += " a" + std::to_string(i) + "=''";
  EXPECT_EQ(complaintOfParts(attributes + "/>"), "r.urdf: has a tag of more than 100 attributes");
  // An = in a comment or in text doesn't count as an attribute.
  modelOf("<!-- " + std::string(1000, '=') + " -->\n" + link("a", std::string(1000, '=')));
}

/// The "billion laughs" attack has no effect, because only XML's own five entities are expanded.
TEST_F(RobotLimits, Entities) {
  std::string entities = "<!DOCTYPE robot [\n<!ENTITY a \"lol\">\n";
  for (char c = 'b'; c <= 'j'; ++c) {
    const std::string last = "&" + std::string(1, static_cast<char>(c - 1)) + ";";
    entities += "<!ENTITY " + std::string(1, c) + " \"";
    for (int i = 0; i < 10; ++i) entities += last;
    entities += "\">\n";
  }
  EXPECT_EQ(complaintOf(entities + "]>\n<robot name=\"&j;\">\n" + link("a&amp;b") + "</robot>\n"),
            "r.urdf:1: a DOCTYPE with declarations is not read; save the file without it");
}

TEST_F(RobotLimits, SrdfCounts) {
  const auto many = [](const std::string& element, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += element;
    return all;
  };
  const std::string pair = "<disable_collisions link1=\"a\" link2=\"b\"/>";
  EXPECT_EQ(complaintOfSrdf(many(pair, 100'000)), "no complaint");
  EXPECT_EQ(complaintOfSrdf(many(pair, 1'000'001)),
            "r.srdf:1: has 1000001 <disable_collisions>; at most 1000000 are read");
  EXPECT_EQ(complaintOfSrdf(many("<group/>", 1001)),
            "r.srdf:1: has 1001 <group>; at most 1000 are read");
  EXPECT_EQ(complaintOfSrdf(many("<virtual_joint/>", 1001)),
            "r.srdf:1: has 1001 <virtual_joint>; at most 1000 are read");
  EXPECT_EQ(complaintOfSrdf(many("<group_state/>", 10'001)),
            "r.srdf:1: has 10001 <group_state>; at most 10000 are read");
  EXPECT_EQ(
      complaintOfSrdf("<group name=\"g\">" + many("<joint name=\"j\"/>", 100'001) + "</group>"),
      "r.srdf:1: has 100001 members of groups; at most 100000 are read");
  EXPECT_EQ(complaintOfSrdf("<group name=\"g\">" +
                            many("<chain base_link=\"a\" tip_link=\"b\"/>", 1001) + "</group>"),
            "r.srdf:1: has 1001 <chain>; at most 1000 are read");
  // Unknown names are counted in one note, however many they are.
  std::string pairs;
  for (int i = 0; i < 100'000; ++i)
    pairs += "<disable_collisions link1=\"a\" link2=\"c" + std::to_string(i) + "\"/>\n";
  EXPECT_EQ(complaintOfSrdf(pairs), "no complaint");
}

TEST_F(RobotLimits, DisableDefaults) {
  std::string all;
  for (int i = 0; i < 600'000; ++i) all += "<disable_default_collisions link=\"a\"/>";
  EXPECT_EQ(complaintOfSrdf(all),
            "r.srdf:1: has 1200000 pairs of links by <disable_default_collisions>; at most 1000000 "
            "are read");
}

}  // namespace
}  // namespace corridor::test
