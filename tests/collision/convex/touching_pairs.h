#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"

namespace corridor::test {

/// A solid or a triangle, with a point x on its surface and an outward normal m at x, all in the
/// frame of the shape. The direction −m points into the shape, except at the face of a triangle.
struct ShapeFeature {
  ConvexPart part;  ///< a triangle is the hull of its corners
  bool isTriangle = false, flat = false;
  Vec3 x = Vec3::Zero(), m = Vec3::UnitZ();

  ConvexSet set() const { return part; }
};

enum class Shape { box, sphere, capsule, cylinder, convex, triangle };
inline constexpr Shape kShapes[] = {Shape::box,      Shape::sphere, Shape::capsule,
                                    Shape::cylinder, Shape::convex, Shape::triangle};

/// A generator of shapes, and of poses in which two shapes touch at known points.
class Touching {
 public:
  explicit Touching(std::uint64_t seed) : random_(seed) {}

  double real(double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  Vec3 vector() { return {real(), real(), real()}; }
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  /// Returns a random length; one in six is very small.
  double extent() { return pick(6) == 0 ? 1e-6 * real(0.5, 1) : real(0.05, 1); }

  /// Returns a random solid (or triangle) of the given kind, with a random point on a face, an
  /// edge, a corner or a curved surface.
  ShapeFeature feature(Shape shape) {
    ShapeFeature f;
    const double turn = real(0, 6.3);
    const Vec3 radial(std::cos(turn), std::sin(turn), 0), z = Vec3::UnitZ();
    switch (shape) {
      case Shape::box: {
        const Vec3 size(extent(), extent(), extent());
        f.part = placed(Box{size}, {});
        const int kind = pick(3);  // face, edge, corner
        for (int i = 0; i < 3; ++i) {
          const bool free = kind == 0 ? i != 0 : kind == 1 && i == 1;
          f.x[i] = 0.5 * size[i] * (free ? real(-0.9, 0.9) : 1);
          f.m[i] = free ? 0 : kind == 0 ? 1 : real(0.05, 1);
        }
        break;
      }
      case Shape::sphere: {
        const double r = extent();
        f.part = placed(Sphere{r}, {});
        f.m = vector().normalized();
        f.x = r * f.m;
        break;
      }
      case Shape::capsule: {
        const double r = extent(), l = extent();
        f.part = placed(Capsule{r, l}, {});
        const bool side = pick(2) == 0;
        f.m = side ? radial : (radial + z * real(0.01, 2)).normalized();
        f.x = r * f.m + z * (l / 2) * (side ? real(-0.9, 0.9) : 1);
        break;
      }
      case Shape::cylinder: {
        const double r = extent(), l = extent();
        f.part = placed(Cylinder{r, l}, {});
        const int kind = pick(3);  // cap, side, rim
        f.m = kind == 0 ? z : kind == 1 ? radial : Vec3(radial + z * std::exp(4 * real()));
        f.x = r * radial * (kind == 0 ? real(0, 0.9) : 1) +
              z * (l / 2) * (kind == 1 ? real(-0.9, 0.9) : 1);
        break;
      }
      case Shape::convex: {
        Convex hull;
        const int n = 4 + pick(20);
        const double size = extent();
        for (int i = 0; i < n; ++i) hull.points.push_back(size * vector().normalized());
        f.part = placed(hull, {});
        f.x = f.m = hull.points[0];  // a corner, with the direction from the centre as its normal
        // Four more points around −0.5·x: the hull contains −0.5·x, so the segment from x along −m
        // is inside the hull.
        for (const double side : {-0.1 * size, 0.1 * size}) {
          const Vec3 u = f.x.unitOrthogonal();
          f.part.points.push_back(-0.5 * f.x + side * u);
          f.part.points.push_back(-0.5 * f.x + side * f.x.cross(u).normalized());
        }
        break;
      }
      case Shape::triangle: {
        const double size = extent();
        f.isTriangle = true;
        const auto around = [&](double angle, double r) {
          return Vec3(r * size * std::cos(angle + turn), r * size * std::sin(angle + turn), 0);
        };
        const int kind = pick(2);  // face, edge
        if (kind == 0) {
          for (int i = 0; i < 3; ++i) f.part.points.push_back(around(2.1 * i, real(0.3, 1)));
          f.flat = true;
        } else {
          f.part.points = {around(0, real(0.3, 1)), around(std::numbers::pi, real(0.3, 1)),
                           around(1.5 * std::numbers::pi, real(0.1, 1))};
          f.m = around(0.5 * std::numbers::pi, 1);
        }
      }
    }
    f.m.normalize();
    return f;
  }

  /// Returns a rotation that maps m to n, with a random rotation about n. Some of these rotations
  /// are signed permutations.
  Mat3 turning(const Vec3& m, const Vec3& n) {
    const auto frame = [](const Vec3& z) {
      const Vec3 x = z.unitOrthogonal();
      return (Mat3() << x, z.cross(x), z).finished();
    };
    return Eigen::AngleAxisd(pick(3) == 0 ? 0 : real(-3, 3), n).toRotationMatrix() * frame(n) *
           frame(m).transpose();
  }

  /// Returns a pose that maps the feature's point to `where`, and its normal to n.
  Transform pose(const ShapeFeature& f, const Vec3& where, const Vec3& n) {
    Transform X;
    X.m = turning(f.m, n);
    const Eigen::Matrix<long double, 3, 1> moved =
        X.m.cast<long double>() * f.x.cast<long double>();
    X.t = (where.cast<long double>() - moved).cast<double>();
    return X;
  }

 private:
  std::mt19937_64 random_;
};

/// Returns the largest magnitude of a coordinate of a set, in the set's frame or in the world,
/// radii included; metres.
inline double largestCoordinate(const ConvexSet& set, const Transform& X) {
  double largest = X.t.cwiseAbs().maxCoeff();
  for (const Vec3& p : set.points)
    largest = std::max({largest, (X * p).cwiseAbs().maxCoeff() + set.ball + set.disc,
                        p.cwiseAbs().maxCoeff() + set.ball + set.disc});
  return largest;
}

}  // namespace corridor::test
