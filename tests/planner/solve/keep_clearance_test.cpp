// Tests of keeping clearance, with a ball that moves in a plane past posts. The distance of the
// ball from each post has a closed form.
#include "planner/solve/keep_clearance.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <ompl/util/RandomNumbers.h>

#include "planner/checker/problem_state_space.h"
#include "planner/solve/prove_clearance.h"
#include "planner/solve/replan_on_target.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::partShape;
using test::poseOf;
using test::Rigid;

constexpr double kRadius = 0.5;      // of the moving ball
constexpr double kPostRadius = 0.3;  // of each post
bool never() {
  return false;
}

/// Returns a problem of a ball that moves in the plane z = 0, among balls (the posts) at these
/// positions.
Problem ballAmong(const std::vector<Vec3>& posts) {
  Problem problem = test::rigidProblem(Rigid::SE2);
  problem.source.name = "posts";
  problem.model.bodies = {{"ball", 2, 0, {partShape("ball", Sphere{kRadius})}}};
  for (std::size_t i = 0; i < posts.size(); ++i) {
    const std::string name = "post" + std::to_string(i);
    problem.model.bodies.push_back({name, 0, {}, {partShape(name, Sphere{kPostRadius}, posts[i])}});
  }
  return problem;
}

/// Returns the smallest distance of the ball from the posts along a path.
double clearanceAlong(const Path& path, const std::vector<Vec3>& posts) {
  double least = HUGE_VAL;
  for (std::size_t i = 1; i < path.size(); ++i)
    for (const Vec3& post : posts) {
      const Eigen::Vector2d a = path[i - 1].head<2>(), d = path[i].head<2>() - a,
                            c = post.head<2>();
      const double t = d.norm() > 0 ? std::clamp(d.dot(c - a) / d.squaredNorm(), 0.0, 1.0) : 0;
      least = std::min(least, (a + t * d - c).norm() - kRadius - kPostRadius);
    }
  return least;
}

/// A path, with the objects that are needed to move it away from posts.
struct Mover {
  Problem problem;
  Checker checker;
  ClearanceTargets targets;
  EdgeMemory edges, onTarget;
  Path path;

  Mover(const std::vector<Vec3>& posts, const Path& from, double clearance)
      : problem(ballAmong(posts)),
        checker(problem),
        targets(checker, clearance, from.front(), from.back()),
        edges([this](const auto& a, const auto& b) { return checker.isProvedFree(a, b); }),
        onTarget([this](const auto& a, const auto& b) { return targets.areKept(a, b); }),
        path(from) {}
  Path moved(double detour) {
    return withClearance(targets, checker.space(), path,
                         (1 + detour) * distanceAlong(checker.space(), path), edges, onTarget,
                         never);
  }
};

TEST(ClearanceTargets, AreLimitedByTheEndsOfThePath) {
  // Post 0 is 0.02 m from the start, post 1 is 0.05 m from the goal, post 2 is far.
  const std::vector<Vec3> posts{{-3, -0.82, 0}, {3, -0.85, 0}, {0, 4, 0}};
  const Problem problem = ballAmong(posts);
  const Checker checker(problem);
  const ClearanceTargets targets(checker, 0.1, poseOf(Rigid::SE2, -3, 0), poseOf(Rigid::SE2, 3, 0));
  ASSERT_EQ(targets.all().size(), 3u);
  EXPECT_NEAR(targets.all()[0], 0.7 * 0.02, 1e-4);
  EXPECT_NEAR(targets.all()[1], 0.7 * 0.05, 1e-4);
  EXPECT_EQ(targets.all()[2], 0.1);
  EXPECT_NEAR(targets.smallestAtEnds(), 0.02, 1e-4);
  EXPECT_EQ(targets.least(), targets.all()[0]);
}

