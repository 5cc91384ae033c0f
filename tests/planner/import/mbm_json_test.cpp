#include "planner/robot/joint_types.h"
#include "tests/planner/problem/arm_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

class MbmJson : public ArmTest {
 protected:
  std::filesystem::path set(const std::string& problems,
                            const std::string& joints = "\"lift\", \"pan\"") const {
    return write("sets/box.json",
                 "{\"format\": \"mbm-scene-1\", \"urdf\": \"arm.urdf\", \"srdf\": "
                 "\"arm.srdf\",\n\"joint_names\": [" +
                     joints + "],\n\"problems\": [" + problems + "]}");
  }
  std::string complaintOfSet(const std::filesystem::path& file, const std::string& index) const {
    return complaint(file.string() + index);
  }
  inline static const std::string two =
      R"({"index": 2, "start": [0, 4], "goals": [[3.1416, 0]], "fixed_joints": {"ghost": 1},
"objects": [
{"id": "can", "type": "cylinder", "position": [1, 0, 0], "orientation_xyzw": [0, 0, 0, 1], "length": 2, "radius": 0.1},
{"id": "base", "type": "box", "position": [3, 0, 0], "orientation_xyzw": [0, 0, 1, 0], "size": [1, 1, 1]},
{"id": "ball", "type": "sphere", "position": [3, 3, 0], "orientation_xyzw": [0, 0, 1, 0], "radius": 1}]})";
};

TEST_F(MbmJson, ReadsTheProblemOfAnIndex) {
  const Problem p = readProblem(set(two).string() + "#2");
  EXPECT_EQ(p.source.name, "box#2");
  EXPECT_EQ(p.settings.planner.name, "RRTConnect");
  EXPECT_EQ(p.model.space.coordinates().at(0).name, "lift") << "in the order of joint_names";
  EXPECT_DOUBLE_EQ(p.task.start[1], 4 - 2 * 3.14159265358979323846);
  EXPECT_EQ(p.task.goals.at(0), numbers({3.14159, 0}));
  ASSERT_EQ(p.model.bodies.size(), 8u);
  EXPECT_EQ(p.model.bodies[5].name, "can");
  EXPECT_TRUE(p.model.bodies[5].shapes[0].parts.at(0).flatEnds);
  EXPECT_EQ(p.model.bodies[6].name, "world/base") << "a link has the name base, too";
  EXPECT_EQ(skipped(p, "upper", "can"), "");
  EXPECT_EQ(p.source.files,
            (std::vector{folder_ / "sets/box.json", folder_ / "arm.urdf", folder_ / "arm.srdf"}));
}

TEST_F(MbmJson, Faults) {
  EXPECT_EQ(complaintOfSet(set(two), ""),
            "sets/box.json: name one of its problems, as in box.json#2; there are 2");
  EXPECT_EQ(complaintOfSet(set(two), "#7"), "sets/box.json: has no problem #7; there are 2");
  EXPECT_EQ(complaintOfSet(set("{\"index\": 1}, {\"index\": 2}, {\"index\": 3}"), "#0"),
            "sets/box.json: has no problem #0; there are 1 to 3");
  EXPECT_EQ(complaintOfSet(set("{\"index\": 1}"), "#1"), "sets/box.json: missing key \"objects\"");
  EXPECT_EQ(complaintOfSet(set(two, "\"lift\", \"pen\", \"wrist\""), "#2"),
            "sets/box.json: joint_names: there is no joint \"pen\" (did you mean \"pan\"?) (known: "
            "pan, lift, slide)\nsets/box.json: joint_names: wrist is fixed");
  EXPECT_EQ(complaintOfSet(set(two, "\"pan\", \"lift\", \"pan\""), "#2"),
            "sets/box.json: joint_names: pan is named twice");
  EXPECT_EQ(complaintOfSet(set(two, "\"lift\""), "#2"),
            "sets/box.json: start: a list of 1 numbers is needed");
  EXPECT_EQ(
      complaintOfSet(set(R"({"index": 1, "start": [9, 0], "goals": [], "objects": []})"), "#1"),
      "sets/box.json: start.lift: 9 is outside of its limits, [-3.14159, 3.14159]\n"
      "sets/box.json: goals: at least one is needed");
  EXPECT_EQ(
      complaintOfSet(
          set(R"({"index": 1, "start": [0, 0], "goals": [[0, 0]], "objects": [{"id": "a", "type": "torus"}]})"),
          "#1"),
      "sets/box.json: a.type: one of box, cylinder, sphere is needed, not \"torus\"");
  EXPECT_EQ(complaint(write("x.json", "{\n\"a\": ,\n}")),
            "x.json:2: is not JSON, or ends too early");
  EXPECT_EQ(complaint(write("x.json", "{\"a\": 1e999}")),
            "x.json: has a number that is too large for a double");
  EXPECT_EQ(complaint(write("x.json", "[]")),
            "x.json: a set of problems (format: mbm-scene-1) is needed");
  EXPECT_EQ(complaint(folder_ / "gone.json"), "gone.json: no such file");
  std::filesystem::remove(folder_ / "arm.srdf");
  EXPECT_EQ(complaintOfSet(set(two), "#2"),
            "sets/box.json: srdf: arm.srdf is in no folder above this file");
}

TEST_F(MbmJson, EachProblemHasAnIndexOfItsOwn) {
  EXPECT_EQ(complaintOfSet(set("{\"index\": 1}, " + two + ", {\"index\": 3}, " + two), "#2"),
            "sets/box.json: problems[1] and problems[3] have the same index, 2; give each problem "
            "its own");
}

