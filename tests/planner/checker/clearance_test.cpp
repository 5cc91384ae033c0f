// Compares the clearance that OMPL's samplers and objectives use with closed forms, and with the
// validity of states.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "planner/checker/state_validity_checkers.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::armProblem;
using test::boxMesh;
using test::Hall;
using test::hallProblem;
using test::poseOf;
using test::Rigid;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double clearanceOf(const Problem& problem, const Configuration& q) {
  return Checker(problem).clearance(q);
}

TEST(Clearance, OfABarBesideAWall) {
  for (const Rigid kind : {Rigid::SE2, Rigid::SE3}) {
    Problem problem = hallProblem(kind);
    for (const double margin : {0.0, 0.1}) {
      problem.task.margin = margin;
      const auto at = [&](double x, double y, double yaw) {
        return clearanceOf(problem, poseOf(kind, x, y, yaw)) + margin;
      };
      EXPECT_NEAR(at(-3, 0, 0), 2.4995, 1e-14);
      EXPECT_NEAR(at(2, -1, 0.4), 1.9995 - 0.5 * std::cos(0.4) - 0.1 * std::sin(0.4), 1e-14);
      EXPECT_NEAR(at(0, 3, 0), 0.9, 1e-14);  // above the gap's edge
      EXPECT_EQ(at(0, 0, 0), 0);             // deep in the wall: no depth is computed
      EXPECT_NEAR(at(-0.5005, 0, 0), 0, 1e-15);
    }
  }
}

TEST(Clearance, OfAnArmOfPrimitivesIsThatOfItsClosestPair) {
  const Problem problem = armProblem();
  // The lower arm lies along x from 1.1 to 1.9, and the post's axis is at (1.2, 1.2). Arm and post
  // have the radius 0.1.
  EXPECT_NEAR(clearanceOf(problem, Configuration::Zero(3)), 1.0, 1e-12);
  // The arm points at the post and meets it.
  EXPECT_EQ(clearanceOf(problem, Configuration(Vec3(0.25 * std::numbers::pi, 0, 0))), 0);
}

TEST(Clearance, InASolidIsContact) {
  Problem problem = hallProblem(Rigid::SE3);
  problem.model.bodies[1].shapes = {test::meshShape("block", boxMesh({4, 4, 4}))};
  EXPECT_NEAR(clearanceOf(problem, poseOf(Rigid::SE3, 0.25, 0)), 1.25, 1e-14);
  problem.model.bodies[1].shapes[0].solid = true;
  EXPECT_EQ(clearanceOf(problem, poseOf(Rigid::SE3, 0.25, 0)), 0);
  problem.task.margin = 0.5;
  EXPECT_EQ(clearanceOf(problem, poseOf(Rigid::SE3, 0.25, 0)), -0.5);
}

TEST(Clearance, WithoutTestedPairsItIsInfinite) {
  Problem problem = hallProblem(Rigid::SE2);
  problem.model.filter.skip(0, 1, "allow");
  EXPECT_EQ(clearanceOf(problem, poseOf(Rigid::SE2, 0, 0)), kInfinity);
}

TEST(Clearance, BothValidityCheckersReturnIt) {
  Hall hall(Rigid::SE3);
  const CertifiedStateValidityChecker certified(hall.si, hall.checker);
  const ExactStateValidityChecker exact(hall.si, hall.checker);
  const auto state = hall.scoped(hall.at(-3, 0)), touching = hall.scoped(hall.at(0, 0)),
             nowhere = hall.scoped(hall.at(std::nan(""), 0));
  for (const ompl::base::StateValidityChecker* checker :
       {static_cast<const ompl::base::StateValidityChecker*>(&certified),
        static_cast<const ompl::base::StateValidityChecker*>(&exact)}) {
    EXPECT_EQ(checker->getSpecs().clearanceComputationType,
              ompl::base::StateValidityCheckerSpecs::EXACT);
    double clearance = -1;
    EXPECT_TRUE(checker->isValid(state.get(), clearance));
    EXPECT_NEAR(clearance, 2.4995, 1e-14);
    EXPECT_FALSE(checker->isValid(touching.get(), clearance));
    EXPECT_EQ(clearance, 0);
    EXPECT_EQ(checker->clearance(nowhere.get()), -kInfinity);
  }
  const std::uint64_t before = hall.checker.counters().states;
  hall.checker.clearance(hall.at(-3, 0));
  EXPECT_EQ(hall.checker.counters().states, before + 1) << "a state, of however many pairs";
}

/// The clearance of a valid state is positive. If the clearance of a state exceeds what its proof
/// needs, the state is valid.
TEST(Clearance, AgreesWithValidity) {
  std::mt19937_64 random(test::testSeed(3));
  std::uniform_real_distribution<double> u(-1, 1);
  for (const double margin : {0.0, 0.2}) {
    Problem problem = armProblem();
    problem.task.margin = margin;
    const Checker checker(problem);
    int valid = 0, invalid = 0;
    for (int i = 0; i < 400; ++i) {
      const Configuration q = Vec3(3 * u(random), 2.4 * u(random), 2.4 * u(random));
      const double clearance = checker.clearance(q);
      if (checker.isProvedFree(q)) {
        ++valid;
        EXPECT_GT(clearance, 0);
      } else {
        ++invalid;
        EXPECT_LT(clearance, 3 * checker.options().tolerance);
      }
      EXPECT_EQ(clearance == -margin, checker.interference(q).has_value());
    }
    EXPECT_GT(valid, 40);
    EXPECT_GT(invalid, 40);
  }
}

}  // namespace
}  // namespace corridor
