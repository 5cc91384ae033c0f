// Tests of `corridor benchmark` on several machines without MPI: --shard and --merge. Merged shards
// have the rows of the whole campaign. Files that don't belong to one campaign are refused.
#include <SQLiteCpp/SQLiteCpp.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/campaign_fixture.h"

namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class CampaignMerge : public corridor::test::CampaignTest {
 protected:
  /// Runs the shards 1/count … count/count into the folders s1, s2, …
  void runShards(int count, const std::string& options = "") const {
    for (int k = 1; k <= count; ++k) {
      const std::string K = std::to_string(k);
      const Result result = run("benchmark campaign.yaml " + options + " --shard " + K + "/" +
                                std::to_string(count) + " -o s" + K);
      ASSERT_EQ(result.status, 0) << result.err;
    }
  }
  /// Returns the sorted paths of all files and folders below a folder, relative to it.
  std::vector<std::string> filesIn(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / folder))
      names.push_back(std::filesystem::relative(entry.path(), folder_ / folder).string());
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(CampaignMerge, ThreeShardsHaveTheRowsOfTheWhole) {
  ASSERT_EQ(run("benchmark campaign.yaml --runs 4 -o whole").status, 0);
  runShards(3, "--runs 4");
  std::size_t rows = 0;
  for (const char* folder : {"s1", "s2", "s3"}) {
    const std::size_t own = repeatable(folder).size() - 1;
    EXPECT_TRUE(own == 6 || own == 9) << own;  // 8 groups of 3 variants
    rows += own;
  }
  EXPECT_EQ(rows, 24u);
  EXPECT_THAT(read("s2/report.html"), HasSubstr("this is shard 2/3"));
  std::filesystem::remove(folder_ / "hall.yaml");  // --merge must not need these files
  std::filesystem::remove(folder_ / "campaign.yaml");
  const Result merged = run("benchmark --merge s3 s1/runs.jsonl s2 -o merged");
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(merged.err, "");
  EXPECT_EQ(repeatable("merged"), repeatable("whole"));
  EXPECT_EQ(filesIn("merged"), filesIn("whole"));
  EXPECT_THAT(read("merged/report.html"), testing::Not(HasSubstr("this is shard")));
  // OMPL's tables have the same runs, except for times.
  for (const char* sql :
       {"SELECT group_concat(x) FROM (SELECT e.name || p.name || r.seed || r.solved || r.certified "
        "|| r.edges || r.path_states AS x FROM runs r JOIN experiments e ON e.id = r.experimentid "
        "JOIN plannerConfigs p ON p.id = r.plannerid ORDER BY x)",
        "SELECT group_concat(name || runcount || seed || edges || ifnull(resolution, '') || setup) "
        "FROM (SELECT * FROM experiments ORDER BY name)",
        "SELECT group_concat(name || settings) FROM (SELECT * FROM plannerConfigs ORDER BY 2, 3)",
        "SELECT group_concat(name) FROM (SELECT name FROM pragma_table_info('runs') ORDER BY "
        "name)"}) {
    EXPECT_EQ(query("merged", sql), query("whole", sql)) << sql;
    EXPECT_GT(query("merged", sql).size(), 4u) << sql;
  }
  // The sessions of the shards are there, and then that of the whole campaign.
  const std::string text = read("merged/runs.jsonl"),
                    shards = read("s3/runs.jsonl") + read("s1/runs.jsonl") + read("s2/runs.jsonl");
  EXPECT_EQ(text.substr(0, shards.size()), shards);
  EXPECT_THAT(text.substr(shards.size()), testing::StartsWith("{\"format\":"));
  EXPECT_THAT(text.substr(shards.size()), HasSubstr("\"shard\":\"\""));
}

/// The two shards have runs of different problems, with the same numbers of setups. RRTstar reports
/// its progress.
TEST_F(CampaignMerge, SetupsBelongToTheirSessions) {
  write("other.yaml", read("hall.yaml") + "margin: 0.01\n");
  write("campaign.yaml",
        "format: corridor-campaign-1\nproblems: [hall.yaml, other.yaml]\nplanners: [RRTstar]\n"
        "checkers: {certified: {edges: certified}}\nlimits: {time: 0.3}\n");
  runShards(2, "--runs 1");
  ASSERT_EQ(run("benchmark --merge s2 s1 -o merged").status, 0);
  const std::string rows =
      "SELECT group_concat(x, char(10)) FROM (SELECT e.name || r.seed || r.solved || r.edges || "
      "substr(e.setup, 1, 20) || count(g.time) || ' ' || sum(g.time) AS x FROM runs r JOIN "
      "experiments e ON e.id = r.experimentid JOIN progress g ON g.runid = r.id GROUP BY r.id "
      "ORDER "
      "BY e.name)";
  const std::string first = query("s1", rows), second = query("s2", rows);
  EXPECT_THAT(first, testing::StartsWith("hall"));
  EXPECT_THAT(first, HasSubstr("Problem hall.yaml"));
  EXPECT_THAT(second, testing::StartsWith("other"));
  EXPECT_THAT(second, HasSubstr("Problem other.yaml"));
  EXPECT_EQ(query("merged", rows), first + "\n" + second);
}

