// Tests of paths of arms, with primitives and solids: closed forms, and random paths against dense
// sampling.
#include <utility>

#include <gtest/gtest.h>

#include "tests/planner/verify/rigid_world.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::boxMesh;

constexpr double kHalfTurn = std::numbers::pi;

ConvexPart boxPart(const Vec3& lower, const Vec3& upper) {
  return {boxMesh(lower, upper).vertices, 0, false};
}

/// A chain of `joints` revolute joints about z, 1 m apart. Each is followed by a rod from 0.1 to
/// 0.9 m, with radius 0.05 m.
struct Chain {
  KinematicTree tree;
  ConfigurationSpace space;
  std::vector<ConvexPart> rods;
  ConvexPart obstacle;
  PathProblem problem;

  Chain(int joints, ConvexPart o) : obstacle(std::move(o)) {
    CoordinateGroup group;
    for (int j = 0; j < joints; ++j) {
      Coordinate c;
      c.name = "joint" + std::to_string(j + 1);
      c.lower = -4;
      c.upper = 4;
      Frame frame;
      frame.parent = j == 0 ? 0 : tree.frames.size() - 1;
      frame.fixed.p = Vec3(j == 0 ? 0 : 1, 0, 0);
      frame.joint = Frame::Joint::revolute;
      frame.variable = static_cast<std::size_t>(j);
      space.add(c);
      tree.add(frame);
      rods.push_back({{Vec3(0.1, 0, 0), Vec3(0.9, 0, 0)}, 0.05, false});
    }
    problem.tree = &tree;
    problem.space = &space;
    problem.tolerance = 1e-8;
    problem.tube = Configuration::Zero(joints);
    problem.bodies.push_back({"obstacle", nullptr, {&obstacle, 1}, false, 0});
    for (std::size_t j = 0; j < rods.size(); ++j) {
      problem.bodies.push_back(
          {"rod" + std::to_string(j + 1), nullptr, {&rods[j], 1}, false, j + 1});
      problem.pairs.push_back({0, j + 1});
      for (std::size_t i = 0; i + 1 < j; ++i) problem.pairs.push_back({i + 1, j + 1});
    }
  }
  Chain(const Chain&) = delete;
};

Configuration joints(std::initializer_list<double> values) {
  Configuration q(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), q.begin());
  return q;
}

