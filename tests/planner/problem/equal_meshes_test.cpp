// Tests that obstacles of one mesh file share the mesh and its trees, if this saves enough
// triangles.
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "collision/core/shortest.h"
#include "planner/checker/checker.h"
#include "planner/robot/edge_motion.h"
#include "planner/solve/verify_solution.h"
#include "tests/planner/problem/problem_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

/// Returns an OBJ file of a closed ball with 2·around·(around - 1) triangles.
std::string ballObj(int around, double radius) {
  std::ostringstream obj;
  obj << "v 0 0 " << radius << "\nv 0 0 " << -radius << "\n";
  for (int i = 1; i < around; ++i)
    for (int k = 0; k < around; ++k) {
      const double theta = std::numbers::pi * i / around, phi = 2 * std::numbers::pi * k / around;
      obj << "v " << radius * std::sin(theta) * std::cos(phi) << " "
          << radius * std::sin(theta) * std::sin(phi) << " " << radius * std::cos(theta) << "\n";
    }
  const auto at = [&](int i, int k) {
    return i == 0 ? 1 : i == around ? 2 : 3 + (i - 1) * around + k % around;
  };
  for (int i = 0; i < around; ++i)
    for (int k = 0; k < around; ++k) {
      if (i > 0) obj << "f " << at(i, k) << " " << at(i + 1, k) << " " << at(i, k + 1) << "\n";
      if (i + 1 < around)
        obj << "f " << at(i, k + 1) << " " << at(i + 1, k) << " " << at(i + 1, k + 1) << "\n";
    }
  return obj.str();
}

class EqualMeshes : public ProblemTest {
 protected:
  static constexpr int kAround = 60;  // a ball has 6960 triangles

  /// Returns a problem with `count` obstacles of the mesh file NAME.obj, at random places.
  std::string problemOf(const std::string& name, int count, const std::string& keys) const {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> real(-4, 4);
    std::ostringstream text;
    text << "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n";
    for (int i = 0; i < count; ++i) {
      text << "  ball" << i << ": {mesh: " << name << ".obj, " << keys << "at: [" << real(random)
           << ", " << real(random) << ", " << real(random) << "], rpy_deg: [" << 40 * real(random)
           << ", " << 40 * real(random) << ", 0]}\n";
    }
    text << poses;
    return text.str();
  }
};

TEST_F(EqualMeshes, ShareTheMeshAndItsTrees) {
  write("ball.obj", ballObj(kAround, 0.5));
  const Problem p = read(problemOf("ball", 10, "solid: true, "));
  const ModelBody &first = bodyOf(p, "ball0"), &last = bodyOf(p, "ball9");
  EXPECT_EQ(first.shapes.at(0).mesh, last.shapes.at(0).mesh);
  EXPECT_NE(first.frame, 0u);
  EXPECT_NE(first.frame, last.frame);
  EXPECT_EQ(p.model.tree.frames[last.frame].parent, 0u);
  EXPECT_EQ(p.model.tree.frames[last.frame].fixed.p, last.shapes.at(0).at.p);
  const Checker checker(p);
  const auto& bodies = checker.scene().bodies();
  EXPECT_EQ(&bodies.at(1).body.mesh(), &bodies.at(10).body.mesh());
  EXPECT_EQ(&bodies.at(1).body.mesh(), &first.shapes.at(0).mesh->mesh) << "no copy";
  EXPECT_EQ(&bodies.at(1).body.tree(), &bodies.at(10).body.tree());
  EXPECT_EQ(bodies.at(10).body.name(), "ball9");
}

TEST_F(EqualMeshes, SmallOrFewMeshesAreMovedToTheirPlaces) {
  write("ball.obj", ballObj(kAround, 0.5));
  write("small.obj", ballObj(20, 0.5));  // 760 triangles
  for (const std::string& text :
       {problemOf("ball", 8, ""), problemOf("small", 100, ""),  // 7·6960 triangles are saved
        problemOf("ball", 1, "")}) {
    const Problem p = read(text);
    for (const ModelBody& body : p.model.bodies)
      EXPECT_EQ(body.frame == 0, !body.robot.has_value());
    const Vec3 centre = bodyOf(p, "ball0").shapes.at(0).at.p;
    EXPECT_NEAR((meshOf(p, "ball0").vertices.at(7) - centre).norm(), 0.5, 1e-5);
  }
}

