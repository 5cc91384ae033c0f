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
  std::string name;       ///< name in the legend; "": not in the legend
  std::size_t color = 0;  ///< index of `plotColor`; related series have the same
  Style style = Style::points;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string name;  ///< name of its files: "error.piano"
  std::string title, xLabel, yLabel;
  bool logX = false, logY = false;  ///< a logarithmic axis leaves out values ≤ 0
  std::optional<std::pair<double, double>> rangeX = {}, rangeY = {};
  std::vector<PlotSeries> series = {};
  std::vector<std::string> shapes = {};  ///< meanings of points' shapes; empty: all are round
};

/// Returns a colour by its number, the same in plots and tables, such as "#0072b2". The first six
/// are distinct for readers with red-green colour blindness (Okabe, Ito 2008). The colours repeat
/// after `kPlotColors`.
std::string plotColor(std::size_t number);
constexpr std::size_t kPlotColors = 18;
/// The number of shapes of points; they repeat after that.
constexpr std::size_t kPlotShapes = 12;

/// Returns whether gnuplot (Debian's gnuplot-nox) is installed.
bool canPlot();
/// Draws a plot as scalable SVG; width and height are in SVG units. Its ids begin with the plot's
/// name, so that several plots can be in one page. @throws std::runtime_error with gnuplot's
/// message. @pre canPlot.
std::string svgOf(const Plot& plot, int width = 560, int height = 380);
/// Returns a plot's data as CSV: series,x,y,from_x,to_x,from_y,to_y,text.
std::string csvOf(const Plot& plot);

}  // namespace corridor
