#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/problem/bounds_of_ends.h"
#include "planner/problem/problem.h"
#include "tests/support/support.h"

namespace corridor::test {

inline const ModelBody& bodyOf(const Problem& problem, const std::string& name) {
  for (const ModelBody& body : problem.model.bodies)
    if (body.name == name) return body;
  throw std::runtime_error("no body " + name);
}
/// Returns the mesh of shape i of a body.
inline const TriangleMesh& meshOf(const Problem& problem, const std::string& name,
                                  std::size_t i = 0) {
  const auto& mesh = bodyOf(problem, name).shapes.at(i).mesh;
  if (!mesh) throw std::runtime_error(name + " is no mesh");
  return mesh->mesh;
}
/// Returns the lower corner of the bounds of a rigid robot's position.
inline Vec3 lowerOf(const Problem& problem) {
  return boundsOf(problem.model.space, problem.model.space.groups().front()).lower;
}
inline Vec3 upperOf(const Problem& problem) {
  return boundsOf(problem.model.space, problem.model.space.groups().front()).upper;
}
inline bool isPlanar(const Problem& problem) {
  return problem.model.robots.at(0).description.mount == JointType::planar;
}
inline Configuration numbers(std::initializer_list<double> list) {
  Configuration q(static_cast<Eigen::Index>(list.size()));
  std::copy(list.begin(), list.end(), q.data());
  return q;
}

/// Writes small problem files into a temporary folder, with robots and a mesh beside them.
class ProblemTest : public testing::Test {
 protected:
  void SetUp() override {
    write("wedge.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    write("robot.yaml", robot3);
    write("flat.yaml", robot2);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  Problem read(const std::string& text) const { return readProblem(write("problem.yaml", text)); }

  /// Returns the message of the InputError that reading throws, without the folder's path.
  std::string complaint(const std::filesystem::path& path) const {
    try {
      readProblem(path);
    } catch (const InputError& error) {
      std::string text = error.what();
      const std::string prefix = folder_.string() + '/';
      for (auto at = text.find(prefix); at != text.npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      return text;
    }
    return "no complaint";
  }
  std::string complaintOf(const std::string& text) const {
    return complaint(write("problem.yaml", text));
  }
  std::string complaintOfRobot(const std::string& text) const {
    write("robot.yaml", text);
    return complaintOf(head + poses);
  }

  static constexpr const char* robot3 =
      "format: corridor-robot-1\nname: wedge\nrigid: SE3\nshapes: [{mesh: wedge.obj}]\n";
  static constexpr const char* robot2 =
      "format: corridor-robot-1\nrigid: SE2\nshapes: [{mesh: wedge.obj}]\n";
  /// Lines 1 to 4 of a problem file.
  inline static const std::string head =
      "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  rock: {mesh: wedge.obj}\n";
  inline static const std::string planarHead =
      "format: corridor-problem-1\nrobot: flat.yaml\nworld:\n  rock: {mesh: wedge.obj}\n";
  /// Lines 5 to 7 of a problem file.
  inline static const std::string poses =
      "start: {at: [5, 0, 0]}\ngoal: {at: [0, 5, 0]}\nbounds: {at: [[-9, -9, -9], [9, 9, 9]]}\n";
  inline static const std::string planarPoses =
      "start: {at: [5, 0]}\ngoal: {at: [0, 5]}\nbounds: {at: [[-9, -9], [9, 9]]}\n";

  std::filesystem::path folder_ = newFolder();
};

/// Writes square.yaml: a rigid body in the plane, a square with edges of 0.2 m.
class SquareTest : public ProblemTest {
 protected:
  void SetUp() override {
    ProblemTest::SetUp();
    write("square.yaml",
          "format: corridor-robot-1\nname: square\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
  }
  static Configuration at(double x, double y, double yaw = 0) { return numbers({x, y, yaw}); }
};

}  // namespace corridor::test
