#include "planner/checker/fixed_pairs.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/problem_goal.h"
#include "planner/problem/problem.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::string ballLink(const std::string& name, double radius) {
  return "<link name='" + name + "'><collision><geometry><sphere radius='" +
         std::to_string(radius) + "'/></geometry></collision></link>";
}

std::string jointBetween(const std::string& type, const std::string& parent,
                         const std::string& child, const std::string& at) {
  return "<joint name='to_" + child + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><origin xyz='" + at + "'/><axis xyz='0 1 0'/>" +
         "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>";
}

/// A robot with a base, a plate fixed to it, an arm, and a finger and a thumb on slides that can be
/// held.
class FixedPairs : public testing::Test {
 protected:
  FixedPairs() : folder_(test::newFolder()) {
    std::ofstream(folder_ / "arm.urdf")
        << "<robot name='arm'>" << ballLink("base", 0.1) << ballLink("plate", 0.05)
        << ballLink("arm", 0.1) << ballLink("finger", 0.05) << ballLink("thumb", 0.05)
        << jointBetween("fixed", "base", "plate", "0.12 0 0")
        << jointBetween("revolute", "base", "arm", "0 0 1")
        << jointBetween("prismatic", "arm", "finger", "0.5 0 0")
        << jointBetween("prismatic", "arm", "thumb", "0.5 0 0.02") << "</robot>";
  }
  ~FixedPairs() override { std::filesystem::remove_all(folder_); }

  /// Returns the pairs of a problem with these keys, "a ~ b: touch" or "a ~ b: close", and their
  /// notes.
  std::vector<std::string> pairsOf(const std::string& keys) {
    std::ofstream(folder_ / "robot.yaml")
        << "format: corridor-robot-1\nurdf: arm.urdf\njoints: [to_arm]\nhold: {to_finger: " << held_
        << "}\n";
    std::ofstream(folder_ / "problem.yaml") << "format: corridor-problem-1\nrobot: robot.yaml\n"
                                            << "start: {to_arm: 0}\ngoal: {to_arm: 0.5}\n"
                                            << keys;
    const Problem problem = readProblem(folder_ / "problem.yaml");
    const Checker checker(problem);
    const auto pairs = closeFixedPairs(checker, startOf(problem));
    notes_ = textsOf(notesOnFixedPairs(checker, startOf(problem)));
    std::vector<std::string> texts;
    for (const FixedPair& pair : pairs)
      texts.push_back(problem.model.bodies[pair.a].name + " ~ " +
                      problem.model.bodies[pair.b].name + (pair.touches ? ": touch" : ": close"));
    return texts;
  }

  std::filesystem::path folder_;
  double held_ = 0.3;
  std::vector<std::string> notes_;
};

TEST_F(FixedPairs, TouchOrAreWithinTheMargin) {
  EXPECT_THAT(pairsOf("world: {far: {box: [1, 1, 0.2], at: [0, 0, -0.3]}}\n"), IsEmpty())
      << "the plate overlaps the base, to which it is fixed";
  EXPECT_THAT(notes_, IsEmpty());

  const std::string world =
      "world:\n  table: {box: [1, 1, 0.2], at: [0, 0, -0.199]}\n"
      "  wall: {box: [0.1, 0.1, 0.1], at: [0, 0.155, 0]}\n";
  EXPECT_THAT(pairsOf(world), ElementsAre("base ~ table: touch"));
  EXPECT_THAT(pairsOf(world + "margin: 0.01\n"),
              ElementsAre("base ~ table: touch", "base ~ wall: close"));
  EXPECT_THAT(notes_,
              ElementsAre("in every state, these bodies touch: base ~ table; no proof covers these "
                          "pairs, because only fixed joints are between their bodies (allow: "
                          "[[base, table]] if this is intended)",
                          "in every state, these bodies are closer than the margin: base ~ wall; "
                          "no proof covers these pairs, because only fixed joints are between "
                          "their bodies (allow: [[base, wall]] if this is intended)"));
  EXPECT_THAT(pairsOf(world + "allow: [[base, table]]\n"), IsEmpty());
}

/// Pairs with held joints between them are not among them: held_pairs.h.
TEST_F(FixedPairs, NotOfHeldJoints) {
  held_ = 0.05;
  EXPECT_THAT(pairsOf("margin: 0.001\n"), IsEmpty());
}

/// Tests the bases of two robots, and two obstacles with the same large mesh. Because of its size,
/// the obstacles share the mesh and have frames of their own.
TEST_F(FixedPairs, OfTwoRobotsAndObstaclesOnFrames) {
  std::ofstream(folder_ / "robot.yaml")
      << "format: corridor-robot-1\nurdf: arm.urdf\njoints: [to_arm]\nhold: {to_finger: 0.3}\n";
  constexpr int kRings = 100, kPerRing = 300;  // shared meshes have 50,000 triangles or more
  std::ofstream obj(folder_ / "ball.obj");
  for (int i = 0; i <= kRings; ++i)
    for (int k = 0; k < kPerRing; ++k) {
      const double up = std::numbers::pi * i / kRings, round = 2 * std::numbers::pi * k / kPerRing;
      obj << "v " << 0.1 * std::sin(up) * std::cos(round) << ' '
          << 0.1 * std::sin(up) * std::sin(round) << ' ' << 0.1 * std::cos(up) << '\n';
    }
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kPerRing; ++k) {
      const int next = (k + 1) % kPerRing, below = (i + 1) * kPerRing + 1;
      const int p = i * kPerRing + k + 1, q = i * kPerRing + next + 1;
      obj << "f " << p << ' ' << below + k << ' ' << below + next << "\nf " << p << ' '
          << below + next << ' ' << q << '\n';
    }
  obj.close();
  std::ofstream(folder_ / "problem.yaml")
      << "format: corridor-problem-1\n"
         "robots: {left: {file: robot.yaml}, right: {file: robot.yaml, base: {at: [0, 0.15, 0]}}}\n"
         "world:\n  near: {mesh: ball.obj, at: [-0.15, 0, 0]}\n"
         "  far: {mesh: ball.obj, at: [-5, 0, 0]}\n"
         "start: {left: {to_arm: 0}, right: {to_arm: 0}}\n"
         "goal: {left: {to_arm: 0.5}, right: {to_arm: 0.5}}\n";
  const Problem problem = readProblem(folder_ / "problem.yaml");
  const Checker checker(problem);
  std::vector<std::string> texts;
  for (const FixedPair& pair : closeFixedPairs(checker, startOf(problem)))
    texts.push_back(problem.model.bodies[pair.a].name + " ~ " + problem.model.bodies[pair.b].name);
  EXPECT_THAT(texts, testing::UnorderedElementsAre("left/base ~ right/base", "left/base ~ near"));
}

/// A base inside a solid obstacle must be reported.
TEST_F(FixedPairs, SolidMeshAroundTheBase) {
  std::ofstream(folder_ / "cube.obj")
      << "v -2 -2 -0.5\nv 2 -2 -0.5\nv 2 2 -0.5\nv -2 2 -0.5\n"
         "v -2 -2 0.5\nv 2 -2 0.5\nv 2 2 0.5\nv -2 2 0.5\n"
         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  EXPECT_THAT(pairsOf("world: {cube: {mesh: cube.obj, solid: true}}\n"),
              ElementsAre("base ~ cube: touch", "plate ~ cube: touch"));
  EXPECT_THAT(pairsOf("world: {cube: {mesh: cube.obj}}\n"), IsEmpty()) << "a surface";
}

}  // namespace
}  // namespace corridor
