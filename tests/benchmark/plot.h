#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Plots of benchmarks as SVG: lines of points over two axes.
namespace corridor::bench {

struct Point {
  double x = 0, y = 0;
};
struct Series {
  std::string name;
  std::vector<Point> points;
};

/// Returns the slope of the least-squares line of log y over log x, which is p in y ~ xᵖ; NaN for
/// fewer than two points.
inline double logSlope(const std::vector<Point>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Point& p : points) {
    const double u = std::log(p.x), v = std::log(p.y);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  return n < 2 ? NAN : (n * xy - x * y) / (n * xx - x * x);
}

/// Returns a number as text with at most `digits` digits.
inline std::string text(double value, int digits = 3) {
  std::ostringstream out;
  out.precision(digits);
  out << value;
  return out.str();
}

class Plot {
 public:
  Plot(std::string title, std::string xLabel, std::string yLabel, bool logX = true,
       bool logY = true)
      : title_(std::move(title)),
        x_{std::move(xLabel), logX, HUGE_VAL, -HUGE_VAL},
        y_{std::move(yLabel), logY, HUGE_VAL, -HUGE_VAL} {}

  void add(Series series) {
    for (const Point& p : series.points) x_.include(p.x), y_.include(p.y);
    series_.push_back(std::move(series));
  }

  /// @throws std::runtime_error if the file cannot be written.
  void write(const std::filesystem::path& file) const {
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    std::ofstream out(file);
    out << svg();
    if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
  }

 private:
  struct Axis {
    std::string label;
    bool logarithmic;
    double low, high;

    double scaled(double value) const { return logarithmic ? std::log10(value) : value; }
    void include(double value) {
      low = std::min(low, scaled(value));
      high = std::max(high, scaled(value));
    }
    /// Returns the position along the axis: 0 at its lower end, 1 at its upper end, with a little
    /// room at both.
    double place(double value) const {
      const double air = 0.04 * std::max(high - low, 1e-9);
      return (scaled(value) - low + air) / (high - low + 2 * air);
    }
    /// Returns powers of ten, with 2 and 5 times these if there are few; for a linear axis, round
    /// steps.
    std::vector<double> ticks() const {
      std::vector<double> all;
      if (logarithmic) {
        for (double e = std::floor(low); e <= high; ++e)
          for (const double m : {1.0, 2.0, 5.0})
            if (m == 1 || high - low < 1.5) all.push_back(m * std::pow(10, e));
      } else {
        const double range = std::max(high - low, 1e-9);
        double step = std::pow(10, std::floor(std::log10(range)));
        if (range / step < 3) step /= 5;
        for (double v = std::ceil(low / step); v * step <= high; ++v) all.push_back(v * step);
      }
      std::erase_if(all, [&](double v) { return place(v) < 0 || place(v) > 1; });
      return all;
    }
  };

  static constexpr double kLeft = 70, kTop = 34, kWidth = 440, kHeight = 320;
  double px(double x) const { return std::round(10 * (kLeft + kWidth * x_.place(x))) / 10; }
  double py(double y) const { return std::round(10 * (kTop + kHeight * (1 - y_.place(y)))) / 10; }

  std::string svg() const {
    static const std::vector<std::string> colours = {"#1b6ca8", "#d1495b", "#2e933c", "#edae49",
                                                     "#6f4e7c", "#00798c", "#8c564b", "#444444",
                                                     "#e377c2", "#7f9f1f"};
    std::size_t letters = 0;
    for (const Series& series : series_) letters = std::max(letters, series.name.size());
    const double legend = 30 + 7 * static_cast<double>(letters);
    std::ostringstream s;
    s << "<svg xmlns='http://www.w3.org/2000/svg' width='" << kLeft + kWidth + legend
      << "' height='" << kTop + kHeight + 50
      << "' font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' "
         "fill='white'/>\n";
    const auto label = [&](double x, double y, const std::string& anchor, const std::string& words,
                           const std::string& more = "") {
      s << "<text x='" << x << "' y='" << y << "' text-anchor='" << anchor << "' " << more << ">"
        << words << "</text>\n";
    };
    const auto line = [&](double x1, double y1, double x2, double y2) {
      s << "<path d='M" << x1 << " " << y1 << "L" << x2 << " " << y2 << "' stroke='#dddddd'/>\n";
    };
    for (const double v : x_.ticks()) {
      line(px(v), kTop, px(v), kTop + kHeight);
      label(px(v), kTop + kHeight + 16, "middle", text(v));
    }
    for (const double v : y_.ticks()) {
      line(kLeft, py(v), kLeft + kWidth, py(v));
      label(kLeft - 6, py(v) + 4, "end", text(v));
    }
    s << "<rect x='" << kLeft << "' y='" << kTop << "' width='" << kWidth << "' height='" << kHeight
      << "' fill='none' stroke='#888888'/>\n";
    label(kLeft, 20, "start", title_, "font-size='14'");
    label(kLeft + kWidth / 2, kTop + kHeight + 38, "middle", x_.label);
    label(16, kTop + kHeight / 2, "middle", y_.label,
          "transform='rotate(-90 16 " + text(kTop + kHeight / 2) + ")'");
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const std::string& colour = colours[i % colours.size()];
      s << "<path fill='none' stroke='" << colour << "' stroke-width='1.5' d='";
      for (std::size_t k = 0; k < series_[i].points.size(); ++k)
        s << (k ? "L" : "M") << px(series_[i].points[k].x) << " " << py(series_[i].points[k].y);
      s << "'/>\n";
      for (const Point& p : series_[i].points)
        s << "<circle cx='" << px(p.x) << "' cy='" << py(p.y) << "' r='2.2' fill='" << colour
          << "'/>\n";
      const double y = kTop + 12 + 18 * static_cast<double>(i);
      s << "<circle cx='" << kLeft + kWidth + 14 << "' cy='" << y - 4 << "' r='4' fill='" << colour
        << "'/>\n";
      label(kLeft + kWidth + 24, y, "start", series_[i].name);
    }
    s << "</svg>\n";
    return s.str();
  }

  std::string title_;
  Axis x_, y_;
  std::vector<Series> series_;
};

}  // namespace corridor::bench
