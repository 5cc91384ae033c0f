// Tests of problems that name messages of MoveIt.
#include <fstream>
#include <map>
#include <set>

#include "planner/problem/problem.h"
#include "planner/robot/joint_types.h"
#include "tests/planner/import/moveit_fixture.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;

TEST_F(Moveit, SceneAndRequest) {
  const Problem p = read(head);
  EXPECT_EQ(p.model.space.size(), 2) << "the group of the request";
  EXPECT_EQ(p.task.start, numbers(0.5, -0.25));
  ASSERT_EQ(p.task.goals.size(), 2u);
  EXPECT_EQ(p.task.goals[0], numbers(1, 0.75));
  EXPECT_EQ(p.task.goals[1], numbers(-1, 0));
  const ModelRobot& robot = p.model.robots.front();
  for (const auto& [j, value] : robot.held)
    EXPECT_EQ(value, robot.description.joints[j].name == "slide" ? 0.04 : 0)
        << "of the start state";
  const ModelBody& crate = p.model.bodies.at(p.model.bodies.size() - 2);
  EXPECT_EQ(crate.name, "crate");
  ASSERT_EQ(crate.shapes.size(), 2u);
  // The object's pose, a quarter turn about z, also applies to its primitives.
  Vec3 centre = Vec3::Zero();
  for (const Vec3& point : crate.shapes[0].parts.at(0).points) centre += point / 8;
  EXPECT_LT((centre - Vec3(0, 0, 0)).norm(), 1e-15);
  EXPECT_LT((crate.shapes[0].parts.at(0).points[0].cwiseAbs() - Vec3(0.05, 0.1, 0.2)).norm(),
            1e-15);
  EXPECT_LT((crate.shapes[1].parts.at(0).points[0] - Vec3(1, 0, 1.75)).norm(), 1e-15);
  EXPECT_EQ(crate.shapes[1].parts.at(0).radius, 0.03);
  const ModelBody& wedge = p.model.bodies.back();
  EXPECT_EQ(wedge.name, "wedge");
  EXPECT_EQ(wedge.shapes.at(0).mesh->mesh.vertices.at(1), Vec3(1, 0, 3));
  EXPECT_EQ(skipped(p, "finger", "crate"), "allowed_collision_matrix");
  EXPECT_EQ(skipped(p, "base", "lower"), "") << "false in the matrix replaces the SRDF";
  EXPECT_EQ(skipped(p, "lower", "crate"), "");
  EXPECT_EQ(skipped(p, "base", "upper"), "adjacent");
  EXPECT_THAT(p.source.files, testing::Contains(folder_ / "scene.yaml"));
  EXPECT_THAT(p.source.files, testing::Contains(folder_ / "request.yaml"));
}

TEST_F(Moveit, TheProblemsOwnKeysCount) {
  const Problem p = read(head + std::string("start: {pan: 0, lift: 0}\nworld: {post: {sphere: 1, "
                                            "at: [9, 9, 9]}}\nmargin: 0.01\n"));
  EXPECT_EQ(p.task.start, numbers(0, 0));
  EXPECT_EQ(p.task.goals.size(), 2u);
  EXPECT_EQ(p.task.margin, 0.01);
  EXPECT_EQ(p.model.bodies.at(p.model.bodies.size() - 3).name, "post");
  const Problem sceneOnly = read(
      "format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: scene.yaml}\n"
      "start: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 1, lift: 0, slide: 0.02}\n");
  EXPECT_EQ(sceneOnly.model.bodies.back().name, "wedge");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: "
                        "scene.yaml}\n")
                .find("problem.yaml: missing key \"start\""),
            0u);
}

