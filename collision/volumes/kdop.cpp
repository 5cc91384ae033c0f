#include "collision/volumes/kdop.h"

#include <algorithm>
#include <cmath>

namespace corridor {

template <int K>
const std::array<Vec3, K / 2>& slabDirections() {
  static const std::array<Vec3, K / 2> directions = [] {
    std::array<Vec3, K / 2> n;
    std::size_t i = 0;
    for (int k = 0; k < 3; ++k) n[i++] = Vec3::Unit(k);
    if (K != 14)
      for (const double s : {1.0, -1.0})
        for (int k = 0; k < 3; ++k) n[i++] = Vec3::Unit(k) + s * Vec3::Unit((k + 1) % 3);
    if (K != 18)
      for (const double s : {1.0, -1.0})
        for (const double t : {1.0, -1.0}) n[i++] = Vec3(1, s, t);
    return n;
  }();
  return directions;
}

template <int K>
Kdop<K> Kdop<K>::around(const Obb&, const Content& content) {
  const auto& n = slabDirections<K>();
  Kdop dop;
  dop.low.fill(HUGE_VAL);
  dop.high.fill(-HUGE_VAL);
  content.forEach([&](const Vec3& p, double r) {
    for (std::size_t i = 0; i < kSlabs; ++i) {
      // Along a coordinate axis the projection of p is exact. Along another direction it takes at
      // most two sums of terms below |p|₁, whose rounding is at most 2.1u·|p|₁. The rounding of the
      // product |n|·r and of two more sums is at most 5u of the sum of the terms.
      const double along = n[i].dot(p), reach = n[i].norm() * r;
      const double pad =
          i < 3 && r == 0 ? 0 : roundedUp(8 * kUnit * (p.cwiseAbs().sum() + 2 * r)) + reach;
      dop.low[i] = std::min(dop.low[i], along - pad);
      dop.high[i] = std::max(dop.high[i], along + pad);
    }
  });
  return dop;
}

template <int K>
double Kdop<K>::centerReach() const {
  const Vec3 farthest(std::max(-low[0], high[0]), std::max(-low[1], high[1]),
                      std::max(-low[2], high[2]));
  return roundedUp(farthest.stableNorm());
}

template <int K>
double Kdop<K>::radius() const {
  const Vec3 size(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  return roundedUp(0.5 * size.stableNorm());
}

template const std::array<Vec3, 7>& slabDirections<14>();
template const std::array<Vec3, 9>& slabDirections<18>();
template const std::array<Vec3, 13>& slabDirections<26>();
template struct Kdop<14>;
template struct Kdop<18>;
template struct Kdop<26>;

}  // namespace corridor
