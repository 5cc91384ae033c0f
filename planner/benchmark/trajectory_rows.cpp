#include "planner/benchmark/trajectory_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/quantiles.h"

namespace corridor {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

RowValue orNothing(double value) {
  return std::isnan(value) ? RowValue{} : RowValue{value};
}

RowValue wordOrNothing(const std::string& text) {
  return text.empty() ? RowValue{} : RowValue{text};
}

/// Returns a share of a limit, or nothing if the share is −1 (see TrajectoryRun).
RowValue shareOrNothing(double share) {
  return share < 0 ? RowValue{} : RowValue{share};
}

std::string setPrefix(const CampaignLimits& limits) {
  return limits.name.empty() ? "" : limits.name + "_";
}

/// Calls visit(set, maker) for the indices of each set of limits and each maker.
template <class Visit>
void forEachMaker(const CampaignTrajectories& trajectories, Visit visit) {
  for (std::size_t set = 0; set < trajectories.limits.size(); ++set)
    for (std::size_t maker = 0; maker < trajectories.makers.size(); ++maker) visit(set, maker);
}

/// Returns the entry for a set and a maker in a run, or null if the run does not have it.
const TrajectoryRun* trajectoryOf(const BenchmarkRun& run, std::size_t set, std::size_t maker) {
  if (set >= run.trajectories.size() || maker >= run.trajectories[set].makers.size())
    return nullptr;
  return &run.trajectories[set].makers[maker];
}

/// Returns `TrajectoryScore::saved` for one trajectory with this duration. Returns NaN if stopping
/// costs at most a thousandth of the optimum, or there is no trajectory by the maker `stop`.
double savedBy(const CampaignTrajectories& trajectories, const BenchmarkRun& run, std::size_t set,
               double duration) {
  const auto stop =
      std::find(trajectories.makers.begin(), trajectories.makers.end(), TrajectoryMaker::stop);
  if (stop == trajectories.makers.end()) return kNoNumber;
  const TrajectoryRun* stopping =
      trajectoryOf(run, set, static_cast<std::size_t>(stop - trajectories.makers.begin()));
  const double optimum = run.trajectories[set].optimum;
  if (!stopping || !stopping->fault.empty() || !(optimum > 0) ||
      !(stopping->duration > 1.001 * optimum))
    return kNoNumber;
  return (stopping->duration - duration) / (stopping->duration - optimum);
}

void widen(double& largest, double share) {
  if (share >= 0) largest = std::isnan(largest) ? share : std::max(largest, share);
}

bool withinLimits(const TrajectoryRun& run) {
  return std::max({run.velocity, run.acceleration, run.jerk, run.link}) <= 1 + kLimitSlack &&
         run.beyondBounds <= kLimitSlack;
}

/// Appends the columns of a score; each name begins with the prefix.
void addScore(const TrajectoryScore& score, const std::string& prefix, Row& row) {
  const auto count = [&](const char* name, std::size_t value) {
    row.emplace_back(prefix + name, std::uint64_t{value});
  };
  const auto number = [&](const char* name, double value) {
    row.emplace_back(prefix + name, orNothing(value));
  };
  count("made", score.made);
  count("proved", score.proved);
  count("refuted", score.refuted);
  count("undecided", score.undecided);
  count("refuted_of_proved", score.refutedOfProved);
  count("within_limits", score.withinLimits);
  number("duration_s", score.duration);
  number("over_optimum", score.overOptimum);
  number("saved", score.saved);
  number("rows", score.rows);
  number("velocity", score.velocity);
  number("acceleration", score.acceleration);
  number("jerk", score.jerk);
  number("link_speed", score.link);
  number("make_s", score.makeTime);
  number("verify_s", score.verifyTime);
}

}  // namespace

std::string trajectoryPrefix(const CampaignTrajectories& trajectories, std::size_t set,
                             std::size_t maker) {
  return setPrefix(trajectories.limits[set]) + nameOf(trajectories.makers[maker]) + "_";
}

