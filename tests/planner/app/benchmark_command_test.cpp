// Tests of the program `corridor benchmark`: table, JSON, files, and bad input, after which it must
// not run anything.
#include <SQLiteCpp/SQLiteCpp.h>
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_test.h"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using testing::UnorderedElementsAre;

class BenchmarkCommand : public corridor::test::ProgramTest {
 protected:
  BenchmarkCommand() {
    write("robot.yaml",
          "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
    write("hall.yaml", problem("-2, 0"));
  }

  /// Returns a problem: a cube, and a wall that is thinner than the steps of `discrete:0.1`, so
  /// sampling misses the wall.
  static std::string problem(const std::string& start) {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.01, 6, 1], at: "
           "[0, -1, 0]}\nstart: {at: [" +
           start + "]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n";
  }

  std::vector<std::string> files(const std::string& folder) const {
    std::vector<std::string> names;
    if (std::filesystem::exists(folder_ / folder))
      for (const auto& entry : std::filesystem::directory_iterator(folder_ / folder))
        names.push_back(entry.path().filename());
    return names;
  }
};

TEST_F(BenchmarkCommand, FilesTableAndVerdicts) {
  const Result result =
      run("benchmark hall.yaml --variants certified,discrete:0.2 --planners RRTConnect,KPIECE1 "
          "--runs 3 --seed 4 -o results");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const std::vector<std::string> table = lines(result.out);
  ASSERT_EQ(table.size(), 5u) << result.out;
  EXPECT_THAT(table[0], testing::MatchesRegex(
                            "problem +variant +planner +runs +solved .* refuted .*time_s +.*"));
  EXPECT_THAT(files("results"), UnorderedElementsAre("runs.jsonl", "campaign.db", "runs.csv",
                                                     "summary.csv", "report.html", "plots"));
  const std::vector<std::string> rows = lines(read("results/runs.csv"));
  ASSERT_EQ(rows.size(), 1u + 2 * 2 * 3);
  EXPECT_THAT(rows[0], StartsWith("problem,variant,planner,seed,result,certified,verdict,time_s,"));
  EXPECT_THAT(rows[1], StartsWith("hall,certified,RRTConnect,4,solved,1,proved,"));
  EXPECT_THAT(rows[3], StartsWith("hall,certified,RRTConnect,6,solved,1,proved,"));
  EXPECT_THAT(rows[4], StartsWith("hall,discrete:0.2,RRTConnect,4,solved,0,"));
  const std::vector<std::string> summary = lines(read("results/summary.csv"));
  ASSERT_EQ(summary.size(), 5u);
  EXPECT_THAT(summary[1], StartsWith("hall,certified,RRTConnect,3,0,3,3,3,0,0,"));
  SQLite::Database base((folder_ / "results/campaign.db").string());
  EXPECT_EQ(base.execAndGet("SELECT group_concat(n) FROM (SELECT count(*) AS n FROM runs GROUP BY "
                            "experimentid, plannerid)")
                .getString(),
            "3,3,3,3");
  const int refuted = base.execAndGet("SELECT sum(refuted) FROM runs").getInt();
  EXPECT_EQ(refuted, std::count_if(rows.begin(), rows.end(), [](const std::string& row) {
              return row.find(",refuted,") != std::string::npos;
            }));
  EXPECT_GT(refuted, 0);
}

