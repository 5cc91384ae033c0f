// Tests of the program `corridor benchmark CAMPAIGN`: after the program was killed at any moment,
// `--resume` gives the same rows as a campaign that was not interrupted. If a campaign can't be
// resumed, the program reports why.
#include <SQLiteCpp/SQLiteCpp.h>
#include <chrono>
#include <csignal>
#include <random>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/campaign_fixture.h"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

using CampaignCommand = corridor::test::CampaignTest;

/// Sends SIGKILL to the program ten times, at random moments, and resumes each time.
TEST_F(CampaignCommand, ResumesAfterBeingKilled) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  ASSERT_EQ(run("benchmark campaign.yaml -o whole").status, 0);
  // Less than a campaign takes: the first session can't do all runs.
  const std::chrono::duration<double> longest = 0.5 * (Clock::now() - start);
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  int last = 0;
  int grown[2] = {};  // the sessions that added runs, by their number of jobs
  for (int kill = 0; kill < 10; ++kill) {
    const pid_t id = ::fork();
    if (id == 0) {
      if (::chdir(folder_.c_str()) != 0) ::_exit(1);
      if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
        ::_exit(1);
      ::execl(CORRIDOR_PROGRAM, CORRIDOR_PROGRAM, "benchmark", "campaign.yaml", "-o", "killed",
              "--resume", "--jobs", kill % 2 ? "2" : "1", static_cast<char*>(nullptr));
      ::_exit(1);
    }
    std::this_thread::sleep_for(std::uniform_real_distribution(0.0, 1.0)(random) * longest);
    ::kill(id, SIGKILL);
    ::waitpid(id, nullptr, 0);
    const int runs = runsIn("killed");
    EXPECT_GE(runs, last);
    grown[kill % 2] += runs > last;
    last = runs;
  }
  const Result result = run("benchmark campaign.yaml -o killed --resume");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(repeatable("killed"), repeatable("whole"));
  EXPECT_EQ(repeatable("killed").size(), 1u + 2 * 3 * 12);
  // At least one session must have added runs before its process was killed; otherwise this test
  // shows nothing.
  EXPECT_GT(grown[0] + grown[1], 0);
  EXPECT_EQ(runsIn("killed"), 2 * 3 * 12);
  for (const char* of : {"runs", "(SELECT DISTINCT experimentid, plannerid, seed FROM runs)"})
    EXPECT_EQ(query("killed", std::string("SELECT count(*) FROM ") + of), "72");
  // The report lists the sessions.
  if (grown[1] > 0) {
    EXPECT_THAT(read("killed/report.html"), HasSubstr("2 at a time"));
  }
}

/// A limit on the size of files acts like a full disk: the fault is reported, and earlier runs are
/// kept.
TEST_F(CampaignCommand, ReportsAFullDiskAndResumesLater) {
  // 100 blocks of 512 bytes: too little for all runs.
  const Result stopped = run("benchmark campaign.yaml -o results", "ulimit -f 100 && ");
  EXPECT_EQ(stopped.status, 2);
  EXPECT_EQ(stopped.out, "");
  EXPECT_EQ(stopped.err,
            "results/runs.jsonl: can't be written: File too large (raise the limit on the size of "
            "files: ulimit -f); finished runs are kept; continue with --resume\n");
  const int kept = runsIn("results");
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, 2 * 3 * 12);
  const Result more = run("benchmark campaign.yaml -o results --resume");
  EXPECT_EQ(more.status, 0) << more.err;
  EXPECT_EQ(more.err, "") << "no line was written in part";
  EXPECT_EQ(runsIn("results"), 2 * 3 * 12);
}

/// The machine lost power while a line was written.
TEST_F(CampaignCommand, ResumesAfterALineThatIsCut) {
  ASSERT_EQ(run("benchmark campaign.yaml --runs 2 -o results").status, 0);
  const auto rows = repeatable("results");
  const std::string whole = read("results/runs.jsonl");
  write("results/runs.jsonl", whole.substr(0, whole.size() - 100));
  const Result more = run("benchmark campaign.yaml --runs 2 -o results --resume");
  EXPECT_EQ(more.status, 0);
  EXPECT_EQ(more.err,
            "corridor: warning: results/runs.jsonl: the last line was not written whole; its run "
            "is left out\n");
  EXPECT_EQ(repeatable("results"), rows);
  EXPECT_EQ(runsIn("results"), 12);
}

