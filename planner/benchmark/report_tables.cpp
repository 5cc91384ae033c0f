#include "planner/benchmark/report_tables.h"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <set>

#include "collision/core/quantiles.h"
#include "planner/benchmark/build_commit.h"
#include "planner/benchmark/ompl_database.h"
#include "planner/benchmark/plot.h"
#include "planner/benchmark/trajectory_rows.h"
#include "planner/view/page_text.h"

namespace corridor {
namespace {

using view::escapedHtml;

/// Returns a number with three significant digits. Numbers from 1000 on are rounded to whole
/// numbers, with their digits in groups of three.
std::string threeDigits(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return "∞";
  char text[64];
  const bool large = std::abs(value) >= 999.5;
  std::snprintf(text, sizeof text, large ? "%.0f" : "%.3g", value);
  std::string all = text;
  for (auto at = static_cast<std::ptrdiff_t>(all.size()) - 3; large && at > (value < 0); at -= 3)
    all.insert(static_cast<std::size_t>(at), 1, ',');
  return all;
}
std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", 100 * share);
  return text;
}
std::string small(const std::string& text) {
  return " <small>" + text + "</small>";
}
std::string interval(const Interval& of, std::string (*text)(double)) {
  return std::isinf(of.from) && of.from < 0 ? small("[0, ∞]")
                                            : small("[" + text(of.from) + ", " + text(of.to) + "]");
}
std::string count(std::size_t hits, std::size_t of) {
  return std::to_string(hits) + " of " + std::to_string(of);
}
/// Returns the text on refuted paths: `hits` of `judged`. It has the style `bad` if at least one
/// path is refuted.
std::string refuted(std::size_t hits, std::size_t judged) {
  if (judged == 0) return "–";
  return std::string("<span class=\"") + (hits ? "bad" : "good") + "\">" + count(hits, judged) +
         "</span>";
}

class Table {
 public:
  explicit Table(const std::vector<std::string>& heads, const std::string& kind = "") {
    text_ = "<div class=\"scroll " + kind + "\"><table>";
    for (const std::string& head : heads)
      text_ += (&head == &heads.front() ? "<thead><tr><th>" : "<th>") + head + "</th>";
    text_ += std::string(heads.empty() ? "" : "</tr></thead>") + "<tbody>\n";
  }
  void row(const std::vector<std::string>& cells) {
    text_ += "<tr>";
    for (const std::string& cell : cells) text_ += "<td>" + cell + "</td>";
    text_ += "</tr>\n";
  }
  std::string html() const { return text_ + "</tbody></table></div>\n"; }

