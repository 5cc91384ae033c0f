// Tests of replays of recorded answers: the second run repeats the first one from recorded answers
// instead of tests, and any difference between the two runs is reported.
#include "tests/benchmark/replay.h"

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>

#include "planner/benchmark/run_campaign.h"
#include "planner/checker/problem_goal.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using bench::replayPeer;
using bench::Transcript;

CampaignResult resultOf(const std::string& planner, const std::vector<std::string>& variants) {
  Campaign campaign;
  campaign.problems = {test::hallProblem(test::Rigid::SE3)};
  for (const std::string& variant : variants)
    campaign.variants.push_back(readVariant(variant, {replayPeer()}));
  campaign.planners = {{planner, planner, {}}};
  identifyProblems(campaign);
  campaign.runs = 2;
  campaign.time = 20.0 * test::kSlowdown;
  return runCampaign(campaign);
}

TEST(Replay, RepeatsTheRunWithoutItsTests) {
  for (const char* planner : {"RRTConnect", "KPIECE1", "SBL"}) {  // KPIECE1 also queries lastValid
    const CampaignResult result = resultOf(planner, {"certified", "replay"});
    for (std::size_t i = 0; i < 2; ++i) {
      const BenchmarkRun &real = result.cells[0].runs[i], &replay = result.cells[1].runs[i];
      ASSERT_EQ(replay.failure, "") << planner;
      ASSERT_TRUE(real.solved && replay.solved && replay.certified) << planner;
      EXPECT_EQ(replay.verdict, "proved");
      EXPECT_EQ(replay.states, real.states);
      EXPECT_EQ(replay.edges, real.edges);
      EXPECT_EQ(replay.pathStates, real.pathStates);
      EXPECT_EQ(replay.length.metres, real.length.metres);
      // In a replay, the checker makes only the tests of start, goals and the final certification.
      EXPECT_LT(replay.counters.edges, real.counters.edges) << planner;
    }
  }
}

TEST(Replay, RefusesWhatDoesNotRepeat) {
  const CampaignResult result = resultOf("CForest", {"replay"});
  EXPECT_EQ(result.cells[0].runs[0].failure, "replay: CForest doesn't repeat");
}

TEST(Replay, ReportsADifferentQuery) {
  const Problem problem = test::hallProblem(test::Rigid::SE3);
  const auto space = std::make_shared<ProblemStateSpace>(problem.model.space);
  const auto si = std::make_shared<ompl::base::SpaceInformation>(space);
  ompl::base::ScopedState<> a(space), b(space);
  Configuration q = startOf(problem);
  space->write(q, a.get());
  q[0] = std::nextafter(q[0], 9);
  space->write(q, b.get());

  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  Transcript recording;
  recording.question(Transcript::Ask::state, *si, a.get());
  EXPECT_TRUE(recording.answer<bool>([] { return true; }));
  recording.write(file.get());

  const auto ask = [&](Transcript::Ask kind, const ompl::base::ScopedState<>& state) {
    Transcript replay = Transcript::read(file.get());
    EXPECT_FALSE(replay.done());
    replay.question(kind, *si, state.get());
    EXPECT_TRUE(replay.answer<bool>([] { return false; }));  // the recorded answer, not the new one
    EXPECT_TRUE(replay.done());
    replay.question(kind, *si, state.get());  // one query more than recorded
  };
  const auto summaryOf = [&](Transcript::Ask kind, const ompl::base::ScopedState<>& state) {
    try {
      ask(kind, state);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(summaryOf(Transcript::Ask::state, a),
            "replay: question 2 differs from the recorded one");
  EXPECT_EQ(summaryOf(Transcript::Ask::clearance, a),
            "replay: question 1 differs from the recorded one");
  EXPECT_EQ(summaryOf(Transcript::Ask::state, b),  // q differs in one bit
            "replay: question 1 differs from the recorded one");
}

}  // namespace
}  // namespace corridor