/// The key `unit`, for example, makes another mesh of the same file.
TEST_F(EqualMeshes, OfDifferentOptionsShareNothing) {
  write("ball.obj", ballObj(kAround, 0.5));
  std::string text = problemOf("ball", 20, "");
  text.replace(text.find("ball19: {"), 9, "ball19: {unit: cm, ");
  const Problem p = read(text);
  EXPECT_EQ(bodyOf(p, "ball18").shapes.at(0).mesh, bodyOf(p, "ball0").shapes.at(0).mesh);
  EXPECT_EQ(bodyOf(p, "ball19").frame, 0u);
  const Vec3 centre = bodyOf(p, "ball19").shapes.at(0).at.p;
  EXPECT_NEAR((meshOf(p, "ball19").vertices.at(7) - centre).norm(), 0.005, 1e-5);
}

/// Solid balls and surfaces of one file share the mesh, and each keeps its own inside.
TEST_F(EqualMeshes, SolidsAndSurfacesDiffer) {
  write("robot.yaml", "format: corridor-robot-1\nrigid: SE3\nshapes: [{box: [0.1, 0.1, 0.1]}]\n");
  write("ball.obj", ballObj(kAround, 0.5));
  for (const bool solidFirst : {false, true}) {
    std::string text = "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n";
    for (int i = 0; i < 40; ++i)
      text += "  ball" + std::to_string(i) + ": {mesh: ball.obj, at: [" + std::to_string(2 * i) +
              ", 0, 5]" + ((i < 20) == solidFirst ? ", solid: true" : "") + "}\n";
    const Problem p = read(text + poses);
    EXPECT_EQ(bodyOf(p, "ball0").shapes.at(0).mesh, bodyOf(p, "ball39").shapes.at(0).mesh);
    const Checker checker(p);
    Configuration q = p.task.start;
    for (const int i : {0, 7, 20, 39}) {
      q.head<3>() = Vec3(2 * i, 0, 5);
      EXPECT_EQ(checker.interference(q).has_value(), (i < 20) == solidFirst) << i;
    }
  }
}

/// Verdicts, tolerance, bounds and proofs equal those for the same balls, each with a mesh file of
/// its own.
TEST_F(EqualMeshes, ChangeNoVerdict) {
  write("robot.yaml", "format: corridor-robot-1\nrigid: SE3\nshapes: [{box: [0.3, 0.2, 0.1]}]\n");
  constexpr int count = 40;
  for (int i = 0; i < count; ++i) write("ball" + std::to_string(i) + ".obj", ballObj(kAround, 0.5));
  write("ball.obj", ballObj(kAround, 0.5));
  const std::string text = problemOf("ball", count, "");
  std::string single = text;
  for (int i = 0; i < count; ++i) {
    const std::string entry = "ball" + std::to_string(i) + ": {mesh: ball";
    single.replace(single.find(entry), entry.size(), entry + std::to_string(i));
  }
  const Problem shared = read(text), alone = read(single);
  ASSERT_NE(bodyOf(shared, "ball0").frame, 0u);
  ASSERT_EQ(bodyOf(alone, "ball0").frame, 0u);
  EXPECT_LT((lowerOf(shared) - lowerOf(alone)).norm(), 1e-12);
  EXPECT_LT((upperOf(shared) - upperOf(alone)).norm(), 1e-12);
  const Checker one(shared), other(alone);
  EXPECT_NEAR(one.options().tolerance, other.options().tolerance, 1e-9 * other.options().tolerance);

  std::mt19937_64 random(testSeed(31));
  std::uniform_real_distribution<double> real(-4, 4);
  std::normal_distribution<double> normal;
  int free = 0, contact = 0, proved = 0;
  const int edges = casesOf(40, 300);
  for (int n = 0; n < edges; ++n) {
    Configuration from(7), to(7);
    for (Eigen::Index k = 0; k < 3; ++k) from[k] = real(random);
    for (Eigen::Index k = 3; k < 7; ++k) from[k] = normal(random);
    to = from;
    for (Eigen::Index k = 0; k < 7; ++k) to[k] += 0.2 * normal(random);
    const MotionVerdict verdict = one.certifyEdge(from, to).verdict;
    ASSERT_EQ(verdict, other.certifyEdge(from, to).verdict) << n;
    EXPECT_EQ(one.interference(to).has_value(), other.interference(to).has_value()) << n;
    EXPECT_NEAR(one.clearance(from), other.clearance(from), 1e-9) << n;
    free += verdict == MotionVerdict::free;
    contact += verdict == MotionVerdict::contact;
    if (n % 10 != 0) continue;  // the verifier is slow
    const PathVerdict path = verifyPath(plainProblem(shared), {from, to}).verdict;
    EXPECT_EQ(path, verifyPath(plainProblem(alone), {from, to}).verdict) << n;
    if (verdict == MotionVerdict::free) {
      EXPECT_NE(path, PathVerdict::refuted) << n;
    }
    proved += path == PathVerdict::proved;
  }
  EXPECT_GT(free, edges / 10);
  EXPECT_GT(contact, edges / 60);
  EXPECT_GT(proved, edges / 100);
}

