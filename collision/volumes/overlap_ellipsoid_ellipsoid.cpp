#include "collision/volumes/overlap_ellipsoid_ellipsoid.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/volumes/direction_search.h"

namespace corridor {
namespace {

/// The maximum number of steps of one search. Most searches need two or three steps; searches at
/// gaps of 1e-9 of the size need up to eight.
constexpr int kOverlapSteps = 12;
/// If the radii of the swept spheres plus the distance to be proved exceed this fraction of the sum
/// of the semi-axes, ellipsoids with longer semi-axes are a bad approximation of the swept
/// ellipsoids. Then a second search, by simplices, follows.
constexpr double kRound = 0x1p-6;
/// An upper bound of what underflow takes from both norms of a gap. Gaps below this bound are not
/// proved.
constexpr double kNorms = 0x1p-500;

/// A pair of ellipsoids in the coordinates of ellipsoid a, with a test along a given direction that
/// does not depend on how the direction was found.
class EllipsoidPair {
 public:
  EllipsoidPair(const Ellipsoid& a, const Ellipsoid& b, const Transform& X_AB,
                const BoxPairMargins& margins)
      : R_(a.core.axes.transpose() * (X_AB.m * b.core.axes)),
        T_(a.core.axes.transpose() * ((X_AB.m * b.core.center + X_AB.t) - a.core.center)),
        a_(a.core.half),
        b_(b.core.half),
        radii_(a.size + b.size),
        size_(T_.cwiseAbs().sum() + a_.sum() + b_.sum() + radii_),
        relative_(margins.relative),
        slack_(relative_ * size_ + margins.absolute + radii_ + kTiny) {
    // The search multiplies up to five lengths. `scale_` avoids underflow and overflow.
    if (!(size_ > 0x1p-60 && size_ < 0x1p60)) scale_ = 1 / powerOfTwo(size_);
  }

  /// Returns false if nothing can be proved, because sizes are extreme or the map is far from
  /// rigid.
  bool usable() const { return size_ > kNorms && slack_ < HUGE_VAL && relative_ < 1; }
  double radii() const { return radii_; }
  double best() const { return best_; }  ///< the widest gap proved so far, metres; or 0

  void alongCenters() { along(T_); }

  /// Searches by the contact function, starting at the s that the previous direction gives
  /// (`share_`). Ends at a gap above `enough`.
  /// @param inflation  metres: added to all semi-axes. If it is half of the distance that is to be
  /// proved, the search finds the right direction for sets that are just this distance apart.
  void search(double inflation, double enough) {
    const Vec3 A = ((a_.array() + inflation) * scale_).square(),
               B = ((b_.array() + inflation) * scale_).square(), T = T_ * scale_;
    Mat3 matrixB;
    for (int i = 0; i < 3; ++i)
      for (int k = i; k < 3; ++k) {
        matrixB(i, k) =
            R_(i, 0) * B[0] * R_(k, 0) + R_(i, 1) * B[1] * R_(k, 1) + R_(i, 2) * B[2] * R_(k, 2);
        matrixB(k, i) = matrixB(i, k);
      }
    double low = 0, high = 1, lastShare = 0, lastRest = 0;
    for (int step = 0; step < kOverlapSteps; ++step) {
      const double s = share_;
      if (!(s > low && s < high)) return;
      Mat3 G = s * matrixB;
      G.diagonal() += (1 - s) * A;
      const Vec3 x = G.col(1).cross(G.col(2)), y = G.col(2).cross(G.col(0)),
                 z = G.col(0).cross(G.col(1));
      const double determinant = G.col(0).dot(x);
      const Vec3 n = (x * T[0] + y * T[1] + z * T[2]) / determinant;  // G⁻¹T, as G is symmetric
      along(n);
      if (best_ > enough) return;
      const double ofA = A.dot(n.cwiseAbs2()), ofB = B.dot((R_.transpose() * n).cwiseAbs2());
      const double value = s * (1 - s) * n.dot(T);
      const double slope = (1 - s) * (1 - s) * ofA - s * s * ofB;
      (slope > 0 ? low : high) = s;
      // S is concave: it stays below its tangent.
      if (!(value + slope * ((slope > 0 ? high : low) - s) > 1)) return;
      const double rootA = std::sqrt(ofA), rootB = std::sqrt(ofB);
      // The s at the maximum is a fixed point of rootA/(rootA + rootB). The first step takes this
      // value, the next steps are secant steps.
      const double rest = rootA / (rootA + rootB) - s;
      if (std::abs(rest) < 0x1p-26 * std::min(s, 1 - s)) return;
      double next = step == 0 ? s + rest : s - rest * (s - lastShare) / (rest - lastRest);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      lastShare = s, lastRest = rest;
      share_ = next;
    }
  }

