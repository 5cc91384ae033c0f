// Tests of a campaign's database: it returns the runs that were stored, equals the database that
// OMPL's own script makes from OMPL's logs, and reports campaigns and files that it can't accept.
#include "planner/benchmark/campaign_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <sys/resource.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "planner/benchmark/build_commit.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/benchmark/run_record.h"
#include "planner/benchmark/write_reports.h"
#include "planner/jobs/child_process.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Mode = CampaignDatabase::Mode;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Campaign hallCampaign(const std::vector<std::string>& variants) {
  Campaign campaign;
  campaign.problems = {test::hallProblem(test::Rigid::SE3)};
  campaign.problems[0].model.bodies[0].shapes[0] = shapeOf("box", test::boxMesh({0.1, 0.1, 0.1}));
  for (const std::string& variant : variants) campaign.variants.push_back(readVariant(variant));
  campaign.runs = 2;
  campaign.time = 2.0 * test::kSlowdown;
  identifyProblems(campaign);
  return campaign;
}

class Database : public testing::Test {
 protected:
  ~Database() override { std::filesystem::remove_all(folder_); }

  CampaignResult runInto(const Campaign& campaign) const {
    std::vector<CampaignCell> cells = cellsOf(campaign);
    CampaignDatabase database(file_, Mode::resume, campaign, cells);
    CampaignOptions options;
    options.done = [&](std::size_t cell, const BenchmarkRun& run) { database.add(cell, run); };
    return runCampaign(campaign, options, cells);
  }
  std::string complaint(Mode mode, const Campaign& campaign) const {
    std::vector<CampaignCell> cells = cellsOf(campaign);
    try {
      CampaignDatabase(file_, mode, campaign, cells);
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind(file_.string() + ": ", 0), 0u) << text;
      return text.substr(file_.string().size() + 2);
    }
    return "";
  }

  std::filesystem::path folder_ = test::newFolder(), file_ = folder_ / "campaign.db";
};

/// Returns all rows of a query, as text.
std::vector<std::string> rowsOf(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database base(file.string());
  SQLite::Statement query(base, sql);
  std::vector<std::string> rows;
  while (query.executeStep()) {
    std::string row;
    for (int i = 0; i < query.getColumnCount(); ++i)
      row += (i ? "|" : "") + std::string(query.getColumn(i).getText());
    rows.push_back(row);
  }
  return rows;
}

/// OMPL's readers turn "one pct" and "one_pct" into the same name. But these are two variants.
TEST_F(Database, VariantsWithSimilarNamesStayApart) {
  Campaign campaign = hallCampaign({"discrete:0.1", "certified"});
  campaign.variants[0].name = "one pct";
  campaign.variants[1].name = "one_pct";
  campaign.runs = 1;
  runInto(campaign);
  EXPECT_THAT(rowsOf(file_, "SELECT name, edges FROM experiments ORDER BY id"),
              ElementsAre("hall/one_pct|discrete", "hall/one_pct-2|certified"));
  EXPECT_THAT(rowsOf(file_,
                     "SELECT count(DISTINCT r.experimentid) FROM corridor_runs o JOIN runs r ON "
                     "o.runid = r.id"),
              ElementsAre("2"));
}

TEST_F(Database, DamagedRecordsAreReported) {
  const Campaign campaign = hallCampaign({"certified"});
  runInto(campaign);
  for (const char* damage : {"UPDATE corridor_runs SET record = '{\"seed\":1}' WHERE seed = 1",
                             "UPDATE corridor_runs SET record = '{' WHERE seed = 1",
                             "UPDATE corridor_cells SET spec = 'x'"}) {
    SQLite::Database(file_.string(), SQLite::OPEN_READWRITE).exec(damage);
    EXPECT_THAT(complaint(Mode::resume, campaign), HasSubstr("is damaged: ")) << damage;
  }
}

