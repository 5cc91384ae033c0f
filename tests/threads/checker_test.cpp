// Tests of planner/ in several threads, which share one problem and one checker.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include "planner/benchmark/checking_tally.h"
#include "planner/checker/motion_validators.h"
#include "planner/checker/problem_goal.h"
#include "planner/checker/problem_state_space.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/problem/digest.h"
#include "planner/robot/edge_motion.h"
#include "planner/robot/urdf_file.h"
#include "planner/solve/verify_solution.h"
#include "tests/support/support.h"
#include "tests/threads/in_threads.h"
#include "tests/threads/own_problem.h"

namespace corridor {
namespace {

namespace ob = ompl::base;
using test::Answers;
using test::expectSameAnswersInAllThreads;
using test::inThreads;
using test::kThreads;
using test::ownProblem;

struct Edge {
  Configuration from, to;
};

/// Returns random edges that begin near the start or the goal, where states are often free. Half of
/// the edges are short, a quarter are longer, and a quarter end near the goal.
std::vector<Edge> someEdges(const Problem& problem, std::size_t count) {
  std::mt19937_64 random(71);
  std::normal_distribution<double> normal;
  const auto near = [&](const Configuration& q, double distance) {
    Configuration r = q;
    for (Eigen::Index i = 0; i < r.size(); ++i) r[i] += distance * normal(random);
    problem.model.space.normalise(r);
    return r;
  };
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < count; ++i) {
    const Configuration from = near(i % 3 ? startOf(problem) : goalsOf(problem)[0], 0.05);
    edges.push_back(
        {from, i % 4 == 3 ? near(goalsOf(problem)[0], 0.05) : near(from, i % 4 == 1 ? 0.3 : 0.02)});
  }
  return edges;
}

/// Adds a checker's answers for one edge and for the states at its ends.
void ask(const Checker& checker, const Edge& edge, Answers& answers) {
  answers.add(checker.certifyState(edge.from));
  answers.add(checker.certifyEdge(edge.from, edge.to));
  answers.add(checker.certifyEdge(edge.from, edge.to, {.earliest = true}));
  answers.addVerdict(checker.isProvedFree(edge.from, edge.to));
  answers.addVerdict(checker.interference(edge.to).has_value());
  answers.add(checker.clearance(edge.from));
  for (const Checker::PairNotFree& pair : checker.pairsNotFree(edge.to)) {
    answers.add(pair.a);
    answers.add(pair.b);
  }
}

class Threads : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Problems, Threads, testing::Values("thin_plate", "two_arms"),
                         [](const auto& parameter) { return std::string(parameter.param); });

/// All threads make the same queries in the same order. Their answers must agree to the last bit,
/// and the counters must include the queries of all threads.
TEST_P(Threads, CheckerInOneOrder) {
  for (const char* const volume : {"obb", "kdop18"}) {
    Problem problem = ownProblem(GetParam());
    problem.settings.checker.trees.volume = volume;
    const std::vector<Edge> edges = someEdges(problem, 10);
    const Checker shared(problem);
    expectSameAnswersInAllThreads([&] {
      Answers answers;
      for (const Edge& edge : edges) ask(shared, edge, answers);
      return answers;
    });
    const std::uint64_t rounds = kThreads + 1;
    EXPECT_EQ(shared.counters().edges, 3 * edges.size() * rounds);
    EXPECT_EQ(shared.counters().states, 4 * edges.size() * rounds);
  }
}

/// The threads make the same queries in different orders. So queries start from other pairs of
/// triangles, which the context stores (`LastPair`). The verdicts must not change.
TEST_P(Threads, CheckerInAnotherOrder) {
  const Problem problem = ownProblem(GetParam());
  const std::vector<Edge> edges = someEdges(problem, 60);
  const Checker alone(problem), shared(problem);
  std::vector<MotionVerdict> states, motions;
  for (const Edge& edge : edges) {
    states.push_back(alone.certifyState(edge.to).verdict);
    motions.push_back(alone.certifyEdge(edge.from, edge.to).verdict);
  }
  for (const MotionVerdict verdict : {MotionVerdict::free, MotionVerdict::contact})
    EXPECT_GT(std::count(motions.begin(), motions.end(), verdict), 3);
  inThreads([&](int k) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const std::size_t e = (i * 7 + static_cast<std::size_t>(k) * 31) % edges.size();
      ASSERT_EQ(shared.certifyEdge(edges[e].from, edges[e].to).verdict, motions[e]) << e;
      ASSERT_EQ(shared.certifyState(edges[e].to).verdict, states[e]) << e;
    }
  });
}

/// Certifies edges without a checker: the threads share a scene, and have an EdgeMotion and a
/// QueryContext each.
TEST_P(Threads, SceneAndEdgeMotions) {
  const Problem problem = ownProblem(GetParam());
  const std::vector<Edge> edges = someEdges(problem, 16);
  MotionOptions options;
  options.tolerance = 1e-5;
  const Scene scene = makeScene(problem.model, requiredBy(problem.task));
  const Answers answers = expectSameAnswersInAllThreads([&] {
    Answers mine;
    QueryContext context;
    EdgeMotion motion(problem.model.tree, problem.model.space, scene.framePairs(),
                      problem.task.tube);
    for (const Edge& edge : edges) {
      motion.set(edge.from, edge.to);
      for (const EdgeMethod method :
           {EdgeMethod::certified, EdgeMethod::adaptive, EdgeMethod::advancement})
        mine.add(scene.certify(motion, options, context, method));
    }
    mine.add(context.counters);
    return mine;
  });
  EXPECT_GT(answers.count(MotionVerdict::free), 3);
  EXPECT_GT(answers.count(MotionVerdict::contact), 2);
}