/// Quarter turns are exact for shared and for separate meshes, so bodies that just touch are in
/// contact in both forms.
TEST_F(EqualMeshes, TouchAfterQuarterTurns) {
  write("robot.yaml", "format: corridor-robot-1\nrigid: SE3\nshapes: [{mesh: cube.obj}]\n");
  std::string cube;  // with faces at a distance of 1
  for (int corner = 0; corner < 8; ++corner)
    cube += std::string("v ") + (corner & 1 ? "1 " : "-1 ") + (corner & 2 ? "1 " : "-1 ") +
            (corner & 4 ? "1\n" : "-1\n");
  write("cube.obj", cube + "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n");
  write("ball.obj", ballObj(kAround, 0.5));  // its highest vertex is at (0, 0, 0.5)
  const auto problem = [&](const std::string& rotation, int count) {
    std::string text =
        "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  ball: {mesh: "
        "ball.obj, " +
        rotation + "}\n";
    for (int i = 1; i < count; ++i)
      text += "  far" + std::to_string(i) + ": {mesh: ball.obj, at: [" + std::to_string(9 * i) +
              ", 30, 0]}\n";
    return read(text + poses);
  };
  const auto touches = [](const Problem& p, const Vec3& at) {
    Configuration q = p.task.start;
    q.head<3>() = at;
    q.tail<4>() = Eigen::Vector4d(0, 0, 0, 1);
    return Checker(p).interference(q).has_value();
  };
  for (const auto& [rotation, axis] : {std::pair{"rpy_deg: [0, 90, 0]", Vec3(1, 0, 0)},
                                       {"rpy_deg: [90, 0, 0]", Vec3(0, -1, 0)},
                                       {"rpy_deg: [-90, 0, 0]", Vec3(0, 1, 0)},
                                       {"rpy_deg: [180, 0, 0]", Vec3(0, 0, -1)},
                                       {"quat_xyzw: [0.7071068, 0, 0, 0.7071068]", Vec3(0, -1, 0)},
                                       {"quat_xyzw: [0.5, 0.5, 0.5, 0.5]", Vec3(1, 0, 0)}}) {
    const Problem alone = problem(rotation, 1), shared = problem(rotation, 12);
    ASSERT_EQ(bodyOf(alone, "ball").frame, 0u);
    ASSERT_NE(bodyOf(shared, "ball").frame, 0u);
    for (const Problem* const p : {&alone, &shared}) {
      EXPECT_TRUE(touches(*p, 1.5 * axis)) << rotation;
      EXPECT_FALSE(touches(*p, (1.5 + 1e-15) * axis)) << rotation;
    }
  }
}

TEST_F(EqualMeshes, AreReportedOnceIfTheFileIsFaulty) {
  write("bad.obj", "v 0 0 0\nf 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(complaintOf(problemOf("bad", 3, "")),
            "bad.obj:3: face corner 2 is out of range: the file has 1 vertices\n"
            "bad.obj:3: face corner 3 is out of range: the file has 1 vertices");
}

TEST_F(EqualMeshes, AreReportedOnceIfTheirOptionsDiffer) {
  write("bad.obj", "v 0 0 0\nf 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld:\n"
                        "  a: {mesh: bad.obj}\n  b: {mesh: bad.obj, unit: mm}\n" +
                        std::string(poses)),
            "bad.obj:3: face corner 2 is out of range: the file has 1 vertices\n"
            "bad.obj:3: face corner 3 is out of range: the file has 1 vertices");
}

}  // namespace
}  // namespace corridor::test
