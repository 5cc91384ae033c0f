// Tests of the file of runs: it returns the runs that were stored, also after a crash or a full
// disk, and reports campaigns and files that it can't accept.
#include "planner/benchmark/run_file.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
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
#include "tests/planner/benchmark/hall_campaign.h"

namespace corridor {
namespace {

using Mode = RunFile::Mode;
using test::hallCampaign;
using test::rowsOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class StoredRuns : public testing::Test {
 protected:
  ~StoredRuns() override { std::filesystem::remove_all(folder_); }

  CampaignResult runInto(const Campaign& campaign) const {
    std::vector<CampaignCell> cells = cellsOf(campaign);
    RunFile stored(file_, Mode::resume, campaign, cells);
    CampaignOptions options;
    options.done = [&](std::size_t cell, const BenchmarkRun& run) { stored.add(cell, run); };
    return runCampaign(campaign, options, cells);
  }
  std::string complaint(Mode mode, const Campaign& campaign) const {
    std::vector<CampaignCell> cells = cellsOf(campaign);
    try {
      RunFile(file_, mode, campaign, cells);
    } catch (const InputError& error) {
      EXPECT_EQ(error.faults().size(), 1u);
      EXPECT_EQ(error.faults()[0].file, file_.string());
      line_ = error.faults()[0].line;
      return error.faults()[0].text;
    }
    return "";
  }
  std::size_t linesWith(const std::string& begin) const {
    std::istringstream lines(test::contents(file_));
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line);) count += line.rfind(begin, 0) == 0;
    return count;
  }

  std::filesystem::path folder_ = test::newFolder(), file_ = folder_ / "runs.jsonl";
  mutable int line_ = 0;  // of the last complaint
};

TEST_F(StoredRuns, DamagedLinesAreReported) {
  const Campaign campaign = hallCampaign({"certified"});
  runInto(campaign);
  const std::string whole = test::contents(file_);
  const auto begin = whole.find("{\"cell\":"), end = whole.find('\n', begin) + 1;
  const auto with = [&](const std::string& line) {
    std::ofstream(file_) << whole.substr(0, begin) << line << '\n' << whole.substr(end);
    return complaint(Mode::resume, campaign);
  };
  EXPECT_THAT(with("{\"cell\":"), StartsWith("is damaged: [json.exception.parse_error"));
  EXPECT_THAT(with("{}"), StartsWith("is damaged: [json.exception.out_of_range"));
  EXPECT_THAT(with("{\"cell\":0,\"setup\":0,\"run\":{\"seed\":1}}"), StartsWith("is damaged: "));
  std::string other = whole.substr(begin, end - begin - 1);
  other.replace(0, 9, "{\"cell\":1");
  EXPECT_EQ(with(other), "the session has no such cell or setup");
  other.replace(0, 19, "{\"cell\":0,\"setup\":1");
  EXPECT_EQ(with(other), "the session has no such cell or setup");
  EXPECT_EQ(line_, 3) << "the line is named";
  std::ofstream(file_) << whole << whole.substr(begin, end - begin);
  EXPECT_EQ(complaint(Mode::resume, campaign),
            "has a run that is there already: seed 1 of hall, certified, RRTConnect; name each "
            "folder once, or repeat one with another --seed");
  std::string next = whole;
  next.replace(next.find("runs-2"), 6, "runs-9");
  std::ofstream(file_) << next;
  EXPECT_EQ(complaint(Mode::resume, campaign),
            "its format is corridor-runs-9; this program reads corridor-runs-2");
}

/// A cell without runs holds no measurement, so its settings may still change.
TEST_F(StoredRuns, WithoutRunsACampaignMayChange) {
  Campaign campaign = hallCampaign({"certified"});
  EXPECT_EQ(complaint(Mode::fresh, campaign), "");
  campaign.time = 3.0 * test::kSlowdown;
  EXPECT_EQ(complaint(Mode::resume, campaign), "");
  runInto(campaign);
  campaign.time = 4.0 * test::kSlowdown;
  EXPECT_THAT(complaint(Mode::resume, campaign),
              HasSubstr("hall, certified, RRTConnect was measured with time "));
}

