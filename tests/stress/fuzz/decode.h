#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/motion/rigid_motion.h"

namespace corridor::fuzz {

/// Makes small scenes from the bytes of an input. Any bytes make a scene; after the last byte, the
/// decoder reads zeros.
///
/// Most numbers are from coarse grids, or repeat an earlier number, or differ from an earlier
/// number by a few units in the last place. So coplanar, touching and grazing features are about as
/// likely as others.
class Decoder {
 public:
  Decoder(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}

  std::uint8_t byte() { return at_ == end_ ? 0 : *at_++; }
  /// Returns a number in [0, count).
  std::size_t below(std::size_t count) { return byte() % count; }
  bool oneIn(std::size_t n) { return below(n) == n - 1; }

  /// Limits the magnitude of all further numbers: each is 0, or has a magnitude from 1/`largest` to
  /// `largest`. @pre `largest` ≥ 2.
  void limit(double largest) { largest_ = largest; }

  double real() {
    const double value = bounded(anyReal());
    earlier_.push_back(value);
    return value;
  }
  double positive() {
    const double value = std::abs(real());
    return value > 0 ? value : 0.5;
  }
  Vec3 vector() {
    const double x = real(), y = real();
    return {x, y, real()};
  }
  /// Returns a vector that is not zero.
  Vec3 direction() {
    if (oneIn(2)) return Vec3::Unit(static_cast<Eigen::Index>(below(3)));
    const Vec3 v = vector();
    return v.stableNorm() > 0 ? v : Vec3(0, 0, 1);
  }
  /// Returns a quaternion of any norm except 0.
  Eigen::Quaterniond quaternion() {
    switch (below(4)) {
      case 0:
        return Eigen::Quaterniond::Identity();
      case 1: {  // quarter and half turns about the axes, and a third of a turn about a diagonal
        const double h = std::numbers::sqrt2 / 2;
        const Eigen::Quaterniond turns[] = {{h, h, 0, 0},    {h, 0, h, 0}, {h, 0, 0, h},
                                            {0, 1, 0, 0},    {0, 0, 1, 0}, {0, 0, 0, 1},
                                            {.5, .5, .5, .5}};
        return turns[below(7)];
      }
      case 2:
        return Eigen::Quaterniond(Eigen::AngleAxisd(real(), direction().stableNormalized()));
      default: {
        const Vec3 v = vector();
        const Eigen::Quaterniond q(real(), v.x(), v.y(), v.z());
        const double norm = q.coeffs().stableNorm();
        return norm > 1e-100 && norm < 1e100 ? q : Eigen::Quaterniond::Identity();
      }
    }
  }
  RigidPose pose() {
    const Vec3 p = vector();
    return {p, quaternion()};
  }
  /// Returns a rigid map; its rotation matrix is rounded.
  Transform map() {
    const RigidPose rigid = pose();
    return {rigid.q.normalized().toRotationMatrix(), rigid.p};
  }
  /// Returns a map that is rarely rigid: it scales, shears, mirrors or flattens, differs from a
  /// rigid map by some 1e-9, or is arbitrary.
  Transform anyMap() {
    Transform X = map();
    const double s = real();
    switch (below(5)) {
      case 0:
        X.m *= s;
        break;
      case 1:
        X.m(below(3), below(3)) += 1e-9 * s;
        break;
      case 2:
        X.m(below(3), below(3)) = s;
        break;
      case 3:
        X.m.col(static_cast<Eigen::Index>(below(3))) *= -1;
        break;
      default:
        for (Eigen::Index i = 0; i < 9; ++i) X.m(i) = real();
    }
    return X;
  }

  TriangleMesh mesh() {
    TriangleMesh mesh;
    switch (below(4)) {
      case 0:
        addTetrahedron(mesh);
        break;
      case 1:
        addBox(mesh);
        break;
      default:
        addSoup(mesh);
    }
    if (oneIn(3)) addCopies(mesh);
    return mesh;
  }
  /// Returns a closed surface, which may be flat, or inside out.
  TriangleMesh closedMesh() {
    TriangleMesh mesh;
    oneIn(2) ? addBox(mesh) : addTetrahedron(mesh);
    if (oneIn(4)) addCopies(mesh);
    return mesh;
  }
  /// Returns a valid primitive at some pose.
  ConvexPart part() {
    Primitive primitive;
    switch (below(5)) {
      case 0: {
        const double x = positive(), y = positive();
        primitive = Box{{x, y, positive()}};
        break;
      }
      case 1:
        primitive = Sphere{positive()};
        break;
      case 2: {
        const double radius = positive();
        primitive = Capsule{radius, positive()};
        break;
      }
      case 3: {
        const double radius = positive();
        primitive = Cylinder{radius, positive()};
        break;
      }
      default: {
        Convex convex;
        for (std::size_t n = 1 + below(8); n > 0; --n) convex.points.push_back(vector());
        primitive = convex;
      }
    }
    const Transform X = map();
    return placed(checkPrimitive(primitive) ? Primitive(Sphere{0.5}) : primitive, X);
  }

