// Tests of the robot's state in messages of MoveIt, and of fields that are not used.
#include <filesystem>

#include "planner/problem/problem.h"
#include "planner/robot/joint_types.h"
#include "tests/planner/problem/moveit_fixture.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;

class MoveitStates : public Moveit {};

/// What a scene says about the robot's state is used, is a fault, or is in a note.
TEST_F(MoveitStates, TheStateOfTheScene) {
  const std::string ends = "start: {pan: 0, lift: 0}\ngoal: {pan: 1, lift: 0}\n";
  const std::string only =
      "format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: scene.yaml}\n" + ends;
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\ngroup: arm\n");
  const auto withState = [&](const std::string& state, const std::string& more = "") {
    return write("scene.yaml", "world: {}\nrobot_state: {" + state + "}\n" + more);
  };
  const auto heldSlide = [&](const Problem& p) {
    const ModelRobot& robot = p.model.robots.front();
    return robot.held.at(*findJoint(robot.description, "slide"));
  };
  const std::string slide = "joint_state: {name: [slide, pan], position: [0.03, 2]}";
  withState(slide);
  const Problem p = read(only);
  EXPECT_EQ(heldSlide(p), 0.03);
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains(
                  HasSubstr("scene.yaml: robot_state: the start has other values of pan; those "
                            "of the start are used")));
  const Problem both = read(head + ends);
  EXPECT_EQ(heldSlide(both), 0.04) << "the start state of the request has priority";
  EXPECT_THAT(textsOf(both.source.notes),
              testing::Contains(HasSubstr("request.yaml: start_state: used instead of the scene's "
                                          "robot_state: slide (0.03)")));
  EXPECT_THAT(textsOf(both.source.notes),
              testing::Contains(
                  HasSubstr("request.yaml: start_state: not used, because they differ from the "
                            "rule of a mimic joint: follow; the proof is for the rule")));
  write("arm.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\ngroup: arm\nhold: {slide: "
        "0.02}\n");
  const Problem kept = read(only);
  EXPECT_EQ(heldSlide(kept), 0.02);
  EXPECT_THAT(
      textsOf(kept.source.notes),
      testing::Contains(HasSubstr("scene.yaml: robot_state: held by robot.yaml at another value: "
                                  "slide (0.02, not 0.03)")));
  withState("multi_dof_joint_state: {joint_names: [base], transforms: [{translation: [0, 0, 1]}]}");
  EXPECT_EQ(complaintOf(only),
            "scene.yaml:2: robot_state.multi_dof_joint_state.transforms: a pose that is not the "
            "identity is not supported; give it by base, or by start in the problem");
  withState(slide, "is_diff: true\n");
  EXPECT_EQ(complaintOf(only),
            "scene.yaml:3: is_diff: the scene is a difference to another one, so objects may be "
            "missing; save the whole scene, or write false if the file has all objects");
  withState(slide, "is_diff: 1\n");
  EXPECT_EQ(complaintOf(only), "scene.yaml:3: is_diff: true or false is needed, not \"1\"");
  withState("is_diff: true");
  EXPECT_THAT(textsOf(read(only).source.notes),
              testing::Contains(HasSubstr("robot_state.is_diff: the state is a difference")));
  const std::string transform =
      "fixed_frame_transforms: [{child_frame_id: /NAME, transform: {translation: [1, 0, 0]}}]\n";
  const auto named = [&](const std::string& name) {
    std::string text = transform;
    return text.replace(text.find("NAME"), 4, name);
  };
  withState(slide, named("camera"));
  EXPECT_THAT(textsOf(read(only).source.notes),
              testing::Not(testing::Contains(HasSubstr("not used"))));
  withState(slide, named("base"));
  EXPECT_EQ(complaintOf(only),
            "scene.yaml:3: fixed_frame_transforms.transform: a pose of \"base\" that is not the "
            "identity is not supported; give the pose of the robot by base in the problem");
}

/// The start of the problem may hold joints at other values than a message: a note names both.
TEST_F(MoveitStates, AStateOfTheStartReplacesHeldValues) {
  write("arm.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\ngroup: arm\n"
        "states: {near: {pan: 0, lift: 0, slide: 0.02}}\n");
  const Problem p = read(head + std::string("start: near\ngoal: {pan: 1, lift: 0}\n"));
  const ModelRobot& robot = p.model.robots.front();
  EXPECT_EQ(robot.held.at(*findJoint(robot.description, "slide")), 0.02);
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains(HasSubstr("request.yaml: start_state: held by the problem's start "
                                          "at another value: slide (0.02, not 0.04)")));
}

/// Values that are not used are named, except those that move nothing.
TEST_F(MoveitStates, OtherFieldsAreNotedByName) {
  write("request.yaml", request +
                            "max_velocity_scaling_factor: 0.1\nnum_planning_attempts: 9\n"
                            "max_acceleration_scaling_factor: 0\n");
  write("scene.yaml", "name: x\nobject_colors: [{id: a}]\n" + scene.substr(scene.find("world:")));
  const Problem p = read(head);
  std::vector<std::string> unused;
  for (const Note& note : p.source.notes)
    if (note.text.find(": not used: ") != note.text.npos)
      unused.push_back(std::filesystem::path(note.text).filename().string());
  EXPECT_THAT(unused, testing::ElementsAre(
                          "request.yaml: not used: max_velocity_scaling_factor (line 14)"));
}

}  // namespace
}  // namespace corridor::test
