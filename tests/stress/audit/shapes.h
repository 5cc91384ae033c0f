#pragma once

#include <random>
#include <span>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "tests/stress/audit/quad.h"

namespace corridor::audit {

/// Random numbers of one case.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double real(double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  std::size_t index(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }
  bool oneIn(std::size_t n) { return index(n) == 0; }
  /// 10^x, x evenly between the two.
  double power(double low, double high) { return std::pow(10.0, real(low, high)); }
  double sign() { return oneIn(2) ? 1 : -1; }
  Vec3 vector() {
    const double x = real(), y = real(), z = real();
    return {x, y, z};
  }
  template <class Any>
  const Any& of(std::span<const Any> all) {
    return all[index(all.size())];
  }

 private:
  std::mt19937_64 random_;
};

/// With what a body meets another: a corner (of a curved body the centre of its ball), an edge (of
/// a capsule its axis), or a face.
enum class Feature { corner, edge, face };

/// A convex or nearly convex body above its feature, before it is rounded: in any frame.
struct Plan {
  Feature feature = Feature::corner;
  bool mesh = false, flatEnds = false;
  double radius = 0;
  std::vector<Vec<Quad>> points;  ///< of a mesh its vertices
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A body that ends in `feature` at the point `q`, everything else of it on the side of the unit
/// vector `up`, some `size` large. The edge goes along the unit vector `along`, at a right angle to
/// `up`. A curved body's surface touches the plane through q, so that its feature is above it.
Plan randomPlan(Dice& dice, Feature feature, const Vec<Quad>& q, const Vec<Quad>& up,
                const Vec<Quad>& along, double size);

/// A body as it is stored, in doubles, and what the truth needs of it.
struct Shape {
  Feature feature = Feature::corner;
  bool isMesh = false;
  TriangleMesh mesh;
  ConvexPart part;
  /// Points of the body, its feature first (a corner, two ends, three corners): their hull is in
  /// it, rounding included. With a radius they are points of its core.
  std::array<Vec<Quad>, 3> core;
  double coreRadius = 0;  ///< around the core

  double reach = 0;  ///< m, from the frame's origin

  /// The largest of m·x over the body; m unit, in its frame.
  template <class S>
  S support(const Vec<S>& m) const;
  const std::vector<Vec3>& points() const { return isMesh ? mesh.vertices : part.points; }
};

/// Rounds `plan` under the map X (to the body's frame) after a shift of the plan.
/// @param up  of the plan. @param[out] error  no less than any point is off by, metres.
Shape stored(const Plan& plan, const Pose<Quad>& X, const Vec<Quad>& shift, const Vec<Quad>& up,
             double* error = nullptr);

template <class S>
S Shape::support(const Vec<S>& m) const {
  S most = dot(m, Vec<S>(points()[0]));
  for (const Vec3& p : points()) {
    const S along = dot(m, Vec<S>(p));
    if (along > most) most = along;
  }
  if (isMesh) return most;
  if (!part.flatEnds) return most + part.radius;
  const Vec<S> axis = unit(Vec<S>(part.points[1]) - Vec<S>(part.points[0]));
  return most + part.radius * length(cross(axis, m));
}

}  // namespace corridor::audit
