#include <cmath>
#include <numbers>

#include "planner/problem/digest.h"
#include "planner/problem/keys.h"
#include "planner/problem/placement.h"
#include "planner/problem/sha256.h"
#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ProblemYaml : public ProblemTest {};

constexpr double degree = std::numbers::pi / 180;

/// A spatial problem with every legal key.
const char* const everything = R"(format: corridor-problem-1
robot: robot.yaml
world:
  rock: {mesh: wedge.obj, unit: cm, up: y, at: [1, 2, 3], rpy_deg: [0, 0, 90]}
  stone: {mesh: wedge.obj, quat_xyzw: [0, 0, 1, 0]}
start: {at: [5, 0, 0], rpy_deg: [10, 20, 30]}
goal: {at: [0, 5, 0], quat_xyzw: [0, 0.6, 0, 0.8], within: {at: 0.05, angle_deg: 5}}
bounds: {at: [[-9, -9, -9], [9, 8, 7]]}
margin: 0.005
tube: {position: 0.001, rotation_deg: 1}
planner:
  name: RRT
  time: 2.5
  stop: time
  restart: 500
  params:
    range: 0.6
    goal_bias: "0.1"
sampler: gaussian
simplify: false
checker: {edges: discrete, resolution: 0.02, tolerance: 1e-5, volume: obb-binary, fit: hull, overlap: gjk, build: median}
allow: [[wedge, stone]]
prefer: {clearance: 0, detour: 0.25, clearance_of: path}
padding: {bodies: {wedge: 0.01, stone: 0.002}, pairs: [[rock, wedge, 0.03]]}
limits: {position: {velocity: 0.5, acceleration: 2}, rotation: {velocity: 3}, velocity_scale: 0.5}
trajectory: {smooth: length, deviation: 0.001, corner_deviation: 0.02, rate: 250}
seed: 18446744073709551615
)";

TEST_F(ProblemYaml, MarginsOfPairs) {
  std::string text = everything;
  const auto at = text.find("margin: ");
  text.replace(at, text.find('\n', at) - at,
               "margin: {self: 0.002, world: 0.02, pairs: [[wedge, rock, 0.005]]}");
  Problem p = read(text);
  EXPECT_EQ(p.task.margin, 0.002);
  const auto total = [&](std::size_t a, std::size_t b, bool sameRobot) {
    return p.task.margin + p.task.padding.of(a, b, sameRobot);
  };
  EXPECT_EQ(total(0, 0, true), 0.002);
  EXPECT_NEAR(total(1, 2, false), 0.02 + 0.002, 1e-15);  // the stone's padding is 0.002
  EXPECT_GE(total(1, 2, false), 0.02 + 0.002);
  EXPECT_NEAR(total(0, 1, false), 0.005 + 0.03, 1e-15);  // with the pair's padding
  EXPECT_NEAR(p.task.padding.largest(), 0.03 + 0.018, 1e-15);
  setMargin(p, 0.01);  // replaces all of them
  EXPECT_EQ(p.task.margin, 0.01);
  EXPECT_EQ(p.task.padding.beyond.largest(), 0);
}