TEST_F(CampaignCommand, ReportListsTheSessions) {
  ASSERT_EQ(run("benchmark campaign.yaml --runs 1 -o results").status, 0);
  ASSERT_EQ(run("benchmark campaign.yaml --runs 2 --jobs 2 --resume -o results").status, 0);
  const std::string page = read("results/report.html");
  EXPECT_THAT(page, HasSubstr("6 runs, 1 at a time"));
  EXPECT_THAT(page, HasSubstr("6 runs, 2 at a time"));
}

/// Names of variants may be long, and names of folders may contain bytes that are not UTF-8.
TEST_F(CampaignCommand, AcceptsAnyNames) {
  const std::string name = "a\xff b\x1b[31m " + std::string(200, 'n');
  std::filesystem::create_directory(folder_ / name);
  std::filesystem::copy_file(folder_ / "robot.yaml", folder_ / name / "robot.yaml");
  std::filesystem::copy_file(folder_ / "hall.yaml", folder_ / name / "problem.yaml");
  write("names.yaml", "format: corridor-campaign-1\nproblems: [hall.yaml]\ncheckers:\n  " +
                          std::string(300, 'v') + ": {edges: certified}\n  " +
                          std::string(300, 'v') + "2: {edges: certified}\nruns: 1\n");
  const Result variants = run("benchmark names.yaml -o variants");
  EXPECT_EQ(variants.status, 0) << variants.err;
  EXPECT_EQ(lines(read("variants/runs.csv")).size(), 3u);
  const Result problem =
      run("benchmark '" + name + "' --variants certified --runs 1 --json -o problem");
  EXPECT_EQ(problem.status, 0) << problem.err;
  const auto json = nlohmann::json::parse(problem.out);
  EXPECT_EQ(json["results"][0]["problem"], "a\uFFFD b [31m " + std::string(200, 'n'));
  EXPECT_EQ(read("problem/runs.csv").find('\x1b'), std::string::npos);
}

/// Figures of trajectories are printed as a second table, and are in columns of summary.csv and in
/// a list of the JSON.
TEST_F(CampaignCommand, TrajectoriesOfProblems) {
  const std::string options = "benchmark hall.yaml --variants certified --runs 1 ";
  const Result table = run(options + "--trajectories stop,spline -o results");
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.err, HasSubstr("trajectories: limits: no acceleration is given for"));
  const auto at = table.out.find("\nTrajectories along the paths of all problems:\nvariant ");
  ASSERT_NE(at, std::string::npos) << table.out;
  EXPECT_EQ(table.out.substr(0, at).find("spline"), std::string::npos);
  const std::vector<std::string> rows = lines(table.out.substr(at + 1));
  ASSERT_EQ(rows.size(), 4u) << table.out;
  EXPECT_THAT(rows[2], StartsWith("certified  stop "));
  EXPECT_THAT(rows[3], StartsWith("certified  spline "));
  EXPECT_THAT(read("results/summary.csv"), HasSubstr(",stop_made,stop_proved,stop_refuted,"));
  EXPECT_THAT(read("results/runs.csv"), HasSubstr(",optimum_s,stop_verdict,stop_duration_s,"));
  EXPECT_EQ(run(options + "--trajectories stop,spline -o results --resume").out, table.out);
  const Result json = run(options + "--trajectories blends --json");
  ASSERT_EQ(json.status, 0) << json.err;
  const auto report = nlohmann::ordered_json::parse(json.out);
  EXPECT_EQ(json.out, report.dump(2) + "\n") << "printed row by row, as if printed at once";
  ASSERT_EQ(report["trajectories"].size(), 1u);
  EXPECT_EQ(report["trajectories"][0]["trajectory"], "blends");
  EXPECT_EQ(report["trajectories"][0]["proved"], 1);
  EXPECT_EQ(report["results"][0]["blends_proved"], 1);
  EXPECT_EQ(report["results"][0]["rows"][0]["blends_verdict"], "proved");
}

TEST_F(CampaignCommand, OptionsOverrideTheFile) {
  const Result result =
      run("benchmark campaign.yaml --runs 2 --seed 5 --time 30 --memory 2000 --jobs 2 --json");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["format"], "corridor-benchmark-report-2");
  EXPECT_EQ(json["campaign"], folder_.filename().string());  // the default name
  ASSERT_EQ(json["results"].size(), 6u);
  EXPECT_EQ(json["results"][3]["planner"], "short");
  EXPECT_EQ(json["results"][3]["rows"][1]["seed"], 6);
  EXPECT_EQ(result.out, nlohmann::ordered_json::parse(result.out).dump(2) + "\n");
}