 private:
  std::string text_;
};

std::vector<std::string> cellRow(const Campaign& campaign, const CampaignCell& cell) {
  std::vector<double> times, states, edges, boxes, triangles, raw, length;
  std::size_t judged = 0, refutedPaths = 0;
  for (const BenchmarkRun& run : cell.runs) {
    judged += !run.verdict.empty();
    refutedPaths += run.verdict == "refuted";
    if (!run.solved) continue;
    times.push_back(run.processorTime);
    states.push_back(static_cast<double>(run.states));
    edges.push_back(static_cast<double>(run.edges));
    boxes.push_back(static_cast<double>(run.counters.boxTests));
    triangles.push_back(static_cast<double>(run.counters.primitiveTests));
    // Metres, or radians if the path has no length in metres.
    const bool metres = run.rawLength.metres > 0;
    raw.push_back(metres ? run.rawLength.metres : run.rawLength.radians);
    length.push_back(metres ? run.length.metres : run.length.radians);
  }
  const bool competes = campaign.variants[cell.variant].competitor.has_value();
  const auto median = [](const std::vector<double>& of) { return threeDigits(medianOf(of)); };
  return {escapedHtml(cell.planner.label),
          variantHtml(campaign, cell.variant),
          median(times) + (times.empty() ? "" : interval(medianInterval(times), threeDigits)),
          count(times.size(), cell.runs.size()),
          refuted(refutedPaths, judged),
          median(states),
          median(edges),
          competes ? "–" : median(boxes),
          competes ? "–" : median(triangles),
          median(raw),
          median(length)};
}

std::string checkerText(const Variant& variant) {
  std::string text;
  for (const YamlValue::Entry& entry : variant.checker.entries)
    text += (text.empty() ? "" : ", ") + entry.key + ": " + entry.value.text;
  if (variant.competitor) text += ", peer: " + variant.competitor->name;
  return text.empty() ? "each problem’s own" : text;
}
/// Returns the value of "Model name:" in the output of `lscpu`, or the first line of the output.
std::string processorOf(const std::string& cpu) {
  const std::string key = "Model name:";
  const auto at = cpu.find(key);
  if (at == std::string::npos) return cpu.substr(0, cpu.find('\n'));
  const auto begin = cpu.find_first_not_of(" \t", at + key.size());
  return begin == std::string::npos ? "" : cpu.substr(begin, cpu.find('\n', begin) - begin);
}

std::string simplifierText(Simplifier simplifier) {
  switch (simplifier) {
    case Simplifier::none:
      return "no";
    case Simplifier::corridor:
      return "yes";
    case Simplifier::ompl:
      return "by OMPL’s simplifier";
  }
  return "";
}

std::string plannerText(const CampaignPlanner& planner) {
  std::string text = planner.name;
  if (!planner.params) {
    text += ", with the problem’s parameters where the problem names this planner";
  } else {
    for (const auto& [key, value] : *planner.params) text += ", " + key + ": " + value;
    if (planner.params->empty()) text += ", with OMPL’s defaults";
  }
  return planner.simplify ? text + "; simplified: " + simplifierText(*planner.simplify) : text;
}
std::string competitorVersions(const Campaign& campaign) {
  std::string text;
  for (const Variant& variant : campaign.variants)
    if (variant.competitor && !variant.competitor->version.empty() &&
        text.find(variant.competitor->version) == std::string::npos)
      text += "; " + variant.competitor->version;
  return text;
}

}  // namespace

std::string variantHtml(const Campaign& campaign, std::size_t variant) {
  return "<i class=\"swatch\" style=\"background:" + plotColor(variant) + "\"></i>" +
         escapedHtml(campaign.variants[variant].name);
}

std::string rankingTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                         const std::vector<VariantScore>& scores) {
  const std::size_t reference = referenceVariant(cells);
  Table table({campaign.planners.size() > 1 ? "planner, variant" : "variant", "refuted",
               "share refuted", "solved", "time", "share of checking", "length left"});
  for (const VariantScore& s : scores) {
    const double share =
        s.judged() ? static_cast<double>(s.refuted) / static_cast<double>(s.judged()) : NAN;
    table.row({variantHtml(campaign, s.variant), refuted(s.refuted, s.judged()),
               s.judged() ? percent(share) + interval(s.refutedShare, percent) : "–",
               count(s.solved, s.runs) + interval(s.solvedShare, percent),
               threeDigits(s.timeRatio) + (s.variant == reference || s.pairs == 0
                                               ? ""
                                               : interval(s.timeRatioInterval, threeDigits)),
               std::isnan(s.checkingShare) ? "–" : percent(s.checkingShare),
               std::isnan(s.lengthRatio) ? "–" : percent(s.lengthRatio)});
  }
  return table.html();
}
std::string costTable(const Campaign& campaign, const std::vector<VariantScore>& scores) {
  Table table({"variant", "C<sub>v</sub>, ns", "C<sub>p</sub>, ns", "5 %", "median", "95 %"});
  for (const VariantScore& s : scores)
    if (s.cost)
      table.row({variantHtml(campaign, s.variant),
                 s.cost->model.boxKnown ? threeDigits(s.cost->model.box) : "–",
                 s.cost->model.triangleKnown ? threeDigits(s.cost->model.triangle) : "–",
                 threeDigits(s.cost->ratioP5), threeDigits(s.cost->ratioMedian),
                 threeDigits(s.cost->ratioP95)});
  return table.html();
}