TEST_F(StoredRuns, StoresTheSessionsOfItsRuns) {
  Campaign campaign = hallCampaign({"certified"});
  campaign.runs = 1;
  runInto(campaign);
  std::string stored = test::contents(file_);
  stored.replace(stored.find(buildCommit()), std::string(buildCommit()).size(), "an older one");
  std::ofstream(file_) << stored;
  std::vector<CampaignCell> cells = cellsOf(campaign);
  std::vector<CampaignSession> sessions =
      RunFile(file_, Mode::resume, campaign, cells, 7).sessions();
  ASSERT_EQ(sessions.size(), 1u) << "a session without a run is not stored";
  EXPECT_EQ(sessions[0].commit, "an older one");
  EXPECT_EQ(sessions[0].jobs, 1u);
  EXPECT_EQ(sessions[0].started.size(), std::string("2026-05-04 03:02:01").size());
  campaign.runs = 3;
  {
    cells = cellsOf(campaign);
    RunFile more(file_, Mode::resume, campaign, cells, 2);
    CampaignOptions options;
    options.done = [&](std::size_t cell, const BenchmarkRun& run) { more.add(cell, run); };
    runCampaign(campaign, options, cells);
    sessions = more.sessions();
  }
  ASSERT_EQ(sessions.size(), 2u);
  EXPECT_EQ(sessions[0].runs, 1u);
  EXPECT_EQ(sessions[1].commit, buildCommit());
  EXPECT_EQ(sessions[1].jobs, 2u);
  EXPECT_EQ(sessions[1].runs, 2u);
}

/// Returns the rows that `writeReports` writes.
std::string reportsOf(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
                      const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  writeReports(campaign, result, runs, folder);
  std::string all = test::contents(folder / "runs.csv") + test::contents(folder / "summary.csv");
  for (const char* sql : {"SELECT * FROM runs", "SELECT * FROM progress",
                          "SELECT * FROM experiments", "SELECT * FROM plannerConfigs"})
    for (const std::string& row : rowsOf(folder / "campaign.db", sql)) all += row + "\n";
  return all;
}

