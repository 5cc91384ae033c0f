// Tests of whole campaigns: a run has the same figures as `solve`, a seed gives the same run again,
// a crash loses only one run, and the verifier refutes sampled paths through the thin plate.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <new>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "planner/benchmark/ompl_database.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/solve/solve.h"
#include "tests/planner/benchmark/hall_campaign.h"

namespace corridor {
namespace {

using test::hallProblem;
using test::Rigid;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Campaign campaignOf(const std::vector<std::string>& variants, std::uint64_t runs,
                    const std::vector<BenchmarkCompetitor>& competitors = {}) {
  Campaign campaign;
  campaign.problems = {hallProblem(Rigid::SE3)};
  for (const std::string& variant : variants)
    campaign.variants.push_back(readVariant(variant, competitors));
  campaign.runs = runs;
  identifyProblems(campaign);
  return campaign;
}

std::vector<CampaignPlanner> named(const std::vector<std::string>& names) {
  std::vector<CampaignPlanner> planners;
  for (const std::string& name : names) planners.push_back({name, name, {}});
  return planners;
}

std::string complaintOf(const Campaign& campaign) {
  try {
    checkCampaign(campaign);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

int countOf(const CampaignCell& cell, const std::string& verdict) {
  return static_cast<int>(
      std::count_if(cell.runs.begin(), cell.runs.end(),
                    [&](const BenchmarkRun& run) { return run.verdict == verdict; }));
}

/// Returns all columns except times.
std::vector<Row> repeatable(const Campaign& campaign, const CampaignResult& result) {
  std::vector<Row> rows = runRows(campaign, result.cells);
  for (Row& row : rows)
    std::erase_if(row, [](const auto& column) { return column.first.ends_with("_s"); });
  return rows;
}

TEST(Campaign, OnlySampledPathsPassThroughTheThinPlate) {
  Campaign campaign = campaignOf({"certified", "discrete:0.01"}, 3);
  campaign.problems = {
      readProblem(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems" / "thin_plate")};
  identifyProblems(campaign);
  campaign.time = 20.0 * test::kSlowdown;
  checkCampaign(campaign);
  const CampaignResult result = runCampaign(campaign);
  ASSERT_EQ(result.cells.size(), 2u);
  const CampaignCell &certified = result.cells[0], &discrete = result.cells[1];
  ASSERT_EQ(certified.runs.size(), 3u);
  ASSERT_EQ(discrete.runs.size(), 3u);
  EXPECT_EQ(countOf(certified, "proved"), 3);
  EXPECT_EQ(countOf(discrete, "refuted"), 3);
  for (const BenchmarkRun& run : certified.runs) {
    EXPECT_TRUE(run.solved && run.certified) << run.why;
    EXPECT_EQ(run.finding, "");
    EXPECT_GT(run.certificationTime, 0);
    EXPECT_GT(run.verificationTime, 0);
  }
  for (const BenchmarkRun& run : discrete.runs) {
    EXPECT_TRUE(run.solved && !run.certified) << run.why;
    EXPECT_THAT(run.finding, HasSubstr("contact: paper_plane and plate"));
  }
}

/// A run must have the same figures as `solve` with the same seed, including the number of box
/// tests.
TEST(Campaign, ARunEqualsASolve) {
  Campaign campaign = campaignOf({"certified", "discrete:0.02"}, 2);
  campaign.planners = named({"RRTConnect", "KPIECE1"});
  campaign.seed = 5;
  campaign.time = 20.0 * test::kSlowdown;
  const CampaignResult result = runCampaign(campaign);
  ASSERT_EQ(result.cells.size(), 4u);
  for (const CampaignCell& cell : result.cells) {
    ASSERT_EQ(cell.runs.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const BenchmarkRun& run = cell.runs[i];
      EXPECT_EQ(run.seed, 5 + i);
      const Problem planned = problemOfRun(campaign, cell, run.seed);
      const SolveReport report = solveProblem(planned);
      ASSERT_EQ(report.outcome, SolveOutcome::solved);
      EXPECT_TRUE(run.solved) << run.why << run.failure;
      EXPECT_EQ(run.certified, report.certified);
      EXPECT_EQ(run.pathStates, report.path.size());
      EXPECT_EQ(run.length.metres, report.length.metres);
      EXPECT_EQ(run.length.radians, report.length.radians);
      EXPECT_EQ(run.counters.states, report.counters.states);
      EXPECT_EQ(run.counters.edges, report.counters.edges);
      EXPECT_EQ(run.counters.boxTests, report.counters.boxTests);
      EXPECT_EQ(run.counters.primitiveTests, report.counters.primitiveTests);
      EXPECT_NEAR(run.time,
                  run.setUpTime + run.plannerTime + run.simplificationTime + run.certificationTime,
                  1e-9);
      EXPECT_EQ(run.counters.undecided, report.counters.undecided);
      EXPECT_GT(run.edges, 0u);
      EXPECT_GT(run.states, 0u);
      EXPECT_GT(run.checkingTime, 0);
      EXPECT_LT(run.checkingTime, run.time);
    }
  }
}

TEST(Campaign, TheSameSeedsGiveTheSameRows) {
  Campaign campaign = campaignOf({"certified", "discrete:0.2"}, 3);
  campaign.time = 20.0 * test::kSlowdown;
  campaign.problems[0].model.bodies[0].shapes[0] = shapeOf("box", test::boxMesh({0.1, 0.1, 0.1}));
  const CampaignResult first = runCampaign(campaign), second = runCampaign(campaign);
  const std::vector<Row> rows = repeatable(campaign, first);
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(csvOf(rows), csvOf(repeatable(campaign, second)));
  EXPECT_NE(first.cells[0].runs[0].length.metres, first.cells[0].runs[1].length.metres);
  EXPECT_EQ(countOf(first.cells[0], "proved"), 3);
  EXPECT_GT(countOf(first.cells[1], "refuted"), 0);
}

TEST(Campaign, ACrashLosesOnlyItsRun) {
  const BenchmarkCompetitor exact{"exact", [](const auto& si, const Checker& checker) {
                                    return std::make_shared<ExactStateValidityChecker>(si, checker);
                                  }};
  BenchmarkCompetitor peer = exact;
  peer.name = "shaky";
  peer.run = [&](const Problem& planned, double memory, Path& path) {
    if (planned.settings.seed == 2) std::raise(SIGKILL);
    if (planned.settings.seed == 3) throw std::bad_alloc();
    return runUnderOmpl(planned, "", exact, memory, path);
  };
  Campaign campaign = campaignOf({"shaky:0.02", "discrete:0.02"}, 4, {peer});
  campaign.time = 20.0 * test::kSlowdown;
  const CampaignResult result = runCampaign(campaign);
  const std::vector<BenchmarkRun>& runs = result.cells[0].runs;
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_TRUE(runs[0].solved);
  EXPECT_TRUE(runs[3].solved);
  EXPECT_EQ(runs[1].result, "failed");
  EXPECT_EQ(runs[1].failure, "killed by signal 9 (Killed)");
  EXPECT_EQ(runs[2].failure, "out of memory");
  // The competitor makes the same tests as `discrete`, but crashes in some runs. The crashes must
  // not affect the runs of `discrete`.
  for (const BenchmarkRun& run : result.cells[1].runs) EXPECT_TRUE(run.solved) << run.failure;
  EXPECT_EQ(runs[3].states, result.cells[1].runs[3].states);
  EXPECT_EQ(runs[3].edges, result.cells[1].runs[3].edges);
  EXPECT_EQ(runs[3].length.metres, result.cells[1].runs[3].length.metres);

  const std::filesystem::path folder = test::newFolder(), file = folder / "campaign.db";
  writeOmplDatabase(campaign, result, runsOf(result.cells), file);
  EXPECT_THAT(
      test::rowsOf(file,
                   "SELECT seed, solved, description, r.time IS NULL FROM runs r JOIN enums "
                   "ON value = status WHERE experimentid = 1"),
      ElementsAre("1|1|Exact solution|0", "2|0|Crash|1", "3|0|Crash|1", "4|1|Exact solution|0"));
  EXPECT_THAT(test::rowsOf(file, "SELECT edges FROM experiments"),
              ElementsAre("shaky", "discrete"));
  EXPECT_THAT(test::rowsOf(file, "SELECT count(DISTINCT plannerid) FROM runs"), ElementsAre("1"))
      << "runs that crashed have the planner of the others";
  std::filesystem::remove_all(folder);
}

/// After an exception in a planner, OMPL's Benchmark would continue as if the run had ended
/// normally.
TEST(Campaign, AnExceptionInAPlannerIsReported) {
  class Thrower : public ExactStateValidityChecker {
   public:
    using ExactStateValidityChecker::ExactStateValidityChecker;
    bool isValid(const ompl::base::State*) const override {
      throw std::runtime_error("the sky is falling");
    }
  };
  BenchmarkCompetitor competitor{"thrower", [](const auto& si, const Checker& checker) {
                                   return std::make_shared<Thrower>(si, checker);
                                 }};
  const Campaign campaign = campaignOf({"thrower"}, 1, {competitor});
  const CampaignResult result = runCampaign(campaign);
  EXPECT_EQ(result.cells[0].runs.at(0).result, "failed");
  EXPECT_EQ(result.cells[0].runs.at(0).failure, "the sky is falling");
}

TEST(Campaign, AnInterruptKeepsFinishedRuns) {
  Campaign campaign = campaignOf({"certified", "discrete:0.02"}, 50);
  std::atomic<bool> interrupted = false;
  CampaignOptions options;
  options.interrupted = &interrupted;
  std::vector<std::uint64_t> seeds;
  options.progress = [&](const CampaignProgress& p) {
    EXPECT_EQ(p.total, 100u);
    EXPECT_EQ(p.done, seeds.size());
    seeds.push_back(p.seed);
    if (seeds.size() == 4) interrupted = true;
  };
  const CampaignResult result = runCampaign(campaign, options);
  EXPECT_TRUE(result.interrupted);
  EXPECT_THAT(seeds, ElementsAre(1, 1, 2, 2));  // variants take turns
  EXPECT_EQ(result.cells[0].runs.size(), 2u);
  EXPECT_EQ(result.cells[1].runs.size(), 1u);
}

TEST(Campaign, ReportsAllFaultsBeforeTheFirstRun) {
  EXPECT_EQ(complaintOf(campaignOf({"certified", "discrete:0.1"}, 1)), "");
  EXPECT_EQ(complaintOf(campaignOf({"certified", "certified"}, 0)),
            "--variants: \"certified\" is named twice\n--runs: 1 or more are needed, not 0");
  EXPECT_EQ(complaintOf(campaignOf({}, 1)), "--variants: a variant is needed");
  Campaign campaign = campaignOf({"certified", "discrete:0.1"}, 1);
  campaign.planners = named({"RRTConnect", "RTT"});
  EXPECT_THAT(complaintOf(campaign),
              StartsWith("--planners: unknown planner \"RTT\" (did you mean \"RRT\"?); there are: "
                         "RRTConnect, "));
  EXPECT_THAT(complaintOf(campaign),
              testing::Not(HasSubstr("\n")));  // reported once, not for each variant
  campaign = campaignOf({"certified"}, 1);
  campaign.problems[0].task.start.head(3) = Vec3(-0.4, -2, 0);
  EXPECT_THAT(complaintOf(campaign), StartsWith("hall.yaml:4: start: in contact: \"bar\""));
  campaign = campaignOf({"certified"}, 1);
  campaign.problems[0].settings.planner.params = {{"rnge", "1"}};
  EXPECT_THAT(complaintOf(campaign), HasSubstr("RRTConnect has no parameter \"rnge\""));
  campaign.planners = named({"RRT"});  // the parameters belong to another planner and are dropped
  EXPECT_EQ(complaintOf(campaign), "");
}

TEST(Campaign, ProblemsWithTheSameNameGetDifferentNames) {
  Campaign campaign = campaignOf({"discrete:0.02"}, 1);
  campaign.problems.push_back(campaign.problems[0]);
  campaign.problems.push_back(campaign.problems[0]);
  identifyProblems(campaign);
  EXPECT_THAT(campaign.problemNames, ElementsAre("hall", "hall-2", "hall-3"));
}

/// A planner that occurs twice, with different labels and parameters, counts as two planners.
TEST(Campaign, PlannersHaveLabelsAndParameters) {
  Campaign campaign = campaignOf({"certified"}, 1);
  campaign.problems[0].settings.planner.params = {{"range", "0.5"}};
  campaign.planners = {{"RRTConnect", "RRTConnect", {}},
                       {"short", "RRTConnect", {{{"range", "0.05"}}}},
                       {"default", "RRTConnect", std::map<std::string, std::string>{}}};
  campaign.time = 20.0 * test::kSlowdown;
  EXPECT_EQ(complaintOf(campaign), "");
  const CampaignResult result = runCampaign(campaign);
  ASSERT_EQ(result.cells.size(), 3u);
  const auto range = [&](std::size_t i) {
    return result.cells[i].runs.at(0).ompl->settings.at("range");
  };
  EXPECT_EQ(range(0), "0.5");
  EXPECT_EQ(range(1), "0.05");
  EXPECT_NE(range(2), "0.5");
  EXPECT_GT(result.cells[1].runs[0].edges, result.cells[0].runs[0].edges);
  const std::filesystem::path folder = test::newFolder(), file = folder / "campaign.db";
  writeOmplDatabase(campaign, result, runsOf(result.cells), file);
  EXPECT_THAT(test::rowsOf(file, "SELECT name FROM plannerConfigs"),
              ElementsAre("geometric_RRTConnect", "short", "default"));
  std::filesystem::remove_all(folder);
  campaign.planners[2].label = "short";
  EXPECT_EQ(complaintOf(campaign), "--planners: \"short\" is named twice");
}

/// If several runs are made at a time, the rows and their order must be the same as with one run at
/// a time.
TEST(Campaign, ParallelJobsGiveTheSameRows) {
  Campaign campaign = campaignOf({"certified", "discrete:0.2"}, 5);
  campaign.time = 20.0 * test::kSlowdown;
  CampaignOptions options;
  options.jobs = 3;
  std::size_t done = 0;
  options.done = [&](std::size_t cell, const BenchmarkRun& run) {
    EXPECT_LT(cell, 2u);
    EXPECT_TRUE(run.solved) << run.why << run.failure;
    ++done;
  };
  const CampaignResult many = runCampaign(campaign, options);
  EXPECT_EQ(done, 10u);
  EXPECT_FALSE(many.interrupted);
  EXPECT_EQ(csvOf(repeatable(campaign, many)), csvOf(repeatable(campaign, runCampaign(campaign))));
}

TEST(Campaign, StoredRunsAreNotRepeated) {
  Campaign campaign = campaignOf({"certified", "discrete:0.2"}, 3);
  campaign.time = 20.0 * test::kSlowdown;
  std::vector<CampaignCell> cells = cellsOf(campaign);
  BenchmarkRun known;
  known.seed = 2;
  known.why = "it was there";
  cells[1].runs = {known};
  CampaignOptions options;
  std::vector<std::pair<std::size_t, std::uint64_t>> ran;
  options.done = [&](std::size_t cell, const BenchmarkRun& run) {
    ran.emplace_back(cell, run.seed);
  };
  const CampaignResult result = runCampaign(campaign, options, cells);
  EXPECT_THAT(ran, ElementsAre(std::pair(0, 1), std::pair(1, 1), std::pair(0, 2), std::pair(0, 3),
                               std::pair(1, 3)));
  ASSERT_EQ(result.cells[1].runs.size(), 3u);
  EXPECT_EQ(result.cells[1].runs[1].why, "it was there");
}

TEST(Campaign, WithoutVerifierNoVerdicts) {
  Campaign campaign = campaignOf({"discrete:0.2"}, 2);
  campaign.verify = false;
  const CampaignResult result = runCampaign(campaign);
  for (const BenchmarkRun& run : result.cells[0].runs) {
    EXPECT_TRUE(run.solved);
    EXPECT_EQ(run.verdict, "");
  }
  EXPECT_THAT(csvOf(summaryRows(campaign, result.cells)), HasSubstr(",2,0,2,0,0,0,0,"));
}

}  // namespace
}  // namespace corridor