/// With -o, the rows come from the file of runs. They must equal the rows without -o, and the rows
/// after --resume.
TEST_F(CampaignCommand, StoredRowsAreTheSame) {
  const auto rows = [&](const std::string& options) {
    const Result result = run("benchmark campaign.yaml --runs 2 --json " + options);
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::ordered_json::parse(result.out);
  };
  const auto without = rows(""), with = rows("-o results"), again = rows("-o results --resume");
  EXPECT_EQ(again, with);
  ASSERT_EQ(with["results"].size(), 6u);
  for (std::size_t c = 0; c < 6; ++c) {
    ASSERT_EQ(with["results"][c]["rows"].size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
      for (const auto& [key, value] : without["results"][c]["rows"][i].items())
        if (!key.ends_with("_s")) {
          EXPECT_EQ(with["results"][c]["rows"][i][key], value) << key;
        }
  }
  EXPECT_NE(with["results"][1]["rows"][0]["finding"], nullptr) << "sampled edges miss the wall";
}

TEST_F(CampaignCommand, BadInputIsOneLine) {
  expectFault("benchmark campaign.yaml hall.yaml",
              "campaign.yaml: is a campaign, which names its problems itself");
  expectFault("benchmark campaign.yaml --variants certified",
              "--variants: a campaign names its checkers itself");
  expectFault("benchmark campaign.yaml --planners RRT",
              "--planners: a campaign names its planners itself");
  expectFault("benchmark campaign.yaml --trajectories stop",
              "--trajectories: a campaign names its trajectories itself");
  expectFault("benchmark hall.yaml --trajectories stop,splin",
              "--trajectories: there is no maker of trajectories \"splin\" (did you mean "
              "\"spline\"?); there are: blends, stop, spline, inserted");
  expectFault("benchmark campaign.yaml --resume",
              "--resume: needs -o with the folder of the campaign");
  ASSERT_EQ(run("benchmark campaign.yaml --runs 1 -o results").status, 0);
  expectFault("benchmark campaign.yaml --runs 1 -o results",
              "results/runs.jsonl: contains 6 runs already; name another folder, or call "
              "benchmark CAMPAIGN --resume, which continues them");
  write("campaign.yaml",
        "format: corridor-campaign-1\nproblems: [hall.yaml]\nplanners: [RRTConect]\n"
        "checkers:\n  certified: {edges: certified}\n");
  const Result result = run("benchmark campaign.yaml -o other");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, StartsWith("campaign.yaml:3: planners: unknown planner \"RRTConect\" "
                                     "(did you mean \"RRTConnect\"?)"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "other"));
  write("campaign.yaml", "format: corridor-campaign-1\nproblems: [hall.yaml]\ncheckers: {a: {}}\n");
  write("results/runs.jsonl", read("results/runs.jsonl") + "{}\n");
  expectFaultThatBegins("benchmark campaign.yaml -o results --resume",
                        "results/runs.jsonl: is not of this campaign: it has runs of ");
  write("results/runs.jsonl", "no runs\n");
  expectFault("benchmark campaign.yaml -o results --resume",
              "results/runs.jsonl: is not a file of runs (corridor-runs-2)");
  std::filesystem::remove(folder_ / "results/runs.jsonl");
  write("results/campaign.db",
        "not a database, but long enough to be looked at as if it were one, "
        "which takes a hundred bytes at least");
  expectFault("benchmark campaign.yaml -o results --resume",
              "results/campaign.db: is not a campaign database");
}

/// Versions 2 and 3 of the database hold the only record of their runs.
TEST_F(CampaignCommand, DatabasesOfOlderVersionsAreNotReplaced) {
  std::filesystem::create_directory(folder_ / "old");
  SQLite::Database((folder_ / "old/campaign.db").string(),
                   SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec(
          "CREATE TABLE corridor_runs (cellid INTEGER); PRAGMA application_id = 1668248178; "
          "PRAGMA user_version = 3");
  const std::string before = read("old/campaign.db"),
                    fault =
                        "old/campaign.db: is of an older version of Corridor; continue or merge it "
                        "with commit b384c05c or earlier";
  for (const char* use : {"campaign.yaml -o old", "campaign.yaml -o old --resume",
                          "--merge old -o new", "--merge old/campaign.db -o new"})
    expectFault(std::string("benchmark ") + use, fault);
  EXPECT_EQ(read("old/campaign.db"), before);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "old/runs.jsonl"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

}  // namespace
