#pragma once

#include <concepts>

#include "collision/volumes/obb.h"

namespace corridor {

/// What `VolumeTree` requires of a bounding volume. A volume is a closed set, which its doubles
/// define in real arithmetic. It contains each triangle of its content, or the hull of the
/// content's spheres. All volumes except `Shell` are convex, and so contain the hull of the
/// triangles, too. Trees and queries do not rely on this.
///
/// Every volume is fitted in the frame of a box around the same content. The frame's axes are those
/// of the content's moments if `kOriented`, else those of the mesh. `PairTest<Volume>`, in the file
/// `overlap_<volume>_<volume>.h`, tests two volumes against each other. A volume may also have a
/// function `merged(a, b)`, which refitting then uses. The result of `merged` must be as tight as a
/// fit around the contents of both volumes.
template <class V>
concept BoundingVolume = requires(const V v, const Obb& box, const Content& content) {
  { V::kOriented } -> std::convertible_to<bool>;
  /// Returns a volume that contains the content in real arithmetic: each triangle, or the hull of
  /// the spheres. `box` is around the content.
  { V::around(box, content) } -> std::same_as<V>;
  /// The axes of the frame in which the volume is fitted again.
  { v.frameAxes() } -> std::convertible_to<Mat3>;
  /// Terms in the margins of the volume's tests, rounded up: the `orthonormalityDefect` of the
  /// axes, and a bound of |center|₂. For a k-DOP or a hull, the second term bounds |x|₂ of all its
  /// vertices.
  { v.axisDefect() } -> std::same_as<double>;
  { v.centerReach() } -> std::same_as<double>;
  /// Radius, rounded up, of a sphere about `ballCenter()`; the sphere contains the volume.
  { v.radius() } -> std::same_as<double>;
  /// The centre of the sphere with this `radius()`, off by at most 2u(|centre| + radius).
  { v.ballCenter() } -> std::convertible_to<Vec3>;
};

/// Upper bounds that hold for all volumes of a tree.
struct VolumeBounds {
  double axisDefect = 0;   ///< of `V::axisDefect()`
  double centerReach = 0;  ///< metres: of `V::centerReach()`
  double reach = 0;        ///< metres: of |x|₂ for all points x of the contents
};

/// Tests volumes of two trees against each other under one relative map. It is constructed once per
/// query, from the bounds of both trees, the map X_AB (doubles, taken as exact) and an `error` in
/// metres. Each specialisation has:
///
/// `bool separated(const Volume& a, const Volume& b, double pad) const`. `true` is a proof that the
/// content of a and the image of the content of b under X_AB are more than error + pad metres
/// apart, in real arithmetic. `false` proves nothing.
///
/// `double distanceBound(const Volume& a, const Volume& b) const` returns a proved lower bound of
/// (distance of the contents, in metres, minus `error`), or 0 if nothing is known.
///
/// If a NaN or an overflow occurs, nothing is separated.
///
/// `Overlap` selects the test where there is a choice (overlap_obb_obb_variants.h).
struct StandardOverlap {};
template <class Volume, class Overlap = StandardOverlap>
class PairTest;

}  // namespace corridor
