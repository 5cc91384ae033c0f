#include "planner/benchmark/report.h"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>

#include "collision/core/error.h"
#include "collision/core/whole_file.h"
#include "planner/benchmark/contenders.h"
#include "planner/benchmark/report_plots.h"
#include "planner/benchmark/report_tables.h"
#include "planner/benchmark/write_reports.h"
#include "planner/view/page_text.h"

namespace corridor {
namespace {

constexpr const char* kNoGnuplot =
    "gnuplot is not installed (Debian's gnuplot-nox), so there are no plots";

namespace fs = std::filesystem;
using view::escapedHtml;

/// If a campaign has more problems than this, the plots and tables of single problems are folded.
constexpr std::size_t kMostAtOnce = 8;
/// Folded plots, and plots whose SVG has more bytes than this, are stored in the page as text. The
/// page draws such a plot when the reader scrolls near it. With 20,000 elements of SVG, a browser
/// would need seconds to open the page.
constexpr std::size_t kLargePlot = 200'000;

/// Returns a number with a noun: "1 problem", "2 problems".
std::string counted(std::size_t number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

/// The size of a plot, in SVG units. The height grows with the legend, so that a long legend does
/// not shrink the plot.
constexpr int kPlotWidth = 560;
int heightOf(const Plot& plot) {
  const auto names = plot.shapes.size() + static_cast<std::size_t>(std::count_if(
                                              plot.series.begin(), plot.series.end(),
                                              [](const PlotSeries& s) { return !s.name.empty(); }));
  // gnuplot lists longer names below each other, not in two columns.
  constexpr std::size_t kLong = 20;
  const bool twoColumns = std::all_of(plot.series.begin(), plot.series.end(),
                                      [](const PlotSeries& s) { return s.name.size() <= kLong; }) &&
                          std::all_of(plot.shapes.begin(), plot.shapes.end(),
                                      [](const std::string& name) { return name.size() <= kLong; });
  return 340 + 15 * static_cast<int>(twoColumns ? (names + 1) / 2 : names);
}

class Report {
 public:
  Report(const Campaign& campaign, const std::vector<CampaignCell>& cells,
         const std::vector<CampaignSession>& sessions, const fs::path& folder)
      : campaign_(campaign),
        cells_(cells),
        sessions_(sessions),
        folder_(folder),
        contenders_(contendersOf(campaign, cells)),
        ranked_(contenders_ ? contenders_->campaign : campaign),
        rankedCells_(contenders_ ? contenders_->cells : cells),
        scores_(scoresOf(campaign, cells)),
        ranking_(scoresOf(ranked_, rankedCells_)),
        reference_(referenceVariant(rankedCells_)),
        files_{folder / "report.html"} {}

  /// Returns the reason why a plot is missing, or "".
  const std::string& whyNoPlot() const { return whyNoPlot_; }
  std::vector<fs::path> write() {
    std::error_code failure;
    fs::create_directory(folder_ / "plots", failure);
    if (failure)
      throw InputError(
          Fault{(folder_ / "plots").string(), 0, "can't be created: " + failure.message()});
    std::string error, solved, clearance;
    if (campaign_.problems.size() > 1) {
      if (campaign_.verify)
        error = figures(figure(refutedShareOfAll(ranked_, rankedCells_, ranking_)));
      solved = figures(figure(profileOfAll(ranked_, rankedCells_)));
    }
    if (campaign_.verify) {
      error += figuresOfEach(timeAgainstRefuted, campaign_, cells_);
      clearance = figuresOfEach(clearances, campaign_, cells_);
    } else {
      error = clearance = "<p>Paths were not verified.</p>";
    }
    solved += figuresOfEach(solvedOverTime, ranked_, rankedCells_);
    const std::string name = campaign_.name.empty() ? "Comparison" : campaign_.name;
    const std::string page =
        view::filled(reportFile("report.html"),
                     {{"title", escapedHtml(name)},
                      {"style", std::string(reportFile("report.css"))},
                      {"script", std::string(reportFile("report.js"))},
                      {"summary", summary()},
                      {"notes", notes()},
                      {"first", escapedHtml(ranked_.variants[reference_].name)},
                      {"pairs", counted(pairs(), "run")},
                      {"ranking", rankingTable(ranked_, rankedCells_, ranking_)},
                      {"contenders",
                       campaign_.planners.size() > 1 ? "Planners with their variants" : "Variants"},
                      {"error", error},
                      {"solved", solved},
                      {"clearance", clearance},
                      {"costs", costTable(campaign_, scores_)},
                      {"cost", figure(predictedCost(campaign_, cells_, scores_))},
                      {"trajectories", trajectories()},
                      {"cells", cellTables()},
                      {"how", measuredTable(campaign_, cells_, sessions_)}});
    writeWhole(files_[0], page);
    return files_;
  }

 private:
  std::size_t runs() const {
    std::size_t sum = 0;
    for (const CampaignCell& cell : cells_) sum += cell.runs.size();
    return sum;
  }
  std::size_t pairs() const {
    std::size_t most = 0;
    for (const VariantScore& score : ranking_)
      if (score.variant != reference_) most = std::max(most, score.pairs);
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
    std::string text = counted(campaign_.problems.size(), "problem") + ", " +
                       counted(campaign_.variants.size(), "variant") + ", " +
                       counted(runs(), "run");
    if (runs() < all) text += " of " + std::to_string(all) + " (not finished)";
    text += ": " + std::to_string(solved) + " returned a path";
    return judged == 0 ? text + "."
                       : text + "; " + std::to_string(refuted) + " of " + std::to_string(judged) +
                             " verified paths are refuted.";
  }
  std::string trajectories() const {
    if (campaign_.trajectories.makers.empty()) return "";
    return view::filled(reportFile("trajectories.html"),
                        {{"table", trajectoryTable(campaign_, cells_)}});
  }
  std::string notes() const {
    std::vector<std::string> notes = campaign_.notes;
    if (!canPlot()) notes.push_back(std::string(kNoGnuplot) + ".");
    if (ranked_.variants.size() > kPlotColors)
      notes.push_back("There are more lines than colours: from the " +
                      std::to_string(kPlotColors + 1) + "th on the colours repeat.");
    if (campaign_.planners.size() > kPlotShapes)
      notes.push_back("There are more planners than shapes of points: from the " +
                      std::to_string(kPlotShapes + 1) + "th on the shapes repeat.");
    if (!campaign_.verify) notes.push_back("Paths were not verified (verify: false).");
    if (notes.empty()) return "";
    std::string list = "<ul class=\"notes\">";
    for (const std::string& note : notes) list += "<li>" + escapedHtml(note) + "</li>";
    return list + "</ul>";
  }

  /// Returns `html`, which shows all problems one by one. If there are more than kMostAtOnce
  /// problems, returns `html` folded: the page shows one line, and a click on this line unfolds
  /// `html`.
  std::string ofEach(const std::string& what, const std::string& html) const {
    const std::size_t count = campaign_.problems.size();
    if (count <= kMostAtOnce) return html;
    return "<details><summary>" + what + " of all " + std::to_string(count) +
           " problems</summary>\n" + html + "</details>\n";
  }
  static std::string figures(const std::string& all) {
    return "<div class=\"plots\">" + all + "</div>\n";
  }
  std::string figuresOfEach(Plot (*plot)(const Campaign&, const std::vector<CampaignCell>&,
                                         std::size_t),
                            const Campaign& campaign, const std::vector<CampaignCell>& cells) {
    std::string all;
    for (std::size_t p = 0; p < campaign.problems.size(); ++p)
      all += figure(plot(campaign, cells, p), campaign.problems.size() > kMostAtOnce);
    return ofEach("Plots", figures(all));
  }
  std::string cellTables() const {
    std::string html;
    for (std::size_t p = 0; p < campaign_.problems.size(); ++p)
      html += "<h3>" + escapedHtml(campaign_.problemNames[p]) + "</h3>\n" +
              cellTable(campaign_, cells_, p);
    return ofEach("Tables", html);
  }

  /// Writes a plot's files, and returns the figure for the page. The data is written even if
  /// gnuplot fails, so that no measurement is lost. @param isFolded whether the figure is hidden
  /// when the page opens.
  std::string figure(Plot plot, bool isFolded = false) {
    const std::string name = fileName(plot.name);
    plot.name = name;
    // Different names, such as "a b" and "a-b", may give the same file name.
    for (int i = 2; !plots_.insert(plot.name).second; ++i)
      plot.name = name + "-" + std::to_string(i);
    const fs::path base = folder_ / "plots" / plot.name;
    writeWhole(base.string() + ".csv", csvOf(plot));
    files_.push_back(base.string() + ".csv");
    const auto none = [&](const std::string& why) {
      std::error_code ignored;
      fs::remove(base.string() + ".svg", ignored);  // an earlier report may have left this file
      return "<figure><p>" + escapedHtml(plot.title + ": no plot" + why) + "</p></figure>\n";
    };
    if (!canPlot()) {
      whyNoPlot_ = kNoGnuplot;
      return none("");
    }
    std::string svg;
    try {
      svg = svgOf(plot, kPlotWidth, heightOf(plot));
    } catch (const std::runtime_error& error) {
      whyNoPlot_ = error.what();
      return none(": " + whyNoPlot_);
    }
    writeWhole(base.string() + ".svg", svg);
    files_.push_back(base.string() + ".svg");
    svg.erase(0, svg.find("<svg"));
    std::string head = "<figure data-plot=\"" + escapedHtml(plot.name) + "\"";
    // report.js draws this plot. No name in the text can end the script, because `svgOf` replaces
    // each "<" in names.
    if (isFolded || svg.size() > kLargePlot) {
      head += " style=\"aspect-ratio: " + std::to_string(kPlotWidth) + " / " +
              std::to_string(heightOf(plot)) + "\"";
      svg = "<script type=\"text/plain\">" + svg + "</script>";
    }
    return head + ">" + svg + "</figure>\n";
  }

  const Campaign& campaign_;
  const std::vector<CampaignCell>& cells_;
  const std::vector<CampaignSession>& sessions_;
  fs::path folder_;
  std::optional<Contenders> contenders_;
  const Campaign& ranked_;  // its variants are ranked
  const std::vector<CampaignCell>& rankedCells_;
  std::vector<VariantScore> scores_, ranking_;  // of the variants, and of what is ranked
  std::size_t reference_;                       // of what is ranked
  std::vector<fs::path> files_;
  std::set<std::string> plots_;  // names of plots that are already used
  std::string whyNoPlot_;        // of the last plot that is missing
};

}  // namespace

std::vector<fs::path> writeReport(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                                  const fs::path& folder,
                                  const std::vector<CampaignSession>& sessions,
                                  std::string* whyNoPlot) {
  Report report(campaign, cells, sessions, folder);
  std::vector<fs::path> files = report.write();
  if (whyNoPlot) *whyNoPlot = report.whyNoPlot();
  return files;
}

}  // namespace corridor
