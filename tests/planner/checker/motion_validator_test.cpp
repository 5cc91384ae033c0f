// One suite for every motion validator: OMPL's contract of checkMotion and lastValid holds exactly.
#include <algorithm>
#include <cstring>
#include <random>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>
#include <ompl/base/spaces/SE3StateSpace.h>

#include "planner/checker/motion_validators.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/problem/keys.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

namespace ob = ompl::base;
using test::Hall;
using test::Rigid;

struct ValidatorKind {
  Rigid space;
  std::string edges, volume;  ///< values of these keys in `checker: {…}`

  bool proves() const { return edges != "discrete"; }
};

/// Returns all kinds of validators that a problem may use: every method in both spaces, and every
/// volume with one of the methods in turn.
std::vector<ValidatorKind> kinds() {
  const auto& methods = problemChoices().at("checker.edges");
  const auto& volumes = problemChoices().at("checker.volume");
  std::vector<ValidatorKind> all;
  for (const std::string& edges : methods)
    for (const Rigid space : {Rigid::SE3, Rigid::SE2})
      all.push_back({space, edges, volumes.front()});
  for (std::size_t v = 1; v < volumes.size(); ++v) {
    all.push_back({Rigid::SE3, methods.front(), volumes[v]});
    all.push_back({Rigid::SE2, methods[1 + v % (methods.size() - 1)], volumes[v]});
  }
  return all;
}

std::string nameOf(const testing::TestParamInfo<ValidatorKind>& info) {
  std::string volume = info.param.volume;
  std::replace(volume.begin(), volume.end(), '-', '_');
  return info.param.edges + (info.param.space == Rigid::SE3 ? "SE3" : "SE2") + "_" + volume;
}

class MotionValidators : public testing::TestWithParam<ValidatorKind> {
 protected:
  MotionValidators() : hall_(GetParam().space, GetParam().edges, GetParam().volume) {
    if (GetParam().proves()) {
      hall_.si->setStateValidityChecker(
          std::make_shared<CertifiedStateValidityChecker>(hall_.si, hall_.checker));
      hall_.si->setMotionValidator(
          std::make_shared<CertifiedMotionValidator>(hall_.si, hall_.checker));
    } else {
      hall_.si->getStateSpace()->setLongestValidSegmentFraction(0.001);
      hall_.si->setStateValidityChecker(
          std::make_shared<ExactStateValidityChecker>(hall_.si, hall_.checker));
      hall_.si->setMotionValidator(
          std::make_shared<DiscreteMotionValidator>(hall_.si, hall_.checker));
    }
    hall_.si->setup();
  }
  const ob::MotionValidator& validator() const { return *hall_.si->getMotionValidator(); }
  ob::ScopedState<> state(double x, double y, double yaw = 0) const {
    return hall_.scoped(hall_.at(x, y, yaw));
  }
  std::vector<double> bits(const ob::ScopedState<>& s) const { return s.reals(); }

  /// Tests the state that a failed check stores in `last`, which may be the same object as `s1`.
  void expectValid(const Configuration& s1, const ob::State* last, double t) const {
    const auto from = hall_.scoped(s1);
    EXPECT_TRUE(hall_.si->isValid(last));
    EXPECT_TRUE(validator().checkMotion(from.get(), last)) << t;
  }

  Hall hall_;
};

TEST_P(MotionValidators, FreeAndBlocked) {
  EXPECT_TRUE(validator().checkMotion(state(-3, 0).get(), state(-2, 1, 2).get()));
  EXPECT_TRUE(validator().checkMotion(state(-3, 3).get(), state(3, 3).get()));
  EXPECT_FALSE(validator().checkMotion(state(-3, 0).get(), state(3, 0).get()));
  EXPECT_FALSE(validator().checkMotion(state(-3, 0).get(), state(0, 0).get()));
  EXPECT_EQ(validator().getValidMotionCount(), 2u);
  EXPECT_EQ(validator().getInvalidMotionCount(), 2u);
}

TEST_P(MotionValidators, OutOfBoundsIsNotValid) {
  EXPECT_TRUE(
      validator().checkMotion(state(-3, 0).get(), state(-5, 0).get()));  // bounds are inclusive
  EXPECT_FALSE(validator().checkMotion(state(-3, 0).get(), state(-5.001, 0).get()));
  EXPECT_FALSE(validator().checkMotion(state(-3, 0).get(), state(std::nan(""), 0).get()));
}

