#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Plots for reports, drawn by gnuplot.
namespace corridor {

struct PlotPoint {
  double x = 0, y = 0;
  /// The ends of the error bars; NaN: no bar.
  double fromX = std::numeric_limits<double>::quiet_NaN(), toX = fromX, fromY = fromX, toY = fromX;
  std::string text = {};  ///< shown while the mouse pointer is on the point
  std::size_t shape = 0;  ///< index into `Plot::shapes`
};

struct PlotSeries {
  enum class Style { points, line, dashes };
  std::string name;       ///< in the legend; "": the series is not in the legend
  std::size_t color = 0;  ///< argument of `plotColor`; related series have the same colour
  Style style = Style::points;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string name;  ///< the name of the plot's files, without the ending: "error.piano"
  std::string title, xLabel, yLabel;
  bool logX = false, logY = false;  ///< a logarithmic axis leaves out values ≤ 0
  std::optional<std::pair<double, double>> rangeX = {}, rangeY = {};
  std::vector<PlotSeries> series = {};
  std::vector<std::string> shapes =
      {};  ///< the meanings of the points' shapes; empty: all points are round
};

/// Returns the colour with a number, such as "#0072b2". Plots and tables use the same colour for
/// the same number. The first six are distinct for readers with red-green colour blindness (Okabe,
/// Ito 2008). After `kPlotColors` colours, they repeat.
std::string plotColor(std::size_t number);
constexpr std::size_t kPlotColors = 18;
/// The number of different shapes of points. Further indices repeat them.
constexpr std::size_t kPlotShapes = 12;

/// Returns whether gnuplot (Debian's gnuplot-nox) is installed.
bool canPlot();
/// Draws a plot as scalable SVG; width and height are in SVG units. The ids in the SVG begin with
/// the plot's name, so that several plots can be in one page. @throws std::runtime_error with
/// gnuplot's message. @pre canPlot.
std::string svgOf(const Plot& plot, int width = 560, int height = 380);
/// Returns a plot's data as CSV: series,x,y,from_x,to_x,from_y,to_y,text.
std::string csvOf(const Plot& plot);

}  // namespace corridor
