// At the default tolerance every free edge with a clearance above twice the tolerance is proved,
// even with coordinates that are large compared with the bodies.
#include "planner/checker/default_tolerance.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/world/rigid_scene.h"
#include "planner/model/model_builder.h"
#include "planner/problem/problem.h"
#include "planner/robot/edge_motion.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Long3 = Eigen::Matrix<long double, 3, 1>;

/// Returns a floor of one triangle at height 0 of its own frame. In the tests the tip of a
/// tetrahedron is just above this floor.
TriangleMesh floorOf(double size) {
  TriangleMesh mesh;
  test::add(mesh, Vec3(-9 * size, -9 * size, 0), Vec3(9 * size, -9 * size, 0),
            Vec3(0, 9 * size, 0));
  return mesh;
}
TriangleMesh topOf(double size) {
  TriangleMesh mesh;
  const Vec3 tip(0, 0, 0), a(size, 0, size), b(-size, size, size), c(-size, -size, size);
  test::add(mesh, tip, a, b);
  test::add(mesh, tip, b, c);
  test::add(mesh, tip, c, a);
  return mesh;
}

/// Rounds to a multiple of 2^-42, so that sums and differences of such positions are exact.
double onGrid(double x) {
  return std::ldexp(std::round(std::ldexp(x, 42)), -42);
}

