#pragma once

#include <random>
#include <span>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "tests/stress/audit/quad.h"

namespace corridor::audit {

/// A generator of the random numbers of one construction.
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
  /// Returns 10^x, with x uniform in [low, high].
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

/// The feature with which a body meets the other: a corner (the centre of a sphere, a point on the
/// rim of a cylinder), an edge (the axis of a capsule), or a face.
enum class Feature { corner, edge, face };

/// A convex or nearly convex body before its coordinates are rounded to doubles, in any frame. It
/// lies above a plane, and touches it (`randomExactBody`).
struct ExactBody {
  Feature feature = Feature::corner;
  bool mesh = false, flatEnds = false;
  double radius = 0;
  std::vector<Vec<Quad>> points;  ///< for a mesh: its vertices
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Returns a body of about `size` metres that touches the plane through `q` with the normal `up`.
/// It touches the plane only with its `feature`, which contains q. All other points are above the
/// plane, on the side of the unit vector `up`. An edge runs along the unit vector `along`, which is
/// orthogonal to `up`. The feature of a sphere or capsule (its centre or axis) lies above q by the
/// radius.
ExactBody randomExactBody(Dice& dice, Feature feature, const Vec<Quad>& q, const Vec<Quad>& up,
                          const Vec<Quad>& along, double size);

/// A body as it is stored, in doubles, and the data from which the true verdict is computed.
struct Shape {
  Feature feature = Feature::corner;
  bool isMesh = false;
  TriangleMesh mesh;
  ConvexPart part;
  /// Points whose hull lies in the body, rounding included. The first points are those of the
  /// feature: a corner, the two ends of an edge, or three corners of a face. The others are
  /// arbitrary points of the body. If `coreRadius` > 0, the hull swept by a sphere of that radius
  /// lies in the body, too.
  std::array<Vec<Quad>, 3> core;
  double coreRadius = 0;  ///< metres

  double reach = 0;  ///< m; no point of the body is farther from the origin of its frame

  /// Returns the largest m·x over all points x of the body; m is a unit vector in the body's frame.
  template <class S>
  S support(const Vec<S>& m) const;
  const std::vector<Vec3>& points() const { return isMesh ? mesh.vertices : part.points; }
};

/// Returns the body `plan`, moved by `shift`, mapped by X to the frame of the stored body, and
/// rounded to doubles.
/// @param up the vector `up` with which `randomExactBody` made the plan. @param[out] error an upper
/// bound of the rounding of any point, metres.
Shape stored(const ExactBody& plan, const Pose<Quad>& X, const Vec<Quad>& shift,
             const Vec<Quad>& up, double* error = nullptr);

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
