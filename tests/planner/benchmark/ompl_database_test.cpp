// Tests of the database for Planner Arena: it equals the database that OMPL's own script makes of
// logs by OMPL's own writer, and it replaces no file that this program has not written.
#include "planner/benchmark/ompl_database.h"

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sys/resource.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/tools/benchmark/Benchmark.h>

#include "collision/core/error.h"
#include "collision/core/shortest.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/jobs/child_process.h"
#include "tests/planner/benchmark/hall_campaign.h"

namespace corridor {
namespace {

using test::hallCampaign;
using test::rowsOf;
using testing::ElementsAre;
using testing::HasSubstr;

class OmplDatabase : public testing::Test {
 protected:
  ~OmplDatabase() override { std::filesystem::remove_all(folder_); }

  void write(const Campaign& campaign, const CampaignResult& result) const {
    writeOmplDatabase(campaign, result, runsOf(result.cells), file_);
  }

  std::filesystem::path folder_ = test::newFolder(), file_ = folder_ / "campaign.db";
};

/// Returns the properties that a run of this campaign has in OMPL's log.
std::map<std::string, std::string> propertiesOf(const Campaign& campaign, const CampaignCell& cell,
                                                const BenchmarkRun& run) {
  std::map<std::string, std::string> properties = run.ompl->properties;
  for (const auto& [name, value] : runRow(campaign, cell, run)) {
    if (const auto* yes = std::get_if<bool>(&value))
      properties[name + " BOOLEAN"] = *yes ? "1" : "0";
    if (const auto* count = std::get_if<std::uint64_t>(&value); count && name != "seed")
      properties[name + " INTEGER"] = std::to_string(*count);
    if (const auto* number = std::get_if<double>(&value))
      properties[name + " REAL"] = shortest(*number);
    if (name == "verdict")
      for (const char* is : {"proved", "refuted", "undecided"})
        properties[is + std::string(" BOOLEAN")] = value == RowValue{is} ? "1" : "0";
  }
  properties["seed INTEGER"] = std::to_string(run.seed);
  return properties;
}

/// Writes the log of a variant by OMPL's own writer, which needs all runs at once.
void logByOmpl(const Campaign& campaign, const CampaignResult& result, std::size_t variant,
               const std::filesystem::path& file) {
  struct Writer final : ompl::tools::Benchmark {
    using Benchmark::Benchmark;
    using Benchmark::exp_;
  };
  ompl::geometric::SimpleSetup none(std::make_shared<ompl::base::RealVectorStateSpace>(1));
  Writer writer(none);
  auto& experiment = writer.exp_;
  experiment.name = "hall/" + campaign.variants[variant].name;
  experiment.maxTime = *campaign.time;
  experiment.maxMem = campaign.limits.memory;
  experiment.runCount = static_cast<unsigned>(campaign.runs);
  experiment.startTime = result.start;
  experiment.seed = static_cast<std::uint_fast32_t>(campaign.seed);
  writer.addExperimentParameter("edges", "TEXT", variant == 0 ? "certified" : "discrete");
  if (variant == 1) writer.addExperimentParameter("resolution", "REAL", "0.2");
  for (const CampaignCell& cell : result.cells) {
    if (cell.variant != variant) continue;
    const OmplRecord& record = *cell.runs[0].ompl;
    ompl::tools::Benchmark::PlannerExperiment planner;
    for (const BenchmarkRun& run : cell.runs) {
      planner.runs.push_back(propertiesOf(campaign, cell, run));
      if (!record.progressNames.empty()) planner.runsProgressData.push_back(run.ompl->progress);
    }
    planner.name = cell.planner.label == "star" ? "star" : record.planner;
    planner.common = record.settings;
    planner.progressPropertyNames = record.progressNames;
    experiment.planners.push_back(planner);
    // A log has the text on the problem once, and then the texts on all planners.
    const std::string begin = "Properties of benchmarked planners:\n";
    const std::string& setup = record.setup;
    experiment.setupInfo +=
        experiment.setupInfo.empty() ? setup : setup.substr(setup.find(begin) + begin.size());
    experiment.host = record.host;
    experiment.cpuInfo = record.cpu;
  }
  std::ostringstream text;
  writer.saveResultsToStream(text);
  const std::string all = text.str();
  // Debian's OMPL 1.5.2 writes no version.
  std::ofstream(file) << "OMPL version " + versionOfOmpl() << all.substr(all.find('\n'));
}

/// The tables and rows must equal those that OMPL's script makes, except for times and dates of
/// whole experiments.
TEST_F(OmplDatabase, EqualsThatOfOmplsScript) {
  if (std::system("command -v ompl_benchmark_statistics >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "ompl_benchmark_statistics is needed (Debian's ompl-demos)";
  Campaign campaign = hallCampaign({"certified", "discrete:0.2"});
  campaign.planners = {{"RRTConnect", "RRTConnect", {}}, {"star", "RRTstar", {}}};
  const CampaignResult result = runCampaign(campaign);
  write(campaign, result);
  std::string logs;
  for (std::size_t v = 0; v < 2; ++v) {
    const std::filesystem::path log = folder_ / (std::to_string(v) + ".log");
    logByOmpl(campaign, result, v, log);
    logs += " '" + log.string() + "'";
  }
  const std::filesystem::path theirs = folder_ / "theirs.db";
  ASSERT_EQ(std::system(("ompl_benchmark_statistics" + logs + " -d '" + theirs.string() +
                         "' >/dev/null 2>&1")
                            .c_str()),
            0);
  const auto expectSame = [&](const std::string& sql) {
    const std::vector<std::string> rows = rowsOf(file_, sql);
    EXPECT_FALSE(rows.empty()) << sql;
    EXPECT_EQ(rows, rowsOf(theirs, sql)) << sql;
  };
  EXPECT_EQ(rowsOf(file_, "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name"),
            rowsOf(theirs, "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name"));
  for (const char* table : {"experiments", "plannerConfigs", "enums", "runs", "progress"})
    expectSame(std::string("SELECT name, type FROM pragma_table_info('") + table +
               "') ORDER BY name");
  expectSame(
      "SELECT name, timelimit, memorylimit, runcount, version, hostname, cpuinfo, seed, setup, "
      "edges, resolution FROM experiments ORDER BY name");
  expectSame("SELECT name, settings FROM plannerConfigs ORDER BY name, settings");
  expectSame("SELECT * FROM enums ORDER BY name, value");
  std::string columns;
  for (const std::string& column :
       rowsOf(theirs, "SELECT name FROM pragma_table_info('runs') ORDER BY name"))
    if (column != "id" && column != "experimentid" && column != "plannerid")
      columns += ", r.\"" + column + "\", typeof(r.\"" + column + "\")";
  const std::string joined =
      " FROM runs r JOIN experiments e ON e.id = r.experimentid JOIN plannerConfigs p ON p.id = "
      "r.plannerid ";
  expectSame("SELECT e.name, p.name, r.seed" + columns + joined + "ORDER BY 1, 2, 3");
  expectSame("SELECT e.name, p.name, r.seed, g.time, g.best_cost, typeof(g.best_cost)" + joined +
             "JOIN progress g ON g.runid = r.id ORDER BY 1, 2, 3, 4");
}

TEST_F(OmplDatabase, HasOmplsColumnsAndOurs) {
  Campaign campaign = hallCampaign({"certified", "discrete:0.2"});
  campaign.problems[0].source.name = "a hall";
  identifyProblems(campaign);
  campaign.planners = {{"RRTConnect", "RRTConnect", {}}, {"RRTstar", "RRTstar", {}}};
  const CampaignResult result = runCampaign(campaign);
  write(campaign, result);
  EXPECT_THAT(
      rowsOf(file_, "SELECT name, edges, resolution, seed, runcount FROM experiments"),
      ElementsAre("a_hall/certified|certified||1|2", "a_hall/discrete:0.2|discrete|0.2|1|2"));
  for (const std::string& setup : rowsOf(file_, "SELECT setup FROM experiments")) {
    EXPECT_THAT(setup, HasSubstr("Problem hall.yaml\n"));
    EXPECT_THAT(setup, HasSubstr("Planner RRTConnect specs:"));
    EXPECT_THAT(setup, HasSubstr("Planner RRTstar specs:"));
  }
  EXPECT_THAT(rowsOf(file_, "SELECT DISTINCT name FROM plannerConfigs"),
              ElementsAre("geometric_RRTConnect", "geometric_RRTstar"));
  EXPECT_THAT(rowsOf(file_,
                     "SELECT DISTINCT p.name FROM progress JOIN runs r ON r.id = runid JOIN "
                     "plannerConfigs p ON p.id = plannerid"),
              ElementsAre("geometric_RRTstar"));
  for (const CampaignCell& cell : result.cells)
    for (const BenchmarkRun& run : cell.runs) {
      ASSERT_TRUE(run.solved) << run.why << run.failure;
      const std::vector<std::string> rows = rowsOf(
          file_, "SELECT solved, certified, proved, refuted, box_tests, description, r.time > " +
                     // OMPL's time excludes only the set-up, and is written with six digits.
                     shortest(0.999 * (run.time - run.setUpTime)) +
                     " FROM runs r JOIN experiments e ON e.id = experimentid JOIN plannerConfigs p "
                     "ON p.id "
                     "= plannerid JOIN enums ON value = status WHERE r.seed = " +
                     std::to_string(run.seed) + " AND p.name = 'geometric_" + cell.planner.name +
                     "' AND e.edges = '" + (cell.variant == 0 ? "certified'" : "discrete'"));
      EXPECT_THAT(rows, ElementsAre(std::string("1|") + (run.certified ? "1" : "0") + "|" +
                                    (run.verdict == "proved" ? "1|0|" : "0|1|") +
                                    std::to_string(run.counters.boxTests) + "|Exact solution|1"));
    }
}

/// OMPL's readers turn "one pct" and "one_pct" into the same name. But these are two variants.
TEST_F(OmplDatabase, VariantsWithSimilarNamesStayApart) {
  Campaign campaign = hallCampaign({"discrete:0.1", "certified"});
  campaign.variants[0].name = "one pct";
  campaign.variants[1].name = "one_pct";
  campaign.runs = 1;
  write(campaign, runCampaign(campaign));
  EXPECT_THAT(rowsOf(file_, "SELECT name, edges FROM experiments ORDER BY id"),
              ElementsAre("hall/one_pct|discrete", "hall/one_pct-2|certified"));
  EXPECT_THAT(rowsOf(file_, "SELECT experimentid FROM runs ORDER BY id"), ElementsAre("1", "2"));
}

TEST_F(OmplDatabase, ReplacesOnlyDatabasesOfThisVersion) {
  EXPECT_EQ(whyNotReplaced(file_), "");
  std::ofstream(file_) << "";
  EXPECT_EQ(whyNotReplaced(file_), "");
  std::ofstream(file_) << "This is no database, but a text that is long enough to be taken for one "
                          "by its size, which is more than a hundred bytes.\n";
  EXPECT_EQ(whyNotReplaced(file_), "is not a campaign database");
  std::filesystem::remove(file_);
  const auto change = [&](const char* sql) {
    SQLite::Database(file_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec(sql);
  };
  change("CREATE TABLE runs (id INTEGER)");
  EXPECT_EQ(whyNotReplaced(file_), "is not a campaign database");
  std::filesystem::remove(file_);
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  write(campaign, {cellsOf(campaign), false, {}, 0});
  EXPECT_EQ(whyNotReplaced(file_), "");
  change("CREATE TABLE corridor_runs (id INTEGER); PRAGMA user_version = 3");
  EXPECT_EQ(whyNotReplaced(file_),
            "is of an older version of Corridor; continue or merge it with commit b384c05c or "
            "earlier");
}

/// A fault while the database is written leaves the database that was there before.
TEST_F(OmplDatabase, AFullDisk) {
  std::ofstream(file_) << "before";
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  CampaignResult result{cellsOf(campaign), false, {}, 0};
  BenchmarkRun run;
  run.result = "solved";
  for (run.seed = 1; run.seed <= 10'000; ++run.seed) result.cells[0].runs.push_back(run);
  const ChildEnd end = inChild(
      [&](const auto& send) {  // a limit on file sizes stands in for a full disk
        rlimit limit{200'000, 200'000};
        setrlimit(RLIMIT_FSIZE, &limit);
        signal(SIGXFSZ, SIG_IGN);
        try {
          write(campaign, result);
        } catch (const InputError& error) {
          send(error.what());
        }
      },
      {{600}, 0});
  ASSERT_EQ(end.messages.size(), 1u) << end.failure;
  EXPECT_EQ(end.messages[0], file_.string() +
                                 ": can't be written: disk I/O error (does ulimit -f limit the "
                                 "size of files?)");
  EXPECT_EQ(test::contents(file_), "before");
  EXPECT_FALSE(std::filesystem::exists(file_.string() + ".part"));
}

}  // namespace
}  // namespace corridor
