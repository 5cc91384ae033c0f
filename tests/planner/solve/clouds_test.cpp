// Tests of checker, verifier and view with problems that have point clouds and octrees.
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/verify_solution.h"
#include "planner/solve/why_not_free.h"
#include "planner/verify/verify_path.h"
#include "planner/view/tessellate.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// A ball robot, and a wall of balls in x = 0 with a hole of half width 0.31 m at the origin.
class WallOfPoints : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream cloud(folder_ / "wall.xyz");
    for (int i = -20; i <= 20; ++i)
      for (int k = -20; k <= 20; ++k)
        if (std::abs(i) > 6 || std::abs(k) > 6)
          cloud << "0 " << 0.05 * i << ' ' << 0.05 * k << '\n';
    std::ofstream(folder_ / "robot.yaml")
        << "format: corridor-robot-1\nname: ball\nrigid: SE3\nshapes: [{sphere: 0.1}]\n";
    std::ofstream(folder_ / "problem.yaml")
        << "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n"
           "  wall: {points: {file: wall.xyz, radius: 0.04}}\n"
           "start: {at: [-1, 0, 0]}\ngoal: {at: [1, 0, 0]}\nbounds: {at: [[-2, -2, -2], [2, 2, "
           "2]]}\n";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static Configuration at(double x, double y, double z) {
    Configuration q(7);
    q << x, y, z, 0, 0, 0, 1;
    return q;
  }

  std::filesystem::path folder_ = test::newFolder();
};

/// Closed form: the centres of the wall's nearest balls are 0.35 m from the x-axis. So the ball
/// robot can pass up to 0.35 − 0.1 − 0.04 = 0.21 m beside the axis.
TEST_F(WallOfPoints, CheckerAndVerifierAgreeWithTheClosedForm) {
  const Problem problem = readProblem(folder_ / "problem.yaml");
  const Checker checker(problem);
  const PathProblem plain = plainProblem(problem.model, problem.task, {});
  for (const auto& [y, free] :
       {std::pair(0.0, true), {0.2099, true}, {0.2101, false}, {0.6, false}}) {
    const MotionResult edge = checker.certifyEdge(at(-1, y, 0), at(1, y, 0));
    EXPECT_EQ(edge.verdict, free ? MotionVerdict::free : MotionVerdict::contact) << y;
    const PathReport report = verifyPath(plain, {at(-1, y, 0), at(1, y, 0)});
    EXPECT_EQ(report.verdict, free ? PathVerdict::proved : PathVerdict::refuted) << y;
    if (!free) continue;
    EXPECT_LE(report.provedClearance, 0.35 - 0.14 - y + 1e-9);
    EXPECT_GE(report.provedClearance, 0.8 * (0.35 - 0.14 - y) - 1e-5);
  }
}

/// The message about a contact names the ball.
TEST_F(WallOfPoints, ContactsNameTheBall) {
  const Problem problem = readProblem(folder_ / "problem.yaml");
  const Checker checker(problem);
  const std::string why = whyNotFree(at(0, 0.6, 0.6), checker).value_or("free");
  EXPECT_NE(why.find("\"wall\" (part "), std::string::npos) << why;
}

/// A tolerance is legal even if a tenth of it rounds to 0.
TEST_F(WallOfPoints, TheSmallestTolerance) {
  const Problem problem = readProblem(folder_ / "problem.yaml");
  EXPECT_GT(plainProblem(problem.model, problem.task, 5e-324).tolerance, 0);
}

TEST_F(WallOfPoints, RandomEdges) {
  const Problem problem = readProblem(folder_ / "problem.yaml");
  const Checker checker(problem);
  const PathProblem plain = plainProblem(problem.model, problem.task, {});
  std::mt19937_64 random(test::testSeed(330));
  std::uniform_real_distribution<double> real(-0.6, 0.6);
  int free = 0, contact = 0;
  for (int n = 0; n < 200; ++n) {
    const double a = real(random), b = real(random), c = real(random), d = real(random);
    const Configuration from = at(-0.3, a, b), to = at(0.3, c, d);
    const MotionResult edge = checker.certifyEdge(from, to);
    const PathVerdict verdict = verifyPath(plain, {from, to}).verdict;
    free += edge.verdict == MotionVerdict::free;
    contact += edge.verdict == MotionVerdict::contact;
    EXPECT_FALSE(edge.verdict == MotionVerdict::free && verdict == PathVerdict::refuted);
    EXPECT_FALSE(edge.verdict == MotionVerdict::contact && verdict == PathVerdict::proved);
  }
  EXPECT_GT(free, 20);
  EXPECT_GT(contact, 20);
}

TEST_F(WallOfPoints, IsDrawnCoarsely) {
  const Problem problem = readProblem(folder_ / "problem.yaml");
  const std::vector<ConvexPart>& balls = problem.model.bodies.back().shapes.at(0).parts;
  EXPECT_EQ(view::tessellated(balls).triangles.size(), 8 * balls.size()) << "octahedra";
  const std::vector<ConvexPart> many(3 * view::kMostParts + 1, balls.front());
  EXPECT_EQ(view::tessellated(many).triangles.size(), 8 * (many.size() + 3) / 4);
}

}  // namespace
}  // namespace corridor