/// An octomap is one body with MoveIt's name, so that the allowed collision matrix can name it.
TEST_F(Moveit, Octomap) {
  // Inner nodes lead to one occupied and one free cell at the positive side of the origin; data are
  // as in .bt.
  std::string data = "0, -64";  // 3 << 14: child 7 is an inner node
  for (int level = 0; level < 14; ++level) data += ", 3, 0";
  data += ", 6, 0";  // child 0 is occupied, child 1 is free
  const auto sceneWith = [&](const std::string& id, const std::string& content) {
    return "world:\n  octomap:\n    header: {frame_id: base}\n    origin: {position: [1, 0, 0], "
           "orientation: [0, 0, 1, 1]}\n    octomap: {" +
           content + ", id: " + id +
           ", resolution: 0.2}\nallowed_collision_matrix:\n  entry_names: [finger, <octomap>]\n"
           "  entry_values: [[false, true], [true, false]]\n";
  };
  write("scene.yaml", sceneWith("OcTree", "binary: true, data: [" + data + "]"));
  const Problem p = read(head);
  const ModelBody& body = p.model.bodies.back();
  EXPECT_EQ(body.name, "<octomap>");
  ASSERT_EQ(body.shapes.size(), 1u);
  ASSERT_EQ(body.shapes[0].parts.size(), 1u);
  Vec3 lower = Vec3::Constant(HUGE_VAL), upper = -lower;
  for (const Vec3& corner : body.shapes[0].parts[0].points) {
    lower = lower.cwiseMin(corner);
    upper = upper.cwiseMax(corner);
  }
  EXPECT_LT((lower - Vec3(0.8, 0, 0)).norm(), 1e-15) << "a quarter turn about z, then moved by 1";
  EXPECT_LT((upper - Vec3(1, 0.2, 0.2)).norm(), 1e-15);
  EXPECT_EQ(skipped(p, "finger", "<octomap>"), "allowed_collision_matrix");
  EXPECT_EQ(skipped(p, "lower", "<octomap>"), "");
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains(testing::EndsWith("world.octomap.octomap: cells without a "
                                                  "measurement count as free, as in MoveIt")));

  // As in .ot: a root with log-odds of 1 (0x3f800000, little-endian), and no children.
  write("scene.yaml", sceneWith("OcTree", "data: [0, 0, -128, 63, 0]"));
  const Problem full = read(head);
  EXPECT_EQ(full.model.bodies.back().shapes.at(0).parts.size(), 1u);
  // A free root, and no data: there is no obstacle.
  for (const char* const content : {"data: [0, 0, 128, 191, 0]", "data: []"}) {
    write("scene.yaml", sceneWith("OcTree", content));
    EXPECT_TRUE(read(head).model.bodies.back().robot) << content;
  }
  write("scene.yaml", "world: {octomap: null}\n---\n");
  EXPECT_TRUE(read(head).model.bodies.back().robot);
}

