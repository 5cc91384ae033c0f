#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Plots of reports, drawn by gnuplot.
namespace corridor {

struct PlotPoint {
  double x = 0, y = 0;
  /// Where they are told: bars from … to. NaN: none.
  double fromX = std::numeric_limits<double>::quiet_NaN(), toX = fromX, fromY = fromX, toY = fromX;
  std::string text = {};  ///< of a point: shown where a pointer rests on it
  std::size_t shape = 0;  ///< of a point: round, square … (index of `Plot::shapes`)
};

struct PlotSeries {
  enum class Style { points, line, dashes };
  std::string name;       ///< in the key; "" leaves it out
  std::size_t color = 0;  ///< series of one colour belong together
  Style style = Style::points;
  std::vector<PlotPoint> points;
};

struct Plot {
  std::string name;  ///< of its files: "time_and_error.piano"
  std::string title, xLabel, yLabel;
  bool logX = false, logY = false;  ///< what is not above 0 is left out then
  std::optional<std::pair<double, double>> rangeX = {}, rangeY = {};
  std::vector<PlotSeries> series = {};
  std::vector<std::string> shapes = {};  ///< what points' shapes mean; none: all are round
};

/// Colours by number, the same in plots and tables: "#0072b2". The first six can be told apart by
/// those who see no red and green (Okabe, Ito 2008); after `kPlotColors` they begin anew.
std::string plotColor(std::size_t number);
constexpr std::size_t kPlotColors = 18;
/// After so many shapes of points these begin anew.
constexpr std::size_t kPlotShapes = 12;

/// Is gnuplot there (Debian's gnuplot-nox)?
bool canPlot();
/// As SVG, of so many units (which scale). Ids in it begin with the plot's name, so that several
/// may stand in one page. @throws std::runtime_error with what gnuplot says. @pre canPlot.
std::string svgOf(const Plot& plot, int width = 560, int height = 380);
/// Its data: series,x,y,from_x,to_x,from_y,to_y,text.
std::string csvOf(const Plot& plot);

}  // namespace corridor