TEST_P(MotionValidators, HalfTurnIsNotValid) {
  EXPECT_FALSE(validator().checkMotion(state(-3, 0, 0).get(), state(-3, 0, std::acos(-1.0)).get()));
  auto last = state(1, 1);
  std::pair<ob::State*, double> lastValid{last.get(), 7};
  EXPECT_FALSE(validator().checkMotion(state(-3, 0, 0).get(), state(-3, 0, std::acos(-1.0)).get(),
                                       lastValid));
  EXPECT_EQ(lastValid.second, 0);
  EXPECT_EQ(bits(last), bits(state(-3, 0, 0)));
}

TEST_P(MotionValidators, OnSuccessNothingIsTouched) {
  auto last = state(1.25, 2.5, 0.75);
  const auto before = bits(last);
  std::pair<ob::State*, double> lastValid{last.get(), 0.123};
  EXPECT_TRUE(validator().checkMotion(state(-3, 0).get(), state(-2, 1, 2).get(), lastValid));
  EXPECT_EQ(lastValid.first, last.get());
  EXPECT_EQ(lastValid.second, 0.123);
  EXPECT_EQ(bits(last), before);
  auto s2 = state(-2, 1, 2);
  lastValid.first = s2.get();
  EXPECT_TRUE(validator().checkMotion(state(-3, 0).get(), s2.get(), lastValid));
  EXPECT_EQ(bits(s2), bits(state(-2, 1, 2)));
}

TEST_P(MotionValidators, LastValidIsCloseToTheWallAndOnTheEdge) {
  auto last = state(1, 1);
  std::pair<ob::State*, double> lastValid{last.get(), -1};
  ASSERT_FALSE(validator().checkMotion(state(-3, 0).get(), state(3, 0).get(), lastValid));
  // The bar's tip meets the wall at x = −0.5005, t = 0.41658.
  EXPECT_LE(lastValid.second, 0.41659);
  EXPECT_GE(lastValid.second, 0.40);
  const Configuration at = configurationOf(*hall_.si, last.get());
  EXPECT_NEAR(at[0], -3 + 6 * lastValid.second, 1e-14);
  expectValid(hall_.at(-3, 0), last.get(), lastValid.second);
}

TEST_P(MotionValidators, LastValidMayBeNull) {
  std::pair<ob::State*, double> lastValid{nullptr, -1};
  EXPECT_FALSE(validator().checkMotion(state(-3, 0).get(), state(3, 0).get(), lastValid));
  EXPECT_EQ(lastValid.first, nullptr);
  EXPECT_GE(lastValid.second, 0.40);
  EXPECT_LE(lastValid.second, 0.41659);
}

TEST_P(MotionValidators, LastValidMayBeTheGoalOrTheStart) {
  auto expected = state(1, 1);
  std::pair<ob::State*, double> apart{expected.get(), -1};
  ASSERT_FALSE(validator().checkMotion(state(-3, 0, 0.1).get(), state(3, 1, 1).get(), apart));
  auto s2 = state(3, 1, 1);
  std::pair<ob::State*, double> asGoal{s2.get(), -1};
  EXPECT_FALSE(validator().checkMotion(state(-3, 0, 0.1).get(), s2.get(), asGoal));
  EXPECT_EQ(asGoal.second, apart.second);
  EXPECT_EQ(bits(s2), bits(expected));
  auto s1 = state(-3, 0, 0.1);
  std::pair<ob::State*, double> asStart{s1.get(), -1};
  EXPECT_FALSE(validator().checkMotion(s1.get(), state(3, 1, 1).get(), asStart));
  EXPECT_EQ(asStart.second, apart.second);
  EXPECT_EQ(bits(s1), bits(expected));
}

TEST_P(MotionValidators, BlockedAtTheStartGivesTheStart) {
  auto last = state(1, 1);
  std::pair<ob::State*, double> lastValid{last.get(), -1};
  EXPECT_FALSE(validator().checkMotion(state(-0.5006, 0).get(), state(3, 0).get(), lastValid));
  EXPECT_LT(lastValid.second, 0.001);
  expectValid(hall_.at(-0.5006, 0), last.get(), lastValid.second);
  if (lastValid.second == 0) {
    EXPECT_EQ(bits(last), bits(state(-0.5006, 0)));
  }
}