TrajectoryScore scoreOf(const CampaignTrajectories& trajectories,
                        const std::vector<const BenchmarkRun*>& runs, std::size_t set,
                        std::size_t maker) {
  TrajectoryScore score;
  std::vector<double> durations, makeTimes, verifyTimes, rows, ratios, saved;
  score.velocity = score.acceleration = score.jerk = score.link = kNoNumber;
  for (const BenchmarkRun* run : runs) {
    if (!run->solved) continue;
    ++score.paths;
    const bool proved = run->verdict == "proved";
    score.provedPaths += proved;
    const TrajectoryRun* one = trajectoryOf(*run, set, maker);
    if (!one || !one->fault.empty()) continue;
    ++score.made;
    score.proved += one->verdict == "proved";
    score.refuted += one->verdict == "refuted";
    score.undecided += one->verdict == "undecided";
    score.refutedOfProved += proved && one->verdict == "refuted";
    score.withinLimits += withinLimits(*one);
    durations.push_back(one->duration);
    makeTimes.push_back(one->makeTime);
    verifyTimes.push_back(one->verifyTime);
    rows.push_back(static_cast<double>(one->rows));
    if (const double optimum = run->trajectories[set].optimum; optimum > 0)
      ratios.push_back(one->duration / optimum);
    if (const double share = savedBy(trajectories, *run, set, one->duration); !std::isnan(share))
      saved.push_back(share);
    widen(score.velocity, one->velocity);
    widen(score.acceleration, one->acceleration);
    widen(score.jerk, one->jerk);
    widen(score.link, one->link);
  }
  score.refutedShare = shareInterval(score.refuted, score.made);
  score.duration = medianOf(durations);
  score.makeTime = medianOf(makeTimes);
  score.verifyTime = medianOf(verifyTimes);
  score.rows = medianOf(rows);
  score.overOptimum = medianOf(ratios);
  score.saved = medianOf(saved);
  return score;
}

TrajectoryScore scoreOf(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                        std::size_t variant, std::size_t set, std::size_t maker) {
  std::vector<const BenchmarkRun*> runs;
  for (const CampaignCell& cell : cells)
    if (cell.variant == variant)
      for (const BenchmarkRun& run : cell.runs) runs.push_back(&run);
  return scoreOf(campaign.trajectories, runs, set, maker);
}

void addTrajectories(const Campaign& campaign, const BenchmarkRun& run, Row& row) {
  const CampaignTrajectories& all = campaign.trajectories;
  std::size_t last = all.limits.size();  // the set of the previous call
  forEachMaker(all, [&](std::size_t set, std::size_t maker) {
    if (set != last) {
      const double optimum = set < run.trajectories.size() ? run.trajectories[set].optimum : 0;
      row.emplace_back(setPrefix(all.limits[set]) + "optimum_s",
                       optimum > 0 ? RowValue{optimum} : RowValue{});
      last = set;
    }
    const TrajectoryRun* one = trajectoryOf(run, set, maker);
    const bool made = one && one->fault.empty();
    const std::string prefix = trajectoryPrefix(all, set, maker);
    const auto add = [&](const char* name, RowValue value) {
      row.emplace_back(prefix + name, made ? std::move(value) : RowValue{});
    };
    const TrajectoryRun none;
    const TrajectoryRun& of = one ? *one : none;
    add("verdict", wordOrNothing(of.verdict));
    add("duration_s", of.duration);
    add("rows", std::uint64_t{of.rows});
    add("velocity", shareOrNothing(of.velocity));
    add("acceleration", shareOrNothing(of.acceleration));
    add("jerk", shareOrNothing(of.jerk));
    add("link_speed", shareOrNothing(of.link));
    add("beyond_bounds", of.beyondBounds);
    add("make_s", of.makeTime);
    add("verify_s", of.verifyTime);
    row.emplace_back(prefix + "finding", wordOrNothing(made ? of.finding : of.fault));
  });
}

void addTrajectories(const Campaign& campaign, const CampaignCell& cell, Row& row) {
  const CampaignTrajectories& all = campaign.trajectories;
  std::vector<const BenchmarkRun*> runs;
  for (const BenchmarkRun& run : cell.runs) runs.push_back(&run);
  forEachMaker(all, [&](std::size_t set, std::size_t maker) {
    addScore(scoreOf(all, runs, set, maker), trajectoryPrefix(all, set, maker), row);
  });
}

std::vector<Row> trajectoryRows(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  const CampaignTrajectories& all = campaign.trajectories;
  std::vector<Row> rows;
  for (std::size_t variant = 0; variant < campaign.variants.size(); ++variant)
    forEachMaker(all, [&](std::size_t set, std::size_t maker) {
      Row row{{"variant", campaign.variants[variant].name},
              {"limits", wordOrNothing(all.limits[set].name)},
              {"trajectory", std::string(nameOf(all.makers[maker]))}};
      addScore(scoreOf(campaign, cells, variant, set, maker), "", row);
      rows.push_back(std::move(row));
    });
  return rows;
}

}  // namespace corridor