std::string trajectoryTable(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  Table table({"variant", "limits", "trajectory", "refuted", "share refuted", "of proved paths",
               "limits kept", "duration", "saved", "rows", "velocity", "acceleration", "jerk",
               "make and prove, ms", "verify, ms"});
  const auto share = [](double value) { return std::isnan(value) ? "–" : percent(value); };
  const CampaignTrajectories& all = campaign.trajectories;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v)
    for (std::size_t set = 0; set < all.limits.size(); ++set)
      for (std::size_t maker = 0; maker < all.makers.size(); ++maker) {
        const TrajectoryScore s = scoreOf(campaign, cells, v, set, maker);
        const double refutedShare =
            s.made ? static_cast<double>(s.refuted) / static_cast<double>(s.made) : NAN;
        const std::string name = all.limits[set].name;
        table.row({variantHtml(campaign, v),
                   name.empty() ? "each problem’s own" : escapedHtml(name),
                   nameOf(all.makers[maker]), refuted(s.refuted, s.made),
                   s.made ? percent(refutedShare) + interval(s.refutedShare, percent) : "–",
                   refuted(s.refutedOfProved, s.provedPaths), count(s.withinLimits, s.made),
                   threeDigits(s.overOptimum), share(s.saved), threeDigits(s.rows),
                   share(s.velocity), share(s.acceleration), share(s.jerk),
                   threeDigits(1e3 * s.makeTime), threeDigits(1e3 * s.verifyTime)});
      }
  return table.html();
}

std::string cellTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                      std::size_t problem) {
  Table table({"planner", "variant", "time, s", "solved", "refuted", "states", "edges",
               "N<sub>v</sub>", "N<sub>p</sub>", "length before", "after"},
              "cells");
  for (const CampaignCell& cell : cells)
    if (cell.problem == problem) table.row(cellRow(campaign, cell));
  return table.html();
}

std::string measuredTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                          const std::vector<CampaignSession>& sessions) {
  char date[64];
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", &utc);
  Table table({});
  table.row({"written", date});
  std::set<const OmplRecord*> records;  // runs share them
  for (const CampaignCell& cell : cells)
    for (const BenchmarkRun& run : cell.runs) records.insert(run.ompl.get());
  std::set<std::pair<std::string, std::string>> machines;
  for (const OmplRecord* record : records)
    if (!record->host.empty()) machines.insert({record->host, processorOf(record->cpu)});
  for (const auto& [host, processor] : machines)
    table.row({"machine", escapedHtml(host + (processor.empty() ? "" : ", " + processor))});
  table.row({"programs", "Corridor, commit " + escapedHtml(buildCommit()) + "; OMPL " +
                             versionOfOmpl() + competitorVersions(campaign)});
  for (const CampaignSession& session : sessions)
    table.row({"session of " + escapedHtml(session.started) + " UTC",
               std::to_string(session.runs) + " runs, " + std::to_string(session.jobs) +
                   " at a time, by commit " + escapedHtml(session.commit)});
  table.row({"seeds", std::to_string(campaign.seed) + " to " +
                          std::to_string(campaign.seed + campaign.runs - 1)});
  table.row({"limits",
             (campaign.time ? threeDigits(*campaign.time) + " s" : "each problem’s time limit") +
                 ", " + threeDigits(campaign.limits.memory) + " MB per run"});
  table.row({"simplified",
             campaign.simplify ? simplifierText(*campaign.simplify) : "each problem’s setting"});
  table.row({"verified", campaign.verify ? "yes" : "no"});
  if (campaign.planners.empty()) table.row({"planners", "each problem’s own"});
  for (const CampaignPlanner& planner : campaign.planners)
    table.row({"planner “" + escapedHtml(planner.label) + "”", escapedHtml(plannerText(planner))});
  for (const Variant& variant : campaign.variants)
    table.row({"variant “" + escapedHtml(variant.name) + "”", escapedHtml(checkerText(variant))});
  for (std::size_t p = 0; p < campaign.problems.size(); ++p)
    table.row({"problem “" + escapedHtml(campaign.problemNames[p]) + "”",
               "SHA-256 " + campaign.digests[p]});
  return table.html();
}

}  // namespace corridor