/// A cell without runs holds no measurement, so its settings may still change.
TEST_F(Database, WithoutRunsACampaignMayChange) {
  Campaign campaign = hallCampaign({"certified"});
  EXPECT_EQ(complaint(Mode::fresh, campaign), "");
  campaign.time = 3.0 * test::kSlowdown;
  EXPECT_EQ(complaint(Mode::resume, campaign), "");
  runInto(campaign);
  campaign.time = 4.0 * test::kSlowdown;
  EXPECT_THAT(complaint(Mode::resume, campaign),
              HasSubstr("was measured with other settings: time was "));
}

TEST_F(Database, StoresTheSessionsOfItsRuns) {
  Campaign campaign = hallCampaign({"certified"});
  campaign.runs = 1;
  runInto(campaign);
  SQLite::Database(file_.string(), SQLite::OPEN_READWRITE)
      .exec("UPDATE corridor_sessions SET \"commit\" = 'an older one'");
  std::vector<CampaignCell> cells = cellsOf(campaign);
  std::vector<CampaignSession> sessions =
      CampaignDatabase(file_, Mode::resume, campaign, cells, 7).sessions();
  ASSERT_EQ(sessions.size(), 1u) << "a session without a run is not stored";
  EXPECT_EQ(sessions[0].commit, "an older one");
  EXPECT_EQ(sessions[0].jobs, 1u);
  EXPECT_EQ(sessions[0].started.size(), std::string("2026-05-04 03:02:01").size());
  campaign.runs = 3;
  {
    cells = cellsOf(campaign);
    CampaignDatabase database(file_, Mode::resume, campaign, cells, 2);
    CampaignOptions options;
    options.done = [&](std::size_t cell, const BenchmarkRun& run) { database.add(cell, run); };
    runCampaign(campaign, options, cells);
    sessions = database.sessions();
  }
  ASSERT_EQ(sessions.size(), 2u);
  EXPECT_EQ(sessions[0].runs, 1u);
  EXPECT_EQ(sessions[1].commit, buildCommit());
  EXPECT_EQ(sessions[1].jobs, 2u);
  EXPECT_EQ(sessions[1].runs, 2u);
}

/// Returns the files that `writeReports` writes, by their names.
std::map<std::string, std::string> reportsOf(const Campaign& campaign, const CampaignResult& result,
                                             const RunSource& runs,
                                             const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::map<std::string, std::string> texts;
  for (const auto& file : writeReports(campaign, result, runs, folder))
    texts[file.filename()] = test::contents(file);
  return texts;
}

/// Stored runs are read one by one, and give the same files as the runs in memory. The runs that a
/// resumed campaign keeps in memory have the same figures, but no texts.
TEST_F(Database, StoredRunsReadBackUnchanged) {
  Campaign campaign = hallCampaign({"certified", "discrete:0.2"});
  campaign.planners = {{"RRTConnect", "RRTConnect", {}}, {"star", "RRTstar", {}}};
  campaign.time = 1.0 * test::kSlowdown;
  const CampaignResult result = runInto(campaign);
  CampaignResult stored = result;
  stored.cells = cellsOf(campaign);
  std::optional<CampaignDatabase> again;
  again.emplace(file_, Mode::resume, campaign, stored.cells);
  const auto before = reportsOf(campaign, result, runsOf(result.cells), folder_ / "before");
  EXPECT_EQ(before.size(), 4u);
  EXPECT_GT(before.at("runs.csv").size(), 2000u);
  EXPECT_THAT(before.at("hall.certified.log"), HasSubstr("progress properties for each run"));
  EXPECT_EQ(reportsOf(campaign, stored, again->runs(), folder_ / "after"), before);
  again.reset();
  bool refuted = false;
  for (std::size_t c = 0; c < result.cells.size(); ++c) {
    ASSERT_EQ(stored.cells[c].runs.size(), result.cells[c].runs.size());
    for (std::size_t i = 0; i < result.cells[c].runs.size(); ++i) {
      const BenchmarkRun &kept = stored.cells[c].runs[i], &whole = result.cells[c].runs[i];
      refuted |= !whole.finding.empty();
      EXPECT_EQ(kept.why + kept.finding, "");
      EXPECT_TRUE(kept.ompl->properties.empty() && kept.ompl->setup.empty());
      EXPECT_EQ(kept.ompl->host, whole.ompl->host);
      EXPECT_EQ(kept.ompl->cpu, whole.ompl->cpu);
      EXPECT_EQ(kept.ompl, stored.cells[0].runs[0].ompl) << "each machine is kept once";
      BenchmarkRun trimmed = whole;
      trimmed.why = trimmed.finding = {};
      trimmed.ompl = kept.ompl;
      EXPECT_EQ(text(kept), text(trimmed));
    }
  }
  EXPECT_TRUE(refuted) << "no run has a finding";
  // The description of a planner and a machine is stored once for all runs of a cell.
  EXPECT_THAT(rowsOf(file_, "SELECT count(*) FROM corridor_setups"), ElementsAre("4"));
}

