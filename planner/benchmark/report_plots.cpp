#include "planner/benchmark/report_plots.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "collision/core/quantiles.h"

namespace corridor {
namespace {

/// The range of axes that show shares: slightly more than [0, 1], so that points at 0 and 1 are not
/// cut off.
constexpr std::pair kShares{-0.03, 1.03};
/// Seconds. Smaller times count as this time, so that ratios are finite.
constexpr double kClockTick = 1e-9;

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Calls f(cell) for each cell of a problem and a variant: one for each planner.
void forCells(const std::vector<CampaignCell>& cells, std::size_t problem, std::size_t variant,
              const std::function<void(const CampaignCell&)>& f) {
  for (const CampaignCell& cell : cells)
    if (cell.problem == problem && cell.variant == variant) f(cell);
}

/// The largest number of steps of a curve. A curve of n > kMostSteps values has kMostSteps of its n
/// steps, the first and the last among them. Each drawn step rises to the right height, so the
/// curve is never too high. Between two successive drawn steps, fewer than (n − 1)/(kMostSteps − 1)
/// steps are missing, so the curve is too low by less than 1/499. gnuplot draws a share of 1 at a
/// height of 195 units (`heightOf` in report.cpp), and the page scales plots by at most 1.32 (a
/// single plot has 738 pixels for 560 units). So the error is at most 0.52 pixels.
constexpr std::size_t kMostSteps = 500;

/// Returns a step function on [first, last] that rises by 1/`of` at each value, starting from 0.
/// Values below `first` count as `first`. With more than kMostSteps values, only some of the steps
/// are drawn. Each drawn step rises to the height that counts all values up to this step.
std::vector<PlotPoint> steps(std::vector<double> values, std::size_t of, double first,
                             double last) {
  std::sort(values.begin(), values.end());
  std::vector<PlotPoint> points{{first, 0}};
  const std::size_t n = values.size(), drawn = std::min(n, kMostSteps);
  std::size_t reached = 0;  // number of values counted so far
  for (std::size_t i = 0; i < drawn; ++i) {
    const std::size_t rank = drawn > 1 ? i * (n - 1) / (drawn - 1) : 0;
    const double x = std::max(values[rank], first);
    points.push_back({x, static_cast<double>(reached) / static_cast<double>(of)});
    reached = rank + 1;
    points.push_back({x, static_cast<double>(reached) / static_cast<double>(of)});
  }
  points.push_back({std::max(last, points.back().x), points.back().y});
  return points;
}

/// Returns the smallest range of whole decades that contains all values above 0. It has at least
/// one decade, because gnuplot fails on an empty range.
std::pair<double, double> decades(const std::vector<double>& values) {
  double least = HUGE_VAL, most = 0;
  for (const double v : values)
    if (v > 0) least = std::min(least, v), most = std::max(most, v);
  if (!(most > 0)) return {1e-3, 1};
  const double from = std::floor(std::log10(least)), to = std::ceil(std::log10(most));
  return {std::pow(10, from), std::pow(10, std::max(to, from + 1))};
}

/// A run in the plot of costs; times in seconds.
struct CostPoint {
  std::size_t variant;
  const CampaignCell& cell;
  const BenchmarkRun& run;
  double predicted, measured;
};

/// Calls f(point) for each run whose cost is known, in order of variants.
void forCosts(const Campaign& campaign, const std::vector<CampaignCell>& cells,
              const std::vector<VariantScore>& scores,
              const std::function<void(const CostPoint&)>& f) {
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    const auto score = std::find_if(scores.begin(), scores.end(),
                                    [&](const VariantScore& s) { return s.variant == v; });
    if (!score->cost) continue;
    for (const CampaignCell& cell : cells) {
      if (cell.variant != v) continue;
      for (const BenchmarkRun& run : cell.runs)
        if (const auto cost = checkingCost(run))
          f({v, cell, run, 1e-9 * score->cost->model.predicted(*cost), 1e-9 * cost->ns});
    }
  }
}

/// With up to kMostPoints runs, the plot of costs has a point per run. If there are more runs, it
/// has one point for each variant and each cell of a grid that contains runs of this variant. The
/// point is at the first of these runs, and its text contains the number of the others. The finest
/// grid has 128 cells along an axis. The axes have 426 and 194 units, so a run is less than 3.4 and
/// 1.6 units from its point, whose radius is 3.4. If there are still too many points, the grid is
/// coarser; the title says how fine it is.
constexpr std::size_t kMostPoints = 4000, kFinestGrid = 128;

/// The points of the plot of costs, one series for each variant.
struct CostGrid {
  const Campaign& campaign;
  std::pair<double, double> range;  ///< of both axes
  std::size_t cells;                ///< along an axis; 0: a point per run
  std::vector<PlotSeries> series;

