// Tests of a campaign's report: its ranking, its plots and their data, and names that contain HTML.
#include "planner/benchmark/report.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/benchmark/comparison.h"
#include "planner/benchmark/contenders.h"
#include "planner/benchmark/report_plots.h"
#include "planner/benchmark/report_tables.h"
#include "tests/planner/benchmark/made_campaign.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::HasSubstr;
using testing::Not;

class Report : public test::MadeCampaign {};

TEST_F(Report, Ranking) {
  const std::vector<VariantScore> scores = scoresOf(campaign_, cells_);
  ASSERT_EQ(scores.size(), 3u);
  EXPECT_EQ(scores[0].variant, 0u);  // no path refuted
  EXPECT_EQ(scores[1].variant, 2u);  // few paths refuted
  EXPECT_EQ(scores[2].variant, 1u);
  EXPECT_EQ(scores[2].refuted, 10u);
  EXPECT_EQ(scores[2].judged(), 20u);
  EXPECT_EQ(scores[2].pairs, 20u);
  EXPECT_DOUBLE_EQ(scores[0].timeRatio, 1);
  EXPECT_DOUBLE_EQ(scores[1].timeRatio, 10);
  EXPECT_DOUBLE_EQ(scores[2].timeRatio, 0.5);
  EXPECT_DOUBLE_EQ(scores[0].lengthRatio, 0.75);
  ASSERT_TRUE(scores[0].cost);
  EXPECT_NEAR(scores[0].cost->model.box, 100, 1e-6);
  EXPECT_NEAR(scores[0].cost->model.triangle, 1000, 1e-6);
  EXPECT_NEAR(scores[0].cost->ratioMedian, 1, 1e-9);
}

TEST_F(Report, AVariantThatSolvesNothingIsLast) {
  for (CampaignCell& cell : cells_)
    if (cell.variant == 0)
      for (BenchmarkRun& run : cell.runs) {
        run.solved = false;
        run.verdict.clear();
        run.result = "not found";
      }
  const std::vector<VariantScore> scores = scoresOf(campaign_, cells_);
  EXPECT_EQ(scores.back().variant, 0u);
  EXPECT_EQ(scores.back().pairs, 0u);
  EXPECT_TRUE(std::isnan(scores.back().timeRatio));
  EXPECT_THAT(page(), HasSubstr("0 of 20"));
}

/// Times are multiples of those of the first variant that solved anything.
TEST_F(Report, TimesAreRelativeToTheFirstVariantThatSolves) {
  for (CampaignCell& cell : cells_)
    if (cell.variant == 0)
      for (BenchmarkRun& run : cell.runs) run.solved = false, run.verdict.clear();
  EXPECT_EQ(referenceVariant(cells_), 1u);
  for (const VariantScore& score : scoresOf(campaign_, cells_)) {
    const double ratios[] = {NAN, 1, 20};
    if (score.variant > 0) {
      EXPECT_DOUBLE_EQ(score.timeRatio, ratios[score.variant]);
    }
  }
  EXPECT_THAT(
      page(),
      HasSubstr("as a multiple of discrete:0.1’s: the median over 20 runs that both solved"));
  for (CampaignCell& cell : cells_) cell.runs.clear();
  EXPECT_EQ(referenceVariant(cells_), 0u);
}

