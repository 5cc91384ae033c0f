#include "collision/motion/moving_hulls.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/geometry/convex_part.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Clusters of small triangles at seven points of a cube: the mesh has a hull of grid cells, and
/// the centre of the cell at the first point is outside of the body's bounding sphere.
TriangleMesh clusters(const Vec3& first) {
  std::mt19937_64 random(3);
  const auto some = [&](double low) {
    return std::uniform_real_distribution<double>(low, 1)(random);
  };
  const Vec3 middle(0.5, 0.5, 0.5);
  TriangleMesh mesh;
  for (const Vec3& at : {first, Vec3(1, .1749, .1999), Vec3(.1999, 1, .1749), Vec3(.1999, .1749, 1),
                         Vec3(.41, .41, 0), Vec3(0, .41, .41), Vec3(.41, 0, .41)}) {
    int axis = 0;
    if (at != first) (at - middle).cwiseAbs().maxCoeff(&axis);
    Vec3 inward(-.1, -.1, -.1);
    inward[axis] = at[axis] > 0.5 ? -1 : 1;
    for (int n = 0; n < 130; ++n) {
      const Vec3 o = at + (n ? 0.002 * some(0.1) : 0) * inward;
      Vec3 side = Vec3::Zero(), other = Vec3::Zero();
      side[axis] = inward[axis], other[axis] = 0.5 * inward[axis];
      side[(axis + 1) % 3] = other[(axis + 2) % 3] = -0.2;
      std::array<Vec3, 3> corners = {o, o + 0.001 * some(0.5) * side,
                                     o + 0.001 * some(0.5) * other};
      for (Vec3& corner : corners) corner = corner.cwiseMax(0.0).cwiseMin(1.0);
      if ((corners[1] - o).cross(corners[2] - o).dot(at - middle) < 0)
        std::swap(corners[1], corners[2]);
      const auto begin = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
      mesh.triangles.push_back({begin, begin + 1, begin + 2});
    }
  }
  return mesh;
}

TEST(MovingHulls, PointsOfCellsMayBeOutsideOfTheSphere) {
  const double cell = 1.0 / 40, z = 1e-10;
  const Vec3 first(39 * cell - z, cell - z, 17 * cell - z);
  const Body b("clusters", clusters(first));
  ASSERT_TRUE(b.hull());
  ASSERT_GT(b.hull()->ball, 0);
  double farthest = 0;
  for (const Vec3& p : b.hull()->points)
    farthest = std::max(farthest, (p - b.sphereCenter()).norm());
  ASSERT_GT(farthest, b.sphereRadius());
  EXPECT_LE(farthest, b.sphereRadius() + b.hull()->ball);

  // The body turns about axes through its centre, above a slab that is 0.3 m below its path.
  const Vec3 center = b.sphereCenter(), u = (first - center).normalized(),
             down = -Vec3(1, 1, 1).normalized();
  int separated = 0;
  for (const double half : {0.03, 0.05, 0.07, 0.1, 0.12})
    for (double along = -2; along <= 2; along += 0.5)
      for (double tilt = -1.5; tilt <= 1.5; tilt += 0.1) {
        const Vec3 k0 = (down - u * u.dot(down)).normalized();
        const double turn = along * half * u.dot(down);
        const Vec3 axis = (std::cos(turn) * k0 + std::sin(turn) * u.cross(k0)).normalized();
        const Mat3 Q = Eigen::Quaterniond::FromTwoVectors(
                           Vec3::UnitX(), Vec3(Eigen::AngleAxisd(tilt * half, axis) * down))
                           .toRotationMatrix();
        const Vec3 n = Q.col(0);
        double least = HUGE_VAL;
        for (int i = -10; i <= 10; ++i) {
          const Mat3 R = Eigen::AngleAxisd(i / 10.0 * half, axis).toRotationMatrix();
          for (const Vec3& v : b.mesh().vertices)
            least = std::min(least, n.dot(R * (v - center) + center));
        }
        RelativeMotion relative;
        ScrewMotion screw;
        screw.axis = axis;
        screw.point = center;
        screw.amount = half * (1 + 1e-15);
        relative.angular = half * axis;
        relative.linear = relative.angular.cross(-center);
        relative.speed = lengthFromAbove(relative.linear);
        relative.angle = lengthFromAbove(relative.angular);
        relative.screws = {&screw, 1};
        relative.fixedError = 1e-14;
        relative.reachError = 1e-15;
        const Body a("slab", {placed(Box{Vec3(0.1, 20, 20)}, {Q, (least - 0.35) * n})});
        HullGuess guess;
        guess.normal = n;
        const MovingHullsAnswer answer = decideMovingHulls(a, b, relative, 0, guess);
        separated += answer.separated;
        EXPECT_LE(answer.clearance, 0.3 + 1e-9) << half << " " << tilt;
      }
  EXPECT_GT(separated, 100);
}

}  // namespace
}  // namespace corridor
