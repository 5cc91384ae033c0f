#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "collision/core/transform.h"
#include "planner/view/projection.h"

/// Pictures of surfaces, drawn by depth buffers: right at every pixel, also where surfaces meet.
namespace corridor::view {

using Triangle3 = std::array<Vec3, 3>;  ///< in the world, metres

/// The colours of a surface that is not lit, and of one that the light meets at a right angle: red,
/// green and blue from 0 to 255.
struct Palette {
  Vec3 dark, light;
};

/// A projected triangle with its colour.
struct Surface {
  Corners corners;
  Vec3 colour = Vec3::Zero();  ///< red, green and blue, from 0 to 255
  /// Surfaces of layer 0 are opaque. In every other layer only the nearest surface is visible, and
  /// lets light through.
  std::size_t layer = 0;
};

/// Projects a triangle, and shades it as a surface that is lit from the viewer's side.
Surface makeSurface(const Camera& camera, const Triangle3& triangle, const Palette& palette,
                    std::size_t layer = 0);

/// Appends a line of this width (pixels of the picture) with round corners.
/// @param points in picture coordinates. @param depth of the whole line.
void addLine(std::vector<Surface>& surfaces, std::span<const Vec3> points, double width,
             double depth, const Vec3& colour, std::size_t layer);

/// A picture of pixels.
struct Image {
  int width = 0, height = 0;
  std::string rgb;  ///< three bytes for each pixel, row by row
};

/// Draws surfaces on a light background, with smooth edges.
/// @param opacities for each layer, from 0 to 1; that of layer 0 is not used.
/// @param longest the longer side of the image, pixels: at most 8000.
Image render(const Camera& camera, std::span<const Surface> surfaces,
             const std::vector<double>& opacities, int longest);

/// Returns the bytes of a PNG file.
std::string pngOf(const Image& image);

/// Returns the first lines of an SVG document of the camera's picture: its size, and an image of
/// the surfaces. What follows is drawn on top.
std::string svgHead(const Camera& camera, std::span<const Surface> surfaces,
                    const std::vector<double>& opacities);

}  // namespace corridor::view
