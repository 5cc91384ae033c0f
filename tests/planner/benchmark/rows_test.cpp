// Tests of the rows of one run and of several runs, and of their output as CSV and as a table.
#include "planner/benchmark/rows.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(Rows, CsvHasAllDigitsAndQuotesWhatNeedsIt) {
  const std::vector<Row> rows{
      {{"name", std::string("a, \"b\"")}, {"x", 0.1 + 0.2}, {"n", std::uint64_t{7}}, {"yes", true}},
      {{"name", std::string("c")}, {"x", {}}, {"n", std::uint64_t{0}}, {"yes", false}}};
  EXPECT_EQ(csvOf(rows), "name,x,n,yes\n\"a, \"\"b\"\"\",0.30000000000000004,7,1\nc,,0,0\n");
  EXPECT_EQ(csvOf(std::vector<Row>()), "");
}

TEST(Rows, TableIsAlignedAndOmitsZeroFailures) {
  const std::vector<Row> rows{{{"name", std::string("naïve")},
                               {"time_s", 0.123456},
                               {"failed", std::uint64_t{0}},
                               {"refuted", std::uint64_t{0}},
                               {"edges", 1234567.0}},
                              {{"name", std::string("b")},
                               {"time_s", {}},
                               {"failed", std::uint64_t{0}},
                               {"refuted", std::uint64_t{0}},
                               {"edges", 20000.5}}};
  EXPECT_EQ(tableOf(rows),
            "name   time_s  refuted    edges\n"
            "naïve  0.1235        0  1234567\n"
            "b           -        0    20000\n");
}

/// Medians cover the solved runs only; a failed run counts only in `runs` and `failed`.
TEST(Rows, SummaryOfRunsThatEndedInAllWays) {
  Campaign campaign;
  campaign.problems.resize(1);
  campaign.variants = {readVariant("certified")};
  campaign.problemNames = {"p"};
  CampaignCell cell{0, 0, {"RRT", "RRT", {}}, std::vector<BenchmarkRun>(6)};
  for (std::size_t i = 0; i < 6; ++i) {
    BenchmarkRun& run = cell.runs[i];
    run.seed = i + 1;
    run.solved = i < 4;
    run.certified = i < 3;
    run.result = i < 4 ? "solved" : i == 4 ? "not found" : "failed";
    run.time = i < 4 ? 1.0 + static_cast<double>(i) : 100;
    run.checkingTime = 0.5 * run.time;
    run.searchProcessorTime = 0.1 * run.time;
    run.states = 100 * (i + 1);
    run.edges = i + 1;
    run.counters.boxTests = 10 * (i + 1);
    run.counters.undecided = 1;
    run.closestFound = i == 1 ? -1 : 0.1 * static_cast<double>(i);  // -1: no obstacle
    run.rawLength = {2.0 * static_cast<double>(i), 1};
  }
  cell.runs[0].verdict = cell.runs[1].verdict = "proved";
  cell.runs[2].verdict = "undecided";
  cell.runs[3].verdict = "refuted";
  const Row row = summaryRow(campaign, cell);
  EXPECT_EQ(csvOf({row}),
            "problem,variant,planner,runs,failed,solved,certified,proved,refuted,undecided,time_s,"
            "time_p95_s,processor_s,search_processor_s,checking_share,states,edges,edges_undecided,"
            "box_tests,"
            "triangle_tests,closest_found_m,raw_length_m,raw_rotation_rad,length_m,rotation_rad\n"
            "p,certified,RRT,6,1,4,3,2,1,1,2.5,4,0,0.25,0.5,250,2.5,6,25,0,0.2,3,1,0,0\n");
  // Values that a run doesn't have are empty.
  const auto value = [&](std::size_t run, const std::string& name) {
    for (const auto& [column, held] : runRow(campaign, cell, cell.runs[run]))
      if (column == name) return held;
    return RowValue{"no such column"};
  };
  EXPECT_EQ(value(3, "verdict"), RowValue{"refuted"});
  EXPECT_EQ(value(4, "verdict"), RowValue{});
  EXPECT_EQ(value(1, "closest_found_m"), RowValue{});
  EXPECT_EQ(value(3, "raw_length_m"), RowValue{6.0});
  EXPECT_EQ(value(4, "raw_length_m"), RowValue{});
  EXPECT_EQ(value(4, "time_s"), RowValue{100.0});
  EXPECT_EQ(value(5, "time_s"), RowValue{});
  EXPECT_EQ(value(5, "result"), RowValue{"failed"});
}

}  // namespace
}  // namespace corridor
