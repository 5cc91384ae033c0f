#include "planner/benchmark/report_plots.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "collision/core/quantiles.h"

namespace corridor {
namespace {

/// The range of axes of shares: slightly more than [0, 1], so that points at the ends are drawn
/// whole.
constexpr std::pair kShares{-0.03, 1.03};
/// Seconds. Smaller times count as this time, so that ratios are finite.
constexpr double kClockTick = 1e-9;

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Calls f(cell) for each planner of a problem and a variant.
void forCells(const std::vector<CampaignCell>& cells, std::size_t problem, std::size_t variant,
              const std::function<void(const CampaignCell&)>& f) {
  for (const CampaignCell& cell : cells)
    if (cell.problem == problem && cell.variant == variant) f(cell);
}

/// Returns a step function that rises by 1/of at each value, over [first, last].
std::vector<PlotPoint> steps(std::vector<double> values, std::size_t of, double first,
                             double last) {
  std::sort(values.begin(), values.end());
  std::vector<PlotPoint> points{{first, 0}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = std::max(values[i], first);
    points.push_back({x, static_cast<double>(i) / static_cast<double>(of)});
    points.push_back({x, static_cast<double>(i + 1) / static_cast<double>(of)});
  }
  points.push_back({std::max(last, points.back().x), points.back().y});
  return points;
}

/// Returns the range of whole decades around the values above 0, at least one decade: gnuplot fails
/// on an empty range.
std::pair<double, double> decades(const std::vector<double>& values) {
  double least = HUGE_VAL, most = 0;
  for (const double v : values)
    if (v > 0) least = std::min(least, v), most = std::max(most, v);
  if (!(most > 0)) return {1e-3, 1};
  const double from = std::floor(std::log10(least)), to = std::ceil(std::log10(most));
  return {std::pow(10, from), std::pow(10, std::max(to, from + 1))};
}

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
  // The time axis ends at the time limit, or at the longest run if that is later, instead of at the
  // next decade.
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
  // Count only runs that every variant has made: otherwise a variant would be the quickest of each
  // run that it alone made.
  const std::size_t variants = campaign.variants.size();
  std::size_t runs = 0;
  std::vector<std::vector<double>> ratios(variants);
  std::vector<double> all;
  for (std::size_t first = 0; first < cells.size(); first += variants)
    for (const BenchmarkRun& any : cells[first].runs) {
      std::vector<const BenchmarkRun*> same;
      for (std::size_t v = 0; v < variants; ++v)
        for (const BenchmarkRun& run : cells[first + v].runs)
          if (run.seed == any.seed) same.push_back(&run);
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
  Plot plot{"profile",
            "All problems, the " + std::to_string(runs) + " runs that every variant has made",
            "processor time, multiples of the quickest variant", "share of runs", true};
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
        if (run.leastDistance >= 0) {
          all[v].push_back(run.leastDistance);
          distances.push_back(run.leastDistance);
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
  std::vector<PlotSeries> series;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    const auto score = std::find_if(scores.begin(), scores.end(),
                                    [&](const VariantScore& s) { return s.variant == v; });
    if (!score->cost) continue;
    PlotSeries of{campaign.variants[v].name, v, PlotSeries::Style::points, {}};
    for (const CampaignCell& cell : cells) {
      if (cell.variant != v) continue;
      for (const BenchmarkRun& run : cell.runs)
        if (const auto cost = checkingCost(run)) {
          const double predicted = 1e-9 * score->cost->model.predicted(*cost);
          both.push_back(predicted), both.push_back(1e-9 * cost->ns);
          PlotPoint point{predicted, 1e-9 * cost->ns};
          point.text = campaign.problemNames[cell.problem] + ", " + cell.planner.label + ", seed " +
                       std::to_string(run.seed) + "\n" + of.name + "\nN_v " +
                       digits(cost->boxTests) + ", N_p " + digits(cost->triangleTests);
          of.points.push_back(std::move(point));
        }
    }
    series.push_back(std::move(of));
  }
  plot.rangeX = plot.rangeY = decades(both);
  const auto [least, most] = *plot.rangeX;
  plot.series.push_back(
      {"as predicted", 6, PlotSeries::Style::dashes, {{least, least}, {most, most}}});
  plot.series.insert(plot.series.end(), series.begin(), series.end());
  return plot;
}

}  // namespace corridor