/// Several planners are ranked with their variants, and each has lines of its own.
TEST_F(Report, PlannersAreRanked) {
  EXPECT_FALSE(contendersOf(campaign_, cells_)) << "one planner: its variants are ranked";
  campaign_.planners = {{"RRT", "RRT", {}}, {"PRM", "PRM", {}}};
  std::vector<CampaignCell> both;  // PRM takes three times as long
  const std::size_t variants = campaign_.variants.size();
  for (std::size_t first = 0; first < cells_.size(); first += variants)
    for (const CampaignPlanner& planner : campaign_.planners)
      for (std::size_t v = 0; v < variants; ++v) {
        both.push_back(cells_[first + v]);
        both.back().planner = planner;
        for (BenchmarkRun& run : both.back().runs)
          if (planner.label == "PRM") run.processorTime *= 3;
      }
  cells_ = both;
  const auto [campaign, cells] = contendersOf(campaign_, cells_).value();
  ASSERT_EQ(campaign.variants.size(), 2 * variants);
  EXPECT_EQ(campaign.variants[0].name, "RRT, certified");
  EXPECT_EQ(campaign.variants[3].name, "PRM, certified");
  const std::vector<VariantScore> scores = scoresOf(campaign, cells);
  ASSERT_EQ(scores.size(), 2 * variants);
  EXPECT_EQ(scores[0].variant, 0u);
  EXPECT_EQ(scores[1].variant, 3u) << "no path refuted either";
  EXPECT_DOUBLE_EQ(scores[1].timeRatio, 3);
  EXPECT_EQ(scores[1].pairs, 20u);
  const Plot solved = solvedOverTime(campaign, cells, 0);
  std::set<std::string> names;
  for (const PlotSeries& line : solved.series) names.insert(line.name);
  EXPECT_EQ(names.size(), 2 * variants + 1) << "and dashed lines without a name";
  EXPECT_EQ(profileOfAll(campaign, cells).series.size(), 2 * variants);
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("Planners with their variants without a refuted path come first"));
  EXPECT_THAT(text, HasSubstr("PRM, certified"));
}

TEST_F(Report, UnverifiedPathsAreNotPlotted) {
  campaign_.verify = false;
  for (CampaignCell& cell : cells_)
    for (BenchmarkRun& run : cell.runs) run.verdict.clear(), run.closestFound = -1;
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("<p>Paths were not verified.</p>"));
  EXPECT_THAT(text, Not(HasSubstr("no data")));
}

TEST_F(Report, PlotsHaveTheirData) {
  const Plot solved = solvedOverTime(campaign_, cells_, 1);
  EXPECT_EQ(solved.name, "solved.hall-2");
  // A dashed line is added for each of the two variants with refuted paths.
  ASSERT_EQ(solved.series.size(), 5u);
  EXPECT_EQ(solved.series[0].name, "certified");
  EXPECT_DOUBLE_EQ(solved.series[0].points.back().y, 1);
  EXPECT_EQ(solved.series[1].style, PlotSeries::Style::dashes);
  EXPECT_DOUBLE_EQ(solved.series[1].points.back().y, 1);
  EXPECT_DOUBLE_EQ(solved.series[2].points.back().y, 0.5);
  for (const PlotSeries& s : solved.series)
    for (std::size_t i = 1; i < s.points.size(); ++i) {
      EXPECT_GE(s.points[i].x, s.points[i - 1].x);
      EXPECT_GE(s.points[i].y, s.points[i - 1].y);
    }
  const Plot error = timeAgainstRefuted(campaign_, cells_, 0);
  ASSERT_EQ(error.series.size(), 3u);
  ASSERT_EQ(error.series[1].points.size(), 1u);
  EXPECT_DOUBLE_EQ(error.series[1].points[0].y, 0.5);
  EXPECT_NEAR(error.series[1].points[0].x, 0.275, 1e-12);
  EXPECT_LT(error.series[1].points[0].fromY, 0.5);
  EXPECT_THAT(error.series[1].points[0].text, HasSubstr("5 of 10 paths refuted"));
  // Each planner has a shape of its own.
  std::vector<CampaignCell> two = cells_;
  for (CampaignCell& cell : cells_) {
    two.push_back(cell);
    two.back().planner.label = "another";
  }
  const Plot planners = timeAgainstRefuted(campaign_, two, 0);
  EXPECT_THAT(planners.shapes, testing::ElementsAre(cells_[0].planner.label, "another"));
  ASSERT_EQ(planners.series[2].points.size(), 2u);
  EXPECT_EQ(planners.series[2].points[1].shape, 1u);
  const Plot clear = clearances(campaign_, cells_, 0);
  ASSERT_EQ(clear.series.size(), 3u);
  EXPECT_DOUBLE_EQ(clear.rangeX->first, 0.01);
  // Half of the paths have the distance 0. So at the left end of the axis, the line is at 0.5 or
  // higher.
  double first = 0;
  for (const PlotPoint& p : clear.series[1].points)
    if (p.x <= clear.rangeX->first) first = p.y;
  EXPECT_GE(first, 0.5);
  const Plot cost = predictedCost(campaign_, cells_, scoresOf(campaign_, cells_));
  ASSERT_EQ(cost.series.size(), 4u);
  EXPECT_EQ(cost.series[1].points.size(), 20u);
  for (const PlotPoint& p : cost.series[1].points) EXPECT_NEAR(p.x / p.y, 1, 1e-9);
}

