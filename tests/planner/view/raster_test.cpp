#include "planner/view/raster.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace corridor::view {
namespace {

const Vec3 kRed(255, 0, 0), kBlue(0, 0, 255);

/// A camera that looks down at the square from (0, 0) to (10, 10), 100 pixels wide.
Camera cameraFromAbove() {
  Camera camera(-M_PI / 2, M_PI / 2);
  camera.fit({Vec3(0, 0, 0), Vec3(10, 8, 0)}, 100, 0);
  return camera;
}

/// Returns the colour of the pixel at a point of the world.
Vec3 colourAt(const Camera& camera, const Image& image, const Vec3& p) {
  const Vec3 at = camera.project(p) * (image.width / camera.width());
  const auto pixel = std::size_t{3} * (int(at.y()) * image.width + int(at.x()));
  const auto byte = [&](std::size_t i) {
    return double(static_cast<unsigned char>(image.rgb.at(pixel + i)));
  };
  return {byte(0), byte(1), byte(2)};
}

std::vector<Surface> square(const Camera& camera, double zLeft, double zRight, const Vec3& colour,
                            std::size_t layer) {
  const Palette flat{colour, colour};
  const Vec3 a(0, 0, zLeft), b(10, 0, zRight), c(10, 8, zRight), d(0, 8, zLeft);
  return {makeSurface(camera, {a, b, c}, flat, layer), makeSurface(camera, {a, c, d}, flat, layer)};
}

/// Two squares that cut each other: a painter that sorts triangles would draw one over the other.
TEST(Raster, TheNearerSurfaceAtEveryPixel) {
  const Camera camera = cameraFromAbove();
  std::vector<Surface> surfaces = square(camera, 0, 1, kRed, 0);
  for (const Surface& surface : square(camera, 1, 0, kBlue, 0)) surfaces.push_back(surface);
  const Image image = render(camera, surfaces, {}, 200);
  EXPECT_EQ(image.width, 200);
  EXPECT_EQ(image.height, 160);
  ASSERT_EQ(image.rgb.size(), 200u * 160 * 3);
  for (const double y : {0.5, 3.0, 7.5}) {
    for (const double x : {0.1, 2.0, 4.9}) EXPECT_EQ(colourAt(camera, image, {x, y, 0}), kBlue);
    for (const double x : {5.1, 8.0, 9.9}) EXPECT_EQ(colourAt(camera, image, {x, y, 0}), kRed);
  }
}

TEST(Raster, TransparentLayersInTheOrderOfTheirDepths) {
  const Camera camera = cameraFromAbove();
  std::vector<Surface> surfaces = square(camera, 0, 0, Vec3::Zero(), 0);
  const auto add = [&](double z, const Vec3& colour, std::size_t layer) {
    for (const Surface& surface : square(camera, z, z, colour, layer)) surfaces.push_back(surface);
  };
  add(2, kRed, 1);
  add(1.5, kRed, 1);  // behind the first in the same layer: not seen
  add(1, kBlue, 2);
  add(-1, kBlue, 3);  // below the opaque square: not seen
  const Image image = render(camera, surfaces, {1, 0.5, 0.5, 0.5}, 100);
  EXPECT_EQ(colourAt(camera, image, {3, 3, 0}), Vec3(128, 0, 64));  // 127.5 and 63.75, rounded
}

/// Triangles of any direction, size and place cover the pixels whose centres they contain.
TEST(Raster, CoversThePixelsInATriangle) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-20, 60);
  const PixelGrid grid{40, 5, 30};
  int covered = 0;
  for (int n = 0; n < 2000; ++n) {
    Corners t;
    for (Vec3& corner : t) corner = {number(random), number(random), 1};
    if (n % 4 == 0) t[2] = 0.5 * (t[0] + t[1]) + Vec3(0.3, 0.2, 0);  // a sliver
    std::vector<int> visits(grid.size(), 0);
    grid.cover(t, [&](std::size_t pixel, double depth) {
      ++visits[pixel];
      EXPECT_NEAR(depth, 1, 1e-9);
    });
    for (int y = grid.begin; y < grid.end; ++y)
      for (int x = 0; x < grid.columns; ++x) {
        const Vec3 p(x + 0.5, y + 0.5, 0);
        double least = HUGE_VAL, most = -HUGE_VAL;
        for (int i = 0; i < 3; ++i) {
          const Vec3 along = t[(i + 1) % 3] - t[i], to = p - t[i];
          const double side = (along.x() * to.y() - along.y() * to.x()) / along.norm();
          least = std::min(least, side);
          most = std::max(most, side);
        }
        const int visit = visits[std::size_t(y - grid.begin) * grid.columns + x];
        if (std::min(std::abs(least), std::abs(most)) < 1e-9) continue;  // on an edge
        ASSERT_EQ(visit, least > 0 || most < 0) << n << ": " << x << ", " << y;
        covered += visit;
      }
  }
  EXPECT_GT(covered, 10'000);
}

TEST(Raster, SidesOfImages) {
  Camera tower(0, 0), nothing(0, 0);
  tower.fit({Vec3(0, 0, 0), Vec3(0, 0.001, 10)}, 1000, 20);
  const Image image = render(tower, {}, {}, 300);
  EXPECT_EQ(image.height, 300);
  EXPECT_LT(image.width, 30);
  nothing.fit({}, 1000, 20);
  EXPECT_EQ(render(nothing, {}, {}, 100).width, 100);
}

TEST(Raster, Lines) {
  const Camera camera = cameraFromAbove();
  std::vector<Surface> surfaces;
  const std::vector<Vec3> points{camera.project({1, 4, 0}), camera.project({9, 4, 0})};
  addLine(surfaces, points, 10, 1e9, kBlue, 0);
  const Image image = render(camera, surfaces, {}, 100);
  EXPECT_EQ(colourAt(camera, image, {5, 4.4, 0}), kBlue);
  EXPECT_NE(colourAt(camera, image, {5, 4.6, 0}), kBlue);
  EXPECT_EQ(colourAt(camera, image, {0.7, 4, 0}), kBlue) << "the ends are round";
  EXPECT_NE(colourAt(camera, image, {0.4, 4, 0}), kBlue);
}

}  // namespace
}  // namespace corridor::view
