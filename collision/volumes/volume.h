#pragma once

#include <concepts>

#include "collision/volumes/obb.h"

namespace corridor {

/// What a `VolumeTree` asks of a volume: a convex set that its doubles define in real arithmetic.
///
/// Every volume is fitted in the frame of a box around the same content: the axes of the content's
/// moments where it is `kOriented`, those of the mesh where it is not. How two of them are tested
/// against each other is `PairTest<Volume>`, beside each volume (`overlap_<volume>_<volume>.h`).
/// A volume for which `merged(a, b)` around two is as tight as one around their contents may have
/// that, too: refitting uses it.
template <class V>
concept BoundingVolume = requires(const V v, const Obb& box, const Content& content) {
  { V::kOriented } -> std::convertible_to<bool>;
  /// Contains the content in real arithmetic. `box` is around the content.
  { V::around(box, content) } -> std::same_as<V>;
  /// The axes to fit it with again.
  { v.frameAxes() } -> std::convertible_to<Mat3>;
  /// What the margins of its tests need: the axes' `orthonormalityDefect`, |center|₂; rounded up.
  { v.axisDefect() } -> std::same_as<double>;
  { v.centerReach() } -> std::same_as<double>;
  /// Of a sphere about its centre that holds it, rounded up: its size.
  { v.radius() } -> std::same_as<double>;
  /// That centre, off by at most 2u of it and of the radius.
  { v.ballCenter() } -> std::convertible_to<Vec3>;
};

/// Bounds that hold for all volumes of a tree.
struct VolumeBounds {
  double axisDefect = 0;
  double centerReach = 0;  ///< metres
  double reach = 0;        ///< metres: largest |x|₂ of all the points that they are around
};

/// How volumes of two trees are tested under one relative map: made once a query, from the bounds
/// of both trees, the map X_AB (doubles, taken as exact) and an `error` in metres. Each has
///
/// `bool separated(const Volume& a, const Volume& b, double pad) const`: `true` is a proof that
/// what is in a, and the image under X_AB of what is in b, are apart by more than error + pad
/// metres in real arithmetic; `false` says nothing.
///
/// `double distanceBound(const Volume& a, const Volume& b) const`: a proven lower bound of their
/// distance less `error`; 0 where nothing is known.
///
/// A NaN or an overflow separates nothing.
///
/// `Overlap` says how, where there is a choice (overlap_obb_obb_variants.h).
struct StandardOverlap {};
template <class Volume, class Overlap = StandardOverlap>
class PairTest;

}  // namespace corridor
