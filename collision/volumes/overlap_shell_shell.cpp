#include "collision/volumes/overlap_shell_shell.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/volumes/direction_search.h"

namespace corridor {
namespace {

/// The cone of a shell, as seen from its centre.
class Cone {
 public:
  explicit Cone(const Shell& shell)
      : axis_(shell.axis), slope_(shell.slope), cosine_(shell.cosine()), whole_(!shell.hasCone()) {}

  /// Returns g(m): the largest product of m with a unit vector of the cone.
  double highest(const Vec3& m) const {
    const double along = axis_.dot(m), across = axis_.cross(m).norm();
    if (whole_ || across <= slope_ * along) return m.norm();
    return (along + slope_ * across) * cosine_;
  }
  /// Returns the unit vector of the cone that has this largest product with m; rounded.
  Vec3 towards(const Vec3& m) const {
    const double along = axis_.dot(m);
    const Vec3 across = m - along * axis_;
    const double length = across.norm();
    if (whole_ || length <= slope_ * along) return m / m.norm();
    const Vec3 side = length > 0 ? Vec3(across / length) : axis_.unitOrthogonal();
    return cosine_ * (axis_ + slope_ * side);
  }

 private:
  const Vec3& axis_;
  double slope_, cosine_;
  bool whole_;
};

struct Range {
  double nearest, farthest;
};

/// Returns the distances of the points of a shell from a given point, the centre of the other
/// shell: the nearest rounded down, the farthest rounded up.
/// @param d  the vector from the given point to the shell's centre, in a's frame; only its length
/// is used
/// @param m  the same vector in the frame of the shell
/// @param stretch  3η, where η bounds the deviation of the map from a rotation
/// (overlap_shell_shell.h)
Range distances(const Shell& shell, const Cone& cone, const Vec3& d, const Vec3& m,
                double stretch) {
  const double square = d.squaredNorm(), high = cone.highest(m), low = -cone.highest(-m);
  const double reach = std::sqrt(square) + shell.outer;
  const double slack = 64 * kUnit * reach * reach + 0x1p-960;
  const auto at = [&](double s, double g, double grow) {
    return square + s * (2 * g + s * (1 + grow));
  };
  const double far = std::max(at(shell.inner, high, stretch), at(shell.outer, high, stretch));
  const double s = std::clamp(-low / (1 - stretch), shell.inner, shell.outer);
  const double near = at(s, low, -stretch) - slack;
  return {near > 0 ? std::sqrt(near) : 0, std::sqrt(far + slack)};
}

BoundingSphere sphereOf(const Shell& shell) {
  return {shell.boundingCenter, shell.boundingRadius};
}

}  // namespace

struct PairTest<Shell>::Placed {
  const Shell &a, &b;
  Cone coneA, coneB;
  Vec3 T;
  double radii, slack;

  Placed(const Shell& shellA, const Shell& shellB, const Transform& X_AB,
         const BoxPairMargins& margins)
      : a(shellA),
        b(shellB),
        coneA(a),
        coneB(b),
        T((X_AB.m * b.center + X_AB.t) - a.center),
        radii(a.size + b.size),
        slack(margins.relative * (T.cwiseAbs().sum() + a.outer + b.outer + radii) +
              margins.absolute + radii + kTiny) {}
  bool usable() const { return slack < HUGE_VAL; }
};

PairTest<Shell>::PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB,
                          double error)
    : X_AB_(X_AB),
      spheres_(a, b, X_AB, error),
      margins_(boxPairMargins(0, a.centerReach, 0, b.centerReach, X_AB)),
      stretch_(roundedUp(3 * orthonormalityDefect(X_AB.m))) {
  margins_.absolute += error;
}

double PairTest<Shell>::byDistances(const Placed& pair) const {
  const auto& [a, b, coneA, coneB, T, radii, slack] = pair;
  const Range ofB = distances(b, coneB, T, X_AB_.m.transpose() * T, stretch_);
  const Range ofA = distances(a, coneA, -T, -T, 0);
  const double gap = std::max({a.inner - ofB.farthest, ofB.nearest - a.outer,
                               b.inner - ofA.farthest, ofA.nearest - b.outer});
  return gap - slack > 0 && gap < HUGE_VAL ? roundedDown(gap - slack) : 0;
}

double PairTest<Shell>::byDirections(const Placed& pair, double pad, double enough,
                                     double agreed) const {
  const Shell &a = pair.a, &b = pair.b;
  const Vec3 between = X_AB_ * b.boundingCenter - a.boundingCenter;
  const double size = between.cwiseAbs().sum() + a.boundingRadius + b.boundingRadius;
  const auto reach = [](const Shell& shell, double g) {
    return g * (g >= 0 ? shell.outer : shell.inner);
  };
  return internal::widestGap(between, size, pair.radii + pad, enough, agreed, [&](const Vec3& n) {
    const Vec3 m = -(X_AB_.m.transpose() * n);
    const double highA = pair.coneA.highest(n), highB = pair.coneB.highest(m);
    const double gap = n.dot(pair.T) - reach(a, highA) - reach(b, highB) - pair.slack;
    const Vec3 p = pair.coneA.towards(n) * (highA >= 0 ? a.outer : a.inner),
               q = pair.coneB.towards(m) * (highB >= 0 ? b.outer : b.inner);
    return internal::AlongDirection{roundedDown(gap), pair.T + X_AB_.m * q - p};
  });
}

bool PairTest<Shell>::separated(const Shell& a, const Shell& b, double pad) const {
  if (spheres_.separated(sphereOf(a), sphereOf(b), pad)) return true;
  const Placed pair(a, b, X_AB_, margins_);
  return pair.usable() &&
         (byDistances(pair) > pad || byDirections(pair, pad, pad, internal::kVerdict) > pad);
}

double PairTest<Shell>::distanceBound(const Shell& a, const Shell& b) const {
  const double spheres = spheres_.distanceBound(sphereOf(a), sphereOf(b));
  const Placed pair(a, b, X_AB_, margins_);
  if (!pair.usable()) return spheres;
  return std::max({spheres, byDistances(pair), byDirections(pair, 0, HUGE_VAL, internal::kBound)});
}

}  // namespace corridor
