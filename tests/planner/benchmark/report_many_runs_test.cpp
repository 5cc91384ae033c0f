// Tests of the report of many runs: curves that are drawn with few steps, and points that stand for
// several runs, are near the exact curves and points; and the page stays small.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/benchmark/comparison.h"
#include "planner/benchmark/report_plots.h"
#include "tests/planner/benchmark/made_campaign.h"

namespace corridor {
namespace {

class ManyRuns : public test::MadeCampaign {};

/// Curves of many runs are drawn with few steps. The drawn curve is compared with the exact one at
/// all values and between them: never above it, less than 1/499 below it, and exact at its own
/// steps.
TEST_F(ManyRuns, CurvesOfManyRunsAreDrawnWithFewSteps) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (const std::size_t runs : {499u, 500u, 501u, 640u, 4000u}) {
    std::lognormal_distribution<double> times(0, 2);
    CampaignCell& cell = cells_[0];
    cell.runs.clear();
    std::vector<double> all;
    for (std::size_t i = 0; i < runs; ++i) {
      BenchmarkRun one = run(cell, i + 1);
      one.verdict = "proved";
      one.closestFound = i % 7 ? times(random) : 0.25;  // some values are equal
      all.push_back(one.closestFound);
      cell.runs.push_back(one);
    }
    std::sort(all.begin(), all.end());
    const std::vector<PlotPoint> points = clearances(campaign_, cells_, 0).series.at(0).points;
    EXPECT_EQ(points.size(), 2 + 2 * std::min<std::size_t>(runs, 500));
    const auto exact = [&](double x) {
      const auto above = std::upper_bound(all.begin(), all.end(), x);
      return static_cast<double>(above - all.begin()) / static_cast<double>(runs);
    };
    const auto drawn = [&](double x) {
      const auto above =
          std::upper_bound(points.begin(), points.end(), x,
                           [](double value, const PlotPoint& p) { return value < p.x; });
      return above == points.begin() ? 0 : std::prev(above)->y;
    };
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      for (const double x : {all[i], 0.5 * (all[i] + all[i + 1])}) {
        EXPECT_LE(drawn(x), exact(x)) << x;
        EXPECT_LT(exact(x) - drawn(x), 1 / 499.0) << x;
        if (runs <= 500) {
          EXPECT_EQ(drawn(x), exact(x)) << x;
        }
      }
    EXPECT_EQ(points.back().y, 1);
    EXPECT_EQ(points[1].x, all.front());
    for (const PlotPoint& p : points) {
      // A step at x rises from `below`, the share of values below x, to exact(x), the share of
      // values up to x.
      const double below =
          static_cast<double>(std::lower_bound(all.begin(), all.end(), p.x) - all.begin()) /
          static_cast<double>(runs);
      EXPECT_LE(p.y, exact(p.x));
      EXPECT_GT(p.y, below - 1 / 499.0);
    }
  }
}

/// With many runs, each point of the plot of costs is at one of the runs, every run is near a point
/// of its variant, and the numbers in the texts add up to all runs.
TEST_F(ManyRuns, PointsStandForTheRunsNearThem) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::lognormal_distribution<double> spread(0, 2), noise(0, 0.5);
  std::size_t runs = 0;
  for (CampaignCell& cell : cells_) {
    cell.runs.clear();
    for (std::uint64_t i = 1; i <= 1500; ++i, ++runs) {
      BenchmarkRun one = run(cell, i);
      one.counters.boxTests = static_cast<std::uint64_t>(1e4 * spread(random)) + 1;
      one.counters.primitiveTests = static_cast<std::uint64_t>(1e3 * spread(random));
      one.checkingTime *= noise(random);
      cell.runs.push_back(one);
    }
  }
  const std::vector<VariantScore> scores = scoresOf(campaign_, cells_);
  const Plot plot = predictedCost(campaign_, cells_, scores);
  ASSERT_EQ(plot.series.size(), 4u);
  std::size_t points = 0, counted = 0;
  const auto at = plot.title.find(" runs, on a grid of ");
  ASSERT_NE(at, std::string::npos) << plot.title;
  const double grid = std::stod(plot.title.substr(at + 20));
  EXPECT_GE(grid, 32) << "a grid of 32 × 32 has at most 3 · 1024 points";
  // Rounding of the logarithms: far below 1e-9 of a cell.
  const double axis = (1 + 1e-9) * std::log(plot.rangeX->second / plot.rangeX->first);
  for (std::size_t v = 0; v < 3; ++v) {
    const std::vector<PlotPoint>& of = plot.series[v + 1].points;
    points += of.size();
    std::set<std::pair<double, double>> all;
    const auto& score = *std::find_if(scores.begin(), scores.end(),
                                      [&](const VariantScore& s) { return s.variant == v; });
    for (const CampaignCell& cell : cells_) {
      if (cell.variant != v) continue;
      for (const BenchmarkRun& one : cell.runs) {
        const QueryCost cost = *checkingCost(one);
        const double x = 1e-9 * score.cost->model.predicted(cost), y = 1e-9 * cost.ns;
        all.insert({x, y});
        const bool near = std::any_of(of.begin(), of.end(), [&](const PlotPoint& p) {
          return std::abs(std::log(p.x / x)) <= axis / grid &&
                 std::abs(std::log(p.y / y)) <= axis / grid;
        });
        EXPECT_TRUE(near) << x << " " << y;
      }
    }
    for (const PlotPoint& p : of) {
      EXPECT_TRUE(all.count({p.x, p.y})) << p.text;
      const auto more = p.text.find("\nand ");
      counted += 1 + (more == p.text.npos ? 0 : std::stoul(p.text.substr(more + 5)));
    }
  }
  EXPECT_EQ(counted, runs);
  EXPECT_LE(points, 4000u);
  EXPECT_GT(points, 100u);
  EXPECT_EQ(plot.title.substr(0, at),
            "All problems, " + std::to_string(points) + " points for " + std::to_string(runs));
}