TEST(ClearanceTargets, FindsTheWorstPlaceAndMovesAwayFromIt) {
  const std::vector<Vec3> posts{{0.7, -0.81, 0}};  // 0.01 m from the way
  const Problem problem = ballAmong(posts);
  const Checker checker(problem);
  const Configuration from = poseOf(Rigid::SE2, -3, 0), to = poseOf(Rigid::SE2, 3, 0);
  const ClearanceTargets targets(checker, 0.1, from, to);
  const auto worst = targets.missedOn(from, to);
  ASSERT_TRUE(worst);
  EXPECT_NEAR(worst->t, 3.7 / 6, 0.01);
  EXPECT_NEAR(worst->distance, 0.01, 1e-3);
  EXPECT_NEAR(worst->share, 0.1, 1e-2);
  const auto apart = targets.movedApart(poseOf(Rigid::SE2, 0.7, 0));
  ASSERT_TRUE(apart);
  EXPECT_NEAR((*apart)[0], 0.7, 1e-3);   // the step goes straight away from the post
  EXPECT_NEAR((*apart)[1], 0.14, 1e-3);  // up to 1.5 times the target distance
  EXPECT_FALSE(targets.missedOn(from, poseOf(Rigid::SE2, -1, 0)));
  // Where nothing is near, there is no step.
  EXPECT_FALSE(targets.movedApart(from));
}

/// An edge of any length is sampled at most 33 times at first: the place where the proof failed is
/// sampled, too.
TEST(ClearanceTargets, FindsTheWorstPlaceOfALongEdge) {
  const Problem problem = ballAmong({{0.7, 5, 0}, {0.7, -0.81, 0}});  // the second is 0.01 m away
  const Checker checker(problem);
  for (const double half : {3.0, 30.0, 100.0}) {
    const Configuration from = poseOf(Rigid::SE2, -half, 0), to = poseOf(Rigid::SE2, half, 0);
    const ClearanceTargets targets(checker, 0.1, from, to);
    for (const auto& worst : {targets.missedOn(from, to), targets.closestOn(from, to)}) {
      if (!worst) continue;  // `closestOn` only samples
      EXPECT_EQ(worst->pair, 1u) << half;
      EXPECT_LT(worst->distance, 0.1) << half;
      EXPECT_GT(worst->distance, 0) << half;
    }
    EXPECT_TRUE(targets.missedOn(from, to)) << half;
  }
}

TEST(KeepClearance, RoundsAPostAtADistance) {
  const std::vector<Vec3> posts{{0, -0.8001, 0}};
  Mover mover(posts, {poseOf(Rigid::SE2, -3, 0), poseOf(Rigid::SE2, 3, 0)}, 0.1);
  ASSERT_NEAR(clearanceAlong(mover.path, posts), 0.0001, 1e-12);
  const Path moved = mover.moved(0.1);
  EXPECT_EQ(moved.front(), mover.path.front());
  EXPECT_EQ(moved.back(), mover.path.back());
  EXPECT_GT(clearanceAlong(moved, posts), 0.1);
  EXPECT_LT(distanceAlong(mover.checker.space(), moved), 6.1);
  const PathClearance proof = proveClearance(mover.checker, mover.targets, moved, mover.onTarget);
  EXPECT_EQ(proof.shareOnTarget, 1);
  EXPECT_EQ(proof.proved, 0.1);
  EXPECT_EQ(proof.a, "");  // nothing is closer than 0.1 m
  // No detour is allowed, so the path stays.
  EXPECT_EQ(mover.moved(1e-6), mover.path);
  // If the time has run out, the path stays.
  EXPECT_EQ(withClearance(mover.targets, mover.checker.space(), mover.path, 7, mover.edges,
                          mover.onTarget, [] { return true; }),
            mover.path);
}