TEST_F(Moveit, FaultsOfTheScene) {
  const auto complaint = [&](const std::string& text) {
    write("scene.yaml", text);
    return complaintOf(head);
  };
  const auto object = [](const std::string& content) {
    return "world:\n  collision_objects:\n    - {id: a, " + content + "}\n";
  };
  const std::string a = "scene.yaml:3: object \"a\"";
  EXPECT_EQ(complaint(object("primitives: [{type: cone, dimensions: [1, 2]}]")),
            a + ".primitives[0].type: one of box, sphere, cylinder is needed, not \"cone\"");
  EXPECT_EQ(complaint(object("primitives: [{type: box, dimensions: [1, 2]}]")),
            a + ".primitives[0].dimensions: a list of 3 numbers is needed, not a list of 2");
  EXPECT_THAT(complaint(object("primitives: [{type: box, dimensions: [1, 2, 0]}]")),
              HasSubstr("primitives[0].dimensions: "));
  EXPECT_EQ(complaint(object("primitives: [{type: sphere, dimensions: [1]}], primitive_poses: "
                             "[{position: [0, 0, 0]}, {position: [0, 0, 0]}]")),
            a + ".primitive_poses: 1 are needed, one for each of primitives, not 2");
  EXPECT_EQ(complaint(object("primitives: [{type: sphere, dimensions: [1]}], pose: {orientation: "
                             "[0, 0, 0, 0]}")),
            "no complaint")
      << "the default of messages, which is noted";
  EXPECT_EQ(complaint(object("header: {frame_id: hand}, primitives: [{type: sphere, dimensions: "
                             "[1]}]")),
            a + ".header.frame_id: the frame of the robot's root, \"base\", or \"world\" is "
                "needed, not \"hand\"");
  EXPECT_EQ(complaint(object("planes: [{coef: [0, 0, 1, 0]}], primitives: [{type: sphere, "
                             "dimensions: [1]}]")),
            a + ".planes: planes are not supported; use a flat box");
  for (const char* const operation : {"0", "ADD", "\"\\0\"", "2", "\"\\x02\""})
    EXPECT_EQ(complaint(object("operation: " + std::string(operation))),
              a + ".primitives: the object has neither primitives nor meshes");
  EXPECT_EQ(complaint(object("meshes: [{vertices: [[0, 0, 0]], triangles: [{vertex_indices: [0, 0, "
                             "1]}]}]")),
            a + ".meshes[0].triangles[0].vertex_indices: the mesh has no vertex 1");
  EXPECT_EQ(complaint("world: {}\nrobot_state: {attached_collision_objects: [{link_name: "
                      "hand}]}\n"),
            "scene.yaml:2: robot_state.attached_collision_objects: is not supported; add the "
            "objects to the robot");
  const std::string map = "scene.yaml:1: world.octomap.octomap";
  EXPECT_EQ(complaint("world: {octomap: {octomap: {id: OcTree, data: [1, 2]}}}\n"),
            map.substr(0, 12) +
                ": missing key \"resolution\" in world.octomap.octomap: the edge "
                "length of a cell, metres");
  EXPECT_EQ(complaint("world: {octomap: {octomap: {resolution: 0.1, data: [1, 2]}}}\n"),
            map + ": the message ends within its nodes: it is cut short");
  EXPECT_EQ(complaint("world: {octomap: {octomap: {resolution: 0.1, id: X, data: [1, 2]}}}\n"),
            map + ": trees of type \"X\" can't be read; save an OcTree or a ColorOcTree");
  EXPECT_EQ(complaint("world: {octomap: {octomap: {resolution: 0.1, binary: true, data: [0, 0, "
                      "7]}}}\n"),
            map + ": 1 byte comes after the last node: the message is damaged");
  EXPECT_EQ(complaint("world: {octomap: {octomap: {resolution: 0.1, data: [1, 256]}}}\n"),
            map + ".data[1]: a whole number from -128 to 255 is needed, not \"256\"");
  EXPECT_EQ(complaint("world: {octomap: {octomap: {resolution: 0.1, data: [1, ...]}}}\n"),
            map +
                ".data[1]: a whole number from -128 to 255 is needed, not \"...\" (ros2 topic "
                "echo --full-length writes whole lists)");
  EXPECT_EQ(complaint("world: {octomap: {header: {frame_id: hand}}}\n"),
            "scene.yaml:1: world.octomap.header.frame_id: the frame of the robot's root, \"base\", "
            "or \"world\" is needed, not \"hand\"");
  EXPECT_THAT(complaint("world: {octomap: {octomap: {resolution: 1, dat: [1]}}}\n"),
              HasSubstr("unknown key \"dat\" in world.octomap.octomap (did you mean \"data\"?)"));
  EXPECT_EQ(complaint("world: {}\nallowed_collision_matrix: {entry_names: [a, b], "
                      "entry_values: [[true, true]]}\n"),
            "scene.yaml:2: allowed_collision_matrix.entry_values: 2 rows are needed, not 1");
  EXPECT_EQ(complaint("world: {}\nallowed_collision_matrix: {entry_names: [a, b], "
                      "entry_values: [[true], [true, true]]}\n"),
            "scene.yaml:2: allowed_collision_matrix.entry_values[0]: 2 values are needed, not 1");
  EXPECT_EQ(complaint("world: {}\nallowed_collision_matrix: {entry_names: [a, b], "
                      "entry_values: [[false, false], [true, false]]}\n"),
            "scene.yaml:2: allowed_collision_matrix.entry_values[1]: the matrix is not symmetric: "
            "\"b\" and \"a\" are allowed in one order only");
  EXPECT_EQ(complaint("link_padding: [{link_name: hand, padding: 0}, {link_name: arm, padding: "
                      "0.1}]\nlink_scale: [{link_name: hand, scale: 1}, {link_name: arm, scale: "
                      "2}]\nworld: {}\n"),
            "scene.yaml:2: link_scale.scale: links are tested in their own size; use link_padding, "
            "or padding in the problem, for a distance to keep");
  EXPECT_EQ(complaint("link_padding: [{padding: 0.1}, {link_name: hand, padding: -1}]\nworld: "
                      "{}\n"),
            "scene.yaml:1: missing key \"link_name\" in link_padding: the link that is padded\n"
            "scene.yaml:1: link_padding.padding: must be 0 or more, not -1");
  for (const char* const second : {"0", "0.01"})
    EXPECT_EQ(
        complaint("link_padding: [{link_name: hand, padding: 0.5}, {link_name: hand, padding: " +
                  std::string(second) + "}]\nworld: {}\n"),
        "scene.yaml:1: link_padding.link_name: link_padding names \"hand\" twice");
  EXPECT_THAT(complaint("wrld: {}\n"),
              HasSubstr("scene.yaml:1: unknown key \"wrld\" (did you mean \"world\"?)"));
  EXPECT_EQ(complaint("name: empty\n"),
            "scene.yaml: missing key \"world\": the collision objects of a planning scene of "
            "MoveIt");
  EXPECT_THAT(complaint(object("primitives: [{type: sphere, dimensions: [1]}], primitive_poses: "
                               "[{postion: [0, 0, 9]}]")),
              HasSubstr("unknown key \"postion\" in object \"a\".primitive_poses[0] (did you mean "
                        "\"position\"?)"));
  EXPECT_EQ(complaint(object("operation: 1, primitives: [{type: sphere, dimensions: [1]}]")),
            a + ".operation: only ADD (0) is supported, not \"1\"");
  EXPECT_EQ(
      complaint(object("operation: \"\\x01\", primitives: [{type: sphere, dimensions: [1]}]")),
      a + ".operation: only ADD (0) is supported, not \"?\"");
  EXPECT_EQ(complaint("world:\n  collision_objects:\n    - {id: a, primitives: [{type: sphere, "
                      "dimensions: [1]}]}\n    - {id: a, primitives: [{type: sphere, dimensions: "
                      "[1]}]}\n"),
            "scene.yaml:4: object \"a\".id: another object has this name");
  EXPECT_THAT(complaint("{"), HasSubstr("scene.yaml:"));
}