  std::size_t points() const {
    std::size_t sum = 0;
    for (const PlotSeries& s : series) sum += s.points.size();
    return sum;
  }
  void fill(const std::vector<CampaignCell>& of, const std::vector<VariantScore>& scores) {
    series.clear();
    std::map<std::pair<std::size_t, std::size_t>, std::pair<std::size_t, std::size_t>> taken;
    const auto endSeries = [&] {
      for (const auto& [place, point] : taken)
        if (const auto [index, runs] = point; runs > 1)
          series.back().points[index].text +=
              "\nand " + std::to_string(runs - 1) + (runs == 2 ? " more run" : " more runs");
      taken.clear();
    };
    forCosts(campaign, of, scores, [&](const CostPoint& p) {
      const std::string& name = campaign.variants[p.variant].name;
      if (series.empty() || series.back().color != p.variant) {
        endSeries();
        series.push_back({name, p.variant, PlotSeries::Style::points, {}});
      }
      auto& points = series.back().points;
      if (cells > 0) {
        const auto [point, isNew] =
            taken.try_emplace({along(p.predicted), along(p.measured)}, points.size(), 0);
        ++point->second.second;
        if (!isNew) return;
      }
      points.push_back({p.predicted, p.measured});
      points.back().text = campaign.problemNames[p.cell.problem] + ", " + p.cell.planner.label +
                           ", seed " + std::to_string(p.run.seed) + "\n" + name + "\nN_v " +
                           digits(static_cast<double>(p.run.counters.boxTests)) + ", N_p " +
                           digits(static_cast<double>(p.run.counters.primitiveTests));
    });
    endSeries();
  }

 private:
  /// Returns the index, from 1, of a value's grid cell along an axis. The axis is logarithmic, so
  /// the index is 0 for values that are not above 0.
  std::size_t along(double value) const {
    if (!(value > 0)) return 0;
    const double share = std::log(value / range.first) / std::log(range.second / range.first);
    return 1 + static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(cells));
  }
};

}  // namespace

Plot solvedOverTime(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                    std::size_t problem) {
  const std::string& name = campaign.problemNames[problem];
  Plot plot{"solved." + name, name, "processor time, s", "share of runs", true};
  plot.rangeY = {0, 1.02};
  struct Times {
    std::vector<double> solved, held;
    std::size_t runs = 0;
  };
  std::vector<Times> all(campaign.variants.size());
  std::vector<double> times;
  for (std::size_t v = 0; v < all.size(); ++v)
    forCells(cells, problem, v, [&](const CampaignCell& cell) {
      all[v].runs += cell.runs.size();
      for (const BenchmarkRun& run : cell.runs) {
        if (!run.solved) continue;
        times.push_back(run.processorTime);
        all[v].solved.push_back(run.processorTime);
        if (run.verdict != "refuted") all[v].held.push_back(run.processorTime);
      }
    });
  plot.rangeX = decades(times);
  // The time axis does not end at a whole decade, but at the time limit, or at the longest run if
  // this is later.
  if (!times.empty()) {
    const double limit = campaign.time.value_or(campaign.problems[problem].settings.planner.time);
    const double most = std::max(limit, *std::max_element(times.begin(), times.end()));
    if (most > 2 * plot.rangeX->first) plot.rangeX->second = std::min(plot.rangeX->second, most);
  }
  for (std::size_t v = 0; v < all.size(); ++v) {
    if (all[v].runs == 0) continue;
    const auto [first, last] = *plot.rangeX;
    if (all[v].held.size() < all[v].solved.size())
      plot.series.push_back(
          {"", v, PlotSeries::Style::dashes, steps(all[v].solved, all[v].runs, first, last)});
    plot.series.push_back({campaign.variants[v].name, v, PlotSeries::Style::line,
                           steps(all[v].held, all[v].runs, first, last)});
  }
  return plot;
}