TEST(KeepClearance, StaysInTheMiddleOfANarrowPassage) {
  // Between the posts, the ball has 0.03 m on both sides: less than the targets.
  const std::vector<Vec3> posts{{0, -0.85, 0}, {0, 0.81, 0}};
  Mover mover(posts, {poseOf(Rigid::SE2, -3, 0), poseOf(Rigid::SE2, 3, 0)}, 0.1);
  const double before = clearanceAlong(mover.path, posts);
  ASSERT_NEAR(before, 0.01, 1e-12);
  const Path moved = mover.moved(0.1);
  const double after = clearanceAlong(moved, posts);
  EXPECT_GT(after, 0.02);
  const PathClearance proof = proveClearance(mover.checker, mover.targets, moved, mover.onTarget);
  EXPECT_LE(proof.proved, after);
  EXPECT_GE(proof.proved, 0.85 * after);
  EXPECT_NEAR(proof.smallest, after, 0.05 * after);
  EXPECT_EQ(proof.a == "ball" ? proof.b.substr(0, 4) : proof.a.substr(0, 4), "post");
  EXPECT_LT(proof.shareOnTarget, 1);
  EXPECT_GT(proof.shareOnTarget, 0.8);
}

/// The promises of the header hold for random posts and paths.
TEST(KeepClearance, HoldsWhatItPromises) {
  std::mt19937_64 random(test::testSeed(2511));
  std::uniform_real_distribution<double> place(-3, 3);
  int tried = 0, better = 0, onTarget = 0;
  for (int n = 0; n < 200 && tried < 40; ++n) {
    std::vector<Vec3> posts;
    for (int i = 0; i < 6; ++i) posts.emplace_back(place(random), place(random), 0);
    Path path;
    for (int i = 0; i < 3; ++i) path.push_back(poseOf(Rigid::SE2, place(random), place(random)));
    if (!(clearanceAlong(path, posts) > 1e-4)) continue;
    ++tried;
    Mover mover(posts, path, 0.2);
    const ConfigurationSpace& space = mover.checker.space();
    const Path moved = mover.moved(0.1);
    ASSERT_EQ(moved.front(), path.front());
    ASSERT_EQ(moved.back(), path.back());
    EXPECT_LE(distanceAlong(space, moved), 1.1 * distanceAlong(space, path) * (1 + 1e-12));
    EXPECT_TRUE(isCertified(mover.checker, moved));
    const PathClearance proof = proveClearance(mover.checker, mover.targets, moved, mover.onTarget);
    const double after = clearanceAlong(moved, posts), before = clearanceAlong(path, posts);
    EXPECT_LT(proof.proved, after) << n;
    EXPECT_GE(proof.proved, 0.6 * std::min(after, 0.2)) << n;
    EXPECT_GE(after, std::min(before, mover.targets.least()) * (1 - 1e-9)) << n;
    better += after > before;
    onTarget += proof.shareOnTarget == 1;
    EXPECT_EQ(moved, Mover(posts, path, 0.2).moved(0.1));  // the same input gives the same path
  }
  EXPECT_GE(tried, 20);
  EXPECT_GE(onTarget, tried / 2);
  EXPECT_GE(better, 5);
}

TEST(ProveClearance, OfAPathOfOneState) {
  const std::vector<Vec3> posts{{0, -0.83, 0}};
  Mover mover(posts, {poseOf(Rigid::SE2, 0, 0)}, 0.1);
  const PathClearance proof =
      proveClearance(mover.checker, mover.targets, mover.path, mover.onTarget);
  EXPECT_NEAR(proof.smallest, 0.03, 1e-4);
  EXPECT_LT(proof.proved, 0.03);
  EXPECT_GE(proof.proved, 0.02);
}

TEST(ProveClearance, OfAPathThatStands) {
  const std::vector<Vec3> posts{{0, -0.83, 0}};
  const Configuration q = poseOf(Rigid::SE2, 0, 0);
  Mover mover(posts, {q, q}, 0.1);
  const PathClearance proof =
      proveClearance(mover.checker, mover.targets, mover.path, mover.onTarget);
  EXPECT_EQ(proof.shareOnTarget, 1);
  EXPECT_NEAR(proof.smallest, 0.03, 1e-4);
  EXPECT_GE(proof.proved, 0.02);
  // With this tolerance, the proof that the target is kept fails. The target is 70 % of the
  // distance of 0.03 m, which leaves 0.009 m; the proof needs twice the tolerance, 0.028 m.
  Problem coarse = ballAmong(posts);
  coarse.settings.checker.tolerance = 0.014;
  const Checker checker(coarse);
  const ClearanceTargets targets(checker, 0.1, q, q);
  EdgeMemory onTarget([&](const auto& a, const auto& b) { return targets.areKept(a, b); });
  const PathClearance none = proveClearance(checker, targets, {q, q}, onTarget);
  EXPECT_EQ(none.shareOnTarget, 0);
  EXPECT_LT(none.proved, 0.03);
}