/// The size of the page depends on its plots, not on the number of runs: a curve has at most 1002
/// points, of at most 16 bytes in the SVG; the plot of costs has 4000 points; and a plot without
/// data has less than 25 kB. Plots that are folded, or large, are no elements of the page.
TEST_F(ManyRuns, ManyRunsMakeNoLargePage) {
  if (!canPlot()) GTEST_SKIP() << "no gnuplot";
  campaign_.problems.resize(9, campaign_.problems[0]);
  campaign_.runs = 700;
  identifyProblems(campaign_);
  cells_ = cellsOf(campaign_);
  std::mt19937 random(1);
  std::lognormal_distribution<double> spread(0, 2);
  for (CampaignCell& cell : cells_)
    for (std::uint64_t seed = 1; seed <= campaign_.runs; ++seed) {
      cell.runs.push_back(run(cell, seed));
      cell.runs.back().processorTime = spread(random);
      cell.runs.back().counters.boxTests = static_cast<std::uint64_t>(1e5 * spread(random));
    }
  const std::string text = page();
  std::size_t all = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "plots")) {
    if (entry.path().extension() != ".svg") continue;
    const bool isCost = entry.path().stem() == "cost";
    EXPECT_LT(entry.file_size(), 25'000 + (isCost ? 4000 * 700 : 6 * 1002 * 16)) << entry.path();
    all += entry.file_size();
  }
  EXPECT_GT(std::filesystem::file_size(folder_ / "plots" / "cost.svg"), 200'000u);
  EXPECT_LT(text.size(), all + 100'000);
  const auto count = [&](const std::string& word) {
    std::size_t times = 0;
    for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++times;
    return times;
  };
  EXPECT_EQ(count("<script type=\"text/plain\"><svg"), 9 * 3 + 1u);
  EXPECT_EQ(count("<svg"), 9 * 3 + 3u);
  EXPECT_EQ(count("</script>"), 9 * 3 + 2u);
}

}  // namespace
}  // namespace corridor
