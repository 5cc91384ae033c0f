// Tests of OMPL's planners that have threads, with Corridor's checker. Every verdict that a planner
// gets on a state or motion must equal that of a new checker in one thread, and the verifier must
// prove the path that the planner returns.
#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <ompl/base/SpaceInformation.h>

#include "planner/checker/motion_validators.h"
#include "planner/checker/problem_state_space.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/solve/solve.h"
#include "planner/solve/verify_solution.h"
#include "tests/threads/own_problem.h"

namespace corridor {
namespace {

namespace ob = ompl::base;
using test::ownProblem;

/// A recorded query of a state, and its answer.
struct AskedState {
  Configuration q;
  bool valid;
};
/// A recorded query of a motion, and its answer.
struct AskedMotion {
  Configuration from, to;
  bool valid;
};

/// Records the queries of planners, in one log per thread. So recording takes a lock only once per
/// thread, to add its log. A lock at every query would order the threads' accesses, and hide data
/// races.
class Recorder {
 public:
  struct Log {
    std::vector<AskedState> states;
    std::vector<AskedMotion> motions;
  };

  Log& mine() const {
    thread_local std::uint64_t owner = 0;
    thread_local Log* log = nullptr;
    if (owner != number_) {
      const std::lock_guard lock(mutex_);
      logs_.push_back(std::make_unique<Log>());
      log = logs_.back().get();
      owner = number_;
    }
    return *log;
  }
  /// @pre the threads that recorded queries have ended.
  const std::vector<std::unique_ptr<Log>>& logs() const { return logs_; }

 private:
  static std::uint64_t next() {
    static std::atomic<std::uint64_t> count = 0;
    return ++count;
  }
  const std::uint64_t number_ = next();
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Log>> logs_;
};

class RecordedStates final : public ob::StateValidityChecker {
 public:
  RecordedStates(const ob::SpaceInformationPtr& si, const Recorder& recorder)
      : StateValidityChecker(si), inner_(si->getStateValidityChecker()), recorder_(recorder) {
    specs_ = inner_->getSpecs();
  }
  bool isValid(const ob::State* state) const override {
    const bool valid = inner_->isValid(state);
    recorder_.mine().states.push_back({configurationOf(*si_, state), valid});
    return valid;
  }
  double clearance(const ob::State* state) const override { return inner_->clearance(state); }

 private:
  ob::StateValidityCheckerPtr inner_;
  const Recorder& recorder_;
};

class RecordedMotions final : public ob::MotionValidator {
 public:
  RecordedMotions(const ob::SpaceInformationPtr& si, const Recorder& recorder)
      : MotionValidator(si), inner_(si->getMotionValidator()), recorder_(recorder) {}
  bool checkMotion(const ob::State* s1, const ob::State* s2) const override {
    return record(s1, s2, inner_->checkMotion(s1, s2));
  }
  bool checkMotion(const ob::State* s1, const ob::State* s2,
                   std::pair<ob::State*, double>& lastValid) const override {
    const Configuration from = configurationOf(*si_, s1), to = configurationOf(*si_, s2);
    const bool valid = inner_->checkMotion(s1, s2, lastValid);
    recorder_.mine().motions.push_back({from, to, valid});
    return valid;
  }
  std::uint64_t checkedMotions() const {
    return dynamic_cast<const CountingMotionValidator&>(*inner_).checkedMotions();
  }

 private:
  bool record(const ob::State* s1, const ob::State* s2, bool valid) const {
    recorder_.mine().motions.push_back(
        {configurationOf(*si_, s1), configurationOf(*si_, s2), valid});
    return valid;
  }

  ob::MotionValidatorPtr inner_;
  const Recorder& recorder_;
};

struct Case {
  std::string planner, problem;
  bool severalThreadsQuery = true;  ///< false: one thread makes queries, another only waits
  bool finds = true;  ///< if false, a path takes too long to find, so some queries are enough
};
std::ostream& operator<<(std::ostream& out, const Case& one) {
  return out << one.planner << " on " << one.problem;
}

Problem problemOf(const Case& one) {
  Problem problem = ownProblem(one.problem);
  problem.settings.planner = {};
  problem.settings.planner.name = one.planner;
  problem.settings.planner.time = 1;
  if (one.planner == "CForest") problem.settings.planner.params["num_threads"] = "4";
  if (one.planner == "AnytimePathShortening") {
    problem.settings.planner.params["planners"] = "RRTConnect,RRTConnect,EST,RRTConnect";
  }
  return problem;
}

/// A run of a planner, and all data of the run that are compared afterwards.
struct Recording {
  Recorder recorder;
  std::shared_ptr<RecordedMotions> motions;
  SolveReport report;

