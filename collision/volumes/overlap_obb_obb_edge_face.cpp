#include "collision/volumes/overlap_obb_obb_direction.h"
#include "collision/volumes/overlap_obb_obb_variants.h"

/// If two closed boxes share a point, an edge of one meets a face of the other, or one box is
/// inside the other. Proof: if neither box is inside the other, their surfaces meet, so two faces
/// meet. An end point (or corner) of the intersection of these faces is on an edge of one of them.
/// (A flat box consists of its surface only.)
///
/// The two boxes here are A and B. A is box a grown by `margin` along its axes; it contains the
/// grown box a of overlap_obb_obb.h. B is the exact parallelepiped {T + R y, |y_j| ≤ b_j}. Points
/// are in coordinates x of A, or z = Rᵀ(x − T). In coordinates z, a point of B is z = RᵀR y, which
/// differs from y by at most η_R·Σb. In both kinds of coordinates, the ends of an edge have fewer
/// than 12 roundings of terms below |T|₁ + Σa + Σb. Faces are enlarged by `slack` in all
/// directions, which is more than both errors.
namespace corridor {
namespace {

/// A segment {q + t·d, low ≤ t ≤ high}, clipped to |q_i + t·d_i| ≤ e.
///
/// A rounded quotient is the exact quotient for a value of e that is off by 2.1u(e + |q|), which
/// `slack` covers. A NaN clips nothing.
struct Cut {
  double low = -1, high = 1;
  void slab(double q, double d, double e) {
    if (d == 0) {
      if (std::abs(q) > e) low = HUGE_VAL;
      return;
    }
    const double s = (-e - q) / d, t = (e - q) / d;
    low = std::max(low, std::min(s, t));
    high = std::min(high, std::max(s, t));
  }
  bool empty() const { return low > high; }
};

/// Returns true if the segment {q + t·d, |t| ≤ 1} meets the face x_i = s of the box |x| ≤ e.
bool meetsFace(const Vec3& q, const Vec3& d, int i, double s, const Vec3& e, double slack) {
  if (std::abs(q[i] - s) > std::abs(d[i]) + slack) return false;
  Cut cut;
  cut.slab(q[i] - s, d[i], slack);
  for (const int k : {(i + 1) % 3, (i + 2) % 3}) {
    cut.slab(q[k], d[k], e[k] + slack);
    if (cut.empty()) return false;
  }
  return true;
}

/// Returns true if an edge of the box {center + axes·y, |y_j| ≤ half_j} meets a face of |x| ≤ e.
bool edgesMeetFaces(const Vec3& center, const Mat3& axes, const Vec3& half, const Vec3& e,
                    double slack) {
  for (int j = 0; j < 3; ++j) {
    const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const Vec3 d = half[j] * axes.col(j);
    for (const double s1 : {-1.0, 1.0})
      for (const double s2 : {-1.0, 1.0}) {
        const Vec3 q = center + s1 * half[j1] * axes.col(j1) + s2 * half[j2] * axes.col(j2);
        for (int i = 0; i < 3; ++i)
          if (meetsFace(q, d, i, -e[i], e, slack) || meetsFace(q, d, i, e[i], e, slack))
            return true;
      }
  }
  return false;
}

bool outside(const Vec3& p, const Vec3& e, double slack) {
  return (p.cwiseAbs().array() > (e.array() + slack)).any();
}

}  // namespace

bool EdgeFace::separated(const Obb& boxA, const Obb& boxB, const Transform& X_AB,
                         const BoxPairMargins& margins, double pad) {
  const internal::DirectedBoxes pair(boxA, boxB, X_AB, margins, pad);
  const Vec3 a = pair.a.array() + pair.margin;
  const double slack = pair.slack + 4 * margins.relative * pair.margin;  // Σa has grown by 3·margin
  const Vec3 centerA = -(pair.R.transpose() * pair.T);                   // in coordinates z
  return outside(pair.T, a, slack) && outside(centerA, pair.b, slack) &&
         !edgesMeetFaces(pair.T, pair.R, pair.b, a, slack) &&
         !edgesMeetFaces(centerA, pair.R.transpose(), a, pair.b, slack);
}

}  // namespace corridor
