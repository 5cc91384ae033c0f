#pragma once

#include <array>
#include <functional>
#include <vector>

#include "collision/core/transform.h"

namespace corridor::view {

/// A parallel projection from world coordinates (metres) to picture coordinates (pixels): x to the
/// right, y down, z (the depth) towards the viewer.
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
  double scale_ = 1, left_ = 0, top_ = 0, width_ = 0, height_ = 0;
};

using Corners = std::array<Vec3, 3>;  ///< of a triangle, in picture coordinates

/// A depth buffer. For each pixel, it also stores which owner (an integer, such as the index of a
/// face) the nearest surface belongs to.
class DepthBuffer {
 public:
  /// @param width, height of the picture, pixels. @param bufferPixelsPerPixel pixels of the buffer
  /// along one pixel of the picture.
  DepthBuffer(double width, double height, double bufferPixelsPerPixel);

  /// Calls visit(pixel, depth) for each pixel whose centre the triangle covers.
  void cover(const Corners& corners, const std::function<void(std::size_t, double)>& visit) const;
  void draw(const Corners& corners, int owner);
  double depth(std::size_t pixel) const { return depth_[pixel]; }
  /// Returns the number of pixels of each owner in [0, owners).
  std::vector<int> pixelsOf(int owners) const;

 private:
  double scale_;
  int columns_, rows_;
  std::vector<double> depth_;
  std::vector<int> owner_;
};

}  // namespace corridor::view