/// A fence of posts. The path leads through a gap that leaves the ball 0.05 m on each side. The gap
/// beside it, 2 m away, leaves 0.35 m, if it is open. Through all others, the ball does not fit.
struct Fence : Mover {
  explicit Fence(bool isOpen)
      : Mover(postsOf(isOpen), {poseOf(Rigid::SE2, -4, 0), poseOf(Rigid::SE2, 4, 0)}, 0.2),
        posts(postsOf(isOpen)) {
    ompl::RNG::setSeed(1);
  }
  static std::vector<Vec3> postsOf(bool isOpen) {
    std::vector<Vec3> posts;
    for (const double y : {-6.15, -4.65, -3.15, -0.85, 0.85, 2.35, 3.85})
      posts.emplace_back(0, y, 0);
    if (!isOpen) posts.emplace_back(0, -2, 0);
    return posts;
  }
  double longest(double detour) const {
    return (1 + detour) * distanceAlong(checker.space(), path);
  }
  ReplannedPath replanned(double detour, const std::function<bool()>& stop = never) {
    return replannedOnTarget(std::make_shared<ProblemStateSpace>(checker.space()), targets, path,
                             edges, onTarget, {longest(detour), 5000, HUGE_VAL, stop});
  }
  std::vector<Vec3> posts;
};

TEST(ReplannedOnTarget, TakesTheGapWithRoom) {
  Fence fence(true);
  ASSERT_NEAR(clearanceAlong(fence.path, fence.posts), 0.05, 1e-9);
  EXPECT_LT(clearanceAlong(fence.moved(0.2), fence.posts), 0.06);  // moving alone does not help
  const ReplannedPath replanned = fence.replanned(0.2);
  EXPECT_GT(clearanceAlong(replanned.path, fence.posts), 0.2);
  EXPECT_LE(distanceAlong(fence.checker.space(), replanned.path), fence.longest(0.2));
  EXPECT_EQ(replanned.path.front(), fence.path.front());
  EXPECT_EQ(replanned.path.back(), fence.path.back());
  for (std::size_t i = 1; i < replanned.path.size(); ++i)
    EXPECT_TRUE(fence.targets.areKept(replanned.path[i - 1], replanned.path[i])) << i;
}

/// With a tube, the start does not keep its target, which is 70 % of its distance. No search can
/// begin there: OMPL would wait for another start until the time is over.
TEST(ReplannedOnTarget, DoesNotSearchFromAnEndThatMissesATarget) {
  Problem problem = ballAmong({{-4, 0.9, 0}, {0, -0.85, 0}});  // 0.1 and 0.05 m away
  problem.task.tube = Eigen::Vector3d(0.05, 0.05, 0);
  const Checker checker(problem);
  const Path path{poseOf(Rigid::SE2, -4, 0), poseOf(Rigid::SE2, 4, 0)};
  const ClearanceTargets targets(checker, 0.1, path.front(), path.back());
  ASSERT_FALSE(targets.areKept(path.front(), path.front()));
  EdgeMemory edges([&](const auto&a, const auto&b) { return checker.isProvedFree(a, b); }),
      onTarget([&](const auto&a, const auto&b) { return targets.areKept(a, b); });
  int calls = 0;
  const ReplannedPath replanned =
      replannedOnTarget(std::make_shared<ProblemStateSpace>(checker.space()), targets, path, edges,
                        onTarget, {20, 5000, HUGE_VAL, [&] {
                                     ++calls;
                                     return false;
                                   }});
  EXPECT_EQ(replanned.path, path);
  EXPECT_EQ(replanned.why, WhyOffTarget::notFound);
  EXPECT_LT(calls, 10);
}

