#pragma once

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "collision/core/whole_file.h"
#include "planner/benchmark/plot.h"

/// What the benchmarks add to the plots of planner/benchmark: lines with a dot at every
/// measurement.
namespace corridor::bench {

/// Returns the slope of the least-squares line of log y over log x, which is p in y ~ xᵖ; NaN for
/// fewer than two points.
inline double logSlope(const std::vector<PlotPoint>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const PlotPoint& p : points) {
    const double u = std::log(p.x), v = std::log(p.y);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return n < 2 ? NAN : (n * xy - x * y) / (n * xx - x * x);
}

/// Returns a number as text with at most `digits` significant digits.
inline std::string text(double value, int digits = 3) {
  std::ostringstream out;
  out.precision(digits);
  out << value;
  return out.str();
}

/// Adds a line with dots, in a colour of its own.
inline void addLine(Plot& plot, const std::string& name, const std::vector<PlotPoint>& points) {
  const std::size_t color = plot.series.size() / 2;
  plot.series.push_back({name, color, PlotSeries::Style::line, points});
  plot.series.push_back({"", color, PlotSeries::Style::points, points});
}

/// Writes the plot to the folder as NAME.svg. @throws std::runtime_error without gnuplot, or if the
/// file can't be written.
inline void writePlot(const Plot& plot, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  writeWhole(folder / (plot.name + ".svg"), svgOf(plot, 720, 440));
}

}  // namespace corridor::bench
