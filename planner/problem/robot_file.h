#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Something of a robot that a start gives a place to: a single joint that is planned for, or what
/// moves as a whole (a planar or floating joint, or a rigid robot).
struct Freedom {
  std::string name;  ///< of the joint; "" for the rigid robot itself
  JointType type = JointType::revolute;
  std::size_t coordinate = 0;  ///< index of its (first) coordinate in the problem's space
};

/// A robot on its way into a problem: what its file says, and later where its parts are in the
/// problem.
struct RobotSetup {
  ProblemRobot robot;
  std::vector<std::size_t> active;             ///< joints that are planned for, in order
  std::map<std::size_t, double> held;          ///< values of the other single joints
  std::map<std::size_t, RigidPose> heldPoses;  ///< and of planar and floating ones
  std::map<std::string, double> jointWeights;
  double rotationWeight = 0.5;  ///< metres per radian of rotation; OMPL's default for SE2 and SE3
  std::vector<std::filesystem::path> files;  ///< all that were named, its own first
  std::vector<Freedom> freedoms;             ///< set where the robot joins the problem's space

  bool isRigid() const { return robot.model.mount != JointType::fixed; }
};

/// Reads a file of the format corridor-robot-1, or a bare URDF. Its faults, and those of the files
/// that it names, go to `faults`; nullopt where the robot isn't known well enough for anything to
/// be said of its start (a rigid one's faulted shapes are left out).
std::optional<RobotSetup> readRobotFile(const std::filesystem::path& file, FaultList& faults);

/// A rigid robot. @param type planar or floating.
RobotModel rigidModel(const std::string& name, JointType type, std::vector<PlacedShape> shapes);

}  // namespace corridor