TEST(ClearanceTargets, ReserveNothingBeyondAPadding) {
  Problem problem = ballAmong({{-4, 0.9, 0}});
  problem.task.padding.bodies[1] = 0.099;  // of 0.1
  const Checker checker(problem);
  const Configuration start = poseOf(Rigid::SE2, -4, 0), goal = poseOf(Rigid::SE2, 4, 0);
  const ClearanceTargets targets(checker, 0.2, start, goal);
  EXPECT_EQ(targets.all()[0], targets.scaled(1.02).all()[0]);
  EXPECT_TRUE(targets.areKept(start, start));
}

TEST(ReplannedOnTarget, SaysWhyNot) {
  const auto why = [](bool isOpen, double detour, const std::function<bool()>& stop = never) {
    Fence fence(isOpen);
    const ReplannedPath replanned = fence.replanned(detour, stop);
    EXPECT_EQ(replanned.path, fence.path);
    return replanned.why;
  };
  EXPECT_EQ(why(true, 0.05), WhyOffTarget::detour);  // the gap with room costs 12 %
  EXPECT_EQ(why(false, 0.2), WhyOffTarget::notFound);
  EXPECT_EQ(why(true, 0.2, [] { return true; }), WhyOffTarget::time);
}

/// The ball passes a post so quickly on a long edge that samples miss the closest place. The proof
/// finds it.
TEST(ProveClearance, FindsTheClosestPlaceBetweenSamples) {
  const std::vector<Vec3> posts{{0.7, -0.83, 0}};
  for (const double half : {3.0, 20.0, 50.0}) {
    Mover mover(posts, {poseOf(Rigid::SE2, -half, 0), poseOf(Rigid::SE2, half, 0)}, 0.2);
    const PathClearance found =
        proveClearance(mover.checker, mover.targets, mover.path, mover.onTarget);
    EXPECT_GE(found.smallest, 0.03 - 1e-9) << half;
    EXPECT_LE(found.smallest, 0.03 / 0.93) << half;
    EXPECT_GE(found.proved, 0.92 * found.smallest) << half;
    EXPECT_LE(found.proved, 0.03) << half;
  }
}

