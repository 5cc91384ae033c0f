// Damaged URDF and SRDF files never crash or hang the readers. The result is a sound model, or
// faults in readable words.
#include <random>

#include "tests/planner/robot/urdf_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : random() % n;
}

std::string damaged(std::string text, Random& random) {
  static const std::vector<std::string> pieces = {"<",
                                                  ">",
                                                  "/>",
                                                  "\"",
                                                  "%n%s",
                                                  "&#0;",
                                                  "&amp;",
                                                  "</robot>",
                                                  "<joint>",
                                                  "0",
                                                  "-",
                                                  "1e999",
                                                  "nan",
                                                  "<!--",
                                                  "]]>",
                                                  "name=",
                                                  "<mimic joint=\"turn\"/>",
                                                  "\xff",
                                                  "a",
                                                  "b",
                                                  "c",
                                                  " ",
                                                  "\n",
                                                  "<link name=\"a\"/>"};
  for (std::size_t times = 1 + below(random, 3); times > 0; --times) {
    const std::size_t at = below(random, text.size());
    switch (below(random, 8)) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text.erase(at, 1 + below(random, 8));
        break;
      case 2:
      case 3:
        text.insert(at, pieces[below(random, pieces.size())]);
        break;
      case 4:
        text.insert(at, text.substr(below(random, text.size()), below(random, 64)));
        break;
      case 5:
        for (std::size_t i = at; i < text.size(); ++i)
          if (text[i] >= '0' && text[i] <= '9') {
            text[i] = static_cast<char>('0' + below(random, 10));
            break;
          }
        break;
      default:
        if (!text.empty()) text[at] = static_cast<char>(random());
    }
  }
  return text;
}

class UrdfFuzz : public UrdfTest {
 protected:
  const std::string urdf =
      "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n" +
      link("a",
           "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" "
           "iyz=\"0\" izz=\"1\"/></inertial>" +
               collision("<box size=\"1 2 3\"/>")) +
      link("b", collision("<mesh filename=\"wedge.obj\" scale=\"1 -1 1\"/>")) +
      link("c", collision("<cylinder radius=\"1\" length=\"2\"/>")) + link("d") +
      joint("turn", "continuous", "a", "b", "<axis xyz=\"0 0 1\"/>") +
      joint("bend", "revolute", "b", "c", limit + "<mimic joint=\"turn\" multiplier=\"2\"/>") +
      joint("weld", "fixed", "c", "d", "<origin xyz=\"0 0 1\" rpy=\"0 1.57 0\"/>") + "</robot>\n";
  const std::string srdf =
      "<robot name=\"r\">\n<group name=\"g\"><chain base_link=\"a\" tip_link=\"d\"/></group>\n"
      "<group name=\"h\"><group name=\"g\"/><joint name=\"turn\"/></group>\n"
      "<group_state name=\"s\" group=\"h\"><joint name=\"turn\" value=\"1\"/></group_state>\n"
      "<disable_collisions link1=\"a\" link2=\"c\" reason=\"Never\"/></robot>\n";

  template <class Read>
  void attack(const std::string& whole, Read read) {
    const int mutations = casesOf(3'000, 200'000);
    Random random(testSeed(11));
    int sound = 0, refused = 0;
    for (int i = 0; i < mutations; ++i) {
      SCOPED_TRACE("mutation " + std::to_string(i));
      const std::vector<Fault> faults = read(damaged(whole, random));
      ++(faults.empty() ? sound : refused);
      for (const Fault& fault : faults) {
        EXPECT_FALSE(fault.text.empty());
        for (const char c : fault.text) ASSERT_TRUE(c >= ' ' || c < 0) << fault.text;
      }
    }
    EXPECT_GT(sound, mutations / 100);  // or the mutations were too destructive to test much
    EXPECT_GT(refused, mutations / 10);
  }
};

TEST_F(UrdfFuzz, Urdf) {
  ASSERT_EQ(complaintOf(urdf), "no complaint");
  attack(urdf, [&](const std::string& text) {
    std::vector<Fault> faults;
    const auto model = readUrdf(write("r.urdf", text), rules_, faults, files_);
    EXPECT_EQ(model.has_value(), faults.empty());
    if (model) {
      EXPECT_EQ(model->joints.size() + 1, model->links.size());
      for (const JointModel& joint : model->joints) {
        EXPECT_TRUE(joint.axis.allFinite() && joint.axis.norm() >= 1);
        if (!joint.mimic) {
          EXPECT_LE(joint.lower, joint.upper);
        }
        EXPECT_GT(joint.X_PJ.q.norm(), 0.9);
      }
    }
    return faults;
  });
}

TEST_F(UrdfFuzz, Srdf) {
  std::vector<Fault> none;
  const auto model = readUrdf(write("r.urdf", urdf), rules_, none, files_);
  ASSERT_TRUE(model);
  attack(srdf, [&](const std::string& text) {
    std::vector<Fault> faults;
    RobotDescription copy = *model;
    readSrdf(write("r.srdf", text), copy, faults);
    return faults;
  });
}

TEST_F(UrdfFuzz, DeepNestingIsRefused) {
  std::string text = "<robot name=\"r\">";
  for (int i = 0; i < 100000; ++i) text += "<a>";
  EXPECT_EQ(complaintOf(text), "r.urdf:1: is not valid XML: elements are nested too deep");
}

}  // namespace
}  // namespace corridor::test