/// Two laboratories run the same campaign with different seeds.
TEST_F(CampaignMerge, OtherSeedsOfTheSameCampaign) {
  ASSERT_EQ(run("benchmark campaign.yaml --runs 5 -o whole").status, 0);
  ASSERT_EQ(run("benchmark campaign.yaml --runs 2 -o a").status, 0);
  ASSERT_EQ(run("benchmark campaign.yaml --runs 3 --seed 3 -o b").status, 0);
  ASSERT_EQ(run("benchmark --merge b a -o merged").status, 0);
  EXPECT_EQ(repeatable("merged"), repeatable("whole"));
  // Merged runs can be continued, and merged again.
  ASSERT_EQ(run("benchmark campaign.yaml --runs 6 -o merged --resume").status, 0);
  ASSERT_EQ(run("benchmark campaign.yaml --runs 1 --seed 7 -o c").status, 0);
  ASSERT_EQ(run("benchmark --merge c merged -o all").status, 0);
  EXPECT_EQ(repeatable("all").size(), 1u + 7 * 6);
  ASSERT_EQ(run("benchmark campaign.yaml --runs 1 --seed 4 -o d").status, 0);
  expectFault("benchmark --merge d a -o gap",
              "d/runs.jsonl: can't be merged with the others: none of them is for the seeds from "
              "3 to 3, and a campaign has seeds without a gap");
  expectFault("benchmark --merge c a -o gap",
              "c/runs.jsonl: can't be merged with the others: none of them is for the seeds from "
              "3 to 6, and a campaign has seeds without a gap");
}

TEST_F(CampaignMerge, MissingSharesAreNotedAndCanBeMade) {
  runShards(3, "--runs 3");
  const Result part = run("benchmark --merge s1 s3 -o merged");
  EXPECT_EQ(part.status, 0);
  EXPECT_EQ(
      part.err,
      "corridor: warning: 6 runs of 18 are missing; benchmark CAMPAIGN --resume makes them\n");
  EXPECT_THAT(read("merged/report.html"), HasSubstr("6 runs of 18 are missing"));
  ASSERT_EQ(run("benchmark campaign.yaml --runs 3 -o merged --resume").status, 0);
  ASSERT_EQ(run("benchmark campaign.yaml --runs 3 -o whole").status, 0);
  EXPECT_EQ(repeatable("merged"), repeatable("whole"));
}

TEST_F(CampaignMerge, TrajectoriesAreRecorded) {
  const std::string options =
      "benchmark hall.yaml --variants certified --trajectories stop,spline --runs 2 ";
  ASSERT_EQ(run(options + "-o whole").status, 0);
  ASSERT_EQ(run(options + "--shard 1/2 -o a").status, 0);
  ASSERT_EQ(run(options + "--shard 2/2 -o b").status, 0);
  const Result merged = run("benchmark --merge a b -o merged");
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_THAT(merged.err, HasSubstr("limits: no acceleration is given for"));
  EXPECT_EQ(repeatable("merged"), repeatable("whole"));
  EXPECT_THAT(read("merged/summary.csv"), HasSubstr(",stop_made,stop_proved,stop_refuted,"));
}

TEST_F(CampaignMerge, AShardResumes) {
  ASSERT_EQ(run("benchmark campaign.yaml --runs 2 --shard 2/3 -o s").status, 0);
  expectFault("benchmark campaign.yaml --runs 4 --resume -o s",
              "s/runs.jsonl: contains shard 2/3 of the runs; continue with --shard 2/3, or name "
              "another folder");
  expectFault("benchmark campaign.yaml --runs 4 --resume --shard 1/3 -o s",
              "s/runs.jsonl: contains shard 2/3 of the runs; continue with --shard 2/3, or name "
              "another folder");
  const std::size_t before = repeatable("s").size();
  const Result more = run("benchmark campaign.yaml --runs 4 --resume --shard 2/3 -o s");
  EXPECT_EQ(more.status, 0) << more.err;
  EXPECT_GT(repeatable("s").size(), before);
  ASSERT_EQ(run("benchmark campaign.yaml --runs 1 -o whole").status, 0);
  expectFault("benchmark campaign.yaml --runs 4 --resume --shard 2/3 -o whole",
              "whole/runs.jsonl: contains runs of the whole campaign, not of shard 2/3 only; "
              "leave out --shard, or name another folder");
  // The campaign now has one planner fewer, so the groups are dealt to other shards.
  write("campaign.yaml",
        "format: corridor-campaign-1\nproblems: [hall.yaml]\nplanners: [RRTConnect]\ncheckers:\n  "
        "certified: {edges: certified}\n  sampled: {edges: discrete, resolution: [0.2, 0.01]}\n");
  expectFaultThatBegins("benchmark campaign.yaml --runs 4 --resume --shard 2/3 -o s",
                        "s/runs.jsonl: is not of this campaign: it has runs of hall, ");
}