TEST_F(Moveit, SwappedFiles) {
  const std::string said = complaintOf(
      "format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: request.yaml, request: "
      "scene.yaml}\n");
  EXPECT_THAT(said,
              HasSubstr("request.yaml: is a motion plan request, not a planning scene (it has "
                        "group_name); write moveit: {request: FILE}"));
  EXPECT_THAT(said, HasSubstr("scene.yaml: is a planning scene, not a motion plan request (it has "
                              "world); write moveit: {scene: FILE}"));
}

TEST_F(Moveit, FaultsOfTheRequest) {
  const auto complaint = [&](const std::string& text) {
    write("request.yaml", text);
    return complaintOf(head);
  };
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = request;
    text.replace(text.find(from), from.size(), to);
    return complaint(text);
  };
  EXPECT_EQ(changed("group_name: arm", "group_name: amr"),
            "arm.yaml:1: group: the request names it; there is no group \"amr\" in the SRDF (did "
            "you mean \"arm\"?) "
            "(known: arm, nothing)");
  EXPECT_EQ(changed("[pan, lift,", "[pan, lft,"),
            "request.yaml:4: start_state: has no value for lift; all joints that are planned for "
            "need one");
  EXPECT_EQ(changed("-0.25", "4"),
            "request.yaml:4: start_state: lift: 4 is outside of its limits, [-3.14159, 3.14159]");
  EXPECT_EQ(changed("0.04", "4"),
            "request.yaml:4: start_state: slide: 4 is outside of its limits, [0.01, 0.05]");
  EXPECT_EQ(changed("position: [0.5, ", "position: ["),
            "request.yaml:6: start_state.joint_state.position: a list of 5 numbers is needed, not "
            "a list of 4");
  EXPECT_EQ(changed("joint_name: lift, position: 0.75", "joint_name: lft"),
            "request.yaml:8: goal_constraints[0].joint_constraints: has no value for lift; all "
            "joints that are planned for need one\n"
            "request.yaml:10: missing key \"position\" in goal_constraints[0].joint_constraints: "
            "the joint's value");
  EXPECT_EQ(complaint("start_state: {joint_state: {name: [pan, lift, slide], position: [0, 0, "
                      "0.02]}}\n"),
            "request.yaml:1: goal_constraints: at least one goal is needed");
  EXPECT_EQ(changed("goal_constraints:\n",
                    "path_constraints: {orientation_constraints: "
                    "[{weight: 1}]}\ngoal_constraints:\n"),
            "request.yaml:7: path_constraints.orientation_constraints: constraints of the path are "
            "not supported");
  EXPECT_EQ(changed("  - joint_constraints:\n",
                    "  - position_constraints: [{weight: 1}]\n    "
                    "joint_constraints:\n"),
            "request.yaml:8: goal_constraints[0].position_constraints: only goals by joint values "
            "are supported (joint_constraints)");
  EXPECT_EQ(
      changed("{joint_name: lift, position: 0}",
              "{joint_name: lift, position: 0}\n      - "
              "{joint_name: slide, position: 0.02}\n"
              "      - {joint_name: lft, position: 0}\n"
              "      - {joint_name: lift, position: 1}"),
      "request.yaml:11: goal_constraints[1].joint_constraints: there is no joint \"lft\" (did "
      "you mean \"lift\"?) (known: pan, lift, slide)\n"
      "request.yaml:11: goal_constraints[1].joint_constraints: slide is held at 0.04, and "
      "can't move to 0.02\n"
      "request.yaml:15: goal_constraints[1].joint_constraints.joint_name: \"lift\" is named "
      "twice");
  EXPECT_EQ(changed("[pan, lift, slide, follow,", "[pan, lift, slide, lift,"),
            "request.yaml:5: start_state.joint_state.name: \"lift\" is named twice");
  EXPECT_EQ(
      changed("start_state:\n",
              "start_state:\n  multi_dof_joint_state: {joint_names: "
              "[virtual], transforms: [{translation: [0, 0, 0.5], rotation: [0, 0, 0, 1]}]}\n"),
      "request.yaml:4: start_state.multi_dof_joint_state.transforms: \"virtual\": the base is at "
      "{at: [0, 0, 0], quat_xyzw: [0, 0, 0, 1]}, not at {at: [0, 0, 0.5], quat_xyzw: [0, 0, 0, 1]} "
      "as here; give it by base in the problem");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: "
                        "none.yaml}\nstart: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 0, lift: "
                        "0, slide: 0.02}\n"),
            "problem.yaml:3: moveit.scene: none.yaml: no such file");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {}\nstart: {pan: 0, "
                        "lift: 0, slide: 0.02}\ngoal: {pan: 0, lift: 0, slide: 0.02}\n"),
            "problem.yaml:3: moveit: scene: FILE, request: FILE, or both are needed");
}

