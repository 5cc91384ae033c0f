// Tests of the robot's state in messages of MoveIt, and of fields that are not used.
#include <filesystem>

#include "planner/problem/problem.h"
#include "planner/robot/joint_types.h"
#include "tests/planner/import/moveit_fixture.h"

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
}

TEST_F(MoveitStates, MimicJointsWithoutTheirLeader) {
  std::string text = urdf;
  const std::string end = "</robot>";
  text.replace(
      text.find(end), end.size(),
      "<link name='tail'/>" +
          joint("wag", "revolute", "base", "tail",
                "<limit lower='-9' upper='9' effort='1' velocity='1'/><mimic joint='lift'/>") +
          end);
  write("arm.urdf", text);
  write("scene.yaml", "world: {}\nrobot_state: {joint_state: {name: [wag], position: [0.5]}}\n");
  EXPECT_THAT(textsOf(read("format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: "
                           "scene.yaml}\nstart: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 1, "
                           "lift: 0, slide: 0.02}\n")
                          .source.notes),
              testing::Contains(testing::EndsWith(
                  "robot_state: not used, because the joints that these mimic joints follow have "
                  "no value here: wag")));
}

/// A message's pose of the robot's base must be that of the problem. A base that the user gave is
/// used, and a note names the difference.
TEST_F(MoveitStates, PosesOfTheBaseAreCompared) {
  const std::string plain =
      "format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: scene.yaml}\n"
      "start: {pan: 0, lift: 0}\ngoal: {pan: 1, lift: 0}\n";
  const std::string moved = plain + "base: {at: [0, 0, 1], rpy_deg: [0, 0, 90]}\n";
  const std::string turn = "rotation: {x: 0, y: 0, z: 0.7071067811865475, w: 0.7071067811865476}",
                    same = "{translation: [0, 0, 1], " + turn + "}",
                    identity = "{translation: [0, 0, 0], rotation: [0, 0, 0, 1]}";
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\ngroup: arm\n");
  const auto with = [&](const std::string& text) { write("scene.yaml", "world: {}\n" + text); };
  const auto state = [&](const std::string& pose) {
    with("robot_state: {multi_dof_joint_state: {joint_names: [virtual], transforms: [" + pose +
         "]}}\n");
  };
  const auto frame = [&](const std::string& pose, const std::string& parent = "world",
                         const std::string& child = "/base") {
    with("fixed_frame_transforms: [{header: {frame_id: " + parent + "}, child_frame_id: " + child +
         ", transform: " + pose + "}]\n");
  };
  const auto notes = [&](const std::string& problem) {
    std::vector<std::string> all;
    for (const Note& note : read(problem).source.notes)
      if (note.text.find("scene.yaml: ") != note.text.npos)
        all.push_back(note.text.substr(note.text.find("scene.yaml: ")));
    return all;
  };
  state(same);
  EXPECT_THAT(notes(moved), testing::IsEmpty());
  EXPECT_EQ(complaintOf(plain),
            "scene.yaml:2: robot_state.multi_dof_joint_state.transforms: \"virtual\": the base is "
            "at {at: [0, 0, 0], quat_xyzw: [0, 0, 0, 1]}, not at {at: [0, 0, 1], quat_xyzw: [0, 0, "
            "0.7071067811865475, 0.7071067811865476]} as here; give it by base in the problem");
  state(identity);
  EXPECT_THAT(notes(plain), testing::IsEmpty());
  EXPECT_THAT(notes(moved), testing::ElementsAre(testing::HasSubstr(
                                "\"virtual\": the base is at {at: [0, 0, 1], quat_xyzw: [0, 0, ")));
  with("robot_state: {multi_dof_joint_state: {joint_names: [], transforms: [" + same + "]}}\n");
  EXPECT_EQ(complaintOf(plain),
            "scene.yaml:2: robot_state.multi_dof_joint_state.transforms: one transform for each of "
            "the joint_names is needed, 0, not 1");
  state("{rotation: [0, 0, 0, 0]}");
  EXPECT_THAT(complaintOf(plain), testing::Not(testing::HasSubstr("quaternion")));
  with(
      "robot_state: {multi_dof_joint_state: {header: {frame_id: map}, joint_names: [pan], "
      "transforms: [" +
      identity + "]}}\n");
  EXPECT_THAT(complaintOf(plain),
              testing::HasSubstr("\"pan\": no pose in this problem belongs to this name"));

  frame(same);
  EXPECT_THAT(notes(moved), testing::IsEmpty());
  EXPECT_EQ(
      complaintOf(plain),
      "scene.yaml:2: fixed_frame_transforms.transform: the pose of \"base\" is {at: [0, 0, 1], "
      "quat_xyzw: [0, 0, 0.7071067811865475, 0.7071067811865476]} here, and {at: [0, 0, 0], "
      "quat_xyzw: [0, 0, 0, 1]} by the base of the robot in the problem; give it by base in "
      "the problem");
  frame(identity);
  EXPECT_THAT(notes(plain), testing::IsEmpty());
  EXPECT_THAT(notes(moved), testing::ElementsAre(testing::HasSubstr("which is used")));
  // The inverse of `same`.
  frame("{translation: [0, 0, -1], rotation: [0, 0, -0.7071067811865475, 0.7071067811865476]}",
        "base", "world");
  EXPECT_THAT(notes(moved), testing::IsEmpty());
  frame(identity, "base");
  EXPECT_THAT(notes(moved), testing::IsEmpty()) << "the pose of a frame in itself";
}

