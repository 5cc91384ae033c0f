#pragma once

#include <string>

#include "planner/trajectory/trajectory_file.h"
#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {

/// A problem of the arm of ArmTest, with the planned joints pan (continuous) and lift (within ±2).
/// Its slide is held at 0.02; follow mimics slide, and wag mimics lift.
class TrajectoryTest : public ArmTest {
 protected:
  void SetUp() override {
    ArmTest::SetUp();
    std::string text = urdf;
    const std::string end = "</robot>";
    text.replace(text.find(end), end.size(),
                 "<link name='tail'/>" +
                     joint("wag", "revolute", "base", "tail",
                           "<axis xyz='0 0 1'/><limit lower='-9' upper='9' effort='1' "
                           "velocity='1'/><mimic joint='lift' multiplier='-2' offset='0.5'/>") +
                     end);
    write("arm.urdf", text);
    write("arm.yaml",
          "format: corridor-robot-1\nname: arm7\nurdf: arm.urdf\njoints: [pan, lift]\n"
          "hold: {slide: 0.02}\n");
    problem_ = readProblem(write("arm_problem.yaml", armHead + "start: {pan: 0, lift: 0}\n"
                                                               "goal: {pan: 1, lift: 0.5}\n"));
  }

  TrajectoryRows rows(const std::string& text) const {
    return readTrajectory("t.csv", text, problem_.model);
  }
  /// Returns the faults for which a text is refused; "" if it is read.
  std::string complaint(const std::string& text) const { return complaint(text, problem_); }
  static std::string complaint(const std::string& text, const Problem& problem) {
    try {
      readTrajectory("t.csv", text, problem.model);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  Problem problem_;
};

}  // namespace corridor::test