TEST(ProveClearance, RoundsDownToThreeDigits) {
  for (int exponent = -9; exponent < 9; ++exponent)
    for (int digits = 100; digits < 1000; digits += digits == 100 ? 1 : 7) {
      const auto number = [&](int d) {
        return std::stod(std::to_string(d) + "e" + std::to_string(exponent));
      };
      const double x = number(digits);
      EXPECT_EQ(roundedDownTo3Digits(x), x);
      EXPECT_EQ(roundedDownTo3Digits(1.0004 * x), x);
      EXPECT_EQ(roundedDownTo3Digits(std::nextafter(x, 1e300)), x);
      const double below =
          digits > 100 ? number(digits - 1)
                       : std::stod("999e" + std::to_string(exponent - 1));  // 999 follows 100
      EXPECT_EQ(roundedDownTo3Digits(std::nextafter(x, 0)), below);
    }
  for (const double x : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_EQ(roundedDownTo3Digits(x), 0);
}

TEST(ClearanceTargets, MovesAnArmAway) {
  const Problem problem = test::armProblem();
  const Checker checker(problem);
  const Configuration far = Configuration::Zero(3);
  const ClearanceTargets targets(checker, 0.05, far, far);
  std::mt19937_64 random(test::testSeed(2512));
  std::uniform_real_distribution<double> angle(-2.5, 2.5);
  int moved = 0;
  for (int n = 0; n < 20'000 && moved < 20; ++n) {
    const Configuration q = Vec3(angle(random), angle(random), angle(random));
    const double before = checker.inBounds(q) ? checker.clearance(q) : 0;
    if (!(before > 1e-3 && before < 0.04)) continue;
    const auto apart = targets.movedApart(q);
    ASSERT_TRUE(apart);
    EXPECT_TRUE(checker.inBounds(*apart));
    EXPECT_GT(checker.clearance(*apart), before + 0.2 * (0.075 - before)) << q.transpose();
    EXPECT_LT(checker.space().distance(q, *apart), 0.5);
    ++moved;
  }
  EXPECT_EQ(moved, 20);
}

TEST(EdgeMemory, TestsNoEdgeTwice) {
  int tests = 0;
  EdgeMemory edges([&](const Configuration& a, const Configuration& b) {
    ++tests;
    return a[0] < b[0];
  });
  const Configuration one = poseOf(Rigid::SE2, 1, 0), two = poseOf(Rigid::SE2, 2, 0);
  EXPECT_FALSE(edges.knowsFree(one, two));
  for (int n = 0; n < 3; ++n) {
    EXPECT_TRUE(edges.isFree(one, two));
    EXPECT_FALSE(edges.isFree(two, one));  // another edge
  }
  EXPECT_EQ(tests, 2);
  EXPECT_TRUE(edges.knowsFree(one, two));
  EXPECT_FALSE(edges.knowsFree(two, one));
  edges.addFree(two, one);
  EXPECT_TRUE(edges.knowsFree(two, one));
  EXPECT_TRUE(edges.isFree(two, one));
  EXPECT_EQ(tests, 2);
}

/// What was proved before is not proved again, but bounds are tested.
TEST(CertifiedPath, TestsNoKnownEdge) {
  const Problem problem = ballAmong({{0, -0.9, 0}});
  const Checker checker(problem);
  const auto at = [](double x, double y) { return poseOf(Rigid::SE2, x, y); };
  EdgeMemory edges([&](const auto& a, const auto& b) { return checker.isProvedFree(a, b); });
  const Path path{at(-3, 0), at(0, 0), at(3, 0)};
  EXPECT_TRUE(edges.isFree(path[0], path[1]));
  const std::uint64_t before = checker.counters().edges;
  EXPECT_TRUE(isCertified(checker, path, &edges));
  EXPECT_EQ(checker.counters().edges, before + 1);
  EXPECT_TRUE(isCertified(checker, path));
  EXPECT_EQ(checker.counters().edges, before + 3);
  EdgeMemory bold([](const auto&, const auto&) { return true; });
  const Path outside{at(-3, 0), at(-7, 0), at(-3, 1)};
  EXPECT_TRUE(bold.isFree(outside[0], outside[1]) && bold.isFree(outside[1], outside[2]));
  EXPECT_FALSE(isCertified(checker, outside, &bold));
}

TEST(PreferredClearance, ItsDefaultIsForRobotsWithJoints) {
  Problem ball = ballAmong({{0, -0.8, 0}});
  EXPECT_EQ(preferredClearance(ball), 0);
  ball.settings.prefer.clearance = 0.02;
  EXPECT_EQ(preferredClearance(ball), 0.02);
  Problem arm = test::armProblem();
  EXPECT_EQ(preferredClearance(arm), 0.005);
  arm.settings.prefer.clearance = 1e308;
  EXPECT_EQ(preferredClearance(arm), 1e6);
  arm.settings.prefer.clearance = 0;
  EXPECT_EQ(preferredClearance(arm), 0);
  arm.settings.prefer.clearance.reset();
  for (const auto& change : std::initializer_list<void (*)(Problem&)>{
           [](Problem& p) { p.task.margin = 1e-3; },
           [](Problem& p) { p.settings.simplify = Simplifier::ompl; },
           [](Problem& p) { p.settings.checker.edges = EdgeMethod::discrete; },
           [](Problem& p) { p.settings.objective = Objective::maxMinClearance; }}) {
    Problem other = arm;
    change(other);
    EXPECT_EQ(preferredClearance(other), 0);
  }
}

}  // namespace
}  // namespace corridor