TEST_F(Report, PlotsOfAllProblems) {
  const Plot error = refutedShareOfAll(campaign_, cells_, scoresOf(campaign_, cells_));
  ASSERT_EQ(error.series.size(), 3u);  // in order of variants, not of rank
  EXPECT_EQ(error.series[1].name, "discrete:0.1");
  EXPECT_DOUBLE_EQ(error.series[1].points[0].x, 0.5);
  EXPECT_DOUBLE_EQ(error.series[1].points[0].y, 0.5);
  EXPECT_DOUBLE_EQ(error.series[2].points[0].x, 10);
  EXPECT_DOUBLE_EQ(error.series[2].points[0].y, 0.1);
  for (const VariantScore& score : scoresOf(campaign_, cells_)) {
    const PlotPoint& p = error.series[score.variant].points[0];
    EXPECT_EQ(p.fromX, score.timeRatioInterval.from);
    EXPECT_EQ(p.toX, score.timeRatioInterval.to);
    EXPECT_EQ(p.fromY, score.refutedShare.from);
    EXPECT_EQ(p.toY, score.refutedShare.to);
    EXPECT_LT(error.rangeX->first, p.x);
    EXPECT_GT(error.rangeX->second, p.x);
  }
  // Each problem has ten seeds. With five of them the path of discrete:0.1 is not refuted. With
  // these five, discrete:0.1 is the quickest, and certified takes twice as long. With the other
  // five, certified is the quickest. discrete:0.01 takes 20 or 10 times as long as the quickest,
  // and one of its paths is refuted.
  const Plot profile = profileOfAll(campaign_, cells_);
  ASSERT_EQ(profile.series.size(), 3u);
  const auto at = [&](std::size_t variant, double x) {
    double share = 0;
    for (const PlotPoint& p : profile.series[variant].points)
      if (p.x <= x) share = p.y;
    return share;
  };
  EXPECT_DOUBLE_EQ(profile.rangeX->first, 1);
  EXPECT_DOUBLE_EQ(at(0, 1), 0.5);
  EXPECT_DOUBLE_EQ(at(0, 1.9), 0.5);
  EXPECT_DOUBLE_EQ(at(0, 2.1), 1);
  EXPECT_DOUBLE_EQ(at(1, 1), 0.5);
  EXPECT_DOUBLE_EQ(at(1, 100), 0.5);
  EXPECT_DOUBLE_EQ(at(2, 9), 0);
  EXPECT_DOUBLE_EQ(at(2, 11), 0.4);
  EXPECT_DOUBLE_EQ(at(2, 21), 0.9);
  EXPECT_THAT(profile.title, HasSubstr("the 20 runs that all have made"));
}