Plot timeAgainstRefuted(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                        std::size_t problem) {
  const std::string& name = campaign.problemNames[problem];
  Plot plot{"error." + name, name, "median processor time, s", "share of paths refuted", true};
  plot.rangeY = kShares;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    PlotSeries series{campaign.variants[v].name, v, PlotSeries::Style::points, {}};
    std::size_t planner = 0;
    forCells(cells, problem, v, [&](const CampaignCell& cell) {
      const std::size_t shape = planner++;
      if (v == 0) plot.shapes.push_back(cell.planner.label);
      std::vector<double> times;
      std::size_t judged = 0, refuted = 0;
      for (const BenchmarkRun& run : cell.runs) {
        if (run.solved) times.push_back(run.processorTime);
        judged += !run.verdict.empty();
        refuted += run.verdict == "refuted";
      }
      if (judged == 0) return;
      const Interval time = medianInterval(times), share = shareInterval(refuted, judged);
      const double y = static_cast<double>(refuted) / static_cast<double>(judged);
      series.points.push_back({medianOf(times), y, time.from, time.to, share.from, share.to,
                               campaign.variants[v].name + ", " + cell.planner.label + "\n" +
                                   std::to_string(refuted) + " of " + std::to_string(judged) +
                                   " paths refuted\n" + digits(medianOf(times)) + " s (median)",
                               shape});
    });
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot refutedShareOfAll(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                       const std::vector<VariantScore>& scores) {
  Plot plot{"error", "All problems",
            "processor time, multiples of " + campaign.variants[referenceVariant(cells)].name,
            "share of paths refuted", true};
  plot.rangeY = kShares;
  double least = 1, most = 1;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    const VariantScore& s = *std::find_if(scores.begin(), scores.end(),
                                          [&](const VariantScore& of) { return of.variant == v; });
    if (s.judged() == 0 || s.pairs == 0) continue;
    for (const double x : {s.timeRatio, s.timeRatioInterval.from, s.timeRatioInterval.to})
      if (std::isfinite(x) && x > 0) least = std::min(least, x), most = std::max(most, x);
    const double y = static_cast<double>(s.refuted) / static_cast<double>(s.judged());
    const std::string& name = campaign.variants[v].name;
    plot.series.push_back(
        {name,
         v,
         PlotSeries::Style::points,
         {{s.timeRatio, y, s.timeRatioInterval.from, s.timeRatioInterval.to, s.refutedShare.from,
           s.refutedShare.to,
           name + "\n" + std::to_string(s.refuted) + " of " + std::to_string(s.judged()) +
               " paths refuted\n" + digits(s.timeRatio) + " times the time"}}});
  }
  plot.rangeX = {least / 1.5, most * 1.5};  // keeps points off the axes
  return plot;
}