TEST_F(MbmJson, SizesOfOtherTypesAreFaults) {
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = two;
    return complaintOfSet(set(text.replace(text.find(from), from.size(), to)), "#2");
  };
  const std::string end = " has none; remove it, or change the type";
  EXPECT_EQ(
      changed("\"size\"", "\"radius\": 2, \"length\": 1, \"size\""),
      "sets/box.json: base.radius: a box" + end + "\nsets/box.json: base.length: a box" + end);
  EXPECT_EQ(changed("\"radius\": 0.1", "\"radius\": 0.1, \"size\": [1, 1, 1]"),
            "sets/box.json: can.size: a cylinder" + end);
  EXPECT_EQ(changed("\"radius\": 1}", "\"radius\": 1, \"length\": 1}"),
            "sets/box.json: ball.length: a sphere" + end);
}

/// Values of held joints, the frame and unknown keys are used, refused or noted.
TEST_F(MbmJson, NothingIsDropped) {
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = two;
    return text.replace(text.find(from), from.size(), to);
  };
  const auto heldSlide = [](const Problem& p) {
    const ModelRobot& robot = p.model.robots.front();
    return robot.held.at(*findJoint(robot.description, "slide"));
  };
  const Problem p =
      readProblem(set(changed("\"ghost\": 1", "\"ghost\": 1, \"slide\": 0.03")).string() + "#2");
  EXPECT_EQ(heldSlide(p), 0.03);
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains((folder_ / "sets/box.json").string() +
                                ": fixed_joints: not used, because they are no joints that can be "
                                "held: ghost"));
  EXPECT_EQ(complaintOfSet(set(changed("\"ghost\"", "\"slide\"")), "#2"),
            "sets/box.json: fixed_joints.slide: 1 is outside of its limits, [0.01, 0.05]");
  EXPECT_EQ(complaintOfSet(set(changed("\"ghost\"", "\"pan\"")), "#2"),
            "sets/box.json: fixed_joints.pan: the joint is planned for (joint_names), and can't be "
            "held");
  EXPECT_THAT(
      textsOf(readProblem(set(changed("\"size\"", "\"scale\": 2, \"size\"")).string() + "#2")
                  .source.notes),
      testing::Contains((folder_ / "sets/box.json").string() + ": not used: objects[].scale"));
  EXPECT_EQ(complaintOfSet(set(changed("\"length\": 2", "\"length\": 2, \"length\": 3")), "#2"),
            "sets/box.json: has the key \"length\" twice in one object; remove one of them");
  EXPECT_EQ(
      complaintOfSet(set(changed("\"ghost\": 1", "\"slide\": 0.03, \"follow\": 0.02")), "#2"),
      "sets/box.json: fixed_joints.follow: the joint mimics \"slide\", which gives it another "
      "value; leave it out");
  EXPECT_EQ(
      complaintOfSet(set(changed("\"ghost\": 1", "\"slide\": 0.03, \"follow\": -0.03")), "#2"),
      "no complaint");
  const auto file = set(two);
  std::string text = contents(file);
  text.insert(1, "\"frame\": \"camera\", ");
  write("sets/box.json", text);
  EXPECT_EQ(complaintOfSet(file, "#2"),
            "sets/box.json: frame: the robot's root link, \"base\", is needed, not \"camera\"");
}

/// Other problems of a set are not parsed. Their texts may have brackets and quotes.
TEST_F(MbmJson, ReadsNoOtherProblem) {
  const std::string other = R"({"note": "\"}]{", "x": [[1, {}], "]"],
"index": 1, "start": [1 2]})";
  EXPECT_EQ(readProblem(set(other + ",\n" + two).string() + "#2").task.goals.size(), 1u);
  EXPECT_EQ(readProblem(set(two + ",\n" + other).string() + "#2").task.goals.size(), 1u);
  EXPECT_EQ(complaintOfSet(set(other + ",\n" + two + "\n"), "#1"),
            "sets/box.json:4: is not JSON, or ends too early");
  const std::string large = R"({"index": 18446744073709551616})";
  EXPECT_EQ(complaintOfSet(set(large + ", " + two), "#18446744073709551616"),
            "sets/box.json: has no problem #18446744073709551616; there are "
            "1.8446744073709552e+19, 2");
  EXPECT_EQ(complaintOfSet(set(other + ", " + two), ""),
            "sets/box.json: name one of its problems, as in box.json#1; there are 1, 2");
  std::string damaged = two;
  damaged.replace(damaged.find("\"length\": 2"), 11, "\"length\" 2 ");
  EXPECT_EQ(complaintOfSet(set(other + ",\n" + damaged), "#2"),
            "sets/box.json:7: is not JSON, or ends too early");
  EXPECT_EQ(complaintOfSet(set(other + ", " + two + ", " + two), "#2"),
            "sets/box.json: problems[1] and problems[2] have the same index, 2; give each problem "
            "its own");
}

TEST(MbmSets, AllAreRead) {
  const auto data = dataFolder();
  if (!data) GTEST_SKIP() << "CORRIDOR_DATA is not set to the folder of the development data";
  int read = 0;
  for (const char* robot : {"panda", "ur5"})
    for (const auto& entry : std::filesystem::directory_iterator(*data / "mbm" / robot))
      for (const char* index : {"#1", "#50"}) {
        const Problem p = readProblem(entry.path().string() + index);
        EXPECT_EQ(p.task.start.size(), robot == std::string("panda") ? 7 : 6);
        EXPECT_TRUE(p.model.space.inBounds(p.task.start) &&
                    p.model.space.inBounds(p.task.goals.at(0)));
        ++read;
      }
  EXPECT_EQ(read, 28);
}

}  // namespace
}  // namespace corridor::test
