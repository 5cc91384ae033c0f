#pragma once

#include "collision/volumes/obb.h"

namespace corridor {

/// An ellipsoid swept by a sphere: the points at most `size` from the ellipsoid
/// {center + axes·x : Σ (x_i/half_i)² ≤ 1}, where center, axes and half are those of `core`. For
/// triangles `size` is 0, and the set is the ellipsoid itself. Metres.
struct Ellipsoid {
  Obb core;         ///< `half` holds the semi-axes, all above 0
  double size = 0;  ///< radius of the swept sphere

  static constexpr bool kOriented = true;
  /// Returns an ellipsoid with the axes of the box. It is near the ellipsoid of least volume among
  /// those with these axes. Each point gets a weight. Each step multiplies the weight by a measure
  /// of the point's distance from the centre of the present ellipsoid (Silvey, Titterington,
  /// Torsney, "An algorithm for optimal designs on a finite design space", 1978). The weighted mean
  /// and variances give the centre and the semi-axes. The optimum is that of Khachiyan's method
  /// (Math. of Operations Research 21(2), 1996) for ellipsoids with given axes.
  static Ellipsoid around(const Obb& box, const Content& content);
  const Mat3& frameAxes() const { return core.axes; }
  double axisDefect() const { return core.axisDefect(); }
  double centerReach() const { return core.centerReach(); }
  double radius() const;
  const Vec3& ballCenter() const { return core.center; }
};

}  // namespace corridor