// The stretched chain rotates as one body about the first joint. The tip of its last rod is 1.9 +
// 0.05 m from this joint.
TEST(VerifyChain, StretchedArmPastAPoint) {
  for (const double gap : {1e-1, 1e-3, 1e-6, -1e-6, -1e-3}) {
    const double r = 1.95 + gap, angle = 0.7;
    Chain chain(2, {{Vec3(r * std::cos(angle), r * std::sin(angle), 0)}, 0, false});
    const PathReport report = verifyPath(chain.problem, {joints({0, 0}), joints({1.9, 0})});
    EXPECT_EQ(report.verdict, gap > 0 ? PathVerdict::proved : PathVerdict::refuted) << gap;
    if (gap > 0) {
      EXPECT_LE(report.provedClearance, gap * (1 + 1e-9));
      EXPECT_GE(report.provedClearance, 0.85 * gap);
      EXPECT_LE(report.distanceQueries, 20'000u);
    } else {
      EXPECT_EQ(report.findings.at(0).a, "obstacle");
      EXPECT_EQ(report.findings.at(0).b, "rod2");
    }
  }
}

// In a pair, the first body may be the only one that moves, or both bodies may move on different
// branches. In both cases the motion of the first body must count.
TEST(VerifyChain, EitherBodyOfAPairMayMove) {
  const ConvexPart post{{Vec3(0.7 * std::cos(0.4), 0.7 * std::sin(0.4), 0)}, 0.01, false};
  for (const bool movingFirst : {true, false}) {
    Chain chain(1, post);
    chain.problem.pairs = {movingFirst ? VerifyPair{1, 0} : VerifyPair{0, 1}};
    EXPECT_EQ(verifyPath(chain.problem, {joints({0}), joints({2})}).verdict, PathVerdict::refuted);
    EXPECT_EQ(verifyPath(chain.problem, {joints({0.6}), joints({2})}).verdict, PathVerdict::proved);
    // Two rods: the pivots are 1 m apart, and one rod rests.
    Chain branches(2, post);
    branches.tree.frames[2].parent = 0;
    branches.problem.pairs = {movingFirst ? VerifyPair{1, 2} : VerifyPair{2, 1}};
    const double up = kHalfTurn / 2;
    EXPECT_EQ(verifyPath(branches.problem, {joints({up, 2.5}), joints({-up, 2.5})}).verdict,
              PathVerdict::refuted);
    EXPECT_EQ(verifyPath(branches.problem, {joints({up, 1.5}), joints({-up, 1.5})}).verdict,
              PathVerdict::proved);
  }
}

// A thin disc turns about one of its diameters, and its rim meets a ball. The points of its core
// are on the axis of the disc; the disc reaches the ball only by its radius.
TEST(VerifyChain, TheRimOfADiscMoves) {
  const ConvexPart disc{{Vec3(-0.01, 0, 0), Vec3(0.01, 0, 0)}, 1, true};
  for (const double angle : {0.2, 0.5, 1.1}) {
    const Vec3 rim(-std::sin(angle), std::cos(angle), 0);
    for (const double from : {0.9, 1.1}) {
      Chain chain(1, {{from * rim}, 0.02, false});
      chain.rods[0] = disc;
      const PathReport report = verifyPath(chain.problem, {joints({0}), joints({1.3})});
      EXPECT_EQ(report.verdict, from < 1 ? PathVerdict::refuted : PathVerdict::proved) << angle;
      EXPECT_LE(report.provedClearance, 0.08 * (1 + 1e-9));
    }
  }
}

// A folding chain meets itself: the third rod rotates onto the first, which moves, too.
TEST(VerifyChain, LinksAgainstEachOtherWhileAllMoves) {
  Chain chain(3, {{Vec3(50, 0, 0)}, 0.1, false});
  // The rods form an equilateral triangle: rod 3 would end at the start of rod 1.
  const double corner = 2 * kHalfTurn / 3;
  PathReport report = verifyPath(chain.problem, {joints({-1, 0, 0}), joints({2, corner, corner})});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  EXPECT_EQ(report.findings.at(0).a, "rod1");
  EXPECT_EQ(report.findings.at(0).b, "rod3");
  EXPECT_EQ(verifyPath(chain.problem, {joints({-1, 0, 0}), joints({2, 1.7, 1.7})}).verdict,
            PathVerdict::proved);
  // Only the joint that carries both rods moves, so their distance is constant.
  report = verifyPath(chain.problem, {joints({-3, 1.7, 1.7}), joints({3, 1.7, 1.7})});
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  chain.problem.pairs = {{1, 3}};
  report = verifyPath(chain.problem, {joints({-3, 1.7, 1.7}), joints({3, 1.7, 1.7})});
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_LE(report.distanceQueries, 5u);
  // If the pair is removed from the problem, the same path is proved.
  chain.problem.pairs.clear();
  EXPECT_EQ(verifyPath(chain.problem, {joints({-1, 0, 0}), joints({2, corner, corner})}).verdict,
            PathVerdict::proved);
}

// The obstacle is beside the tip of a stretched arm. Perturbations of both joints move the tip
// towards the obstacle.
TEST(VerifyChain, TubesOfJointsCount) {
  Chain chain(2, {{Vec3(1.9, 0.05 + 0.01, 0)}, 0, false});
  const std::vector<Configuration> path = {joints({0, 0}), joints({0, 0})};
  EXPECT_EQ(verifyPath(chain.problem, path).verdict, PathVerdict::proved);
  // The perturbations reduce the gap of 0.01 by 1.9·τ + 0.9·τ, and by half of (1.95 + 3·0.95) τ².
  chain.problem.tube = joints({0.00355, 0.00355});
  EXPECT_EQ(verifyPath(chain.problem, path).verdict, PathVerdict::proved);
  EXPECT_EQ(verifyPath(chain.problem, {path[0]}).verdict, PathVerdict::proved);
  chain.problem.tube = joints({0.00358, 0.00358});
  const PathReport report = verifyPath(chain.problem, path);
  ASSERT_EQ(report.verdict, PathVerdict::undecided);
  EXPECT_EQ(report.findings[0].reason, "the tube may take all of the clearance");
  EXPECT_EQ(verifyPath(chain.problem, {joints({0.00358, 0.00358})}).verdict, PathVerdict::refuted);
}

TEST(VerifyChain, TubesAcrossTheDirectionTakeNoClearance) {
  // The obstacle is in front of a stretched arm. Rotations within the tube move the arm sideways.
  Chain chain(2, boxPart(Vec3(1.952, -0.2, -0.2), Vec3(2.2, 0.2, 0.2)));
  chain.problem.tube = joints({0.001, 0.001});
  EXPECT_EQ(verifyPath(chain.problem, {joints({0, 0})}).verdict, PathVerdict::proved);
  // With a tube of 0.1 the bound's second-order term exceeds the gap of 0.002.
  chain.problem.tube = joints({0.1, 0.1});
  EXPECT_EQ(verifyPath(chain.problem, {joints({0, 0})}).verdict, PathVerdict::undecided);
}

// All joints rotate about z, a millimetre above a table. Their tubes displace the tip by 30 mm, but
// only along the table. Beside a wall the same tubes use up the clearance.
TEST(VerifyChain, AnArmSlidesOverATableWithATube) {
  Chain chain(3, boxPart(Vec3(-4, -4, -1), Vec3(4, 4, -0.051)));
  chain.problem.tube = joints({0.01, 0.01, 0.01});
  const std::vector<Configuration> path = {joints({-1, 0.3, 0.4}), joints({0.5, -0.2, 0.1})};
  const PathReport report = verifyPath(chain.problem, path);
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_LE(report.provedClearance, 0.001);
  Chain beside(3, boxPart(Vec3(0, 0.08, -1), Vec3(4, 1, 1)));
  beside.problem.tube = chain.problem.tube;
  const std::vector<Configuration> along = {joints({0, 0, 0}), joints({-0.2, 0.05, 0.01})};
  EXPECT_EQ(verifyPath(beside.problem, along).verdict, PathVerdict::undecided);
  beside.problem.tube = joints({0, 0, 0});
  EXPECT_EQ(verifyPath(beside.problem, along).verdict, PathVerdict::proved);
  EXPECT_EQ(verifyPath(beside.problem, {joints({0.01, 0.01, 0.01})}).verdict,
            PathVerdict::refuted);  // a state within that tube touches
  beside.problem.tube = joints({0.003, 0.003, 0.003});
  EXPECT_EQ(verifyPath(beside.problem, along).verdict, PathVerdict::proved);
}

// One joint reverses the rotation of the joint before it, so the hand keeps its direction.
// Perturbations displace all points of the hand, up to its far end, in the same way, and only
// sideways.
TEST(VerifyChain, JointsOfOneVariableHaveOnePerturbation) {
  Chain chain(2, boxPart(Vec3(-2, -0.2, -0.2), Vec3(2, 0.948, 0.2)));
  chain.tree.frames[2].variable = 0;
  chain.tree.frames[2].multiplier = -1;
  chain.problem.tube = joints({0.01, 0});
  chain.problem.pairs = {{0, 2}};
  const std::vector<Configuration> path = {joints({kHalfTurn / 2 - 0.01, 0}),
                                           joints({kHalfTurn / 2 + 0.01, 0})};
  EXPECT_EQ(verifyPath(chain.problem, path).verdict, PathVerdict::proved);
  chain.tree.frames[2].variable = 1;
  chain.problem.tube = joints({0.01, 0.01});
  const std::vector<Configuration> same = {joints({kHalfTurn / 2 - 0.01, kHalfTurn / 2 - 0.01}),
                                           joints({kHalfTurn / 2 + 0.01, kHalfTurn / 2 + 0.01})};
  EXPECT_EQ(verifyPath(chain.problem, same).verdict, PathVerdict::undecided);
}

TEST(VerifyChain, RandomPathsAgainstDenseSampling) {
  std::mt19937_64 random(test::testSeed(7));
  const int paths = test::casesOf(45, 300);
  int proved = 0, refuted = 0;
  for (int i = 0; i < paths; ++i) {
    const Vec3 at = test::randomVec(random, 1.5);
    ConvexPart obstacle = boxPart(at - Vec3(0.3, 0.2, 2), at + Vec3(0.3, 0.2, 2));
    if (i % 3 == 1) obstacle = {{at - Vec3(0, 0, 2), at + Vec3(0, 0, 2)}, 0.3, true};
    if (i % 3 == 2) obstacle = {{at}, 0.4, false};
    Chain chain(4, obstacle);
    std::uniform_real_distribution<double> uniform(-1.5, 1.5);
    Configuration from(4), to(4);
    for (double& value : from) value = uniform(random);
    for (double& value : to) value = uniform(random);
    const PathReport report = verifyPath(chain.problem, {from, to});
    double sampled = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= 300; ++k) {
      const Configuration q = from + k / 300.0 * (to - from);
      sampled = std::min(sampled, verifyPath(chain.problem, {q}).closestFound);
    }
    if (report.verdict == PathVerdict::proved) {
      ++proved;
      EXPECT_GE(sampled, report.provedClearance * (1 - 1e-12)) << i;
      EXPECT_GE(report.provedClearance, 0.5 * std::min(sampled, report.closestFound)) << i;
    } else {
      refuted += report.verdict == PathVerdict::refuted;
    }
    if (sampled == 0) {
      EXPECT_EQ(report.verdict, PathVerdict::refuted) << i;
    }
    EXPECT_EQ(verifyPath(chain.problem, {to, from}).verdict, report.verdict) << i;
  }
  EXPECT_GT(proved, paths / 10);
  EXPECT_GT(refuted, paths / 10);
  EXPECT_EQ(proved + refuted, paths);
}