TEST_F(ProblemYaml, EveryKeyIsRead) {
  const Problem p = read(everything);
  EXPECT_FALSE(isPlanar(p));
  ASSERT_EQ(p.model.robots.size(), 1u);
  ASSERT_EQ(p.model.bodies.size(), 3u);
  EXPECT_EQ(p.model.bodies[0].name, "wedge");
  EXPECT_EQ(p.model.bodies[0].robot, 0u);
  EXPECT_EQ(meshOf(p, "wedge").triangles.size(), 4u);
  EXPECT_EQ(p.model.bodies[1].name, "rock");
  EXPECT_FALSE(p.model.bodies[1].robot);
  EXPECT_EQ(p.model.bodies[2].name, "stone");
  EXPECT_EQ(p.task.start.head(3), Vec3(5, 0, 0));
  const Eigen::Quaterniond q = Eigen::AngleAxisd(30 * degree, Vec3::UnitZ()) *
                               Eigen::AngleAxisd(20 * degree, Vec3::UnitY()) *
                               Eigen::AngleAxisd(10 * degree, Vec3::UnitX());
  EXPECT_LT((p.task.start.tail(4) - q.coeffs()).norm(), 1e-15);
  ASSERT_EQ(p.task.goals.size(), 1u);
  EXPECT_EQ(p.task.goals[0], numbers({0, 5, 0, 0, 0.6, 0, 0.8}));
  ASSERT_TRUE(p.task.goalRegion);
  EXPECT_EQ(p.task.goalRegion->position, 0.05);
  EXPECT_DOUBLE_EQ(p.task.goalRegion->angle, 5 * degree);
  EXPECT_FALSE(p.task.goalThreshold);
  EXPECT_EQ(lowerOf(p), Vec3(-9, -9, -9));
  EXPECT_EQ(upperOf(p), Vec3(9, 8, 7));
  EXPECT_EQ(p.task.margin, 0.005);
  EXPECT_EQ(p.task.padding.bodies, (std::map<std::size_t, double>{{0, 0.01}, {2, 0.002}}));
  EXPECT_EQ(p.task.padding.pairs.size(), 1u);
  EXPECT_EQ(p.task.padding.of(0, 1, false), 0.03);
  EXPECT_EQ(p.task.limits.velocity[0], 0.25);
  EXPECT_EQ(p.task.limits.acceleration[0], 2);
  EXPECT_EQ(p.task.limits.velocity[3], 1.5);
  EXPECT_EQ(p.settings.trajectory.smooth, Smoothing::length);
  EXPECT_EQ(p.settings.trajectory.deviation, 0.001);
  EXPECT_EQ(p.settings.trajectory.cornerDeviation, 0.02);
  EXPECT_EQ(p.settings.trajectory.rate, 250);
  EXPECT_EQ(p.settings.prefer.clearance, 0);
  EXPECT_EQ(p.settings.prefer.detour, 0.25);
  EXPECT_EQ(p.settings.prefer.clearanceOf, ClearanceOf::path);
  EXPECT_EQ(pairCount(p.model), 2);
  EXPECT_EQ(p.model.filter.whyNotTested(0, 1, requiredBy(p.task)), "");
  EXPECT_EQ(p.model.filter.whyNotTested(0, 2, requiredBy(p.task)), "allow");
  EXPECT_EQ(p.task.tube.head(3), Vec3(0.001, 0.001, 0.001));
  EXPECT_DOUBLE_EQ(p.task.tube[3], degree);
  EXPECT_EQ(p.settings.planner.name, "RRT");
  EXPECT_EQ(p.settings.planner.time, 2.5);
  EXPECT_EQ(p.settings.planner.stopAtFirst, false);
  EXPECT_EQ(p.settings.planner.params,
            (std::map<std::string, std::string>{{"range", "0.6"}, {"goal_bias", "0.1"}}));
  EXPECT_EQ(p.settings.sampler, ValidSampler::gaussian);
  EXPECT_EQ(p.settings.simplify, Simplifier::none);
  EXPECT_EQ(p.settings.planner.restart, 500U);
  EXPECT_EQ(p.settings.checker.edges, EdgeMethod::discrete);
  EXPECT_EQ(p.settings.checker.resolution, 0.02);
  EXPECT_EQ(p.settings.checker.tolerance, 1e-5);
  EXPECT_EQ(p.settings.checker.trees.volume, "obb-binary");
  EXPECT_EQ(p.settings.checker.trees.fit, "hull");
  EXPECT_EQ(p.settings.checker.trees.overlap, "gjk");
  EXPECT_EQ(p.settings.checker.trees.build, "median");
  EXPECT_EQ(p.settings.seed, 18446744073709551615u);
  for (const std::string& key : problemKeys().at("").legal)
    if (key != "robots" && key != "base" && key != "moveit") {
      EXPECT_TRUE(p.source.lines.contains(key)) << key << " is missing in this test";
    }
}

TEST_F(ProblemYaml, Defaults) {
  const Problem p = read(head + "start: {at: [5, 0, 0]}\ngoal: {at: [0, 5, 0]}\n");
  EXPECT_EQ(p.source.name, folder_.filename());
  EXPECT_EQ(p.settings.planner.name, "RRTConnect");
  EXPECT_EQ(p.settings.planner.time, 20);
  EXPECT_FALSE(p.settings.planner.stopAtFirst);
  EXPECT_EQ(p.settings.sampler, ValidSampler::uniform);
  EXPECT_EQ(p.settings.checker.edges, EdgeMethod::certified);
  EXPECT_EQ(p.settings.checker.trees.volume, "obb");
  EXPECT_EQ(treesNamed(p.settings.checker.trees).trees, TreeKind::obb4);
  EXPECT_EQ(p.task.margin, 0);
  EXPECT_EQ(p.task.tube.head(3), Vec3::Constant(0x1p-40 * 5)) << "of the longest range";
  EXPECT_EQ(p.task.tube[3], 0x1p-40 * 2 * std::numbers::pi);
  EXPECT_EQ(p.settings.simplify, Simplifier::corridor);
  EXPECT_EQ(p.settings.seed, 1u);
  // The weight is per radian of the quaternion's angle, half the rotation angle. So a weight of 1
  // is half a metre per radian of rotation.
  EXPECT_EQ(p.model.space.coordinates().at(3).weight, 1);
  EXPECT_EQ(lowerOf(p), Vec3(0, 0, 0));
  EXPECT_EQ(upperOf(p), Vec3(5, 5, 3));
  EXPECT_THAT(textsOf(p.source.notes),
              ElementsAre("bounds: those of the world, start and goal, since none are given"));
  EXPECT_EQ(digestOf(readProblem(folder_)), digestOf(p))
      << "the folder stands for its problem.yaml";
}

