// Tests a problem's space as an OMPL space: it interpolates along Corridor's edges, has everything
// that planners need, and samples as OMPL does.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/util/RandomNumbers.h>

#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

namespace ob = ompl::base;
using std::numbers::pi;
using test::Rigid;

/// A cart (x, y, yaw) with an arm: a continuous shoulder and two joints.
ConfigurationSpace cartWithArm() {
  using Kind = Coordinate::Kind;
  ConfigurationSpace space;
  CoordinateGroup cart{CoordinateGroup::Kind::planar, "cart", {}}, arm;
  cart.coordinates = {space.add({Kind::line, "x", 0, -4, 4, false, 1}),
                      space.add({Kind::line, "y", 0, -3, 3, false, 1}),
                      space.add({Kind::circle, "yaw", 0, 0, 0, true, 0.5})};
  arm.coordinates = {space.add({Kind::line, "lift", 0, 0, 1, false, 2}),
                     space.add({Kind::circle, "shoulder", 0, 0, 0, true, 1}),
                     space.add({Kind::line, "elbow", 0, -2, 2, true, 1})};
  space.addGroup(cart);
  space.addGroup(arm);
  return space;
}

ConfigurationSpace spaceOf(int kind) {
  return kind == 0   ? test::rigidProblem(Rigid::SE2, 0.7).model.space
         : kind == 1 ? test::rigidProblem(Rigid::SE3, 0.7).model.space
         : kind == 2 ? test::armProblem().model.space
                     : cartWithArm();
}

class StateSpaces : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, StateSpaces, testing::Range(0, 4));

TEST_P(StateSpaces, PassOmplsSanityChecks) {
  const ConfigurationSpace configurations = spaceOf(GetParam());
  ProblemStateSpace space(configurations);
  space.setup();
  EXPECT_NO_THROW(space.sanityChecks());
}

/// A half turn is an angle like any other, also for OMPL, whose angles end below π.
TEST_P(StateSpaces, HalfTurnsAreInBounds) {
  const ConfigurationSpace configurations = spaceOf(GetParam());
  ProblemStateSpace space(configurations);
  space.setup();
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(configurations.size()));
  for (const Coordinate& c : configurations.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::circle) q[i] = pi;
    if (c.kind == Coordinate::Kind::line) q[i] = 0.5 * (c.lower + c.upper);
    if (c.kind == Coordinate::Kind::rotation) q[i + 3] = 1;
  }
  ob::State* state = space.allocState();
  space.write(q, state);
  EXPECT_TRUE(space.satisfiesBounds(state));
  EXPECT_TRUE(configurations.equal(space.read(state), q));
  space.freeState(state);
}

TEST_P(StateSpaces, SamplesAreInBoundsAndNoFartherApartThanTheExtent) {
  ompl::RNG::setSeed(test::testSeed(3) + 1);
  const ConfigurationSpace configurations = spaceOf(GetParam());
  const auto space = std::make_shared<ProblemStateSpace>(configurations);
  space->setup();
  ob::ScopedState<> a(space), b(space);
  double farthest = 0;
  for (int i = 0; i < 2000; ++i) {
    a.random();
    b.random();
    EXPECT_TRUE(configurations.inBounds(space->read(a.get())));
    farthest = std::max(farthest, space->distance(a.get(), b.get()));
  }
  EXPECT_LE(farthest, space->getMaximumExtent());
  EXPECT_GE(farthest, 0.4 * space->getMaximumExtent());
}

TEST_P(StateSpaces, ReadsWhatItWrote) {
  const ConfigurationSpace configurations = spaceOf(GetParam());
  const auto space = std::make_shared<ProblemStateSpace>(configurations);
  ob::ScopedState<> state(space);
  Configuration q(static_cast<Eigen::Index>(configurations.size()));
  for (Eigen::Index i = 0; i < q.size(); ++i) q[i] = 0.125 * static_cast<double>(i + 1);
  space->write(q, state.get());
  EXPECT_EQ(space->read(state.get()), q);
}

TEST_P(StateSpaces, OutputMayBeEitherInput) {
  const ConfigurationSpace configurations = spaceOf(GetParam());
  const auto space = std::make_shared<ProblemStateSpace>(configurations);
  ompl::RNG::setSeed(7);
  ob::ScopedState<> a(space), b(space);
  a.random();
  b.random();
  const Configuration expected =
      configurations.interpolate(space->read(a.get()), space->read(b.get()), 0.3);
  for (const bool first : {true, false}) {
    ob::ScopedState<> s = a, t = b;
    ob::State* out = first ? s.get() : t.get();
    space->interpolate(s.get(), t.get(), 0.3, out);
    EXPECT_EQ(space->read(out), expected);
  }
}

TEST_P(StateSpaces, HaveAProjectionOfTheBounds) {
  const ConfigurationSpace configurations = spaceOf(GetParam());
  const auto space = std::make_shared<ProblemStateSpace>(configurations);
  space->setup();
  ASSERT_TRUE(space->hasDefaultProjection());
  const auto projection = space->getDefaultProjection();
  const unsigned dimension[] = {2, 3, 3, 2};
  EXPECT_EQ(projection->getDimension(), dimension[GetParam()]);
  for (const double cell : projection->getCellSizes()) EXPECT_GT(cell, 0.05);
}

TEST(StateSpace, TinyDifferencesAreDifferent) {
  for (const Rigid kind : {Rigid::SE2, Rigid::SE3}) {
    const test::Hall hall(kind);
    const auto a = hall.scoped(hall.at(0, 0, 0.5)), b = hall.scoped(hall.at(0, 0, 0.5 + 1e-7)),
               c = hall.scoped(hall.at(0, 0, 0.5));
    EXPECT_FALSE(hall.si->equalStates(a.get(), b.get()));
    EXPECT_GT(hall.si->distance(a.get(), b.get()), 0);
    EXPECT_TRUE(hall.si->equalStates(a.get(), c.get()));
    EXPECT_EQ(hall.si->distance(a.get(), c.get()), 0);
  }
}

/// With the same seed, a rigid body's samples, near and uniform, equal those of OMPL's own space.
/// So planning behaves as with SE3StateSpace.
TEST(StateSpace, RigidBodiesAreSampledAsByOmpl) {
  const ConfigurationSpace configurations = test::rigidProblem(Rigid::SE3, 0.7).model.space;
  const auto ours = std::make_shared<ProblemStateSpace>(configurations);
  const auto theirs = std::make_shared<ob::SE3StateSpace>();
  ob::RealVectorBounds bounds(3);
  bounds.setLow(-5);
  bounds.setHigh(5);
  theirs->setBounds(bounds);
  theirs->setSubspaceWeight(1, 0.7);
  ours->setup();
  theirs->setup();
  EXPECT_EQ(ours->getType(), ob::STATE_SPACE_SE3);
  EXPECT_EQ(ours->getMaximumExtent(), theirs->getMaximumExtent());
  const auto samples = [](const ob::StateSpacePtr& space) {
    ompl::RNG::setSeed(11);
    const auto sampler = space->allocStateSampler();
    ob::ScopedState<> at(space), near(space);
    std::vector<double> numbers;
    for (int i = 0; i < 20; ++i) {
      sampler->sampleUniform(at.get());
      sampler->sampleUniformNear(near.get(), at.get(), 0.5);
      for (const auto& state : {at, near}) {
        const std::vector<double> values = state.reals();
        numbers.insert(numbers.end(), values.begin(), values.end());
      }
    }
    return numbers;
  };
  EXPECT_EQ(samples(ours), samples(theirs));
}

}  // namespace
}  // namespace corridor