/// Tests the classes through which OMPL calls the checker, with three methods. `CheckingTally`,
/// which benchmarks use, counts the calls.
TEST_P(Threads, Validators) {
  for (const char* const method : {"certified", "adaptive", "discrete"}) {
    Problem problem = ownProblem(GetParam());
    problem.settings.checker.edges = edgeMethodNamed(method).value();
    const std::vector<Edge> edges = someEdges(problem, 16);
    const Checker checker(problem);
    const auto space = std::make_shared<ProblemStateSpace>(problem.model.space);
    const auto si = std::make_shared<ob::SpaceInformation>(space);
    std::shared_ptr<CountingMotionValidator> validator;
    if (std::string(method) == "discrete") {
      si->setStateValidityChecker(std::make_shared<ExactStateValidityChecker>(si, checker));
      validator = std::make_shared<DiscreteMotionValidator>(si, checker);
    } else {
      si->setStateValidityChecker(std::make_shared<CertifiedStateValidityChecker>(si, checker));
      validator = std::make_shared<CertifiedMotionValidator>(si, checker);
    }
    si->setMotionValidator(validator);
    CheckingTally tally;
    tallyChecks(si, tally);
    si->setup();
    const Answers answers = expectSameAnswersInAllThreads([&] {
      Answers mine;
      ob::ScopedState<> from(si), to(si), last(si);
      for (const Edge& edge : edges) {
        space->write(edge.from, from.get());
        space->write(edge.to, to.get());
        mine.addVerdict(si->isValid(from.get()));
        mine.addVerdict(si->checkMotion(from.get(), to.get()));
        std::pair<ob::State*, double> lastValid{last.get(), 1};
        mine.addVerdict(si->checkMotion(from.get(), to.get(), lastValid));
        mine.add(lastValid.second);
        if (lastValid.second < 1)
          for (const double number : space->read(last.get())) mine.add(number);
      }
      return mine;
    });
    EXPECT_GT(answers.count(true), 3);
    if (std::string(method) != "discrete") {  // samples may miss an obstacle
      EXPECT_GT(answers.count(false), 2);
    }
    const std::uint64_t motions = (kThreads + 1) * 2 * edges.size();
    EXPECT_EQ(validator->checkedMotions(), motions);
    EXPECT_EQ(si->getMotionValidator()->getCheckedMotionCount(), motions);
    EXPECT_EQ(tally.motions, motions);
    EXPECT_EQ(tally.states % (kThreads + 1), 0u);
  }
}

/// Threads verify the same edges at once. The verifier keeps no state between calls, so all reports
/// must agree.
TEST_P(Threads, Verifier) {
  const Problem problem = ownProblem(GetParam());
  const PathProblem plain = plainProblem(problem);
  const std::vector<Edge> edges = someEdges(problem, 6);
  expectSameAnswersInAllThreads([&] {
    Answers answers;
    for (const Edge& edge : edges) {
      const PathReport report = verifyPath(plain, {edge.from, edge.to});
      answers.addVerdict(report.verdict);
      answers.add(report.provedClearance);
      answers.add(report.closestFound);
      answers.add(report.distanceQueries);
    }
    return answers;
  });
}

/// All threads read the same files at once: problem, robots, URDF, SRDF, meshes.
TEST_P(Threads, ReadProblems) {
  std::array<std::string, kThreads> seen;
  inThreads([&](int k) {
    for (int i = 0; i < 3; ++i) {
      const Problem problem = ownProblem(GetParam());
      seen[k] += digestOf(problem);
      forEachTestedPair(problem.model, requiredBy(problem.task), [&](std::size_t a, std::size_t b) {
        seen[k] += " " + std::to_string(a) + "~" + std::to_string(b);
      });
    }
  });
  EXPECT_FALSE(seen[0].empty());
  for (const std::string& mine : seen) EXPECT_EQ(mine, seen[0]);
}

/// Each thread must get the faults of its own URDF only.
TEST(Threads, ReadFaultyRobots) {
  const std::filesystem::path folder = test::newFolder();
  const auto fileOf = [&](int k) { return folder / ("robot" + std::to_string(k) + ".urdf"); };
  const auto nameOf = [](int k) { return "\"link" + std::to_string(k) + "\""; };
  for (int k = 0; k < kThreads; ++k) {
    std::ofstream file(fileOf(k));
    file << "<robot name=\"r\">";
    for (int i = 0; i < 100; ++i)  // makes reading slow enough to overlap
      file << "<link name=\"sound" << i << "\"/><joint name=\"j" << i
           << "\" type=\"fixed\"><parent link=\"link" << k << "\"/><child link=\"sound" << i
           << "\"/></joint>";
    file << "<link name=\"link" << k << "\"><collision/></link></robot>";
  }
  inThreads([&](int k) {
    for (int i = 0; i < 10; ++i) {
      std::vector<Fault> faults;
      std::vector<std::filesystem::path> files;
      EXPECT_FALSE(readUrdf(fileOf(k), {}, faults, files));
      ASSERT_EQ(faults.size(), 1u);
      for (int other = 0; other < kThreads; ++other)
        ASSERT_EQ(faults[0].text.find(nameOf(other)) != std::string::npos, other == k)
            << faults[0].text;
    }
  });
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace corridor
