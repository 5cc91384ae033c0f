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

/// An entry of a robot's start: a joint that is planned for, or the pose of a rigid robot.
struct DegreeOfFreedom {
  std::string name;  ///< name of the joint; "" for a rigid robot
  JointType type = JointType::revolute;
  std::size_t coordinate = 0;  ///< index of its (first) coordinate in the problem's space
};

/// A robot while a problem is read: the content of its file, and then its coordinates in the
/// problem.
struct RobotSetup {
  ProblemRobot robot;
  std::vector<std::size_t> active;             ///< joints that are planned for, in order
  std::map<std::size_t, double> held;          ///< values of the other single joints, rad or m
  std::map<std::size_t, RigidPose> heldPoses;  ///< poses of the other planar and floating joints
  std::map<std::string, double> jointWeights;  ///< joints that are not listed have weight 1
  double rotationWeight = 0.5;  ///< metres per radian of rotation; OMPL's default for SE2 and SE3
  std::vector<std::filesystem::path> files;  ///< the robot's file, then all that it names
  std::vector<DegreeOfFreedom> freedoms;     ///< set by `assembleRobots`

  bool isRigid() const { return robot.model.mount != JointType::fixed; }
};

/// Reads a file of the format corridor-robot-1, or a bare URDF. Its faults, and those of the files
/// that it names, go to `faults`. Returns nullopt if the robot is not known well enough to read its
/// start. A rigid robot is returned without the shapes that have faults.
std::optional<RobotSetup> readRobotFile(const std::filesystem::path& file, FaultList& faults);

/// Makes the model of a rigid robot. @param type planar or floating.
RobotModel rigidModel(const std::string& name, JointType type, std::vector<PlacedShape> shapes);

}  // namespace corridor
