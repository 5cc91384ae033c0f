#pragma once

#include <string>

#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {

/// Problems of the arm of ArmTest that name a scene and a request of MoveIt.
class Moveit : public ArmTest {
 protected:
  void SetUp() override {
    ArmTest::SetUp();
    write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\n");
    write("scene.yaml", scene);
    write("request.yaml", request);
  }
  static constexpr const char* head =
      "format: corridor-problem-1\nrobot: arm.yaml\nmoveit: {scene: scene.yaml, request: "
      "request.yaml}\n";
  inline static const std::string scene = R"(name: ""
world:
  collision_objects:
    - id: crate
      pose: {position: [1, 0, 0], orientation: [0, 0, 1, 1]}
      primitives:
        - type: box
          dimensions: [0.2, 0.1, 0.4]
        - {type: 3, dimensions: [0.5, 0.03]}
      primitive_poses:
        - position: [0, 1, 0]
          orientation: [0, 0, 0, 2]
        - {position: {x: 0, y: 0, z: 2}, orientation: {x: 0, y: 0, z: 0, w: 1}}
    - id: wedge
      header: {frame_id: base}
      meshes:
        - vertices: [{x: 0, y: 0, z: 0}, [1, 0, 0], [0, 1, 0]]
          triangles: [{vertex_indices: [0, 1, 2]}]
      mesh_poses: [{position: [0, 0, 3]}]
robot_state: {joint_state: {name: [pan], position: [9]}}
allowed_collision_matrix:
  entry_names: [base, lower, crate, finger]
  entry_values:
    - [false, false, false, true]
    - {enabled: [false, false, false, false]}
    - [false, false, false, true]
    - [true, false, true, false]
)";
  inline static const std::string request = R"(group_name: arm
planner_id: RRTConnect
start_state:
  joint_state:
    name: [pan, lift, slide, follow, unknown]
    position: [0.5, -0.25, 0.04, 7, 7]
goal_constraints:
  - joint_constraints:
      - {joint_name: pan, position: 1, tolerance_above: 0.001}
      - {joint_name: lift, position: 0.75}
  - joint_constraints:
      - {joint_name: lift, position: 0}
      - {joint_name: pan, position: -1}
)";
  static Configuration numbers(double a, double b) { return Eigen::Vector2d(a, b); }
};

}  // namespace corridor::test