/// Stored runs are read one by one, and give the same files as the runs in memory. The runs that a
/// resumed campaign keeps in memory have the same figures, but no texts.
TEST_F(StoredRuns, StoredRunsReadBackUnchanged) {
  Campaign campaign = hallCampaign({"certified", "discrete:0.2"});
  campaign.planners = {{"RRTConnect", "RRTConnect", {}}, {"star", "RRTstar", {}}};
  campaign.time = 1.0 * test::kSlowdown;
  const CampaignResult result = runInto(campaign);
  CampaignResult stored = result;
  stored.cells = cellsOf(campaign);
  const std::string size = std::to_string(std::filesystem::file_size(file_));
  {
    const RunFile again(file_, Mode::resume, campaign, stored.cells);
    const std::string before =
        reportsOf(campaign, result, runsOf(result.cells), folder_ / "before");
    EXPECT_GT(before.size(), 4000u);
    EXPECT_EQ(reportsOf(campaign, stored, again.runs(), folder_ / "after"), before);
    EXPECT_FALSE(rowsOf(folder_ / "after/campaign.db", "SELECT * FROM progress").empty());
  }
  EXPECT_EQ(std::to_string(std::filesystem::file_size(file_)), size) << "nothing was added";
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
  EXPECT_EQ(linesWith("{\"setup\":"), 4u);
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

/// A process that is killed, or a machine that loses power, may leave a part of a line.
TEST_F(StoredRuns, ALineThatWasNotWrittenWholeIsCutOff) {
  const Campaign campaign = hallCampaign({"certified"});
  runInto(campaign);
  const std::string whole = test::contents(file_);
  const auto last = whole.rfind("{\"cell\":");
  for (const std::size_t size : {last + 1, whole.size() - 1, last + 300}) {
    std::ofstream(file_) << whole.substr(0, size);
    std::vector<CampaignCell> cells = cellsOf(campaign);
    {
      const RunFile stored(file_, Mode::resume, campaign, cells);
      EXPECT_THAT(stored.notes(),
                  ElementsAre(file_.string() +
                              ": the last line was not written whole; its run is left out"));
    }
    EXPECT_EQ(cells[0].runs.size(), 1u);
    EXPECT_EQ(test::contents(file_), whole.substr(0, last));
    EXPECT_EQ(runInto(campaign).cells[0].runs.size(), 2u);
    EXPECT_EQ(complaint(Mode::resume, campaign), "");
  }
  std::filesystem::resize_file(file_, 20);  // within the first line
  EXPECT_EQ(complaint(Mode::fresh, campaign), "");
  EXPECT_EQ(std::filesystem::file_size(file_), 0u);
}

TEST_F(StoredRuns, AKilledProcessLosesNoStoredRun) {
  const Campaign campaign = hallCampaign({"certified"});
  std::vector<CampaignCell> cells = cellsOf(campaign);
  const ChildEnd end = inChild(
      [&](const auto&) {
        RunFile stored(file_, Mode::fresh, campaign, cells);
        BenchmarkRun run;
        run.result = "not found";
        for (run.seed = 1; run.seed <= 2; ++run.seed) stored.add(0, run);
        std::raise(SIGKILL);
      },
      {{600}, 0});
  EXPECT_THAT(end.failure, HasSubstr("killed by signal 9"));
  RunFile(file_, Mode::resume, campaign, cells);
  EXPECT_EQ(cells[0].runs.size(), 2u);
}

TEST_F(StoredRuns, CanBeExtendedByRunsAndVariants) {
  Campaign campaign = hallCampaign({"discrete:0.2"});
  runInto(campaign);
  campaign.runs = 3;
  campaign.variants.push_back(readVariant("certified"));
  const CampaignResult result = runInto(campaign);
  EXPECT_EQ(result.cells[0].runs.size() + result.cells[1].runs.size(), 6u);
  EXPECT_EQ(linesWith("{\"cell\":"), 6u);
  EXPECT_EQ(linesWith("{\"format\":"), 2u);
  EXPECT_EQ(complaint(Mode::resume, campaign), "");
}

TEST_F(StoredRuns, RefusesExistingRunsAndOtherCampaigns) {
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  runInto(campaign);
  const std::string whole = test::contents(file_);
  EXPECT_EQ(complaint(Mode::fresh, campaign),
            "contains 2 runs already; name another folder, or call benchmark CAMPAIGN --resume, "
            "which continues them");
  EXPECT_EQ(complaint(Mode::resume, campaign), "");

  Campaign other = campaign;
  other.variants = {readVariant("certified")};
  EXPECT_EQ(complaint(Mode::resume, other),
            "is not of this campaign: it has runs of hall, discrete:0.2, RRTConnect; name another "
            "folder");
  other = campaign;
  other.variants = {readVariant("discrete:0.3")};
  other.variants[0].name = "discrete:0.2";
  EXPECT_EQ(complaint(Mode::resume, other),
            "is not of this campaign: hall, discrete:0.2, RRTConnect was measured with checker "
            R"({"edges":"discrete","resolution":"0.2"}, not )"
            R"({"edges":"discrete","resolution":"0.3"}; name another folder)");
  other = campaign;
  other.digests[0] = "another";
  EXPECT_THAT(complaint(Mode::resume, other), HasSubstr("was measured with problem "));
  other = campaign;
  other.time = 77;
  EXPECT_THAT(complaint(Mode::resume, other), HasSubstr(", not 77.0;"));
  other = campaign;
  other.runs = 1;
  EXPECT_EQ(complaint(Mode::resume, other),
            "is not of this campaign: it has a run of seed 2 of hall, discrete:0.2, RRTConnect; "
            "name another folder");
  // The refusals above must not have changed the file.
  EXPECT_EQ(complaint(Mode::resume, campaign), "");
  EXPECT_EQ(test::contents(file_), whole);
}

TEST_F(StoredRuns, ForeignFiles) {
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  for (const char* text : {"a text", "a text\n", "\n", "{}\n{}\n", "{\"cell\":0}\n"})
    for (const Mode mode : {Mode::fresh, Mode::resume}) {
      std::ofstream(file_) << text;
      EXPECT_EQ(complaint(mode, campaign), "is not a file of runs (corridor-runs-2)");
      EXPECT_EQ(test::contents(file_), text);
    }
  std::filesystem::remove(file_);
  std::filesystem::create_directory(file_);
  EXPECT_EQ(complaint(Mode::fresh, campaign), "can't be opened: Is a directory");
}

TEST_F(StoredRuns, OnlyOneProcessAtATime) {
  const Campaign campaign = hallCampaign({"discrete:0.2"});
  std::vector<CampaignCell> cells = cellsOf(campaign);
  const RunFile mine(file_, Mode::fresh, campaign, cells);
  const ChildEnd end =
      inChild([&](const auto& send) { send(complaint(Mode::resume, campaign)); }, {{600}, 0});
  EXPECT_THAT(end.messages, ElementsAre("is in use by another process"));
}

/// A disk that fills up during a campaign must be reported, and the runs stored before must stay.
TEST_F(StoredRuns, AFullDisk) {
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
    RunFile stored(file_, Mode::fresh, campaign, cells);
    for (;;) {
      run.seed = added + 1;
      stored.add(0, run);
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
  EXPECT_EQ(end.messages[1],
            file_.string() +
                ": can't be written: File too large (raise the limit on the size of files: ulimit "
                "-f); finished runs are kept; continue with --resume");
  RunFile(file_, Mode::resume, campaign, cells);
  EXPECT_EQ(cells[0].runs.size(), std::stoul(end.messages[0]));
  EXPECT_EQ(linesWith("{\"cell\":"), cells[0].runs.size()) << "no line is left in part";
}

}  // namespace
}  // namespace corridor