/// Objects that are attached to the robot's root link move with the robot's base.
TEST_F(Moveit, ObjectsOnTheRoot) {
  const Problem p = read(head + std::string("base: {at: [0, 0, 5]}\n"));
  EXPECT_EQ(p.model.bodies.back().name, "wedge");
  EXPECT_EQ(p.model.bodies.back().shapes.at(0).mesh->mesh.vertices.at(1), Vec3(1, 0, 8));
  const ModelBody& crate = p.model.bodies.at(p.model.bodies.size() - 2);
  EXPECT_LT((crate.shapes[1].parts.at(0).points[0] - Vec3(1, 0, 1.75)).norm(), 1e-15)
      << "in the world";
}

/// A quaternion of any norm counts as the normalised quaternion.
TEST_F(Moveit, TinyQuaternions) {
  for (const std::string size : {"1e-170", "1e170", "1"}) {
    write("scene.yaml",
          "world: {collision_objects: [{id: a, primitives: [{type: box, dimensions: "
          "[2, 4, 6]}], primitive_poses: [{orientation: [0, 0, " +
              size + ", " + size + "]}]}]}\n");
    const Problem p = read(head);
    const Vec3 corner = p.model.bodies.back().shapes.at(0).parts.at(0).points.at(0).cwiseAbs();
    EXPECT_LT((corner - Vec3(2, 1, 3)).norm(), 1e-14) << size;
  }
}

/// The start of the problem replaces that of the request, also for held joints.
TEST_F(Moveit, HeldJointsFollowTheProblemsStart) {
  write("arm.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\nstates: {near: {pan: 0, lift: "
        "0, slide: 0.02}}\n");
  const auto slide = [&](const std::string& more) {
    const Problem p = read(head + more);
    const ModelRobot& robot = p.model.robots.front();
    return robot.held.at(*findJoint(robot.description, "slide"));
  };
  EXPECT_EQ(slide(""), 0.04);
  EXPECT_EQ(slide("start: near\n"), 0.02);
  EXPECT_EQ(slide("start: {pan: 0, lift: 0}\n"), 0.04);
}

TEST_F(Moveit, LinkPadding) {
  write("scene.yaml", scene +
                          "link_padding: [{link_name: upper, padding: 0.02}, {link_name: hand, "
                          "padding: 0}, {link_name: lower, padding: 0.03}, {link_name: uper, "
                          "padding: 0.1}]\n");
  const auto paddingOf = [](const Problem& p, const std::string& a, const std::string& b) {
    const auto indexOf = [&](const std::string& name) {
      return static_cast<std::size_t>(&bodyOf(p, name) - p.model.bodies.data());
    };
    return corridor::paddingOf(p.model, p.task.padding, indexOf(a), indexOf(b));
  };
  const Problem p = read(head);
  EXPECT_NEAR(paddingOf(p, "upper", "crate"), 0.02, 1e-15);
  EXPECT_NEAR(paddingOf(p, "crate", "lower"), 0.03, 1e-15);
  EXPECT_EQ(paddingOf(p, "upper", "finger"), 0);  // two links of one robot
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains(testing::EndsWith(
                  "scene.yaml: its link_padding has names of no links (1): uper")));
  // The problem's own padding replaces that of the same link.
  EXPECT_NEAR(
      paddingOf(read(std::string(head) + "padding: {bodies: {upper: 0.5}}\n"), "upper", "crate"),
      0.5, 1e-14);
}

