#pragma once

#include <algorithm>
#include <cmath>

#include "collision/convex/simplex.h"
#include "collision/core/rounding.h"

namespace corridor::internal {

/// Values of the parameter `agreed` of `widestGap`: `kVerdict` for verdicts, `kBound` for lower
/// bounds of distances, for which a few digits suffice.
inline constexpr double kVerdict = 0x1p-20, kBound = 0x1p-4;

/// The result of testing a pair of sets along a direction n, from a to b.
struct AlongDirection {
  /// A proved lower bound of the distance of the sets, metres; negative if n does not separate
  /// them.
  double gap;
  /// A point of the difference b − a that is extreme along −n, up to rounding; metres.
  Vec3 corner;
};

/// Searches for a direction along which two sets are separated, by the simplices of Gilbert,
/// Johnson, Keerthi (1988). `along(n)` returns an `AlongDirection` for a vector n of length 1, up
/// to 4u. Each call proves the gap along its n, so rounding in the search does no harm. Returns the
/// widest gap that was proved, or 0. The search ends at a gap above `enough`, or when it finds a
/// point of each set's hull such that both points are at most `near` apart. It also ends if no
/// progress is possible, and after 24 rounds.
/// @param direction  the first direction to test, from a to b, metres. Its length does not matter.
/// @param size  metres: about the largest coordinate of an `AlongDirection::corner`.
/// @param near, enough  metres.
/// @param agreed  the search ends if a gap and the distance of two points, one of each hull, differ
/// by less than `agreed` times that distance.
template <class Along>
double widestGap(Vec3 direction, double size, double near, double enough, double agreed,
                 const Along& along) {
  // Polyhedra need up to some ten rounds. For round surfaces each further round improves the gap a
  // little, but costs more than descending to the children of the volumes.
  constexpr int kRounds = 24;
  // The search multiplies up to five lengths. `scale` avoids underflow and overflow.
  const double scale = size > 0x1p-60 && size < 0x1p60 ? 1 : 1 / powerOfTwo(size);
  const double noise = 256 * kUnit * size * scale, close = near * scale;
  gjk::Nearest<double> face;
  double best = 0;
  direction *= scale;
  for (int round = 0; round < kRounds; ++round) {
    const double length = direction.norm();
    if (!(length > 0x1p-200 && length < 0x1p200)) break;
    const Vec3 n = direction / length;
    const AlongDirection found = along(n);
    if (found.gap > best && found.gap < HUGE_VAL) best = found.gap;
    if (best > enough) break;
    const gjk::Vector<double> w(Vec3(found.corner * scale));
    const gjk::Vector<double>* const c = face.corner;
    bool known = false;
    for (int i = 0; i < face.count; ++i) known = known || w == c[i];
    // If `known`, no corner of b − a is closer to the origin than `face`. Else n·corner, a lower
    // bound of the distance from the origin, is within the fraction `agreed` of `length`.
    if (known || (face.count > 0 && n.dot(found.corner * scale) > (1 - agreed) * length)) break;
    switch (face.count) {
      case 0:
        face = gjk::nearest(w);
        break;
      case 1:
        face = gjk::nearest(c[0], w);
        break;
      case 2:
        face = gjk::nearest(c[0], c[1], w);
        break;
      default:
        face = gjk::nearest(c[0], c[1], c[2], w, noise);
    }
    if (face.count == 4 || !(face.squared > close * close)) break;
    direction = {face.v.x, face.v.y, face.v.z};
  }
  return best;
}

}  // namespace corridor::internal
