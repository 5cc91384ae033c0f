#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/meshes.h"
#include "tests/support/reference_motion.h"

namespace corridor::test {

/// A fixed mesh below a plane with normal n, and a moving mesh above this plane. The height of the
/// moving mesh's lowest corner above the plane is `gap` at t = 1, or at all times if the mesh
/// slides. If `known` is true, the verdict follows from the construction. If the gap is negative,
/// two features (a corner and a face, or two edges) penetrate each other. Otherwise the gap is the
/// distance of the meshes at t = 1.
struct Grazing {
  enum Feature { cornerOnFace, faceOnCorner, edgeOnEdge, features };
  TriangleMesh fixed, moving;
  RigidPose from, to;
  /// True if the lowest corner of the moving mesh is never lower than the lowest corner at the end.
  /// The verdict is then known.
  bool known = false;

  Grazing(std::mt19937_64& random, Feature feature, bool slides, double gap, double size) {
    const auto real = [&](double low = -1, double high = 1) {
      return std::uniform_real_distribution(low, high)(random);
    };
    const Vec3 n = Vec3(real(), real(), real()).normalized();
    const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
    const double spread = real(0, 6.28);
    const auto inPlane = [&](double angle, double r) {
      return Vec3(r * (std::cos(angle + spread) * u + std::sin(angle + spread) * v));
    };
    const auto around = [&](int i) {
      return inPlane(2.1 * i, real(0.3, 1));
    };  // the results for i = 0, 1, 2 surround the origin
    const Vec3 x = 3 * Vec3(real(), real(), real());
    // Points are relative to x, and heights are along n. Heights are at most 0 on the fixed
    // triangle, and at least `gap` on the moving triangle.
    Triangle a, b;
    if (feature == cornerOnFace) {
      for (int i = 0; i < 3; ++i) a[i] = around(i);
      b = {Vec3::Zero(), around(0) + n, around(1) + n * real(0.3, 1)};
    } else if (feature == faceOnCorner) {
      for (int i = 0; i < 3; ++i) b[i] = around(i);
      a = {Vec3::Zero(), around(0) - n, around(1) - n * real(0.3, 1)};
    } else {
      const double turn = real(0.3, 2.8);
      a = {inPlane(0, real(0.3, 1)), inPlane(std::numbers::pi, real(0.3, 1)), around(2) - n};
      b = {inPlane(turn, real(0.3, 1)), inPlane(turn + std::numbers::pi, real(0.3, 1)),
           around(1) + n};
    }
    to = {size * (x + Vec3(real(), real(), real())),
          Eigen::Quaterniond(real(), real(), real(), real()).normalized()};
    const ReferenceMotion at(to, to);
    const auto toBody = [&](const Vec3& p) {
      const auto world = (size * (x + p + gap * n)).cast<long double>().eval();
      return Vec3((at.rotation(0).transpose() * (world - at.position(0))).cast<double>());
    };
    add(fixed, size * (x + a[0]), size * (x + a[1]), size * (x + a[2]));
    add(moving, toBody(b[0]), toBody(b[1]), toBody(b[2]));
    for (int i = 0; i < 40; ++i) {  // more triangles, so that the trees have depth
      const Vec3 c = 2 * around(i) + n * real(1, 2), d = 2 * around(i) - n * real(0.5, 2);
      add(moving, toBody(c), toBody(c + 0.1 * around(0)), toBody(c + 0.1 * n));
      add(fixed, size * (x + d), size * (x + d + 0.1 * around(1)), size * (x + d - 0.1 * n));
    }
    if (slides) {  // along the plane, with a rotation about its normal: every height is constant
      from.p = to.p + size * inPlane(real(), real(0, 3));
      from.q = Eigen::Quaterniond(Eigen::AngleAxisd(real(-2, 2), n)) * to.q;
    } else {
      from.p = to.p + size * (n * real(0.5, 3) + inPlane(real(), real(0, 3)));
      from.q = Eigen::Quaterniond(
                   Eigen::AngleAxisd(real(-1, 1), Vec3(real(), real(), real()).normalized())) *
               to.q;
    }
    const ReferenceMotion motion(from, to);
    known = true;
    const auto lowestHeight = [&](long double t) {
      const auto R = motion.rotation(t);
      const auto nL = n.cast<long double>().eval();
      const long double base = (motion.position(t) / size - x.cast<long double>()).dot(nL);
      long double lowest = 1e300L;
      for (const Vec3& p : moving.vertices)
        lowest = std::min(lowest, base + nL.dot(R * p.cast<long double>()) / size);
      return lowest;
    };
    for (int i = 0; i <= 200 && known && !slides; ++i)
      known = lowestHeight(i / 200.0L) >= lowestHeight(1) - 1e-17L;
    for (int k = 1; k < 12 && known && !slides; ++k)
      known = lowestHeight(1 - std::pow(10.0L, -k)) >= lowestHeight(1) - 1e-17L;
  }
};

}  // namespace corridor::test