TEST_F(BenchmarkCommand, JsonAgreesWithItself) {
  const Result result =
      run("benchmark hall.yaml --variants certified,discrete:0.2 --runs 2 --json");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["format"], "corridor-benchmark-report-2");
  EXPECT_EQ(json["interrupted"], false);
  ASSERT_EQ(json["results"].size(), 2u);
  for (const auto& cell : json["results"]) {
    EXPECT_EQ(cell["runs"], 2);
    ASSERT_EQ(cell["rows"].size(), 2u);
    for (const char* verdict : {"proved", "refuted", "undecided"})
      EXPECT_EQ(cell[verdict],
                std::count_if(cell["rows"].begin(), cell["rows"].end(),
                              [&](const auto& row) { return row["verdict"] == verdict; }));
    EXPECT_EQ(cell["box_tests"], 0.5 * (cell["rows"][0]["box_tests"].get<double>() +
                                        cell["rows"][1]["box_tests"].get<double>()));
  }
  EXPECT_EQ(json["results"][0]["proved"], 2);
  EXPECT_EQ(json["results"][0]["rows"][0]["failure"], nullptr);
  // `solve` with the same seed must have the same counters.
  const auto solved = nlohmann::json::parse(run("solve hall.yaml --seed 2 --json").out);
  const auto& row = json["results"][0]["rows"][1];
  EXPECT_EQ(row["triangle_tests"], solved["problems"][0]["triangle_tests"]);
  EXPECT_EQ(row["box_tests"], solved["problems"][0]["box_tests"]);
  EXPECT_EQ(row["length_m"], solved["problems"][0]["path"]["length_m"]);
}

TEST_F(BenchmarkCommand, BadInputIsOneLineAndRunsNothing) {
  const auto refuse = [&](const std::string& arguments, const std::string& message) {
    const Result result = run("benchmark " + arguments + " -o results");
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_THAT(result.err, StartsWith(message)) << arguments;
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "results")) << arguments;
  };
  refuse("hall.yaml --variants certifed",
         "--variants: unknown variant \"certifed\" (did you mean \"certified\"?)");
  refuse("hall.yaml --variants discrete:fine",
         "--variants: \"discrete:fine\": a resolution from 1e-09 to below 1 is needed");
  refuse("hall.yaml --variants discrete:2",
         "--variants: \"discrete:2\": a resolution from 1e-09 to below 1 is needed");
  refuse("hall.yaml --variants certified:0",
         "--variants: \"certified:0\": a tolerance above 0, in metres, is needed");
  refuse("hall.yaml --variants fle:0.01", "--variants: unknown variant \"fle\"");
  refuse("hall.yaml --jobs 0", "--jobs: a whole number from 1 to 1024 is needed");
  refuse("set.json#5-3", "set.json: \"#5-3\" is not a range of 1 to 1000 problems, such as #1-10");
  refuse("hall.yaml --variants certified,certified", "--variants: \"certified\" is named twice");
  refuse("hall.yaml --planners RRTConect",
         "--planners: unknown planner \"RRTConect\" (did you mean \"RRTConnect\"?)");
  for (const std::string list : {"certified,,discrete:0.1", ",certified", "certified,", ","})
    refuse("hall.yaml --variants " + list, "--variants: an entry of \"" + list + "\" is empty");
  refuse("hall.yaml --planners RRT,,PRM", "--planners: an entry of \"RRT,,PRM\" is empty");
  refuse("hall.yaml --runs 0", "--runs: a whole number from 1 to 1000000 is needed");
  refuse("hall.yaml --runs 500001",
         "--runs: more than 1000000 runs in all: 500001 of each of 2 combinations");
  refuse("hall.yaml --runs 2 --seed 4294967295", "--runs: the last seed would be above 2^32 - 1");
  refuse("hall.yaml --runs few", "--runs: a whole number from 1 to 1000000 is needed");
  refuse("hall.yaml --time 0", "--time: a number of seconds above 0 is needed");
  refuse("hall.yaml --time nan", "--time: a number of seconds above 0 is needed");
  refuse("hall.yaml --seed 0", "--seed: a whole number from 1 to 2^32 - 1 is needed");
  refuse("hall.yaml --memory 0", "--memory: a number of MB from 1 to 1e9 is needed");
  refuse("nothing.yaml", "nothing.yaml: ");
  refuse("", "CAMPAIGN|PROBLEM is required");
  const Result both = run("benchmark hall.yaml none.yaml --planners RRTConect");
  EXPECT_THAT(both.err, HasSubstr("none.yaml: no such file"));
  EXPECT_THAT(both.err, HasSubstr("--planners: unknown planner \"RRTConect\""));
  write("touching.yaml", problem("0, 0"));
  refuse("hall.yaml touching.yaml", "touching.yaml:5: start: in contact");
}