/// A message's pose of a held joint must be the one at which the joint is held.
TEST_F(MoveitStates, PosesOfHeldJointsAreCompared) {
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  };
  write("cart.urdf",
        "<robot name='cart'><link name='hall'/><link name='cart'/><link name='arm'/>"
        "<joint name='drive' type='floating'><parent link='hall'/><child link='cart'/></joint>"
        "<joint name='turn' type='continuous'><parent link='cart'/><child link='arm'/>"
        "<axis xyz='0 0 1'/></joint></robot>\n");
  const std::string robot = "format: corridor-robot-1\nurdf: cart.urdf\njoints: [turn]\n",
                    problem =
                        "format: corridor-problem-1\nrobot: cart.yaml\nmoveit: {scene: "
                        "cart_scene.yaml}\nstart: {turn: 0}\ngoal: {turn: 1}\n";
  const auto pose = [&](const std::string& x) {
    write("cart_scene.yaml",
          "world: {}\nrobot_state: {multi_dof_joint_state: {joint_names: "
          "[drive], transforms: [{translation: [" +
              x + ", 0, 0]}]}}\n");
  };
  const auto notes = [&] { return textsOf(read(problem).source.notes); };
  const auto noted =
      testing::Contains(HasSubstr("\"drive\": the joint is held at {at: [2, 0, 0], "
                                  "quat_xyzw: [0, 0, 0, 1]}, not at {at: [0, 0, 0]"));
  write("cart.yaml", robot);
  pose("0");
  EXPECT_THAT(notes(), testing::Not(testing::Contains(HasSubstr("drive\": the joint is held"))));
  pose("2");
  EXPECT_THAT(complaintOf(problem),
              HasSubstr("\"drive\": the joint is held at {at: [0, 0, 0], quat_xyzw: [0, 0, 0, 1]}, "
                        "not at {at: [2, 0, 0], quat_xyzw: [0, 0, 0, 1]} as here; give it by hold "
                        "in the robot's file"));
  write("cart.yaml", robot + "hold: {drive: {at: [2, 0, 0]}}\n");
  EXPECT_THAT(notes(), testing::Not(noted));
  pose("0");
  EXPECT_THAT(notes(), noted);
}