TEST_P(MotionValidators, RandomEdgesKeepTheContract) {
  std::mt19937_64 random(test::testSeed(2));
  std::uniform_real_distribution<double> u(-1, 1);
  int failed = 0;
  const int count = test::casesOf(200, 300);
  for (int i = 0; i < count; ++i) {
    const Configuration a = hall_.at(5 * u(random), 5 * u(random), 3 * u(random)),
                        b = hall_.at(5 * u(random), 5 * u(random), 3 * u(random));
    const auto s1 = hall_.scoped(a), s2 = hall_.scoped(b);
    if (!hall_.si->isValid(s1.get())) continue;
    auto last = state(1, 1);
    std::pair<ob::State*, double> lastValid{last.get(), -1};
    const bool free = validator().checkMotion(s1.get(), s2.get(), lastValid);
    EXPECT_EQ(free, validator().checkMotion(s1.get(), s2.get()));
    if (free) continue;
    ++failed;
    EXPECT_GE(lastValid.second, 0);
    EXPECT_LT(lastValid.second, 1);
    expectValid(a, last.get(), lastValid.second);
  }
  EXPECT_GT(failed, count / 10);
}

TEST_P(MotionValidators, ManyThreadsCountRightAndAgree) {
  constexpr int threads = 4, edges = 50;
  std::vector<std::thread> pool;
  std::vector<int> valid(threads, 0);
  for (int k = 0; k < threads; ++k)
    pool.emplace_back([&, k] {
      for (int i = 0; i < edges; ++i)
        valid[k] +=
            validator().checkMotion(state(-3, 0.05 * i).get(), state(3, 0.1 * i, 0.5).get());
    });
  for (std::thread& thread : pool) thread.join();
  for (int k = 1; k < threads; ++k) EXPECT_EQ(valid[k], valid[0]);
  EXPECT_EQ(validator().getCheckedMotionCount(), unsigned(threads * edges));
  if (GetParam().proves()) {
    EXPECT_EQ(hall_.checker.counters().edges, unsigned(threads * edges));
  }
}

TEST(DiscreteMotionValidator, StepsOverAThinWallAndCertifiedDoesNot) {
  const Hall hall(Rigid::SE3);
  hall.si->setStateValidityChecker(
      std::make_shared<ExactStateValidityChecker>(hall.si, hall.checker));
  hall.si->getStateSpace()->setLongestValidSegmentFraction(0.2);
  hall.si->setup();
  // Steps of 3.4 m with a bar of 1 m step over the wall.
  const DiscreteMotionValidator discrete(hall.si, hall.checker);
  const CertifiedMotionValidator certified(hall.si, hall.checker);
  const auto from = hall.scoped(hall.at(-1, 0)), to = hall.scoped(hall.at(2, 0));
  EXPECT_TRUE(discrete.checkMotion(from.get(), to.get()));
  EXPECT_FALSE(certified.checkMotion(from.get(), to.get()));
}

/// Returns the message of the exception that `make` throws.
template <class Make>
std::string complaintOf(const Make& make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no complaint";
}

/// Without the check, the validators would cast OMPL's states to those of another class.
TEST(CheckersForOmpl, RefuseOtherStateSpaces) {
  const Hall spatial(Rigid::SE3), planar(Rigid::SE2);
  const auto complaintsIn = [&](const ob::SpaceInformationPtr& si) {
    const Checker& checker = spatial.checker;
    const std::string complaint =
        complaintOf([&] { const CertifiedMotionValidator validator(si, checker); });
    EXPECT_EQ(complaintOf([&] { const DiscreteMotionValidator validator(si, checker); }),
              complaint);
    EXPECT_EQ(complaintOf([&] { const CertifiedStateValidityChecker validity(si, checker); }),
              complaint);
    EXPECT_EQ(complaintOf([&] { const ExactStateValidityChecker validity(si, checker); }),
              complaint);
    return complaint;
  };
  EXPECT_EQ(complaintsIn(spatial.si), "no complaint");
  const auto theirs = std::make_shared<ob::SE3StateSpace>();
  EXPECT_EQ(complaintsIn(std::make_shared<ob::SpaceInformation>(theirs)),
            "the state space of OMPL must be a ProblemStateSpace, made of the model's space");
  EXPECT_EQ(complaintsIn(planar.si),
            "the ProblemStateSpace has 3 numbers, but the checker's model has 7; make it of the "
            "space of the checker's model");
}

INSTANTIATE_TEST_SUITE_P(All, MotionValidators, testing::ValuesIn(kinds()), nameOf);

}  // namespace
}  // namespace corridor