TEST_F(BenchmarkCommand, RefusesFoldersThatCannotBeWritten) {
  const auto refuse = [&](const std::string& folder, const std::string& message) {
    expectFault("benchmark hall.yaml --runs 1 -o " + folder, message);
  };
  refuse("robot.yaml", "robot.yaml: is a file; a folder is needed");
  refuse("robot.yaml/results", "robot.yaml/results: can't be created: Not a directory");
  refuse("none/results", "none/results: can't be created: No such file or directory");
  // After this beginning, the line has the operating system's reason.
  EXPECT_THAT(run("benchmark hall.yaml -o /proc").err, StartsWith("/proc: can't be written to: "));
}

/// Files or folders that prevent writing the output are reported before the first run, and are not
/// changed.
TEST_F(BenchmarkCommand, ReportsObstaclesToOutputFilesBeforeTheFirstRun) {
  const auto inTheWay = [&](const char* name) {
    return "results/" + std::string(name) + ": is a folder; a file is to be written here\n";
  };
  for (const char* name : {"runs.jsonl", "campaign.db", "runs.csv", "summary.csv", "report.html"})
    std::filesystem::create_directories(folder_ / "results" / name);
  write("results/report.html/mine.txt", "mine");
  write("results/plots", "mine");
  const Result all = run("benchmark hall.yaml --runs 1 -o results");
  EXPECT_EQ(all.status, 2);
  EXPECT_EQ(all.out, "");
  EXPECT_EQ(all.err, inTheWay("runs.jsonl") + inTheWay("campaign.db") + inTheWay("runs.csv") +
                         inTheWay("summary.csv") + inTheWay("report.html") +
                         "results/plots: is a file; a folder is needed\n");
  EXPECT_EQ(read("results/report.html/mine.txt"), "mine");
  EXPECT_EQ(read("results/plots"), "mine");
  EXPECT_THAT(files("results"), UnorderedElementsAre("runs.jsonl", "campaign.db", "runs.csv",
                                                     "summary.csv", "report.html", "plots"));
  std::filesystem::remove_all(folder_ / "results");
  std::filesystem::create_directories(folder_ / "results/plots/cost.svg");
  expectFault("benchmark hall.yaml --runs 1 -o results",
              "results/plots/cost.svg: is a folder; a file may be written here");
  std::filesystem::remove_all(folder_ / "results");
  std::filesystem::create_directory(folder_ / "results");
  std::filesystem::create_symlink("/proc", folder_ / "results/plots");
  EXPECT_THAT(run("benchmark hall.yaml --runs 1 -o results").err,
              StartsWith("results/plots: can't be written to: "));
  std::filesystem::remove(folder_ / "results/plots");
  std::filesystem::create_symlink("nowhere", folder_ / "results/plots");
  expectFault("benchmark hall.yaml --runs 1 -o results",
              "results/plots: is a file; a folder is needed");
}

TEST_F(BenchmarkCommand, KeepsOtherFilesOfAnExistingFolder) {
  std::filesystem::create_directory(folder_ / "results");
  write("results/notes.txt", "mine");
  write("results/runs.csv", "old");
  ASSERT_EQ(run("benchmark hall.yaml --variants discrete:0.05 --runs 1 -o results").status, 0);
  EXPECT_EQ(read("results/notes.txt"), "mine");
  EXPECT_EQ(lines(read("results/runs.csv")).size(), 2u);
  EXPECT_THAT(files("results"),
              UnorderedElementsAre("notes.txt", "runs.jsonl", "campaign.db", "runs.csv",
                                   "summary.csv", "report.html", "plots"));
}

TEST_F(BenchmarkCommand, AnInterruptKeepsFinishedRuns) {
  const std::string command = "cd '" + folder_.string() +
                              "' && timeout -s INT --preserve-status 5 '" CORRIDOR_PROGRAM
                              "' benchmark hall.yaml --runs 500000 -o results >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(read("err.txt"),
            "corridor: warning: interrupted: the results cover the finished runs; --resume "
            "continues\n");
  const std::size_t rows = lines(read("results/runs.csv")).size();
  EXPECT_GT(rows, 1u);
  EXPECT_LT(rows, 100'000u);
  SQLite::Database base((folder_ / "results/campaign.db").string());
  EXPECT_EQ(base.execAndGet("SELECT count(*) FROM runs").getInt(), static_cast<int>(rows) - 1);
}