Plot profileOfAll(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  // Count only the combinations of problem, planner and seed that every variant has run. A variant
  // would otherwise be the quickest wherever it is the only one.
  const std::size_t variants = campaign.variants.size();
  std::size_t runs = 0;
  std::vector<std::vector<double>> ratios(variants);
  std::vector<double> all;
  for (std::size_t first = 0; first < cells.size(); first += variants) {
    std::vector<std::size_t> at(variants, 0);  // the runs of a cell are ordered by seed
    for (const BenchmarkRun& any : cells[first].runs) {
      std::vector<const BenchmarkRun*> same;
      for (std::size_t v = 0; v < variants; ++v) {
        const std::vector<BenchmarkRun>& of = cells[first + v].runs;
        while (at[v] < of.size() && of[at[v]].seed < any.seed) ++at[v];
        if (at[v] < of.size() && of[at[v]].seed == any.seed) same.push_back(&of[at[v]]);
      }
      if (same.size() < variants) continue;
      ++runs;
      const auto holds = [](const BenchmarkRun& r) { return r.solved && r.verdict != "refuted"; };
      const auto time = [](const BenchmarkRun& r) { return std::max(r.processorTime, kClockTick); };
      double best = HUGE_VAL;
      for (const BenchmarkRun* run : same)
        if (holds(*run)) best = std::min(best, time(*run));
      for (std::size_t v = 0; v < variants; ++v)
        if (holds(*same[v])) {
          ratios[v].push_back(time(*same[v]) / best);
          all.push_back(ratios[v].back());
        }
    }
  }
  Plot plot{"profile", "All problems, the " + std::to_string(runs) + " runs that all have made",
            "processor time, multiples of the quickest", "share of runs", true};
  plot.rangeX = {1, std::max(10.0, decades(all).second)};
  plot.rangeY = {0, 1.02};
  for (std::size_t v = 0; v < variants && runs > 0; ++v)
    plot.series.push_back({campaign.variants[v].name, v, PlotSeries::Style::line,
                           steps(ratios[v], runs, 1, plot.rangeX->second)});
  return plot;
}

Plot clearances(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                std::size_t problem) {
  const std::string& name = campaign.problemNames[problem];
  Plot plot{"clearance." + name, name, "least distance of the path, m", "share of paths", true};
  plot.rangeY = {0, 1.02};
  std::vector<std::vector<double>> all(campaign.variants.size());
  std::vector<double> distances;
  for (std::size_t v = 0; v < all.size(); ++v)
    forCells(cells, problem, v, [&](const CampaignCell& cell) {
      for (const BenchmarkRun& run : cell.runs)
        if (run.closestFound >= 0) {
          all[v].push_back(run.closestFound);
          distances.push_back(run.closestFound);
        }
    });
  plot.rangeX = decades(distances);
  for (std::size_t v = 0; v < all.size(); ++v)
    if (!all[v].empty())
      plot.series.push_back(
          {campaign.variants[v].name, v, PlotSeries::Style::line,
           steps(all[v], all[v].size(), plot.rangeX->first, plot.rangeX->second)});
  return plot;
}

Plot predictedCost(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                   const std::vector<VariantScore>& scores) {
  Plot plot{"cost",
            "All problems, one point per run",
            "predicted, Nᵥ·Cᵥ + Nₚ·Cₚ, s",
            "time spent in checking, s",
            true,
            true};
  std::vector<double> both;
  forCosts(campaign, cells, scores,
           [&](const CostPoint& p) { both.push_back(p.predicted), both.push_back(p.measured); });
  plot.rangeX = plot.rangeY = decades(both);
  const auto [least, most] = *plot.rangeX;
  plot.series.push_back(
      {"as predicted", 6, PlotSeries::Style::dashes, {{least, least}, {most, most}}});
  const std::size_t runs = both.size() / 2;
  CostGrid grid{campaign, *plot.rangeX, runs <= kMostPoints ? 0 : kFinestGrid, {}};
  grid.fill(cells, scores);
  while (grid.points() > kMostPoints && grid.cells > 1) {
    grid.cells /= 2;
    grid.fill(cells, scores);
  }
  if (grid.cells > 0)
    plot.title = "All problems, " + std::to_string(grid.points()) + " points for " +
                 std::to_string(runs) + " runs, on a grid of " + std::to_string(grid.cells) +
                 " × " + std::to_string(grid.cells);
  for (PlotSeries& series : grid.series) plot.series.push_back(std::move(series));
  return plot;
}

}  // namespace corridor
