#pragma once

#include <array>
#include <string>
#include <vector>

#include "collision/core/transform.h"
#include "planner/view/projection.h"

/// The triangles of SVG pictures: functions that shade them, sort them by depth, and write them as
/// SVG.
namespace corridor::view {

using Triangle3 = std::array<Vec3, 3>;  ///< in the world, metres

/// The number of shades of a palette.
inline constexpr int kShades = 8;

/// A projected triangle of the picture.
struct Face {
  Corners corners;
  char palette = 'w';
  int shade = 0;  ///< from 0 (dark) to kShades − 1 (light)
  double depth() const { return corners[0].z() + corners[1].z() + corners[2].z(); }
};

/// Projects a triangle, and shades it as a surface that is lit from the viewer's side.
Face makeFace(const Camera& camera, const Triangle3& triangle, char palette);

/// Cuts a face into pieces with edges of at most 70 pixels, by halving the longest edge, and
/// appends them to `pieces`. Small pieces can be sorted by depth.
void cut(const Face& face, std::vector<Face>& pieces);

/// Returns SVG paths of the visible faces, farthest first, with coordinates in whole pixels. Leaves
/// out faces with few visible pixels, until the text has at most `limit` bytes or only large faces
/// are left.
std::string drawVisible(const Camera& camera, const std::vector<Face>& faces, std::size_t limit);

/// Returns the CSS of a palette: shades from the colour `dark` to the colour `light`, each given by
/// red, green and blue from 0 to 255.
std::string palette(char name, const Vec3& dark, const Vec3& light);

}  // namespace corridor::view