TEST(DefaultTolerance, RigidBodiesFarFromTheOrigin) {
  std::mt19937_64 random(test::testSeed(7));
  std::uniform_real_distribution<double> real(-1, 1);
  for (int n = 0; n < 2'000; ++n) {
    // In the second half of the cases the rounding exceeds 1e-7 of the body's size.
    const double far = std::pow(10.0, 1 + n % 3), size = far * (n < 1'000 ? 1e-6 : 1e-8);
    const Vec3 where(onGrid(far * real(random)), onGrid(far * real(random)),
                     onGrid(far * real(random)));
    TriangleMesh floor = floorOf(size);
    for (Vec3& p : floor.vertices) p = Vec3(p + where);
    for (Vec3& p : floor.vertices) p.z() = where.z();  // exactly level
    std::vector<Body> moving, fixed;
    moving.emplace_back("top", topOf(size));
    fixed.emplace_back("floor", floor);
    const RigidScene scene(std::move(moving), std::move(fixed));
    MotionOptions options;
    options.tolerance = scene.defaultTolerance(where.norm() + 1);
    const double gap = options.tolerance * (2.01 + std::abs(real(random)));
    // The body moves along the floor and rotates about the vertical, so the tip stays the lowest
    // point.
    RigidPose from, to;
    from.p = where + Vec3(size * real(random), size * real(random), 0);
    to.p = where + Vec3(size * real(random), size * real(random), 0);
    from.p.z() = to.p.z() = where.z() + gap;  // rounds by 2^-53 of `far`, far less than the gap
    to.q = Eigen::AngleAxisd(real(random), Vec3::UnitZ());
    QueryContext context;
    const MotionResult result = scene.certifyEdge(from, to, options, context);
    ASSERT_EQ(result.verdict, MotionVerdict::free)
        << n << ": size " << size << ", far " << far << ", tolerance " << options.tolerance;
  }
}

TEST(DefaultTolerance, ChainsFarFromTheOrigin) {
  std::mt19937_64 random(test::testSeed(8));
  std::uniform_real_distribution<double> real(-1, 1);
  int sharp = 0;
  for (int n = 0; n < 1'000; ++n) {
    const double size = std::pow(10.0, -5 + n % 3), far = std::pow(10.0, 1 + n % 3);
    Problem problem;
    const auto variable = [&](Coordinate::Kind kind, double limit) {
      Coordinate c;
      c.kind = kind;
      c.lower = -limit;
      c.upper = limit;
      return problem.model.space.coordinates()[problem.model.space.add(c)].first;
    };
    // Prismatic joints along x, y and z are followed by revolute joints about z, far from each
    // other in alternating directions.
    std::size_t parent = 0;
    for (int k = 0; k < 3; ++k) {
      Frame frame;
      frame.parent = parent;
      frame.joint = Frame::Joint::prismatic;
      frame.axis = Vec3::Unit(k);
      frame.variable = variable(Coordinate::Kind::line, far + 1);
      parent = problem.model.tree.add(frame);
    }
    const int turns = 1 + n % 4;
    for (int k = 0; k < turns; ++k) {
      Frame frame;
      frame.parent = parent;
      frame.fixed.p = Vec3(far / 3 * real(random), far / 3 * real(random), 0);
      frame.joint = Frame::Joint::revolute;
      frame.variable = variable(k % 2 ? Coordinate::Kind::circle : Coordinate::Kind::line, 3);
      parent = problem.model.tree.add(frame);
    }
    const auto numbers = static_cast<Eigen::Index>(problem.model.space.size());
    problem.task.tube = Configuration::Zero(numbers);
    Configuration from(numbers), to(numbers);
    for (Eigen::Index i = 0; i < numbers; ++i) {
      from[i] = i < 3 ? onGrid(far * real(random)) : 3 * real(random);
      to[i] = from[i] + (i < 3 ? 0 : size / far * real(random));
    }
    const std::vector<Transform> poses = framePoses(problem.model.tree, from);
    const Vec3 tip = poses[parent].t;
    TriangleMesh floor = floorOf(100 * size);
    for (Vec3& p : floor.vertices) p = Vec3(p.x() + tip.x(), p.y() + tip.y(), from[2]);
    PlacedShape under, over;
    under = shapeOf("floor", floor);
    over = shapeOf("top", topOf(size));
    problem.model.bodies = {{"top", parent, 0, {over}}, {"floor", 0, {}, {under}}};

    std::vector<Scene::Placed> placed;
    placed.push_back({Body("top", topOf(size)), parent});
    placed.push_back({Body("floor", floor), 0});
    const Scene scene(std::move(placed), {{0, 1}});
    MotionOptions options;
    const double rounding = roundingTolerance(problem.model, requiredBy(problem.task));
    options.tolerance = std::max(scene.defaultTolerance(), rounding);
    sharp += options.tolerance == rounding;
    ASSERT_LT(options.tolerance, 0.01 * size) << "the tolerance is too large to be of use";
    from[2] = to[2] = from[2] + options.tolerance * (2.05 + std::abs(real(random)));
    EdgeMotion motion(problem.model.tree, problem.model.space, scene.framePairs(),
                      problem.task.tube);
    motion.set(from, to);
    QueryContext context;
    const MotionResult result = scene.certify(motion, options, context);
    ASSERT_EQ(result.verdict, MotionVerdict::free)
        << n << ": size " << size << ", far " << far << ", tolerance " << options.tolerance
        << ", reason " << static_cast<int>(result.reason);
  }
  EXPECT_GT(sharp, 300) << "too few cases in which rounding sets the tolerance";
}

/// Two branches of one tree: the rounding errors of both branches count.
TEST(DefaultTolerance, BranchesFarFromTheOrigin) {
  std::mt19937_64 random(test::testSeed(9));
  std::uniform_real_distribution<double> real(-1, 1);
  for (int n = 0; n < 1'000; ++n) {
    const double size = std::pow(10.0, -4 + n % 2), far = std::pow(10.0, 1 + n % 2);
    Problem problem;
    const auto add = [&](std::size_t parent, const Vec3& at) {
      Coordinate c;
      c.lower = -3;
      c.upper = 3;
      Frame frame;
      frame.parent = parent;
      frame.fixed.p = at;
      frame.joint = Frame::Joint::revolute;
      frame.variable = problem.model.space.coordinates()[problem.model.space.add(c)].first;
      return problem.model.tree.add(frame);
    };
    // All rotations are about z, so the heights of tip and floor are exactly those of their meshes.
    const auto out = [&] { return Vec3(far * real(random), far * real(random), 0); };
    const std::size_t left = add(add(add(0, out()), out()), out());
    const std::size_t right = add(add(add(0, out()), out()), out());
    const auto numbers = static_cast<Eigen::Index>(problem.model.space.size());
    problem.task.tube = Configuration::Zero(numbers);
    Configuration from(numbers), to(numbers);
    for (Eigen::Index i = 0; i < numbers; ++i) {
      from[i] = 2.5 * real(random);
      to[i] = from[i] + 0.1 * size / far * real(random);
    }
    // The floor is on the left branch, below the tip on the right one.
    const std::vector<Transform> poses = framePoses(problem.model.tree, from);
    const Vec3 tip = poses[left].m.transpose() * (poses[right].t - poses[left].t);
    TriangleMesh floor = floorOf(100 * size);
    for (Vec3& p : floor.vertices) p = Vec3(p.x() + tip.x(), p.y() + tip.y(), 0);
    const auto bodies = [&](double gap) {
      TriangleMesh top = topOf(size);
      for (Vec3& p : top.vertices) p.z() += gap;
      PlacedShape under, over;
      under = shapeOf("floor", floor);
      over = shapeOf("top", top);
      problem.model.bodies = {{"floor", left, 0, {under}}, {"top", right, 0, {over}}};
      std::vector<Scene::Placed> placed;
      placed.push_back({Body("floor", floor), left});
      placed.push_back({Body("top", top), right});
      return placed;
    };
    bodies(0);
    MotionOptions options;
    options.tolerance = defaultTolerance(problem.model, requiredBy(problem.task), 1e-7 * size);
    ASSERT_LT(options.tolerance, 0.01 * size) << "the tolerance is too large to be of use";
    const Scene scene(bodies(options.tolerance * (2.05 + std::abs(real(random)))), {{0, 1}});
    EdgeMotion motion(problem.model.tree, problem.model.space, scene.framePairs(),
                      problem.task.tube);
    motion.set(from, to);
    QueryContext context;
    const MotionResult result = scene.certify(motion, options, context);
    ASSERT_EQ(result.verdict, MotionVerdict::free)
        << n << ": size " << size << ", far " << far << ", tolerance " << options.tolerance
        << ", gap " << result.gap << ", reason " << static_cast<int>(result.reason);
  }
}

/// A joint limit that is far larger than any robot must not lead to a default tolerance of metres.
TEST(DefaultTolerance, IsNeverMoreThanAThousandTimesTheUsualOne) {
  Problem problem;
  Coordinate c;
  c.lower = -1e16;
  c.upper = 1e16;
  Frame frame;
  frame.joint = Frame::Joint::revolute;
  frame.variable = problem.model.space.coordinates()[problem.model.space.add(c)].first;
  const std::size_t link = problem.model.tree.add(frame);
  PlacedShape ball;
  ball.parts = {ConvexPart{{Vec3(1, 0, 0)}, 0.1, false}};
  problem.model.bodies = {{"ball", link, 0, {ball}}, {"post", 0, {}, {ball}}};
  EXPECT_GT(roundingTolerance(problem.model, requiredBy(problem.task)), 1);
  EXPECT_DOUBLE_EQ(defaultTolerance(problem.model, requiredBy(problem.task), 1e-8), 1e-5);
}

}  // namespace
}  // namespace corridor