 private:
  double anyReal() {
    switch (below(8)) {
      case 0:
      case 1:
        return static_cast<std::int8_t>(byte()) / 8.0;
      case 2:
        return earlier();
      case 3: {  // a few units in the last place away from an earlier number
        double value = earlier();
        const int steps = static_cast<std::int8_t>(byte()) % 8;
        for (int i = 0; i < std::abs(steps); ++i)
          value = std::nextafter(value, steps > 0 ? HUGE_VAL : -HUGE_VAL);
        return value;
      }
      case 4: {
        const double a = earlier(), b = earlier();
        return oneIn(2) ? a + b : a - b;
      }
      case 5:
        return static_cast<std::int16_t>(byte() << 8 | byte()) / 1000.0;
      case 6: {
        static constexpr double nasty[] = {0,
                                           -0.0,
                                           1e-15,
                                           1e-12,
                                           1e-9,
                                           1e-7,
                                           1e-5,
                                           1e-3,
                                           1.0 / 3,
                                           1 + 0x1p-52,
                                           1 - 0x1p-53,
                                           std::numbers::pi,
                                           std::numbers::pi / 2,
                                           1e3,
                                           1e5,
                                           1e6,
                                           1e9,
                                           1e15,
                                           1e100,
                                           1e-100,
                                           1e-300,
                                           1e300,
                                           0x1p-1074,
                                           0x1p-1022};
        return nasty[below(std::size(nasty))] * (oneIn(2) ? -1 : 1);
      }
      default: {
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
        return std::bit_cast<double>(bits);
      }
    }
  }
  double earlier() { return earlier_.empty() ? 1 : earlier_[below(earlier_.size())]; }
  /// Returns the value, brought into the range of `limit`: a number out of range keeps its
  /// significand, and gets a magnitude in [1/2, 1). An infinity becomes ±`largest_`, and a NaN
  /// becomes 1.
  double bounded(double value) const {
    if (std::isnan(value)) return 1;
    if (std::isinf(value)) return std::copysign(largest_, value);
    if (value == 0 || (std::abs(value) <= largest_ && std::abs(value) >= 1 / largest_))
      return value;
    int exponent = 0;
    return std::frexp(value, &exponent);
  }

  void addTriangle(TriangleMesh& mesh, std::array<std::uint32_t, 3> corners) {
    mesh.triangles.push_back(corners);
  }
  void addTetrahedron(TriangleMesh& mesh) {
    for (int i = 0; i < 4; ++i) mesh.vertices.push_back(vector());
    for (const auto& t : {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
      addTriangle(mesh, t);
  }
  void addBox(TriangleMesh& mesh) {
    const Vec3 lower = vector(), upper = vector();
    for (int i = 0; i < 8; ++i)
      mesh.vertices.emplace_back(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
                                 i & 4 ? upper.z() : lower.z());
    static constexpr std::uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& f : faces) {
      addTriangle(mesh, {f[0], f[1], f[2]});
      addTriangle(mesh, {f[0], f[2], f[3]});
    }
  }
  void addSoup(TriangleMesh& mesh) {
    for (std::size_t n = 3 + below(6); n > 0; --n) mesh.vertices.push_back(vector());
    for (std::size_t n = 1 + below(8); n > 0; --n) {
      std::array<std::uint32_t, 3> corners{};
      for (std::uint32_t& corner : corners)
        corner = static_cast<std::uint32_t>(below(mesh.vertices.size()));
      addTriangle(mesh, corners);
    }
  }
  /// Adds up to 8 copies of the mesh, in a row.
  void addCopies(TriangleMesh& mesh) {
    const TriangleMesh one = mesh;
    const Vec3 step = vector();
    const std::size_t copies = below(9);
    for (std::size_t i = 1; i <= copies; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const Vec3& v : one.vertices) mesh.vertices.push_back(v + double(i) * step);
      for (const auto& t : one.triangles)
        addTriangle(mesh, {first + t[0], first + t[1], first + t[2]});
    }
  }

  const std::uint8_t* at_;
  const std::uint8_t* end_;
  double largest_ = 1e6;
  std::vector<double> earlier_;
};

}  // namespace corridor::fuzz