/// Results of long runs must reach stdout even if the files can't be written.
TEST_F(BenchmarkCommand, PrintsTheTableIfFilesCannotBeWritten) {
  // While the runs are under way, a folder is created that has the name of one of the output files.
  const Result result =
      run("benchmark hall.yaml --variants discrete:0.05 --runs 40 -o results",
          "{ (for i in $(seq 1000); do [ -e results/runs.jsonl ] && break; sleep 0.01; done; "
          "mkdir results/runs.csv) & } && ");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, StartsWith("results/runs.csv: can't be written"));
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  EXPECT_EQ(lines(result.out).size(), 2u) << result.out;
  EXPECT_THAT(files("results"), UnorderedElementsAre("runs.jsonl", "runs.csv"));
}

/// An interrupt before any run has finished must not leave empty files or an empty
/// table.
TEST_F(BenchmarkCommand, AnInterruptDuringTheFirstRunLeavesNoFiles) {
  write("hall.yaml",
        "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.01, 10, 1]}\n"
        "start: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n");
  const auto interrupted = [&](const std::string& more) {
    const std::string command = "cd '" + folder_.string() +
                                "' && timeout -s INT --preserve-status 5 '" CORRIDOR_PROGRAM
                                "' benchmark hall.yaml --time 1000 " +
                                more + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    EXPECT_EQ(read("err.txt"),
              "corridor: warning: interrupted before the first run was done; nothing is written\n");
  };
  interrupted("-o results");
  EXPECT_EQ(read("out.txt"), "");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "results"));
  std::filesystem::create_directory(folder_ / "mine");
  write("mine/runs.csv", "old");
  interrupted("-o mine --json");
  EXPECT_EQ(nlohmann::json::parse(read("out.txt"))["interrupted"], true);
  EXPECT_EQ(read("mine/runs.csv"), "old");
}

TEST_F(BenchmarkCommand, ARunOutOfMemoryCountsAsFailed) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer ends the process where memory ends";
#endif
  // 1 MB is less than a thread's stack.
  const Result result = run("benchmark hall.yaml --variants certified --runs 1 --memory 1 --json");
  EXPECT_EQ(result.status, 0) << result.err;
  const auto cell = nlohmann::json::parse(result.out)["results"][0];
  EXPECT_EQ(cell["failed"], 1);
  EXPECT_EQ(cell["rows"][0]["result"], "failed");
  EXPECT_EQ(cell["rows"][0]["time_s"], nullptr);
  const auto why = cell["rows"][0]["failure"].get<std::string>();
  EXPECT_FALSE(why.empty());
  EXPECT_THAT(result.err, testing::HasSubstr("1 run failed: " + why + "\n"));
}

TEST_F(BenchmarkCommand, AnUnsolvedProblemIsNoError) {
  write("hall.yaml",
        "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.01, 10, 1]}\n"
        "start: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n");
  const Result result = run("benchmark hall.yaml --variants certified --runs 1 --time 0.5 --json");
  EXPECT_EQ(result.status, 0) << result.err;
  const auto cell = nlohmann::json::parse(result.out)["results"][0];
  EXPECT_EQ(cell["solved"], 0);
  EXPECT_EQ(cell["failed"], 0);
  EXPECT_EQ(cell["time_s"], nullptr);
  // RRTConnect may return a path to a state near the wall as an approximate solution.
  EXPECT_THAT(cell["rows"][0]["result"].get<std::string>(),
              testing::AnyOf("approximate only", "not found"));
  EXPECT_EQ(cell["rows"][0]["verdict"], nullptr);
  EXPECT_THAT(cell["rows"][0]["why"].get<std::string>(), HasSubstr("another planner or seed"));
}

}  // namespace
