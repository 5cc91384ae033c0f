#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collision/core/transform.h"

namespace corridor::view {

/// A parallel projection: world to (x right, y down, depth towards the viewer), in pixels.
class Camera {
 public:
  /// Angles in radians: azimuth of the viewer about z, elevation above the ground.
  Camera(double azimuth, double elevation);
  /// Scales and shifts such that the points fill a picture of this width, with a border.
  void fit(const std::vector<Vec3>& points, double width, double border);

  Vec3 project(const Vec3& point) const;
  const Vec3& towardsViewer() const { return toViewer_; }
  /// The length in the world that is a pixel wide.
  double worldPixel() const { return 1 / scale_; }
  double width() const { return width_; }
  double height() const { return height_; }

 private:
  Vec3 right_, up_, toViewer_;
  double scale_ = 1, left_ = 0, top_ = 0, width_ = 0, height_ = 0;
};

using Corners = std::array<Vec3, 3>;  ///< projected

/// A depth buffer that knows whose pixel is nearest.
class DepthBuffer {
 public:
  DepthBuffer(double width, double height, double pixelsAPixel);

  /// Calls visit(pixel, depth) for each pixel whose middle the triangle covers.
  void cover(const Corners& corners, const std::function<void(std::size_t, double)>& visit) const;
  void draw(const Corners& corners, int owner);
  double depth(std::size_t pixel) const { return depth_[pixel]; }
  /// How many pixels each owner in [0, owners) has.
  std::vector<int> pixelsOf(int owners) const;

 private:
  double scale_;
  int columns_, rows_;
  std::vector<double> depth_;
  std::vector<int> owner_;
};

}  // namespace corridor::view
