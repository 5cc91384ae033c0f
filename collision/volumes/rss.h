#pragma once

#include "collision/volumes/obb.h"

namespace corridor {

/// A rectangle swept by a sphere (Larsen, Gottschalk, Lin, Manocha, "Fast proximity queries with
/// swept sphere volumes", 1999): the points at most `size` from the flat box `core`. Metres.
struct Rss {
  Obb core;         ///< half[2] is 0
  double size = 0;  ///< radius of the swept sphere

  static constexpr bool kOriented = true;
  static Rss around(const Obb& box, const Content& content);
  const Mat3& frameAxes() const { return core.axes; }
  double axisDefect() const { return core.axisDefect(); }
  double centerReach() const { return core.centerReach(); }
  double radius() const;
  const Vec3& ballCenter() const { return core.center; }
};

}  // namespace corridor