/// A variant must not count as the quickest in runs that other variants have not made.
TEST_F(Report, TheProfileUsesRunsOfAllVariants) {
  const auto shareAtOnce = [&](std::size_t variant) {
    const Plot profile = profileOfAll(campaign_, cells_);
    double share = 0;
    for (const PlotPoint& p : profile.series.at(variant).points)
      if (p.x <= 1) share = p.y;
    return share;
  };
  cells_[1].runs.resize(2);  // discrete:0.1, first problem: two runs, both quicker and proved
  cells_[4].runs.clear();    // discrete:0.1, second problem: no run
  EXPECT_DOUBLE_EQ(shareAtOnce(0), 0);
  EXPECT_DOUBLE_EQ(shareAtOnce(1), 1);
  // An undecided path counts as returned, an unsolved run does not; both runs count as made.
  cells_[1].runs[0].verdict = "undecided";
  EXPECT_DOUBLE_EQ(shareAtOnce(1), 1);
  cells_[1].runs[0].solved = false;
  EXPECT_DOUBLE_EQ(shareAtOnce(0), 0.5);
  EXPECT_DOUBLE_EQ(shareAtOnce(1), 0.5);
  cells_[1].runs.clear();
  EXPECT_TRUE(profileOfAll(campaign_, cells_).series.empty());
  EXPECT_THAT(page(), HasSubstr("All problems"));
}

/// Every point is drawn once, whatever its shape, and has a text.
TEST_F(Report, PointsAreDrawnOnce) {
  if (!canPlot()) GTEST_SKIP() << "no gnuplot";
  std::vector<CampaignCell> two = cells_;
  for (CampaignCell& cell : cells_) {
    two.push_back(cell);
    two.back().planner.label = "another";
  }
  const std::string svg = svgOf(timeAgainstRefuted(campaign_, two, 0));
  const auto count = [&](const std::string& word) {
    std::size_t times = 0;
    for (auto at = svg.find(word); at != svg.npos; at = svg.find(word, at + 1)) ++times;
    return times;
  };
  EXPECT_EQ(count("onmousemove"), 6u);
  EXPECT_EQ(count("paths refuted"), 6u + count(">share of paths refuted<"));
}

TEST_F(Report, ManyNamesDoNotShrinkThePlot) {
  if (!canPlot()) GTEST_SKIP() << "no gnuplot";
  const auto height = [&] {
    page();
    const std::string svg = test::contents(folder_ / "plots" / "solved.hall.svg");
    return std::atof(svg.substr(svg.find("viewBox=\"0 0 560 ") + 17, 4).c_str());
  };
  const double few = height();
  EXPECT_GT(few, 300);
  for (Variant& variant : campaign_.variants) variant.name += " of a name that is very long";
  EXPECT_GT(height(), few);
  // A longer name is cut at a boundary of UTF-8 characters.
  campaign_.variants[0].name = std::string(58, 'x') + "ßßßß";
  height();
  const std::string svg = test::contents(folder_ / "plots" / "solved.hall.svg");
  EXPECT_THAT(svg, HasSubstr(">" + std::string(58, 'x') + "…<"));
}

TEST_F(Report, TableCellsMatchTheirHeads) {
  for (CampaignCell& cell : cells_)
    for (BenchmarkRun& run : cell.runs) run.states = 1234, run.edges = 77;
  const std::string table = cellTable(campaign_, cells_, 0);
  EXPECT_THAT(table, HasSubstr("<td>10 of 10</td><td><span class=\"bad\">5 of 10</span></td>"
                               "<td>1,234</td><td>77</td><td>5,500</td><td>305</td>"
                               "<td>4</td><td>3</td>"));
}

TEST_F(Report, TimeAxisEndsAtTheLimit) {
  campaign_.time = 20;
  EXPECT_DOUBLE_EQ(solvedOverTime(campaign_, cells_, 0).rangeX->second,
                   10);  // all runs are quicker than the limit
  cells_[0].runs[0].processorTime = 12;
  EXPECT_DOUBLE_EQ(solvedOverTime(campaign_, cells_, 0).rangeX->second, 20);
  cells_[0].runs[0].processorTime = 30;  // processor time of several threads can exceed the limit
  EXPECT_DOUBLE_EQ(solvedOverTime(campaign_, cells_, 0).rangeX->second, 30);
}

