// Bodies inside closed meshes that are not solid: free, with a note; and how links become solid.
#include "planner/checker/enclosed_bodies.h"

#include <gmock/gmock.h>

#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// An arm whose link is a closed cube of 1 m, which moves along x; and a small obstacle.
class EnclosedBodies : public ProblemTest {
 protected:
  void SetUp() override {
    ProblemTest::SetUp();
    write("box.obj", box);
    write("open.obj", box.substr(0, box.rfind("f ")));
    writeUrdf("box.obj");
    writeRobot("");
  }
  void writeUrdf(const std::string& mesh) const {
    write("slide.urdf",
          "<robot name='slide'><link name='base'/><link name='hand'><collision><geometry><mesh "
          "filename='" +
              mesh +
              "'/></geometry></collision></link><joint name='x' type='prismatic'><parent "
              "link='base'/><child link='hand'/><axis xyz='1 0 0'/><limit lower='-5' upper='5' "
              "effort='1' velocity='1'/></joint></robot>");
  }
  void writeRobot(const std::string& keys) const {
    write("slide.yaml", "format: corridor-robot-1\nurdf: slide.urdf\n" + keys);
  }
  Problem problem(const std::string& obstacle, double x = 0) const {
    return read("format: corridor-problem-1\nrobot: slide.yaml\nworld: {thing: " + obstacle +
                "}\nstart: {x: " + std::to_string(x) + "}\ngoal: {x: 3}\n");
  }
  static std::vector<std::string> notesOf(const Problem& problem) {
    const Checker checker(problem);
    return textsOf(notesOnStart(checker, startOf(problem)));
  }
  static bool isFree(const Problem& problem) {
    return Checker(problem).isProvedFree(startOf(problem));
  }

  const std::string box =
      "v -.5 -.5 -.5\nv .5 -.5 -.5\nv .5 .5 -.5\nv -.5 .5 -.5\nv -.5 -.5 .5\nv .5 -.5 .5\nv .5 .5 "
      ".5\nv -.5 .5 .5\nf 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 3 4 8\nf 3 8 7\nf "
      "2 "
      "3 7\nf 2 7 6\nf 1 5 8\nf 1 8 4\n";
};

TEST_F(EnclosedBodies, AreNoted) {
  const std::string note =
      "bodies are inside closed meshes, without touching them: thing in hand; a mesh is a surface, "
      "so this is no contact (solid: true in robot.yaml, for all links or some, makes the inside "
      "solid)";
  for (const std::string thing :
       {"{sphere: 0.1}", "{box: [0.2, 0.3, 0.4]}", "{mesh: box.obj, unit: cm}"}) {
    const Problem inside = problem(thing);
    EXPECT_TRUE(isFree(inside));
    EXPECT_THAT(notesOf(inside), ElementsAre(note)) << thing;
    EXPECT_THAT(notesOf(problem(thing, 2)), IsEmpty()) << "beside it";
    EXPECT_THAT(notesOf(problem(thing, 0.5)), IsEmpty()) << "in contact";
  }
}

TEST_F(EnclosedBodies, ObstaclesAround) {
  write("big.obj", "# units: m\n" + box);
  writeUrdf("box.obj");
  const std::string around = "{shapes: [{mesh: big.obj, unit: m}]}";
  write("small.obj", "v 0 0 0\nv .1 0 0\nv 0 .1 0\nf 1 2 3\n");
  writeUrdf("small.obj");
  const Problem inside = problem(around);
  EXPECT_TRUE(isFree(inside));
  EXPECT_THAT(notesOf(inside), ElementsAre(HasSubstr("hand in thing")));
  EXPECT_THAT(notesOf(inside), ElementsAre(HasSubstr("(solid: true beside the mesh makes")));
  EXPECT_FALSE(isFree(problem("{mesh: big.obj, unit: m, solid: true}")));
}

TEST_F(EnclosedBodies, NotInOpenMeshes) {
  writeUrdf("open.obj");
  EXPECT_THAT(notesOf(problem("{sphere: 0.1}")), IsEmpty());
}

TEST_F(EnclosedBodies, LinksCanBeSolid) {
  for (const std::string solid : {"true", "[hand]"}) {
    writeRobot("solid: " + solid + "\n");
    const Problem inside = problem("{sphere: 0.1}");
    EXPECT_FALSE(isFree(inside)) << solid;
    EXPECT_THAT(notesOf(inside), IsEmpty());
    EXPECT_TRUE(isFree(problem("{sphere: 0.1}", 2)));
  }
  for (const std::string solid : {"false", "[base]", "[]"}) {
    writeRobot("solid: " + solid + "\n");
    EXPECT_TRUE(isFree(problem("{sphere: 0.1}"))) << solid;
  }
}

TEST_F(EnclosedBodies, SolidLinksMustBeWatertight) {
  writeUrdf("open.obj");
  const auto complaint = [&](const std::string& solid) {
    writeRobot("solid: " + solid + "\n");
    return complaintOf(
        "format: corridor-problem-1\nrobot: slide.yaml\nworld: {}\nstart: {x: "
        "0}\ngoal: {x: 3}\n");
  };
  EXPECT_THAT(complaint("[hand]"), HasSubstr("slide.yaml:3: solid: needs watertight meshes, and "));
  EXPECT_THAT(complaint("[hnad]"), HasSubstr("solid: there is no link \"hnad\" (did you mean "
                                             "\"hand\"?)"));
  EXPECT_THAT(complaint("hand"), HasSubstr("slide.yaml:3: solid: "));
  EXPECT_EQ(complaint("true"), "no complaint");
  EXPECT_THAT(textsOf(problem("{sphere: 0.1}").source.notes),
              testing::Contains("solid: meshes that are not watertight stay surfaces: hand"));
}

}  // namespace
}  // namespace corridor::test
