#pragma once

#include <string>

#include "tests/planner/app/program_test.h"

/// Small problems that the tests of several commands use.
namespace corridor::test {

/// Writes a problem: a cube that moves freely, and a wall beside the cube's way.
class CubeTest : public ProgramTest {
 protected:
  CubeTest() {
    write("cube.obj",
          "v -.1 -.1 -.1\nv .1 -.1 -.1\nv .1 .1 -.1\nv -.1 .1 -.1\nv -.1 -.1 .1\nv .1 -.1 .1\nv .1 "
          ".1 .1\nv -.1 .1 .1\n"
          "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 3 4 8\nf 3 8 7\nf 2 3 7\nf 2 7 "
          "6\nf 1 5 8\nf 1 8 4\n");
    write("wall.obj", "v 0 -5 -5\nv 0 2 -5\nv 0 2 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\n");
    write(
        "robot.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE3\nshapes: [{mesh: cube.obj, unit: m}]\n");
    write("problem.yaml", problem());
  }

  static std::string problem(const std::string& start = "-2, 0, 0", const std::string& more = "") {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {mesh: wall.obj, unit: "
           "m}\nstart: {at: [" +
           start + "]}\ngoal: {at: [2, 0, 0]}\nbounds: {at: [[-4, -4, -4], [4, 4, 4]]}\n" + more;
  }
};

/// Writes a problem: an arm of two links with revolute joints about z, and a post beside the arm.
class ArmTest : public CubeTest {
 protected:
  ArmTest() {
    write(
        "arm.urdf",
        "<robot name=\"arm\">\n"
        "<link name=\"base\"/>\n"
        "<link name=\"upper\"><collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"0.8 0.1 "
        "0.1\"/></geometry></collision></link>\n"
        "<link name=\"lower\"><collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"0.8 0.1 "
        "0.1\"/></geometry></collision></link>\n"
        "<joint name=\"shoulder\" type=\"revolute\"><parent link=\"base\"/><child link=\"upper\"/>"
        "<axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" "
        "velocity=\"1\"/></joint>\n"
        "<joint name=\"elbow\" type=\"revolute\"><parent link=\"upper\"/><child link=\"lower\"/>"
        "<origin xyz=\"1 0 0\"/><axis xyz=\"0 0 1\"/><limit lower=\"-2\" upper=\"2\" effort=\"1\" "
        "velocity=\"1\"/></joint>\n"
        "</robot>\n");
    write("arm.yaml",
          "format: corridor-problem-1\nrobot: arm.urdf\nworld:\n  post: {sphere: 0.1, at: [0, 1.5, "
          "0]}\n"
          "start: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
  }
};

/// Writes a problem: a cube that moves in a plane, and a short wall.
class HallTest : public ProgramTest {
 protected:
  HallTest() {
    write("robot.yaml",
          "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
    write("hall.yaml", hall(""));
  }

  static std::string hall(const std::string& more) {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.1, 2, 1]}\n"
           "start: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n" +
           more;
  }
};

}  // namespace corridor::test