TEST_F(ProblemYaml, LinesAreKeptForLaterFaults) {
  const Problem p = read(everything);
  EXPECT_EQ(p.source.lines.at("planner.name"), 12);
  EXPECT_EQ(p.source.lines.at("planner.params.range"), 17);
  EXPECT_EQ(p.source.lines.at("start"), 6);
  EXPECT_EQ(p.source.lines.at("checker.edges"), 21);
  const std::string file = (folder_ / "problem.yaml").string();
  EXPECT_EQ(p.source.faultAt("planner.params.rnage", "no").str(), file + ":16: no");
  EXPECT_EQ(p.source.faultAt("elsewhere.key", "no").str(), file + ": no");
}

TEST_F(ProblemYaml, MeshesArePlacedOnceInDouble) {
  const Problem p = read(everything);
  const auto& rock = meshOf(p, "rock").vertices;
  // (0, 2, 0) in cm with y up is (0, 0, 0.02). The rotation by 90° about z does not change this
  // point, and the translation is added.
  EXPECT_EQ(rock[2], Vec3(1, 2, 3 + 0.01 * 2));
  // (1, 0, 0) in cm: the rotation by 90° takes x to y exactly.
  EXPECT_EQ(rock[1], Vec3(1, 2 + 0.01, 3));
  const auto& stone = meshOf(p, "stone").vertices;
  EXPECT_EQ(stone[1], Vec3(-1, 0, 0));
  EXPECT_EQ(stone[3], Vec3(0, 0, 3));
}

TEST_F(ProblemYaml, PlanarPosesAndWrappedYaws) {
  const std::string bounds = "bounds: {at: [[-9, -9], [9, 9]]}\n";
  Problem p = read(planarHead + "start: {at: [5, 0], yaw_deg: 270}\ngoal: {at: [0, 5], yaw: -1}\n" +
                   bounds);
  EXPECT_TRUE(isPlanar(p));
  EXPECT_EQ(p.model.bodies[0].name, "flat") << "an unnamed robot is called by its file";
  EXPECT_EQ(p.task.start, numbers({5, 0, -90 * degree}));
  EXPECT_EQ(p.task.goals[0], numbers({0, 5, -1}));
  EXPECT_EQ(p.model.space.coordinates().at(2).weight, 0.5);
  EXPECT_THAT(textsOf(p.source.notes),
              ElementsAre("start.yaw_deg: 270 is read as -90, the same angle up to full turns"));
  p = read(planarHead + "start: {at: [5, 0], yaw_deg: -180}\ngoal: {at: [0, 5], yaw: 10}\n" +
           bounds);
  EXPECT_EQ(p.task.start[2], std::numbers::pi);
  EXPECT_DOUBLE_EQ(p.task.goals[0][2], 10 - 4 * std::numbers::pi);
  EXPECT_EQ(p.source.notes.size(), 2u);
}

TEST_F(ProblemYaml, RobotOfSeveralShapesAboutItsCentroid) {
  write("robot.yaml", R"(format: corridor-robot-1
name: twins
rigid: SE3
shapes:
  - {mesh: wedge.obj, name: left}
  - {mesh: wedge.obj, at: [0, 0, 0]}
  - {mesh: wedge.obj, at: [4, 0, 0]}
reference: centroid
weights: {rotation: 3}
)");
  const Problem p = read(head + poses);
  const auto& shapes = bodyOf(p, "twins").shapes;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].name, "twins/left");
  EXPECT_EQ(shapes[1].name, "twins/2");
  // The centroid is the average of the eight distinct vertices: the repeated shape does not count
  // twice.
  const Vec3 centroid(2.25, 0.5, 0.75);
  EXPECT_EQ(meshOf(p, "twins", 0).vertices[3], Vec3(0, 0, 3) - centroid);
  EXPECT_EQ(meshOf(p, "twins", 2).vertices[0], Vec3(4, 0, 0) - centroid);
  EXPECT_EQ(p.model.space.coordinates().at(3).weight, 6)
      << "3 metres per radian of rotation, twice the quaternion angle";
  EXPECT_THAT(
      textsOf(p.source.notes),
      ElementsAre("reference of twins: the centroid (2.25, 0.5, 0.75) of its distinct vertices"));
}