  bool isRound(double pad) const { return radii_ + pad > kRound * (a_.sum() + b_.sum()); }
  /// Searches by simplices, if the spheres and `pad` are large relative to the semi-axes
  /// (`isRound`).
  /// @param pad  as for `separated`.
  void searchBySimplices(double pad, double enough, double agreed) {
    if (!isRound(pad)) return;
    const double found =
        internal::widestGap(T_, size_, radii_ + pad, enough, agreed, [&](const Vec3& n) {
          const Vec3 m = R_.transpose() * n, alongA = a_.cwiseProduct(n),
                     alongB = b_.cwiseProduct(m);
          const double reachA = alongA.norm(), reachB = alongB.norm();
          return internal::AlongDirection{
              gapOf(n, reachA, reachB),
              T_ - R_ * (b_.cwiseProduct(alongB) / reachB) - a_.cwiseProduct(alongA) / reachA};
        });
    best_ = std::max(best_, found);
  }

 private:
  double gapOf(const Vec3& n, double reachA, double reachB) const {
    const double gap = (n.dot(T_) - reachA - reachB - kNorms) / n.norm() - slack_;
    return roundedDown(gap * (1 - relative_));
  }
  void along(const Vec3& direction) {
    const Vec3 n = direction / direction.cwiseAbs().maxCoeff();  // so that kNorms covers underflow
    const double reachA = a_.cwiseProduct(n).norm(),
                 reachB = b_.cwiseProduct(R_.transpose() * n).norm();
    const double gap = gapOf(n, reachA, reachB);
    if (gap < HUGE_VAL) best_ = std::max(best_, gap);
    const double share = reachA / (reachA + reachB);
    if (share > 0 && share < 1) share_ = share;
  }

  Mat3 R_;
  Vec3 T_;
  const Vec3 &a_, &b_;
  double radii_, size_, relative_, slack_, scale_ = 1;
  double best_ = 0, share_ = 0.5;
};

}  // namespace

bool PairTest<Ellipsoid>::separated(const Ellipsoid& a, const Ellipsoid& b, double pad) const {
  EllipsoidPair pair(a, b, X_AB_, margins_);
  if (!pair.usable()) return false;
  pair.alongCenters();
  if (!(pair.best() > pad)) pair.search(0.5 * (pair.radii() + pad), pad);
  if (!(pair.best() > pad)) pair.searchBySimplices(pad, pad, internal::kVerdict);
  return pair.best() > pad;
}

double PairTest<Ellipsoid>::distanceBound(const Ellipsoid& a, const Ellipsoid& b) const {
  EllipsoidPair pair(a, b, X_AB_, margins_);
  if (!pair.usable()) return 0;
  pair.alongCenters();
  // For ellipsoids that are close, the best direction is the normal at the point where they would
  // touch if they grew. For other ellipsoids it is the line between their closest points.
  if (!pair.isRound(pair.best())) pair.search(0.5 * (pair.radii() + pair.best()), HUGE_VAL);
  pair.searchBySimplices(pair.best(), HUGE_VAL, internal::kBound);
  return pair.best();
}

}  // namespace corridor