/// Verifies two fixed meshes.
PathVerdict still(const TriangleMesh& a, bool solidA, const TriangleMesh& b, bool solidB) {
  const KinematicTree tree;
  const ConfigurationSpace space;
  PathProblem problem;
  problem.tree = &tree;
  problem.space = &space;
  problem.tolerance = 1e-8;
  problem.bodies = {{"a", &a, {}, solidA, 0}, {"b", &b, {}, solidB, 0}};
  problem.pairs = {{0, 1}};
  return verifyPath(problem, {Configuration()}).verdict;
}

TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles)
    a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

TEST(VerifyChain, SolidsHoldWhatIsInside) {
  const TriangleMesh large = boxMesh({-2, -2, -2}, {2, 2, 2}),
                     small = boxMesh({-1, -1, -1}, {1, 1, 1}), far = boxMesh({5, 5, 5}, {6, 6, 6});
  EXPECT_EQ(still(large, false, small, false), PathVerdict::proved);
  EXPECT_EQ(still(large, false, small, true), PathVerdict::proved);
  EXPECT_EQ(still(large, true, small, false), PathVerdict::refuted);
  EXPECT_EQ(still(small, false, large, true), PathVerdict::refuted);
  EXPECT_EQ(still(far, true, small, true), PathVerdict::proved);
  // One component is inside, the other is not. A cavity counts as solid, too, because any closed
  // component does.
  EXPECT_EQ(still(large, true, both(far, small), false), PathVerdict::refuted);
  EXPECT_EQ(still(both(far, large), true, small, false), PathVerdict::refuted);
  TriangleMesh mirrored = large;
  for (Vec3& v : mirrored.vertices) v.y() = -v.y();
  EXPECT_EQ(still(mirrored, true, small, false), PathVerdict::refuted);
}

TEST(VerifyChain, ShellsThatMeetInACornerAreSolidsOfTheirOwn) {
  const TriangleMesh large = boxMesh({0, 0, 0}, {4, 4, 4}), small = boxMesh({0, 0, 0}, {2, 2, 2});
  TriangleMesh inward = small;
  for (auto& t : inward.triangles) std::swap(t[0], t[1]);
  const auto crumb = [](double x) { return boxMesh(Vec3::Constant(x), Vec3::Constant(x + 0.1)); };
  // Around a point inside both shells, the sum of the two winding numbers is 2, or 0 if one shell
  // is turned inside out.
  for (const TriangleMesh& inner : {small, inward}) {
    EXPECT_EQ(still(both(large, inner), true, crumb(1), false), PathVerdict::refuted);
    EXPECT_EQ(still(both(large, inner), true, crumb(3), false), PathVerdict::refuted);
    EXPECT_EQ(still(both(large, inner), true, crumb(5), false), PathVerdict::proved);
  }
}

}  // namespace
}  // namespace corridor
