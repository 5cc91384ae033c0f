#include "planner/view/tessellate.h"

#include <gtest/gtest.h>

#include "collision/convex/simple_polygon.h"

namespace corridor::view {
namespace {

/// Each side of a polygon has the polygon's area, and all triangles are in its plane. A corner of
/// nearly 180 degrees is drawn, too.
TEST(FlatSurface, CoversAPolygonOnBothSides) {
  const std::vector<Vec2> polygon{{0, 0}, {4, -0.125}, {8, 0}, {8, 1}, {1, 1}, {1, 4}, {0, 4}};
  const double area = 8 + 0.5 + 3;
  std::vector<ConvexPart> parts;
  for (const auto& piece : convexPieces(polygon)) {
    ConvexPart& part = parts.emplace_back();
    for (const std::uint32_t i : piece) part.points.emplace_back(polygon[i].x(), polygon[i].y(), 0);
  }
  const TriangleMesh mesh = flatSurface(parts);
  double up = 0, down = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const double twice = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    (twice > 0 ? up : down) += twice / 2;
    EXPECT_EQ(a.z(), 0);
  }
  EXPECT_EQ(up, area);
  EXPECT_EQ(down, -area);
}

}  // namespace
}  // namespace corridor::view
