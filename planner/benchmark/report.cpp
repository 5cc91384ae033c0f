#include "planner/benchmark/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <set>
#include <stdexcept>

#include "collision/core/error.h"
#include "planner/benchmark/build_commit.h"
#include "planner/benchmark/comparison.h"
#include "planner/benchmark/report_plots.h"
#include "planner/benchmark/write_reports.h"
#include "planner/solve/solution.h"
#include "planner/view/page_text.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;
using view::escapedHtml;

/// Three digits; of large numbers all, in groups.
std::string digits(double value) {
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
/// One is bad news.
std::string refuted(std::size_t hits, std::size_t judged) {
  if (judged == 0) return "–";
  return std::string("<span class=\"") + (hits ? "bad" : "good") + "\">" + count(hits, judged) +
         "</span>";
}

class Table {
 public:
  explicit Table(const std::vector<std::string>& heads, const std::string& kind = "") {
    text_ = "<div class=\"scroll " + kind + "\"><table><thead><tr>";
    for (const std::string& head : heads) text_ += "<th>" + head + "</th>";
    text_ += "</tr></thead><tbody>\n";
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

class Report {
 public:
  Report(const Campaign& campaign, const std::vector<CampaignCell>& cells, const fs::path& folder)
      : campaign_(campaign),
        cells_(cells),
        folder_(folder),
        scores_(scoresOf(campaign, cells)),
        files_{folder / "report.html"} {}

  std::vector<fs::path> write() {
    std::error_code failure;
    fs::create_directory(folder_ / "plots", failure);
    if (failure)
      throw InputError(
          Fault{(folder_ / "plots").string(), 0, "can't be made: " + failure.message()});
    std::string solved, error, clearance;
    for (std::size_t p = 0; p < campaign_.problems.size(); ++p) {
      error += figure(timeAgainstError(campaign_, cells_, p));
      solved += figure(solvedOverTime(campaign_, cells_, p));
      clearance += figure(clearances(campaign_, cells_, p));
    }
    const std::string name = campaign_.name.empty() ? "Comparison" : campaign_.name;
    const std::string page = view::filled(
        reportFile("report.html"), {{"title", escapedHtml(name)},
                                    {"style", std::string(reportFile("report.css"))},
                                    {"script", std::string(reportFile("report.js"))},
                                    {"summary", summary()},
                                    {"notes", notes()},
                                    {"first", escapedHtml(campaign_.variants.front().name)},
                                    {"pairs", std::to_string(pairs())},
                                    {"ranking", ranking()},
                                    {"error", error},
                                    {"solved", solved},
                                    {"clearance", clearance},
                                    {"costs", costs()},
                                    {"cost", figure(predictedCost(campaign_, cells_, scores_))},
                                    {"cells", cells()},
                                    {"how", how()}});
    writeWhole(files_[0], page);
    return files_;
  }

 private:
  std::string variantName(std::size_t v) const {
    return "<i class=\"swatch\" style=\"background:" + plotColor(v) + "\"></i>" +
           escapedHtml(campaign_.variants[v].name);
  }
  std::size_t runs() const {
    std::size_t sum = 0;
    for (const CampaignCell& cell : cells_) sum += cell.runs.size();
    return sum;
  }
  std::size_t pairs() const {
    std::size_t most = 0;
    for (const VariantScore& score : scores_)
      if (score.variant != 0) most = std::max(most, score.pairs);
    return most;
  }

  std::string summary() const {
    std::size_t solved = 0, judged = 0, refuted = 0;
    for (const VariantScore& score : scores_) {
      solved += score.solved;
      judged += score.judged();
      refuted += score.refuted;
    }
    const std::size_t all = cells_.size() * campaign_.runs;
    std::string text = std::to_string(campaign_.problems.size()) + " problems, " +
                       std::to_string(campaign_.variants.size()) + " variants, " +
                       std::to_string(runs()) + " runs";
    if (runs() < all) text += " of " + std::to_string(all) + " (not finished)";
    return text + ": " + std::to_string(solved) + " returned a path; of " + std::to_string(judged) +
           " paths that were judged " + std::to_string(refuted) + " are refuted.";
  }
  std::string notes() const {
    std::vector<std::string> notes = campaign_.notes;
    if (!canPlot())
      notes.push_back("gnuplot is not installed (Debian's gnuplot-nox): there are no plots.");
    if (!campaign_.verify) notes.push_back("Paths were not judged (verify: false).");
    if (notes.empty()) return "";
    std::string list = "<ul class=\"notes\">";
    for (const std::string& note : notes) list += "<li>" + escapedHtml(note) + "</li>";
    return list + "</ul>";
  }

  std::string ranking() const {
    Table table(
        {"variant", "refuted", "share refuted", "solved", "time", "in checking", "length left"});
    for (const VariantScore& s : scores_) {
      const double share =
          s.judged() ? static_cast<double>(s.refuted) / static_cast<double>(s.judged()) : NAN;
      table.row({variantName(s.variant), refuted(s.refuted, s.judged()),
                 s.judged() ? percent(share) + interval(s.refutedShare, percent) : "–",
                 count(s.solved, s.runs) + interval(s.solvedShare, percent),
                 digits(s.timeRatio) +
                     (s.variant == 0 || s.pairs == 0 ? "" : interval(s.timeRatioInterval, digits)),
                 std::isnan(s.checkingShare) ? "–" : percent(s.checkingShare),
                 std::isnan(s.lengthShare) ? "–" : percent(s.lengthShare)});
    }
    return table.html();
  }
  std::string costs() const {
    Table table({"variant", "C<sub>v</sub>, ns", "C<sub>p</sub>, ns", "5 %", "median", "95 %"});
    for (const VariantScore& s : scores_)
      if (s.cost)
        table.row({variantName(s.variant), digits(s.cost->model.box),
                   digits(s.cost->model.triangle), digits(s.cost->ratioP5),
                   digits(s.cost->ratioMedian), digits(s.cost->ratioP95)});
    return table.html();
  }
  std::string cells() const {
    std::string html;
    for (std::size_t p = 0; p < campaign_.problems.size(); ++p) {
      Table table({"planner", "variant", "time, s", "solved", "refuted", "states", "edges",
                   "N<sub>v</sub>", "N<sub>p</sub>", "length before", "after"},
                  "cells");
      for (const CampaignCell& cell : cells_)
        if (cell.problem == p) table.row(cellRow(cell));
      html += "<h3>" + escapedHtml(campaign_.problemNames[p]) + "</h3>\n" + table.html();
    }
    return html;
  }
  std::vector<std::string> cellRow(const CampaignCell& cell) const {
    std::vector<double> times, states, edges, boxes, triangles, raw, length;
    std::size_t judged = 0, refutedPaths = 0;
    for (const BenchmarkRun& run : cell.runs) {
      judged += !run.verdict.empty();
      refutedPaths += run.verdict == "refuted";
      if (!run.solved) continue;
      times.push_back(run.time);
      states.push_back(static_cast<double>(run.states));
      edges.push_back(static_cast<double>(run.edges));
      boxes.push_back(static_cast<double>(run.counters.boxTests));
      triangles.push_back(static_cast<double>(run.counters.triangleTests));
      // Metres, or of what only turns radians.
      const bool metres = run.rawLength.metres > 0;
      raw.push_back(metres ? run.rawLength.metres : run.rawLength.radians);
      length.push_back(metres ? run.length.metres : run.length.radians);
    }
    const bool peer = campaign_.variants[cell.variant].peer.has_value();
    const auto median = [](const std::vector<double>& of) { return digits(medianOf(of)); };
    return {escapedHtml(cell.planner.label),
            variantName(cell.variant),
            median(times) + (times.empty() ? "" : interval(medianInterval(times), digits)),
            count(times.size(), cell.runs.size()),
            refuted(refutedPaths, judged),
            median(states),
            median(edges),
            peer ? "–" : median(boxes),
            peer ? "–" : median(triangles),
            median(raw),
            median(length)};
  }

  std::string how() const {
    const BenchmarkRun* any = nullptr;
    for (const CampaignCell& cell : cells_)
      for (const BenchmarkRun& run : cell.runs)
        if (!any && !run.ompl.host.empty()) any = &run;
    char date[64];
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", &utc);
    Table table({"", ""});
    table.row({"written", date});
    table.row({"program", std::string("commit ") + buildCommit()});
    if (any) table.row({"processor", escapedHtml(processorOf(any->ompl.cpu))});
    table.row({"seeds", std::to_string(campaign_.seed) + " to " +
                            std::to_string(campaign_.seed + campaign_.runs - 1)});
    table.row(
        {"limits", (campaign_.time ? digits(*campaign_.time) + " s" : "time as each problem says") +
                       ", " + digits(campaign_.limits.memory) + " MB a run"});
    for (const Variant& variant : campaign_.variants)
      table.row({"variant “" + escapedHtml(variant.name) + "”", escapedHtml(checkerText(variant))});
    for (std::size_t p = 0; p < campaign_.problems.size(); ++p)
      table.row({"problem “" + escapedHtml(campaign_.problemNames[p]) + "”",
                 "SHA-256 " + campaign_.problems[p].digest});
    return table.html();
  }
  static std::string checkerText(const Variant& variant) {
    std::string text;
    for (const YamlValue::Entry& entry : variant.checker.entries)
      text += (text.empty() ? "" : ", ") + entry.key + ": " + entry.value.text;
    if (variant.peer) text += ", peer: " + variant.peer->name;
    return text.empty() ? "as each problem says" : text;
  }
  /// Of what `lscpu` says: its "Model name:".
  static std::string processorOf(const std::string& cpu) {
    const std::string key = "Model name:";
    const auto at = cpu.find(key);
    if (at == std::string::npos) return cpu.substr(0, cpu.find('\n'));
    const auto begin = cpu.find_first_not_of(" \t", at + key.size());
    return cpu.substr(begin, cpu.find('\n', begin) - begin);
  }

  /// Files of the plot, and the figure for the page. Without a picture there is the data all the
  /// same: what was measured isn't lost to a gnuplot that fails.
  std::string figure(Plot plot) {
    const std::string name = fileName(plot.name);
    plot.name = name;
    for (int i = 2; !plots_.insert(plot.name).second; ++i)  // "a b" and "a-b"
      plot.name = name + "-" + std::to_string(i);
    const fs::path base = folder_ / "plots" / plot.name;
    writeWhole(base.string() + ".csv", csvOf(plot));
    files_.push_back(base.string() + ".csv");
    const auto none = [&](const std::string& why) {
      std::error_code ignored;
      fs::remove(base.string() + ".svg", ignored);  // an earlier report's
      return "<figure><p>" + escapedHtml(plot.title + ": no plot" + why) + "</p></figure>\n";
    };
    if (!canPlot()) return none("");
    std::string svg;
    try {
      svg = svgOf(plot);
    } catch (const std::runtime_error& error) {
      return none(": " + std::string(error.what()));
    }
    writeWhole(base.string() + ".svg", svg);
    files_.push_back(base.string() + ".svg");
    svg.erase(0, svg.find("<svg"));
    return "<figure data-plot=\"" + escapedHtml(plot.name) + "\">" + svg + "</figure>\n";
  }

  const Campaign& campaign_;
  const std::vector<CampaignCell>& cells_;
  fs::path folder_;
  std::vector<VariantScore> scores_;
  std::vector<fs::path> files_;
  std::set<std::string> plots_;  // names
};

}  // namespace

std::vector<fs::path> writeReport(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                                  const fs::path& folder) {
  return Report(campaign, cells, folder).write();
}

}  // namespace corridor