TEST_F(ProblemYaml, ReferencePointIsSubtracted) {
  write("robot.yaml", std::string(robot3) + "reference: [1, 2, 3]\n");
  EXPECT_EQ(meshOf(read(head + poses), "wedge").vertices[3], Vec3(-1, -2, 0));
  write("flat.yaml", std::string(robot2) + "reference: centroid\n");
  EXPECT_EQ(meshOf(read(planarHead + planarPoses), "flat").vertices[3], Vec3(-0.25, -0.5, 3))
      << "a planar robot keeps its height";
}

TEST_F(ProblemYaml, DigestIsThatOfAllFilesInOrder) {
  const Problem p = read(head + poses);
  const auto hashOf = [&](const std::string& name) {
    const auto digest = sha256(contents(folder_ / name));
    return std::string(digest.begin(), digest.end());
  };
  const std::string wedge = hashOf("wedge.obj");
  const std::string digest = digestOf(p);
  EXPECT_EQ(digest, sha256Hex(hashOf("problem.yaml") + hashOf("robot.yaml") + wedge))
      << "a file that is named twice counts once";
  write("wedge.obj", contents(folder_ / "wedge.obj") + "# more\n");
  EXPECT_NE(digestOf(p), digest) << "it is that of the files as they are now";
}

TEST_F(ProblemYaml, FilesAreRelativeToTheFileThatNamesThem) {
  write("robots/w/robot.yaml",
        "format: corridor-robot-1\nrigid: SE3\nshapes: [{mesh: parts/w.obj}]\n");
  write("robots/w/parts/w.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("problems/p/rock.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("problems/p/problem.yaml",
        "format: corridor-problem-1\nrobot: ../../robots/w/robot.yaml\nworld: {rock: {mesh: "
        "rock.obj}}\n" +
            poses);
  const Problem p = readProblem(folder_ / "problems/p");
  EXPECT_EQ(p.source.name, "p");
  EXPECT_EQ(p.model.bodies[0].name, "w");
}

TEST(Placement, RotationsByDegreesAreExactWhereTheyCanBe) {
  EXPECT_EQ(fromRpyDegrees({0, 0, 90}).R, (Mat3() << 0, -1, 0, 1, 0, 0, 0, 0, 1).finished());
  EXPECT_EQ(fromRpyDegrees({90, 0, 0}).R, (Mat3() << 1, 0, 0, 0, 0, -1, 0, 1, 0).finished());
  EXPECT_EQ(fromRpyDegrees({0, 90, 0}).R, (Mat3() << 0, 0, 1, 0, 1, 0, -1, 0, 0).finished());
  EXPECT_EQ(fromRpyDegrees({0, 0, -450}).R, fromRpyDegrees({0, 0, -90}).R);
  EXPECT_EQ(fromRpyDegrees({180, 0, 0}).q.coeffs(), Eigen::Vector4d(1, 0, 0, 0));
  const auto quarter = fromRpyDegrees({0, 0, 90}).q;
  EXPECT_EQ(quarter.z(), quarter.w());
}

TEST(Placement, BothFormsOfARotationAgree) {
  for (const Vec3& a : {Vec3(10, 20, 30), Vec3(-170, 80, 200), Vec3(90, 45, -135), Vec3(0, 0, 0)}) {
    const Orientation degrees = fromRpyDegrees(a), radians = fromRpy(degree * a);
    EXPECT_LT((degrees.R - degrees.q.toRotationMatrix()).norm(), 2e-15);
    EXPECT_LT((degrees.R - radians.R).norm(), 2e-15);
    EXPECT_LT((degrees.q.coeffs() - radians.q.coeffs()).norm(), 2e-15);
  }
}

TEST(Placement, YawsWrapIntoTheHalfOpenInterval) {
  EXPECT_EQ(wrappedYawDegrees(180), 180);
  EXPECT_EQ(wrappedYawDegrees(-180), 180);
  EXPECT_EQ(wrappedYawDegrees(540), 180);
  EXPECT_EQ(wrappedYawDegrees(359), -1);
  EXPECT_EQ(wrappedYaw(3), 3);
  EXPECT_DOUBLE_EQ(wrappedYaw(4), 4 - 2 * std::numbers::pi);
}

}  // namespace
}  // namespace corridor::test