TEST_F(CampaignMerge, BadInputIsOneLine) {
  expectFault("benchmark campaign.yaml --shard 1/3",
              "--shard: needs -o with a folder for this shard of the runs");
  for (const char* shard : {"0/3", "4/3", "x", "1"})
    expectFault("benchmark campaign.yaml -o s --shard " + std::string(shard),
                "--shard: K/N is needed, such as 1/3, with K from 1 to N, not \"" +
                    std::string(shard) + "\"; see corridor benchmark --help");
  expectFault(
      "benchmark campaign.yaml --runs 2 --shard 5/5 -o s",
      "--shard: 5 shards are too many for 4 combinations of problem, planner and seed: some "
      "would have no runs");
  runShards(2, "--runs 1");
  expectFault("benchmark --merge s1 s2", "--merge: needs -o with the folder of the results");
  expectFault("benchmark --merge s1 s3 -o m",
              "s3: there is no such file; a folder of results, or its runs.jsonl, is needed");
  expectFault("benchmark --merge s1 . -o m",
              "./runs.jsonl: there is no such file; a folder of results, or its runs.jsonl, is "
              "needed");
  expectFault("benchmark --merge s1 hall.yaml -o m",
              "hall.yaml: is not a file of runs (corridor-runs-2)");
  expectFault("benchmark --merge s1 s2 --runs 3 -o m",
              "--runs excludes --merge; see corridor benchmark --help");
  expectFault("benchmark --merge s1 s2 -o s1",
              "s1/runs.jsonl: contains 3 runs already; name another folder, or call benchmark "
              "CAMPAIGN --resume, which continues them");
  for (const char* same : {"s1 s2 s1", "s2 s1/runs.jsonl s1"})
    expectFault(
        "benchmark --merge " + std::string(same) + " -o m",
        "s1/runs.jsonl: has a run that is there already: seed 1 of hall, certified, RRTConnect; "
        "name each folder once, or repeat one with another --seed");
  ASSERT_EQ(run("benchmark campaign.yaml --runs 1 --seed 9 --time 77 -o other").status, 0);
  expectFault("benchmark --merge s1 other -o m",
              "other/runs.jsonl: is not of the campaign of s1/runs.jsonl: hall, certified, "
              "RRTConnect was measured with time 77.0, not 20.0");
  ASSERT_EQ(run("benchmark hall.yaml --variants certified --runs 1 -o other2").status, 0);
  expectFault("benchmark --merge s1 other2 -o m",
              "other2/runs.jsonl: is not of the campaign of s1/runs.jsonl: it does not have "
              "hall, sampled 0.2, RRTConnect");
  expectFault("benchmark --merge other2 s1 -o m",
              "s1/runs.jsonl: is not of the campaign of other2/runs.jsonl: it has runs of hall, "
              "sampled 0.2, RRTConnect; name another folder");
  const std::string whole = read("s2/runs.jsonl");
  write("s2/runs.jsonl", whole + "{}\n");
  expectFaultThatBegins(
      "benchmark --merge s1 s2 -o m",
      "s2/runs.jsonl:" + std::to_string(lines(whole).size() + 1) + ": is damaged: ");
  write("s2/runs.jsonl", "");
  expectFault("benchmark --merge s1 s2 -o m", "s2/runs.jsonl: has no runs");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m"));  // nothing was written
  write("s2/runs.jsonl", whole.substr(0, whole.size() - 9));
  const Result cut = run("benchmark --merge s1 s2 -o m");
  EXPECT_EQ(cut.status, 0);
  EXPECT_EQ(
      cut.err,
      "corridor: warning: s2/runs.jsonl: the last line was not written whole; its run is left "
      "out\ncorridor: warning: 1 run of 6 are missing; benchmark CAMPAIGN --resume makes "
      "them\n");
}

TEST_F(CampaignMerge, AFullDiskLeavesNothing) {
  runShards(2, "--runs 8");
  const Result full = run("benchmark --merge s1 s2 -o m", "ulimit -f 100 && ");
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(
      full.err,
      HasSubstr("m/runs.jsonl.part: can't be written: File too large (raise the limit on the "
                "size of files: ulimit -f); nothing is merged"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "m"));
}

}  // namespace