  void solve(const Problem& problem, SolveOptions options = {}) {
    options.adaptChecking = [&](const ob::SpaceInformationPtr& si, const Checker&) {
      si->setStateValidityChecker(std::make_shared<RecordedStates>(si, recorder));
      motions = std::make_shared<RecordedMotions>(si, recorder);
      si->setMotionValidator(motions);
    };
    report = solveProblem(problem, options);
  }
};

/// Repeats the recorded queries with a new checker in one thread, and expects the same verdicts.
/// @returns the number of recorded queries of motions.
std::size_t expectTheSameOfOneThread(const Problem& problem, const Recorder& recorder) {
  const Checker checker(problem);
  std::size_t asked = 0, wrong = 0;
  for (const auto& log : recorder.logs()) {
    for (const AskedState& state : log->states)
      wrong += checker.isProvedFree(state.q) != state.valid;
    for (const AskedMotion& motion : log->motions) {
      const bool valid = checker.inBounds(motion.to) &&
                         checker.certifyEdge(motion.from, motion.to).verdict == MotionVerdict::free;
      wrong += valid != motion.valid;
    }
    asked += log->motions.size();
  }
  EXPECT_EQ(wrong, 0u) << "verdicts that differ from one thread's";
  return asked;
}

class PlannersWithThreads : public testing::TestWithParam<Case> {};

TEST_P(PlannersWithThreads, VerdictsAreThoseOfOneThread) {
  Problem problem = problemOf(GetParam());
  // On a slow or busy machine the planner may not do enough in its time. Then it is run again with
  // twice the time.
  std::optional<Recording> run;
  const auto done = [&] {
    return GetParam().finds ? run->report.outcome == SolveOutcome::solved
                            : run->motions->checkedMotions() > 20;
  };
  do {
    problem.settings.planner.time *= 2;
    run.emplace();
    run->solve(problem);
  } while (!done() && problem.settings.planner.time < 200);
  if (run->report.outcome == SolveOutcome::solved) {
    EXPECT_TRUE(run->report.certified);
    EXPECT_EQ(verifySolution(problem, makeSolution(problem, run->report)).verdict,
              PathVerdict::proved);
  } else {
    EXPECT_FALSE(GetParam().finds) << run->report.why;
  }
  if (GetParam().severalThreadsQuery) {
    EXPECT_GT(run->recorder.logs().size(), 1u) << "only one thread made queries";
  }
  const std::size_t asked = expectTheSameOfOneThread(problem, run->recorder);
  EXPECT_GT(asked, 20u);
  EXPECT_EQ(run->motions->checkedMotions(), asked)
      << "the validator counted another number of motions than were recorded";
}

INSTANTIATE_TEST_SUITE_P(
    All, PlannersWithThreads,
    testing::Values(Case{"CForest", "thin_plate"}, Case{"CForest", "two_arms", true, false},
                    Case{"AnytimePathShortening", "thin_plate"},
                    Case{"AnytimePathShortening", "two_arms"}, Case{"PRM", "thin_plate", false},
                    Case{"PRMstar", "two_arms", false, false}, Case{"SPARS", "thin_plate", false},
                    Case{"SPARStwo", "thin_plate", false}),
    [](const auto& parameter) { return parameter.param.planner + "_" + parameter.param.problem; });

/// The planner's threads report progress, never two at once, and another thread may interrupt them.
TEST(Planners, ProgressAndInterrupt) {
  for (const char* const planner : {"CForest", "AnytimePathShortening"}) {
    Problem problem = problemOf({planner, "two_arms"});
    problem.settings.planner.time = 300;
    std::atomic<bool> interrupted = false, progressed = false;
    std::vector<SolveProgress> progress;  // without a lock: calls never overlap
    SolveOptions options;
    options.interrupted = &interrupted;
    options.progress = [&](const SolveProgress& now) {
      progress.push_back(now);
      progressed = progress.size() > 3;
    };
    std::jthread interrupts([&] {
      while (!progressed) std::this_thread::yield();
      interrupted = true;
    });
    Recording run;
    run.solve(problem, options);
    progressed = true;
    EXPECT_EQ(run.report.outcome, SolveOutcome::interrupted) << planner;
    EXPECT_GT(progress.size(), 3u);
    for (std::size_t i = 1; i < progress.size(); ++i)
      EXPECT_GE(progress[i].edges, progress[i - 1].edges);
    expectTheSameOfOneThread(problem, run.recorder);
  }
}

}  // namespace
}  // namespace corridor
