#include "planner/benchmark/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <unistd.h>

#include "collision/core/csv_text.h"
#include "collision/core/external_program.h"
#include "collision/core/shortest.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

/// Replaces the characters that are syntax for gnuplot or SVG, because users may choose any names.
std::string plain(std::string text) {
  for (char& c : text)
    if (c == '"' || c == '\'' || c == '\\' || c == '<' || c == '>' || c == '&' || c == '`')
      c = c == '<' || c == '>' || c == '&' ? '-' : ' ';
  std::replace(text.begin(), text.end(), '\r', ' ');
  return text;
}
/// Returns a text in double quotes, with line breaks as gnuplot reads them.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : plain(text)) out += c == '\n' ? std::string("\\n") : std::string(1, c);
  return out + "\"";
}
/// Shortens a name for the legend, without splitting a UTF-8 character.
std::string shortened(const std::string& name) {
  constexpr std::size_t kMost = 60;
  if (name.size() <= kMost) return name;
  std::size_t end = kMost - 1;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
  return name.substr(0, end) + "…";
}
std::string number(double value) {
  return std::isfinite(value) ? shortest(value) : "NaN";
}

class Script {
 public:
  explicit Script(const Plot& plot, int width, int height) : plot_(plot) {
    out_ << "set terminal svg size " << width << "," << height
         << " dynamic noenhanced background \"white\" font \"sans-serif,13\" linewidth 1.2\n"
         << "set encoding utf8\nset border 3 lc rgb \"#94a3b8\"\n"
         << "set tics nomirror out textcolor rgb \"#334155\"\n"
         << "set grid lt 1 lc rgb \"#e2e8f0\" lw 0.6\n"
         << "set key outside top left horizontal Left reverse samplen 1.5 width 3 textcolor rgb "
            "\"#334155\"\n"
         << "set title " << quoted(plot.title) << " font \",14\" offset 0,-0.4\n"
         << "set xlabel " << quoted(plot.xLabel) << "\nset ylabel " << quoted(plot.yLabel) << "\n"
         << "set bars 0.4\n";
    axis('x', plot.logX, plot.rangeX);
    axis('y', plot.logY, plot.rangeY);
    std::string drawn;
    for (std::size_t i = 0; i < plot.series.size(); ++i) drawn += series(i);
    for (std::size_t i = 0; i < plot.shapes.size() && !drawn.empty(); ++i)
      drawn += ", NaN with points" + pointOf(i, 0.9) + " lc rgb \"#64748b\" title " +
               quoted(shortened(plot.shapes[i]));
    // gnuplot fails on a plot without data.
    out_ << (drawn.empty() ? "set xrange [1:2]\nset yrange [1:2]\nset label \"no data\" at graph "
                             "0.5,0.5 center\nplot NaN notitle\n"
                           : "plot " + drawn.substr(2) + "\n");
  }
  std::string text() const { return out_.str(); }

 private:
  void axis(char name, bool log, const std::optional<std::pair<double, double>>& range) {
    if (log && range && range->second < 300 * range->first) labelHalfDecades(name, *range);
    if (log)
      out_ << "set logscale " << name << "\nset format " << name << " \"%g\"\nset m" << name
           << "tics 10\n";
    if (range)
      out_ << "set " << name << "range [" << number(range->first) << ":" << number(range->second)
           << "]\n";
  }
  /// Labels an axis at 1, 2 and 5 times each power of ten. With powers of ten alone, a narrow range
  /// could have only one label.
  void labelHalfDecades(char name, const std::pair<double, double>& range) {
    std::string tics;
    const int last = static_cast<int>(std::ceil(std::log10(range.second)));
    for (int decade = static_cast<int>(std::floor(std::log10(range.first))); decade <= last;
         ++decade)
      for (const int digit : {1, 2, 5})
        if (const double at = digit * std::pow(10, decade); range.first <= at && at <= range.second)
          tics += ", " + number(at);
    if (!tics.empty()) out_ << "set " << name << "tics (" << tics.substr(2) << ")\n";
  }
  bool shown(const PlotPoint& p) const {
    return std::isfinite(p.x) && std::isfinite(p.y) && (!plot_.logX || p.x > 0) &&
           (!plot_.logY || p.y > 0);
  }
  /// Writes the data of a series, one block per shape of its points. Returns the arguments
  /// of gnuplot's "plot" that draw these blocks.
  std::string series(std::size_t i) {
    const PlotSeries& s = plot_.series[i];
    const std::string color = " lc rgb \"" + plotColor(s.color) + "\"";
    const std::string title =
        s.name.empty() ? std::string(" notitle") : " title " + quoted(shortened(s.name));
    std::string drawn;
    for (std::size_t shape = 0; shape < std::max<std::size_t>(plot_.shapes.size(), 1); ++shape) {
      const std::string block = "$data" + std::to_string(i) + "_" + std::to_string(shape);
      drawn += part(s, shape, block, color, title);
    }
    if (s.style == PlotSeries::Style::points && !drawn.empty() && !s.name.empty())
      drawn += ", NaN with points pt 7 ps 0.9" + color + title;
    return drawn;
  }
  std::string part(const PlotSeries& s, std::size_t shape, const std::string& block,
                   const std::string& color, const std::string& title) {
    std::ostringstream data;
    bool barsX = false, barsY = false;
    for (const PlotPoint& p : s.points) {
      if (!shown(p) || p.shape != shape) continue;
      const bool x = std::isfinite(p.fromX) && std::isfinite(p.toX);
      const bool y = std::isfinite(p.fromY) && std::isfinite(p.toY);
      barsX |= x, barsY |= y;
      data << number(p.x) << ' ' << number(p.y) << ' ' << number(x ? p.fromX : p.x) << ' '
           << number(x ? p.toX : p.x) << ' ' << number(y ? p.fromY : p.y) << ' '
           << number(y ? p.toY : p.y) << ' ' << quoted(p.text) << '\n';
    }
    if (data.str().empty()) return "";
    out_ << block << " << CORRIDOR_END\n" << data.str() << "CORRIDOR_END\n";
    if (s.style != PlotSeries::Style::points)
      return ", " + block + " using 1:2 with lines lw 1.8" +
             (s.style == PlotSeries::Style::dashes ? " dt (6,4)" : "") + color + title;
    std::string drawn;
    if (barsX)
      drawn += ", " + block + " using 1:2:3:4 with xerrorbars pt -1 lw 1" + color + " notitle";
    if (barsY)
      drawn += ", " + block + " using 1:2:5:6 with yerrorbars pt -1 lw 1" + color + " notitle";
    return drawn + ", " + block + " using 1:2:7 with labels hypertext point" + pointOf(shape, 0.7) +
           color + " notitle";
  }
  /// Returns gnuplot's words for a shape: round, square, triangle up, triangle down, diamond,
  /// pentagon, filled; then the same shapes, hollow.
  static std::string pointOf(std::size_t shape, double size) {
    static constexpr std::array<int, kPlotShapes> kTypes{7, 5, 9, 11, 13, 15, 6, 4, 8, 10, 12, 14};
    std::ostringstream text;
    text << " pt " << kTypes[shape % kTypes.size()] << " ps " << size;
    return text.str();
  }