/// A planar joint moves across its axis, here in the plane of y and z: its x is −z. The quaternions
/// q and −q are the same rotation.
TEST_F(MoveitStates, PosesOfPlanarJointsAreThoseOfTheLink) {
  std::ofstream(folder_ / "cart.urdf")
      << "<robot name='cart'><link name='wall'/><link name='cart'/><link name='arm'/>"
         "<joint name='slide' type='planar'><parent link='wall'/><child link='cart'/>"
         "<axis xyz='1 0 0'/></joint>"
         "<joint name='turn' type='continuous'><parent link='cart'/><child link='arm'/>"
         "<axis xyz='0 0 1'/></joint></robot>\n";
  std::ofstream(folder_ / "cart.yaml")
      << "format: corridor-robot-1\nurdf: cart.urdf\njoints: [turn]\n"
         "hold: {slide: {at: [0.2, 0.3], yaw: 1.2870022175865687}}\n";  // 2·asin(0.6)
  const auto notes = [&](const std::string& translation, const std::string& rotation) {
    std::ofstream(folder_ / "cart_scene.yaml")
        << "world: {}\nrobot_state: {multi_dof_joint_state: {joint_names: [slide], transforms: "
           "[{translation: " +
               translation + ", rotation: " + rotation + "}]}}\n";
    return textsOf(read("format: corridor-problem-1\nrobot: cart.yaml\nmoveit: {scene: "
                        "cart_scene.yaml}\nstart: {turn: 0}\ngoal: {turn: 1}\n")
                       .source.notes);
  };
  const auto noted = testing::Contains(HasSubstr("\"slide\": the joint is held at "));
  EXPECT_THAT(notes("[0, 0.3, -0.2]", "[0.6, 0, 0, 0.8]"), testing::Not(noted));
  EXPECT_THAT(notes("[0, 0.3, -0.2]", "[-0.6, 0, 0, -0.8]"), testing::Not(noted));
  EXPECT_THAT(notes("[0, 0.3, -0.2]", "[-0.6, 0, 0, 0.8]"), noted);
  EXPECT_THAT(notes("[0.2, 0.3, 0]", "[0, 0, 0.6, 0.8]"), noted);
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

/// What a scene says about frames and paddings, and is not used, is a fault or in a note.
TEST_F(MoveitStates, FramesAndPaddingsThatAreNotUsed) {
  const std::string plain =
      "format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: scene.yaml}\n"
      "start: {pan: 0, lift: 0}\ngoal: {pan: 1, lift: 0}\n";
  const auto contains = [](const std::string& text) { return testing::Contains(HasSubstr(text)); };
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\ngroup: arm\n");
  write("scene.yaml",
        "world: {}\nrobot_state: {joint_state: {name: [wrist], position: [1]}}\n"
        "fixed_frame_transforms:\n- {header: {frame_id: base}, child_frame_id: odom, transform: "
        "{translation: [-5, 0, 0]}}\n- {header: {frame_id: odom}, child_frame_id: world}\n");
  const std::vector<std::string> notes = textsOf(read(plain).source.notes);
  EXPECT_THAT(notes,
              contains("fixed_frame_transforms: the poses of these frames have no effect, because "
                       "objects may only be in the world's frame and in the root's: odom, world"));
  EXPECT_THAT(notes, contains("robot_state: not used, because the joints are fixed in the URDF: "
                              "wrist"));
  write("scene.yaml",
        "link_padding: [{link_name: upper, padding: 0.2}]\nworld: {collision_objects: [{id: crate, "
        "pose: {position: [9, 0, 0]}, primitives: [{type: box, dimensions: [1, 1, 1]}], "
        "primitive_poses: [{position: [0, 0, 0]}]}]}\n");
  EXPECT_THAT(textsOf(read(plain + "padding: {bodies: {upper: 0.1}}\n").source.notes),
              contains("padding of the problem is used instead of the scene's larger link_padding "
                       "(m): upper (0.1, not 0.2)"));
  EXPECT_THAT(textsOf(read(plain + "padding: {pairs: [[upper, crate, 0]]}\n").source.notes),
              contains("link_padding (m): upper ~ crate (0, not 0.2)"));
  for (const char* const padding : {"{bodies: {upper: 0.3}}", "{pairs: [[upper, finger, 0]]}"})
    EXPECT_THAT(textsOf(read(plain + "padding: " + padding + "\n").source.notes),
                testing::Not(contains("link_padding (m)")))
        << padding;
}

/// "world" is the frame of the world, unless a link that is not the root has this name.
TEST_F(MoveitStates, ALinkNamedWorld) {
  std::string named = urdf;
  named.insert(named.find("</robot>"),
               "<link name='world'/>" + joint("to_world", "fixed", "base", "world", ""));
  write("arm.urdf", named);
  write(
      "scene.yaml",
      "world: {collision_objects: [{id: crate, header: {frame_id: world}, pose: {position: [9, 0, "
      "0]}, primitives: [{type: box, dimensions: [1, 1, 1]}], primitive_poses: [{position: [0, "
      "0, 0]}]}]}\n");
  EXPECT_THAT(complaintOf("format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: "
                          "scene.yaml}\nstart: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 1, "
                          "lift: 0, slide: 0.02}\n"),
              HasSubstr("header.frame_id: a link of the robot that is not its root is named "
                        "\"world\", and objects in its frame are not supported; give the object in "
                        "the frame of the root, \"base\""));
}

}  // namespace
}  // namespace corridor::test