TEST(RunTrimmer, FreesTexts) {
  BenchmarkRun run;
  run.why = run.finding = std::string(200, 'x');
  TrajectoryRun made;
  made.fault = made.finding = run.why;
  run.trajectories = {{1.0, {made}}};
  RunTrimmer().trim(run);
  const TrajectoryRun& kept = run.trajectories[0].makers[0];
  for (const std::string& text :
       {std::cref(run.why), std::cref(run.finding), std::cref(kept.fault), std::cref(kept.finding)})
    EXPECT_LT(text.capacity(), 32u);
  EXPECT_EQ(kept.fault, RunTrimmer::kFault);
}

/// Version 2 of the program stored each run as one text. Its files can be resumed.
TEST_F(Database, ContinuesFilesOfTheVersionBefore) {
  Campaign campaign = hallCampaign({"certified"});
  const CampaignResult result = runInto(campaign);
  {
    SQLite::Database base(file_.string(), SQLite::OPEN_READWRITE);
    for (const BenchmarkRun& run : result.cells[0].runs) {
      SQLite::Statement old(base, "UPDATE corridor_runs SET record = ? WHERE seed = ?");
      old.bind(1, text(run));
      old.bind(2, static_cast<std::int64_t>(run.seed));
      old.exec();
    }
    base.exec(
        "ALTER TABLE corridor_runs DROP COLUMN setupid; ALTER TABLE corridor_runs DROP COLUMN "
        "ompl; DROP TABLE corridor_setups; PRAGMA user_version = 2");
  }
  campaign.runs = 3;
  CampaignResult all = runInto(campaign);
  ASSERT_EQ(all.cells[0].runs.size(), 3u);
  EXPECT_EQ(all.cells[0].runs[0].ompl->host, result.cells[0].runs[0].ompl->host);
  EXPECT_THAT(rowsOf(file_, "PRAGMA user_version"), ElementsAre("3"));
  const CampaignDatabase again(file_, Mode::resume, campaign, all.cells);
  std::vector<std::string> texts;
  again.runs()(0, [&](const BenchmarkRun& run) { texts.push_back(text(run)); });
  ASSERT_EQ(texts.size(), 3u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(texts[i], text(result.cells[0].runs[i]));
}

/// Runs that are added together are stored together, or not at all.
TEST_F(Database, RunsAddedTogether) {
  const Campaign campaign = hallCampaign({"certified", "discrete:0.2"});
  std::vector<CampaignCell> cells = cellsOf(campaign);
  BenchmarkRun run;
  run.result = "not found";
  {
    CampaignDatabase database(file_, Mode::fresh, campaign, cells);
    const auto add = [&](std::size_t cell, std::uint64_t seed) {
      run.seed = seed;
      database.add(cell, run);
    };
    const auto fails = [&] {
      add(0, 1);
      add(1, 1);
      throw std::runtime_error("a reason");
    };
    EXPECT_THROW(database.addTogether(fails), std::runtime_error);
    EXPECT_THROW(database.addTogether([&] { add(0, 1), add(0, 1); }), InputError);
    add(0, 2);
    database.addTogether([&] { add(0, 1), add(1, 2); });
  }
  CampaignDatabase(file_, Mode::resume, campaign, cells);
  ASSERT_EQ(cells[0].runs.size(), 2u);
  EXPECT_EQ(cells[0].runs[0].seed, 1u);
  ASSERT_EQ(cells[1].runs.size(), 1u);
  EXPECT_EQ(cells[1].runs[0].seed, 2u);
  EXPECT_THAT(rowsOf(file_, "SELECT count(*) FROM runs"), ElementsAre("3"));
}

/// A killed process leaves a log beside the database. The next process takes the runs from the log
/// into the database, and removes the log.
TEST_F(Database, AKilledProcessLosesNoStoredRun) {
  const Campaign campaign = hallCampaign({"certified"});
  std::vector<CampaignCell> cells = cellsOf(campaign);
  const ChildEnd end = inChild(
      [&](const auto&) {
        CampaignDatabase database(file_, Mode::fresh, campaign, cells);
        BenchmarkRun run;
        run.result = "not found";
        for (run.seed = 1; run.seed <= 2; ++run.seed) database.add(0, run);
        std::raise(SIGKILL);
      },
      {{600}, 0});
  EXPECT_THAT(end.failure, HasSubstr("killed by signal 9"));
  const std::filesystem::path log = file_.string() + "-wal";
  EXPECT_TRUE(std::filesystem::exists(log));
  CampaignDatabase(file_, Mode::resume, campaign, cells);
  EXPECT_EQ(cells[0].runs.size(), 2u);
  EXPECT_FALSE(std::filesystem::exists(log));
  EXPECT_THAT(rowsOf(file_, "PRAGMA journal_mode"), ElementsAre("delete"));
}

/// The tables and rows must equal those that OMPL's script makes, except for times and dates of
/// whole experiments.
TEST_F(Database, EqualsTheDatabaseOfOmplsScript) {
  if (std::system("command -v ompl_benchmark_statistics >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "ompl_benchmark_statistics is needed (Debian's ompl-demos)";
  Campaign campaign = hallCampaign({"certified", "discrete:0.2"});
  campaign.planners = {{"RRTConnect", "RRTConnect", {}}, {"star", "RRTstar", {}}};
  const CampaignResult result = runInto(campaign);
  std::string logs;
  for (const auto& path : writeReports(campaign, result, folder_))
    if (path.extension() == ".log") logs += " '" + path.string() + "'";
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

TEST_F(Database, CanBeExtendedByRunsAndVariants) {
  Campaign campaign = hallCampaign({"discrete:0.2"});
  runInto(campaign);
  campaign.runs = 3;
  campaign.variants.push_back(readVariant("certified"));
  const CampaignResult result = runInto(campaign);
  EXPECT_EQ(result.cells[0].runs.size() + result.cells[1].runs.size(), 6u);
  EXPECT_THAT(rowsOf(file_, "SELECT count(*), count(DISTINCT runid) FROM corridor_runs"),
              ElementsAre("6|6"));
  EXPECT_THAT(rowsOf(file_, "SELECT count(*) FROM runs"), ElementsAre("6"));
  EXPECT_THAT(rowsOf(file_, "SELECT name, runcount FROM experiments ORDER BY name"),
              ElementsAre("hall/certified|3", "hall/discrete:0.2|3"));
  EXPECT_THAT(rowsOf(file_, "SELECT count(*) FROM corridor_sessions"), ElementsAre("2"));
}

TEST_F(Database, RefusesExistingRunsAndOtherCampaigns) {
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  runInto(campaign);
  EXPECT_EQ(complaint(Mode::fresh, campaign),
            "contains 2 runs already; name another folder, or call benchmark CAMPAIGN --resume, "
            "which continues them");
  EXPECT_EQ(complaint(Mode::resume, campaign), "");

  Campaign other = campaign;
  other.variants = {readVariant("certified")};
  EXPECT_THAT(
      complaint(Mode::resume, other),
      HasSubstr("contains runs of hall, discrete:0.2, RRTConnect, which the campaign doesn't "
                "have"));
  other = campaign;
  other.variants = {readVariant("discrete:0.3")};
  other.variants[0].name = "discrete:0.2";
  EXPECT_THAT(
      complaint(Mode::resume, other),
      HasSubstr("hall, discrete:0.2, RRTConnect was measured with other settings: checker was "
                R"({"edges":"discrete","resolution":"0.2"} and is now )"
                R"({"edges":"discrete","resolution":"0.3"};)"));
  other = campaign;
  other.digests[0] = "another";
  EXPECT_THAT(complaint(Mode::resume, other),
              HasSubstr("was measured with other settings: problem was "));
  other = campaign;
  other.time = 77;
  EXPECT_THAT(complaint(Mode::resume, other), HasSubstr(" and is now 77.0;"));
  other = campaign;
  other.runs = 1;
  EXPECT_THAT(complaint(Mode::resume, other),
              HasSubstr("contains a run of seed 2 of hall, discrete:0.2, RRTConnect, which the "
                        "campaign doesn't have"));
  // The refusals above must not have changed the database.
  EXPECT_EQ(complaint(Mode::resume, campaign), "");
  EXPECT_THAT(rowsOf(file_, "SELECT count(*) FROM corridor_cells"), ElementsAre("1"));
}

TEST_F(Database, ForeignAndDamagedFiles) {
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  std::ofstream(file_) << "This is no database, but a text that is long enough to be taken for one "
                          "by its size, which is more than a hundred bytes.\n";
  EXPECT_EQ(complaint(Mode::resume, campaign), "is not a campaign database");
  std::filesystem::remove(file_);
  SQLite::Database(file_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE runs (id INTEGER)");
  EXPECT_EQ(complaint(Mode::resume, campaign), "is a database, but not of a campaign");
  EXPECT_EQ(complaint(Mode::fresh, campaign), "is a database, but not of a campaign");
  std::filesystem::remove(file_);
  runInto(campaign);
  SQLite::Database(file_.string(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99");
  EXPECT_EQ(
      complaint(Mode::resume, campaign),
      "is a campaign database of version 99; this program needs version 3; name another folder");
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  EXPECT_THAT(complaint(Mode::resume, campaign),
              testing::AnyOf(HasSubstr("is damaged"), HasSubstr("of version 99")));
  std::filesystem::remove(file_);
  std::filesystem::create_directory(file_);
  EXPECT_EQ(complaint(Mode::fresh, campaign), "can't be created or opened");
}

TEST_F(Database, OnlyOneProcessAtATime) {
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  std::vector<CampaignCell> cells = cellsOf(campaign);
  const CampaignDatabase mine(file_, Mode::fresh, campaign, cells);
  EXPECT_EQ(complaint(Mode::resume, campaign), "is in use by another process");
}

/// A disk that fills up during a campaign must be reported, and the runs stored before must stay.
TEST_F(Database, AFullDisk) {
  Campaign campaign = hallCampaign({"discrete:0.2"});
  campaign.runs = 1'000'000;
  std::vector<CampaignCell> cells = cellsOf(campaign);
  BenchmarkRun run;
  run.result = "solved";
  run.why = std::string(2000, 'x');
  std::uint64_t added = 0;
  const auto child = [&] {  // a limit on file sizes stands in for a full disk
    rlimit limit{200'000, 200'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    signal(SIGXFSZ, SIG_IGN);
    CampaignDatabase database(file_, Mode::fresh, campaign, cells);
    for (;;) {
      run.seed = added + 1;
      database.add(0, run);
      ++added;
    }
  };
  const ChildEnd end = inChild(
      [&](const auto& send) {
        try {
          child();
        } catch (const InputError& error) {
          send(std::to_string(added));
          send(error.what());
        }
      },
      {{600, 600}, 0});
  ASSERT_EQ(end.messages.size(), 2u) << end.failure;
  EXPECT_GT(std::stoul(end.messages[0]), 5u);
  EXPECT_THAT(end.messages[1], HasSubstr("campaign.db: can't be "));
  CampaignDatabase(file_, Mode::resume, campaign, cells);
  EXPECT_EQ(cells[0].runs.size(), std::stoul(end.messages[0]));
}

}  // namespace
}  // namespace corridor