  const Plot& plot_;
  std::ostringstream out_;
};

void replaceAll(std::string& text, const std::string& what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

std::string runGnuplot(const std::string& script) {
  std::string file = (std::filesystem::temp_directory_path() / "corridor_plot_XXXXXX").string();
  const int made = ::mkstemp(file.data());
  if (made < 0) throw std::runtime_error("can't create a file for a plot: " + file);
  ::close(made);
  if (!(std::ofstream(file) << script << std::flush)) {
    std::filesystem::remove(file);
    throw std::runtime_error("can't write a plot's file: " + file);
  }
  // -d ignores the user's own settings (~/.gnuplot).
  const ProgramEnd end = runProgram({{findProgram("gnuplot").string(), "-d", file}});
  std::filesystem::remove(file);
  const auto begin = end.out.find("<?xml");
  if (end.why != ProgramEnd::Why::exited)
    throw std::runtime_error(
        "gnuplot did not end as it should: a time limit, too much output, "
        "or SIGCHLD is ignored");
  if (end.exitStatus != 0 || begin == std::string::npos)
    throw std::runtime_error("gnuplot: " + end.out + end.err);
  return end.out.substr(begin);
}

}  // namespace

std::string plotColor(std::size_t number) {
  static constexpr std::array<const char*, kPlotColors> kColors{
      "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00",
      "#6b7280", "#7c3aed", "#84cc16", "#991b1b", "#111827", "#f472b6",
      "#0f766e", "#a16207", "#1e3a8a", "#c4b5fd", "#3f6212", "#fb7185"};
  return kColors[number % kColors.size()];
}

bool canPlot() {
  static const bool there = !findProgram("gnuplot").empty();
  return there;
}

std::string svgOf(const Plot& plot, int width, int height) {
  std::string svg = runGnuplot(Script(plot, width, height).text());
  std::string prefix;
  for (const char c : plot.name)
    prefix += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' ? c : '_';
  for (const char* id : {"gpDot", "gpPt", "textbox", "greybox", "gnuplot_canvas"}) {
    replaceAll(svg, "id='" + std::string(id), "id='" + prefix + "_" + id);
    replaceAll(svg, "id=\"" + std::string(id), "id=\"" + prefix + "_" + id);
    replaceAll(svg, "href='#" + std::string(id), "href='#" + prefix + "_" + id);
    replaceAll(svg, "url(#" + std::string(id), "url(#" + prefix + "_" + id);
  }
  replaceAll(svg, "id=\"gnuplot_plot_", "id=\"" + prefix + "_plot_");
  replaceAll(svg, "<title>Gnuplot</title>", "<title>" + plain(plot.title) + "</title>");
  return svg;
}

std::string csvOf(const Plot& plot) {
  std::ostringstream out;
  out << "series,x,y,from_x,to_x,from_y,to_y,text\n";
  const auto cell = [](double value) { return std::isnan(value) ? "" : shortest(value); };
  for (const PlotSeries& s : plot.series)
    for (const PlotPoint& p : s.points)
      out << inDoubleQuotes(s.name) << ',' << cell(p.x) << ',' << cell(p.y) << ',' << cell(p.fromX)
          << ',' << cell(p.toX) << ',' << cell(p.fromY) << ',' << cell(p.toY) << ','
          << inDoubleQuotes(p.text) << '\n';
  return out.str();
}

}  // namespace corridor
