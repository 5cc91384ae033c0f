#include "planner/view/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace corridor::view {

Camera::Camera(double azimuth, double elevation)
    : right_(-std::sin(azimuth), std::cos(azimuth), 0),
      toViewer_(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                std::sin(elevation)) {
  up_ = toViewer_.cross(right_);
}

void Camera::fit(const std::vector<Vec3>& points, double width, double border) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : points) {
    const Vec3 seen(p.dot(right_), -p.dot(up_), 0);
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  const Vec3 size = (high - low).cwiseMax(1e-9 * (high - low).maxCoeff());
  // The picture's width is at most `width`, and its height at most about 0.8 times `width`.
  scale_ = std::min((width - 2 * border) / size.x(), 0.8 * width / size.y());
  width_ = scale_ * size.x() + 2 * border;
  height_ = scale_ * size.y() + 2 * border;
  left_ = scale_ * low.x() - border;
  top_ = scale_ * low.y() - border;
}

Vec3 Camera::project(const Vec3& p) const {
  return {scale_ * p.dot(right_) - left_, -scale_ * p.dot(up_) - top_, scale_ * p.dot(toViewer_)};
}

DepthBuffer::DepthBuffer(double width, double height, double bufferPixelsPerPixel)
    : scale_(bufferPixelsPerPixel),
      columns_(static_cast<int>(width * bufferPixelsPerPixel) + 1),
      rows_(static_cast<int>(height * bufferPixelsPerPixel) + 1),
      depth_(static_cast<std::size_t>(columns_) * rows_, -std::numeric_limits<double>::infinity()),
      owner_(depth_.size(), -1) {}

void DepthBuffer::cover(const Corners& corners,
                        const std::function<void(std::size_t, double)>& visit) const {
  const Vec3 a = corners[0] * scale_, b = corners[1] * scale_, c = corners[2] * scale_;
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (!(std::abs(area) > 1e-9)) return;
  const auto clamp = [](double v, int top) {
    return static_cast<int>(std::clamp(v, 0.0, double(top)));
  };
  const int x0 = clamp(std::min({a.x(), b.x(), c.x()}), columns_ - 1),
            x1 = clamp(std::max({a.x(), b.x(), c.x()}), columns_ - 1);
  const int y0 = clamp(std::min({a.y(), b.y(), c.y()}), rows_ - 1),
            y1 = clamp(std::max({a.y(), b.y(), c.y()}), rows_ - 1);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double u = ((px - a.x()) * (c.y() - a.y()) - (py - a.y()) * (c.x() - a.x())) / area;
      const double v = ((b.x() - a.x()) * (py - a.y()) - (b.y() - a.y()) * (px - a.x())) / area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      visit(static_cast<std::size_t>(y) * columns_ + x,
            (a.z() + u * (b.z() - a.z()) + v * (c.z() - a.z())) / scale_);
    }
}

void DepthBuffer::draw(const Corners& corners, int owner) {
  cover(corners, [&](std::size_t pixel, double depth) {
    if (depth <= depth_[pixel]) return;
    depth_[pixel] = depth;
    owner_[pixel] = owner;
  });
}

std::vector<int> DepthBuffer::pixelsOf(int owners) const {
  std::vector<int> counts(static_cast<std::size_t>(owners), 0);
  for (const int owner : owner_)
    if (owner >= 0) ++counts[static_cast<std::size_t>(owner)];
  return counts;
}

}  // namespace corridor::view
