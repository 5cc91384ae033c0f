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
    const Vec3 seen(p.dot(right_), -p.dot(up_), p.dot(toViewer_));
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  if (points.empty()) low = high = Vec3::Zero();
  // A point, or a line along the line of sight, gets some extent.
  const double largest = (high - low).maxCoeff();
  const Vec3 size = (high - low).cwiseMax(largest > 0 ? 2e-3 * largest : 2),
             corner = 0.5 * (low + high) - 0.5 * size;
  // The picture's width is at most `width`, and its height at most about 0.8 times `width`.
  scale_ = std::min((width - 2 * border) / size.x(), 0.8 * width / size.y());
  width_ = scale_ * size.x() + 2 * border;
  height_ = scale_ * size.y() + 2 * border;
  left_ = scale_ * corner.x() - border;
  top_ = scale_ * corner.y() - border;
  farthest_ = scale_ * corner.z();
}

Vec3 Camera::project(const Vec3& p) const {
  return {scale_ * p.dot(right_) - left_, -scale_ * p.dot(up_) - top_,
          scale_ * p.dot(toViewer_) - farthest_};
}

}  // namespace corridor::view