/// The plots of ten problems are in the page, but folded.
TEST_F(Report, FoldsThePlotsOfManyProblems) {
  EXPECT_THAT(page(), Not(HasSubstr("<details>")));
  campaign_.problems.resize(10, campaign_.problems[0]);
  identifyProblems(campaign_);
  cells_ = cellsOf(campaign_);
  for (CampaignCell& cell : cells_) cell.runs.push_back(run(cell, 1));
  EXPECT_THAT(page(), HasSubstr("<summary>Plots of all 10 problems</summary>"));
}

TEST_F(Report, DescribesTheMeasurement) {
  campaign_.planners = {{"short", "RRT", {{{"range", "0.2"}}}},
                        {"KPIECE1", "KPIECE1", {}},
                        {"by OMPL", "RRT", {{}}, Simplifier::ompl}};
  campaign_.simplify = Simplifier::none;
  cells_ = cellsOf(campaign_);
  writeReport(campaign_, cells_, folder_, {{"2026-05-04 03:02:01", "abc", 2, 60}});
  const std::string text = test::contents(folder_ / "report.html");
  for (const char* said :
       {"session of 2026-05-04 03:02:01 UTC</td><td>60 runs, 2 at a time, by commit abc<",
        "planner “short”</td><td>RRT, range: 0.2<", "OMPL 1.5.2", "simplified</td><td>no<",
        "planner “KPIECE1”</td><td>KPIECE1, with the problem’s parameters",
        "RRT, with OMPL’s defaults; simplified: by OMPL’s simplifier<"})
    EXPECT_THAT(text, HasSubstr(said));
}

TEST_F(Report, ProcessorsWithoutANameAreNoFault) {
  for (const char* cpu : {"", "\n", "Model name:", "Model name:  ", "Model name:\nmore"}) {
    cells_[0].runs[0].ompl = onMachine("somewhere", cpu);
    EXPECT_THAT(page(), HasSubstr("machine</td><td>somewhere</td>")) << cpu;
  }
}

TEST_F(Report, ThePageAndItsFiles) {
  const auto files = writeReport(campaign_, cells_, folder_);
  for (const auto& file : files) {
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_GT(std::filesystem::file_size(file), 50u) << file;
  }
  EXPECT_EQ(files.size(), 1 + (canPlot() ? 2u : 1u) * (3 * 2 + 3));
  const std::string text = page();
  EXPECT_THAT(text, HasSubstr("60 runs: 60 returned a path; 12 of 60 verified paths are refuted."));
  EXPECT_THAT(text, Not(HasSubstr("{{")));
  for (const char* outside : {"src=", "http://www.w3.org/1999/xhtml", "https://", "@import"})
    EXPECT_THAT(text, Not(HasSubstr(outside)));
  if (canPlot()) {
    EXPECT_THAT(text, HasSubstr("data-plot=\"error.hall-2\""));
    EXPECT_THAT(text, HasSubstr("data-plot=\"profile\""));
  } else {
    EXPECT_THAT(text, HasSubstr("gnuplot is not installed"));
  }
  // An unfinished campaign is reported as such.
  cells_[0].runs.resize(3);
  EXPECT_THAT(page(), HasSubstr("53 runs of 60 (not finished)"));
}

