#include "collision/convex/simplex.h"
#include "collision/volumes/overlap_obb_obb_direction.h"
#include "collision/volumes/overlap_obb_obb_variants.h"

namespace corridor {
namespace {

/// The maximum number of rounds. Pairs of boxes need fewer, except flat boxes that are so close
/// that the simplices cycle (one in a million of the pairs in the tests).
constexpr int kRounds = 32;

double signOf(double x) {
  return std::copysign(1.0, x);
}

}  // namespace

/// Searches for the point of the difference b − a that is closest to the origin. For each direction
/// of the search, `apartAlong` tests whether the projections of both boxes prove separation. So
/// rounding in the search does no harm.
bool Gjk::separated(const Obb& boxA, const Obb& boxB, const Transform& X_AB,
                    const BoxPairMargins& margins, double pad) {
  using gjk::nearest;
  using Point = gjk::Vector<double>;
  const internal::DirectedBoxes pair(boxA, boxB, X_AB, margins, pad);
  const double size = pair.size();
  if (!(size > kTiny && size < HUGE_VAL)) return false;  // nothing can be proved for such sizes
  // The search multiplies up to five lengths, some of which are 2^-50 of others. `scale` avoids
  // underflow and overflow.
  double scale = 1;
  if (!(size > 0x1p-60 && size < 0x1p60)) scale = std::ldexp(1.0, -std::ilogb(size));
  const double noise = 256 * kUnit * size * scale, near = pair.margin * scale;
  gjk::Nearest<double> face;
  Vec3 direction = pair.T;
  for (int round = 0; round < kRounds; ++round) {
    const Vec3 L = direction / direction.cwiseAbs().maxCoeff();
    const Vec3 along = pair.R.transpose() * L;
    if (pair.apartAlong(L, along)) return true;
    Vec3 corner = pair.T;  // the corner of b − a that is farthest along −L
    for (int j = 0; j < 3; ++j) corner -= signOf(along[j]) * pair.b[j] * pair.R.col(j);
    for (int i = 0; i < 3; ++i) corner[i] -= signOf(L[i]) * pair.a[i];
    const Point w(Vec3(corner * scale));
    const Point* const c = face.corner;
    for (int i = 0; i < face.count; ++i)
      if (w == c[i]) return pair.apartAlongAny();  // no corner is closer to the origin
    switch (face.count) {
      case 0:
        face = nearest(w);
        break;
      case 1:
        face = nearest(c[0], w);
        break;
      case 2:
        face = nearest(c[0], c[1], w);
        break;
      default:
        face = nearest(c[0], c[1], c[2], w, noise);
    }
    if (face.count == 4 || !(face.squared > near * near)) return false;
    direction = {face.v.x, face.v.y, face.v.z};
  }
  return pair.apartAlongAny();
}

}  // namespace corridor
