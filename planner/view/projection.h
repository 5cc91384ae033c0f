#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "collision/core/transform.h"

namespace corridor::view {

/// A parallel projection from world coordinates (metres) to picture coordinates (pixels): x to the
/// right, y down, z (the depth) from the farthest point towards the viewer.
class Camera {
 public:
  /// @param azimuth the direction of the viewer about z, radians. @param elevation the angle of the
  /// viewer above the ground, radians.
  Camera(double azimuth, double elevation);
  /// Sets scale and offset so that the points fill a picture of at most this width, with a border.
  /// The picture's height is at most about 0.8 times `width`. Pixels.
  void fit(const std::vector<Vec3>& points, double width, double border);

  Vec3 project(const Vec3& point) const;
  const Vec3& towardsViewer() const { return toViewer_; }
  /// Returns the length in the world, in metres, of one pixel.
  double worldPixel() const { return 1 / scale_; }
  double width() const { return width_; }
  double height() const { return height_; }

 private:
  Vec3 right_, up_, toViewer_;
  double scale_ = 1, left_ = 0, top_ = 0, farthest_ = 0, width_ = 0, height_ = 0;
};

using Corners = std::array<Vec3, 3>;  ///< of a triangle, in picture coordinates

/// Some rows of a grid of pixels.
struct PixelGrid {
  int columns = 0;         ///< pixels in a row
  int begin = 0, end = 0;  ///< the rows from `begin` to before `end`

  std::size_t size() const { return static_cast<std::size_t>(columns) * (end - begin); }
  /// Calls visit(pixel, depth) for each pixel whose centre the triangle covers. Pixels are counted
  /// from 0, row by row. @param corners in pixels.
  template <class Visit>
  void cover(const Corners& corners, const Visit& visit) const {
    const auto& [a, b, c] = corners;
    const auto within = [](double v, int low, int high) {
      return static_cast<int>(std::clamp(v, double(low), double(high)));
    };
    if (!(std::max({a.y(), b.y(), c.y()}) >= begin && std::min({a.y(), b.y(), c.y()}) <= end))
      return;
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    if (!(std::abs(area) > 1e-9)) return;
    const int x0 = within(std::min({a.x(), b.x(), c.x()}), 0, columns - 1),
              x1 = within(std::max({a.x(), b.x(), c.x()}), 0, columns - 1);
    const int y0 = within(std::min({a.y(), b.y(), c.y()}), begin, end - 1),
              y1 = within(std::max({a.y(), b.y(), c.y()}), begin, end - 1);
    for (int y = y0; y <= y1; ++y) {
      // The pixels of the row between the triangle's edges, and one more on each side.
      double from = x0, to = x1;
      for (int i = 0; i < 3; ++i) {
        const Vec3 &p = corners[i], &q = corners[(i + 1) % 3];
        const double slope = (area > 0 ? 1 : -1) * (p.y() - q.y());
        const double x = p.x() + (y + 0.5 - p.y()) * (q.x() - p.x()) / (q.y() - p.y());
        if (slope > 0) from = std::max(from, x - 1.5);
        if (slope < 0) to = std::min(to, x + 0.5);
      }
      for (int x = static_cast<int>(std::max(from, double(x0))); x <= x1 && x <= to; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double u = ((px - a.x()) * (c.y() - a.y()) - (py - a.y()) * (c.x() - a.x())) / area;
        const double v = ((b.x() - a.x()) * (py - a.y()) - (b.y() - a.y()) * (px - a.x())) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        visit(static_cast<std::size_t>(y - begin) * columns + x,
              a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z()));
      }
    }
  }
};

}  // namespace corridor::view