TEST_F(Moveit, ASceneOfAnotherRobotIsNoted) {
  std::string text = scene;
  text += "robot_model_name: fetch\n";
  text.replace(text.find("[base, lower, crate, finger]"), 28, "[base, lower, crate, fingre]");
  write("scene.yaml", text);
  const Problem p = read(head);
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains(testing::EndsWith(
                  "scene.yaml: is for robot \"fetch\", and is used for \"armbot\"")));
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains(testing::EndsWith("has names of neither links nor obstacles (1): "
                                                  "fingre")));
}

TEST_F(Moveit, ARequestNeedsJoints) {
  write("rigid.yaml", "format: corridor-robot-1\nrigid: SE3\nshapes: [{sphere: 1}]\n");
  EXPECT_EQ(
      complaintOf(
          "format: corridor-problem-1\nrobot: rigid.yaml\nmoveit: "
          "{request: request.yaml}\nworld: {a: {sphere: 1}}\nstart: {at: [9, 9, 9]}\ngoal: {at: "
          "[9, 9, 8]}\n"),
      "problem.yaml:3: moveit: a request is for a robot with joints; this one is rigid");
}

/// The messages of MotionBenchMaker give the same models, starts and goals as the set made of them.
TEST(SharedMoveit, IsTheSameProblemAsTheSet) {
  const auto data = dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  const std::filesystem::path folder = newFolder();
  int compared = 0;
  for (const std::string robot : {"panda", "ur5"}) {
    const std::filesystem::path robots = *data / "robots" / robot / robot;
    std::ofstream(folder / "robot.yaml") << "format: corridor-robot-1\nurdf: " << robots.string()
                                         << ".urdf\nsrdf: " << robots.string() << ".srdf\n";
    for (const auto& entry : std::filesystem::directory_iterator(*data / "mbm/raw" / robot)) {
      const std::string name = entry.path().filename().string();
      const std::string scene = name.substr(0, name.size() - robot.size() - 1);
      std::ofstream(folder / "problem.yaml")
          << "format: corridor-problem-1\nrobot: robot.yaml\nmoveit: {scene: "
          << (entry.path() / "scene0001.yaml").string()
          << ", request: " << (entry.path() / "request0001.yaml").string() << "}\n";
      const Problem raw = readProblem(folder / "problem.yaml");
      const Problem set = readProblem((*data / "mbm" / robot / (scene + ".json")).string() + "#1");
      SCOPED_TRACE(name);
      EXPECT_EQ(raw.task.start, set.task.start);
      EXPECT_EQ(raw.task.goals, set.task.goals);
      ASSERT_EQ(raw.model.bodies.size(), set.model.bodies.size());
      std::map<std::string, const ModelBody*> bodies;
      for (const ModelBody& body : set.model.bodies) bodies[body.name] = &body;
      for (const ModelBody& body : raw.model.bodies) {
        ASSERT_TRUE(bodies.contains(body.name)) << body.name;
        const auto& shapes = bodies[body.name]->shapes;
        ASSERT_EQ(body.shapes.size(), shapes.size());
        for (std::size_t i = 0; i < shapes.size(); ++i) {
          if (shapes[i].mesh) continue;
          ASSERT_EQ(body.shapes[i].parts.at(0).points.size(), shapes[i].parts.at(0).points.size());
          for (std::size_t k = 0; k < shapes[i].parts.at(0).points.size(); ++k)
            EXPECT_LT(
                (body.shapes[i].parts.at(0).points[k] - shapes[i].parts.at(0).points[k]).norm(),
                1e-12);
        }
      }
      const auto pairsOf = [](const Problem& p) {
        std::set<std::string> tested;
        forEachTestedPair(p.model, requiredBy(p.task), [&](std::size_t a, std::size_t b) {
          const auto [x, y] = std::minmax(p.model.bodies[a].name, p.model.bodies[b].name);
          tested.insert(x + "~" + y);
        });
        return tested;
      };
      EXPECT_EQ(pairsOf(raw), pairsOf(set));
      ++compared;
    }
  }
  EXPECT_EQ(compared, 14);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace corridor::test
