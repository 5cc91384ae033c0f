#include "collision/predicates/triangle_contact.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

/// The corners of both triangles in the world frame, rounded. `bound` is one error bound that holds
/// for the orientation determinant of any four of these corners.
struct Filter {
  Triangle a, b;
  double bound;  ///< NaN or infinite if the filter must not decide

  Filter(const Triangle& a0, const Transform& X_WA, const Triangle& b0, const Transform& X_WB) {
    const double errorA = apply(a0, X_WA, a), errorB = apply(b0, X_WB, b);
    // d: the largest difference of two corners in one coordinate.
    Vec3 low = a[0], high = a[0];
    for (const Triangle* t : {&a, &b})
      for (const Vec3& p : *t) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    const double d = (high - low).maxCoeff();
    // An entry of the determinant is a difference of two rounded coordinates, off by at most e =
    // 2·error + u·d. With entries ≤ D = d + e, a 3×3 determinant has six products of three. The
    // errors of the entries change the determinant by at most 6·3·e·D². Its evaluation (two
    // roundings per product, three for the sums) adds at most 6·D³·γ5 < 31·u·D³, where γ5 = 5u/(1 −
    // 5u). Underflow, also of inputs flushed to zero, loses less than 2^-1000·D², which 9·u·D³
    // covers for D > 2^-250. D < 2^250 keeps all products finite.
    const double e = 2 * std::max(errorA, errorB) + kUnit * d;
    const double D = d + e;
    const bool usable = D > 0x1p-250 && D < 0x1p250;
    bound = usable ? roundedUp((18 * e + 40 * kUnit * D) * D * D) : HUGE_VAL;
  }

  /// Stores the mapped corners in `to`. Returns a bound of the error of each of their coordinates.
  /// Coordinate i is Σ_k m_ik v_k + t_i. A sum of three products and a translation has four
  /// roundings on its longest path, so the error is at most γ4·s < 4.1·u·s, where s = Σ_k
  /// |m_ik||v_k| + |t_i| and γ4 = 4u/(1 − 4u).
  static double apply(const Triangle& from, const Transform& X, Triangle& to) {
    double reach = 0;
    for (int i = 0; i < 3; ++i) {
      to[i] = X * from[i];
      reach = std::max(reach, from[i].cwiseAbs().maxCoeff());
    }
    const bool isIdentity = X.m == Mat3::Identity() && X.t == Vec3::Zero();
    if (isIdentity) return 0;
    const double rowSum = X.m.cwiseAbs().rowwise().sum().maxCoeff();
    return roundedUp(4.1 * kUnit * (rowSum * reach + X.t.cwiseAbs().maxCoeff()));
  }

  /// Returns the sign of det(q − p, r − p, s − p), or 0 if it is not certain.
  int orientation(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) const {
    const double ax = q[0] - p[0], ay = q[1] - p[1], az = q[2] - p[2];
    const double bx = r[0] - p[0], by = r[1] - p[1], bz = r[2] - p[2];
    const double cx = s[0] - p[0], cy = s[1] - p[1], cz = s[2] - p[2];
    const double det =
        cx * (ay * bz - az * by) + cy * (az * bx - ax * bz) + cz * (ax * by - ay * bx);
    return det > bound ? 1 : det < -bound ? -1 : 0;
  }

  /// Returns 1 for contact, 0 for no contact, −1 if undecided.
  int decide() const {
    int sideB[3], sideA[3];  // b's corners relative to a's plane; a's corners relative to b's
    for (int i = 0; i < 3; ++i) sideB[i] = orientation(a[0], a[1], a[2], b[i]);
    if (sideB[0] != 0 && sideB[0] == sideB[1] && sideB[0] == sideB[2]) return 0;
    for (int i = 0; i < 3; ++i) sideA[i] = orientation(b[0], b[1], b[2], a[i]);
    if (sideA[0] != 0 && sideA[0] == sideA[1] && sideA[0] == sideA[2]) return 0;
    for (int i = 0; i < 3; ++i)
      if (sideA[i] == 0 || sideB[i] == 0) return -1;
    // General position: each triangle crosses the other's plane. Corners are numbered so that p1 is
    // alone on its side of b's plane, and p2 is alone on its side of a's plane. The triangles are
    // oriented so that p1 is on the positive side of b's plane, and p2 on the positive side of a's
    // plane.
    const int i = alone(sideA), j = alone(sideB);
    const Vec3 &p1 = a[i], &p2 = b[j];
    const Vec3 *q1 = &a[(i + 1) % 3], *r1 = &a[(i + 2) % 3], *q2 = &b[(j + 1) % 3],
               *r2 = &b[(j + 2) % 3];
    // Exchanging two corners of b exchanges the positive and the negative side of b's plane, and
    // likewise for a.
    if (sideA[i] < 0) std::swap(q2, r2);
    if (sideB[j] < 0) std::swap(q1, r1);
    const int first = orientation(p1, *q1, p2, *q2);
    if (first > 0) return 0;
    const int second = orientation(p1, *r1, *r2, p2);
    if (second > 0) return 0;
    return first < 0 && second < 0 ? 1 : -1;
  }

  /// Returns the index of the corner that is alone on its side.
  static int alone(const int (&side)[3]) {
    return side[0] == side[1] ? 2 : side[0] == side[2] ? 1 : 0;
  }
};

}  // namespace

PredicateResult trianglesTouch(const Triangle& a, const Transform& X_WA, const Triangle& b,
                               const Transform& X_WB) {
  const int decided = Filter(a, X_WA, b, X_WB).decide();
  if (decided >= 0) return {decided == 1, false};
  return {trianglesTouchExact(a, X_WA, b, X_WB), true};
}

}  // namespace corridor