/// Users choose the names: no name may act as HTML or as gnuplot's syntax.
TEST_F(Report, HostileNames) {
  const std::string evil = "<script>alert('1')</script> \"x\" `id` $0 {/x} \\n & %s";
  campaign_.name = evil;
  campaign_.problemNames[0] = evil;
  campaign_.variants[1].name = evil;
  for (CampaignCell& cell : cells_) cell.planner.label = evil;
  campaign_.planners = {{evil, evil, {{{evil, evil}}}}};
  cells_[0].runs[0].ompl = onMachine(evil, "Model name:  " + evil);
  campaign_.notes = {evil};
  const std::string text = page();
  EXPECT_THAT(text, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(text, HasSubstr("&lt;script&gt;alert"));
  EXPECT_THAT(text, Not(HasSubstr("showHypertext(evt,'<")));
  std::size_t scripts = 0;
  for (auto at = text.find("<script"); at != std::string::npos; at = text.find("<script", at + 1))
    ++scripts;
  EXPECT_EQ(scripts, 1u);
}

/// All clearances are equal: the plot's range must still span a decade.
TEST_F(Report, EqualValuesSpanADecade) {
  for (CampaignCell& cell : cells_)
    for (BenchmarkRun& run : cell.runs) run.closestFound = run.processorTime = 1;
  for (const Plot& plot :
       {clearances(campaign_, cells_, 0), solvedOverTime(campaign_, cells_, 0)}) {
    ASSERT_TRUE(plot.rangeX);
    EXPECT_LE(plot.rangeX->first, 1) << plot.name;
    EXPECT_GE(plot.rangeX->second, 10 * plot.rangeX->first) << plot.name;
    if (canPlot()) {
      EXPECT_THAT(svgOf(plot), HasSubstr("<svg")) << plot.name;
    }
  }
}

TEST_F(Report, NamesThatGiveTheSameFileName) {
  campaign_.problemNames = {"a b", "a-b"};
  const auto files = writeReport(campaign_, cells_, folder_);
  EXPECT_EQ(std::set(files.begin(), files.end()).size(), files.size());
  std::ifstream in(folder_ / "plots" / "clearance.a-b-2.csv");
  EXPECT_TRUE(in.good());
}

/// If gnuplot fails, the report is written without the pictures.
TEST_F(Report, WithoutPictures) {
  if (!canPlot()) GTEST_SKIP() << "no gnuplot";
  writeReport(campaign_, cells_, folder_);
  const auto picture = folder_ / "plots" / "cost.svg";
  ASSERT_TRUE(std::filesystem::exists(picture));
  const auto bin = folder_ / "bin";
  std::filesystem::create_directory(bin);
  std::ofstream(bin / "gnuplot") << "#!/bin/sh\necho 'no <terminal>'; exit 1\n";
  std::filesystem::permissions(bin / "gnuplot", std::filesystem::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (bin.string() + ":" + path).c_str(), 1);
  const std::string text = page();
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(text, HasSubstr("no plot: gnuplot: no &lt;terminal&gt;"));
  EXPECT_THAT(text, HasSubstr("60 runs: 60 returned a path"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "plots" / "cost.csv"));
  EXPECT_FALSE(std::filesystem::exists(picture))
      << "the picture of an earlier report is still there";
  // TMPDIR may contain any characters.
  const auto temporary = folder_ / "it's here";
  std::filesystem::create_directory(temporary);
  const char* const was = std::getenv("TMPDIR");
  const std::string before = was ? was : "";
  ::setenv("TMPDIR", temporary.c_str(), 1);
  EXPECT_THAT(page(), Not(HasSubstr("no plot")));
  if (was)
    ::setenv("TMPDIR", before.c_str(), 1);
  else
    ::unsetenv("TMPDIR");
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
}

/// A user's own gnuplot settings must not change the plots.
TEST_F(Report, IgnoresTheUsersGnuplotSettings) {
  if (!canPlot()) GTEST_SKIP() << "no gnuplot";
  const Plot plot = timeAgainstRefuted(campaign_, cells_, 0);
  const std::string usual = svgOf(plot);
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / ".gnuplot") << "set datafile separator ','\nset key off\n";
  const char* const was = std::getenv("HOME");
  const std::string before = was ? was : "";
  ::setenv("HOME", folder_.c_str(), 1);
  EXPECT_EQ(svgOf(plot), usual);
  if (was)
    ::setenv("HOME", before.c_str(), 1);
  else
    ::unsetenv("HOME");
}

TEST_F(Report, WithoutAnyRun) {
  for (CampaignCell& cell : cells_) cell.runs.clear();
  EXPECT_THAT(page(), HasSubstr("0 runs of 60 (not finished)"));
}

}  // namespace
}  // namespace corridor
