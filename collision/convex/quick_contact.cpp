#include "collision/convex/quick_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/convex/quick_boxes.h"
#include "collision/convex/quick_set.h"
#include "collision/core/rounding.h"

/// Notation. A set is {M p + t} over its points p, with its disc and its sphere. u = 2^-53. F and ρ
/// are those of `QuickSet`, and S = Σ(Fρ + |t|) over both sets. w is a point of core b minus a
/// point of core a; the cores touch if and only if the hull of all w contains 0. N = |n|.
///
/// Separation. Let p be the point whose computed product fl(m·p), m = fl(Mᵀn), is the largest. m is
/// off by 3.1uFN, and the product by 3.1uFNρ more. Therefore no point of the set is farther along n
/// than p by more than 2·6.2uFNρ. The image of p is off by 4.1u(Fρ + |t|). The rounding of the
/// difference w is u|w|, and that of n·w is 3.1uN|w|. These errors are below 21uSN. The term r|m|
/// of a sphere is off by 7.1uFNr, and the subtraction of these terms by 2uSN: together below 31uSN.
/// A box adds `boxError`, and a disc 35uSN (`QuickSet::radial`). `slack` is 40uS, or 80uS with a
/// disc, which also covers the rounding of `slack` itself.
///
/// Contact of the cores. The origin is inside the tetrahedron of four corners w_i if the four
/// determinants of three corners each, with their signs, are all positive. A corner is off by e:
/// 4.1u(Fρ + |t|) for each point, 12uF·disc for a point on a disc (axis 6u, projections and a norm
/// 6u), and u|w|. Together e < 16uS. With |w| ≤ S a determinant is off by at most (18e + 40uS)S² <
/// 328uS³ (predicates/orientation.cpp); `inside` is 512uS³.
///
/// Contact within the band. Let c be the largest coordinate involved. `near` decides only if both
/// maps are nearly rigid, F ≈ √3 (otherwise S could be far above c). Then |p| ≤ √3·c, S < 17c and
/// |w| < 4c. `upper` is a convex combination of differences w. A coordinate of an image is off by
/// 4.1u(√3 + 1)c, so w is off by 43uc, the combination by 8u|w| more: 75uc together. `toPoint`
/// finds a point of the solid up to 2√3(r + 6uρ) < 100uc for a box (r < 2^-50·2c), and 40uc for a
/// cylinder. The maps may shrink each sphere by 3·2^-48·c = 96uc (`keepsBall`), and `near` allows
/// 2^-51·S < 70uc. The sum is below 75 + 100 + 192 + 70 < 512 = 2^-44/u: the band.
///
/// Underflow. S is within 2^±100. A product that underflows is off by 2^-1022, and later factors
/// are below 2^400. The smallest slack, 40uSN with N > 2^-60·S, is far larger.
namespace corridor {
namespace {

constexpr int kRounds = 24;  // more rounds would be slower than the search that follows

/// Returns x clamped to [0, 1].
double within(double x) {
  return std::min(std::max(x, 0.0), 1.0);
}

/// The smallest face of a simplex that contains the simplex's point closest to the origin: one, two
/// or three corners.
struct Face {
  std::array<Vec3, 3> w;  ///< the newest first
  int count = 0;
  Vec3 v = Vec3::Zero();     ///< the closest point, with an accurate direction
  Vec3 foot = Vec3::Zero();  ///< the closest point as a convex combination of the corners
};

Face corner(const Vec3& a) {
  return {{a, a, a}, 1, a, a};
}

Face segment(const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double square = d.squaredNorm(), along = -a.dot(d);
  if (!(along > 0)) return corner(a);
  if (!(along < square)) return corner(b);
  const Vec3 foot = a + d * (along / square);
  return {{a, b, b}, 2, foot - d * (foot.dot(d) / square), foot};
}

/// Method: Ericson, Real-Time Collision Detection (2005), section 5.1.5.
Face triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  if (d1 <= 0 && d2 <= 0) return corner(a);
  const double bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
  const double d3 = d1 - bb, d4 = d2 - bc, d5 = d1 - bc, d6 = d2 - cc;
  const double inC = d1 * d4 - d3 * d2, inB = d5 * d2 - d1 * d6, inA = d3 * d6 - d5 * d4;
  if (inC <= 0 && d1 >= 0 && d3 <= 0) return segment(a, b);
  if (inB <= 0 && d2 >= 0 && d6 <= 0) return segment(a, c);
  if (!(inA > 0 && inB > 0 && inC > 0)) return segment(b, c);
  const Vec3 n = ab.cross(ac);
  const double sum = 1 / (inA + inB + inC);
  return {{a, b, c},
          3,
          n * (n.dot(a) / n.squaredNorm()),
          a * (inA * sum) + b * (inB * sum) + c * (inC * sum)};
}

class Query {
 public:
  Query(const PosedSet& a, const PosedSet& b)
      : a_(a), b_(b), radii_(a.set().ball + b.set().ball), size_(a_.size + b_.size) {
    slack_ = (a_.flatEnds || b_.flatEnds ? 80 : 40) * kUnit * size_ + a_.boxError + b_.boxError;
  }

  std::optional<bool> decide() {
    if (!(size_ > 0x1p-100 && size_ < 0x1p100)) return std::nullopt;  // also for NaN
    if (a_.count == 1 && b_.count == 1)
      return verdict(b_.image(b_.points[0]) - a_.image(a_.points[0]));
    if (a_.box && b_.box) return quickBoxes(a_, b_);
    if (a_.count == 1 && (b_.box || b_.flatEnds)) return verdict(toPoint(b_, a_));
    if (b_.count == 1 && (a_.box || a_.flatEnds)) return verdict(-toPoint(a_, b_));
    if (a_.count <= 2 && b_.count <= 2 && !a_.flatEnds && !b_.flatEnds) return segments();
    const Vec3 between = b_.image(b_.middle) - a_.image(a_.middle);
    w_ = between;  // `apart` keeps this if `between` is too short for a direction
    if (apart(between)) return false;
    return search();
  }

 private:
  /// Returns whether n proves that the sets are apart. Sets `w_` to the corner that is extreme
  /// along n, unless n is too short for a direction.
  bool apart(const Vec3& n) {
    const double square = n.squaredNorm();
    if (!(square > 0x1p-120 * size_ * size_)) return false;
    const Vec3 m = a_.local(n), k = -b_.local(n);
    double missed = 0;
    if (a_.count == 1 && b_.count == 1)
      w_ = n;  // the only corner, which `decide` has computed
    else
      w_ = b_.farthest(k, missed) - a_.farthest(m, missed);
    const double along = n.dot(w_) - missed;
    if (!(along > 0)) return false;
    const double length = std::sqrt(square);
    if (radii_ == 0) return along > slack_ * length;
    // r|m| ≤ r(|m|² + N²)/2N
    return 2 * length * (along - slack_ * length) >
           a_.ball * (m.squaredNorm() + square) + b_.ball * (k.squaredNorm() + square);
  }

  /// Returns true if the cores are proved to be so close that the sets touch, up to the band.
  /// @param upper  a vector from a point of core a to a point of core b.
  bool near(const Vec3& upper) const {
    if (!a_.isNearlyRigid || !b_.isNearlyRigid) return false;
    const double limit = radii_ + 0x1p-51 * size_;
    return upper.squaredNorm() <= limit * limit && a_.posed.keepsBall() && b_.posed.keepsBall();
  }

  std::optional<bool> verdict(const Vec3& v) {
    if (near(v)) return true;
    if (apart(v)) return false;
    return std::nullopt;
  }

  /// Decides for two capsules, or a sphere and a capsule. Method: Ericson, section 5.1.9.
  std::optional<bool> segments() {
    const Vec3 a = a_.image(a_.points[0]), b = b_.image(b_.points[0]);
    if (a_.count == 1) return verdict(segment(b - a, b_.image(b_.points[1]) - a).foot);
    if (b_.count == 1) return verdict(segment(b - a, b - a_.image(a_.points[1])).foot);
    const Vec3 d = a_.image(a_.points[1]) - a, e = b_.image(b_.points[1]) - b, r = a - b;
    const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e), dr = d.dot(r),
                 er = e.dot(r), area = dd * ee - de * de;
    if (!(dd > 0 && ee > 0)) return std::nullopt;
    double s = area > 0 ? within((de * er - dr * ee) / area) : 0;
    const double t = within((de * s + er) / ee);
    s = within((t * de - dr) / dd);
    return verdict(e * t - d * s - r);
  }

  /// Returns the vector from a point to the closest point of a box or cylinder. If the map is not
  /// rigid, the vector leads to some point of the solid.
  Vec3 toPoint(const QuickSet& solid, const QuickSet& point) const {
    const Vec3 p = point.image(point.points[0]), q = solid.local(p - solid.t) - solid.points[0];
    if (solid.box) {
      Vec3 foot = solid.points[0];
      for (const Vec3& e : solid.edge) foot += e * within(e.dot(q) / e.squaredNorm());
      return solid.image(foot) - p;
    }
    const Vec3& axis = solid.posed.set().axis;
    const Vec3 d = solid.points[1] - solid.points[0];
    const double z = axis.dot(q);
    Vec3 out = q - axis * z;
    const double square = out.squaredNorm(), disc = solid.posed.set().disc;
    if (square > disc * disc) out *= disc / std::sqrt(square);
    out -= axis * axis.dot(out);
    return solid.image(solid.points[0] + d * within(d.dot(q) / d.squaredNorm()) + out) - p;
  }

  /// Runs GJK. Its first simplex is the corner `w_`, which was found along the first direction.
  std::optional<bool> search() {
    Face face = corner(w_);
    for (int round = 0; round < kRounds; ++round) {
      if (near(face.foot)) return true;
      if (apart(face.v)) return false;
      for (int i = 0; i < face.count; ++i)
        if (w_ == face.w[static_cast<std::size_t>(i)]) return std::nullopt;  // no progress
      if (face.count == 1) {
        face = segment(w_, face.w[0]);
      } else if (face.count == 2) {
        face = triangle(w_, face.w[0], face.w[1]);
      } else {
        switch (tetrahedron(face)) {
          case Inside::yes:
            return true;
          case Inside::unknown:
            return std::nullopt;
          case Inside::no:
            break;
        }
      }
    }
    return std::nullopt;
  }

  enum class Inside { yes, no, unknown };

  /// Adds `w_` to a triangle. If the origin is not in the tetrahedron, replaces `face` by the
  /// tetrahedron's face closest to the origin.
  Inside tetrahedron(Face& face) const {
    const Vec3 &a = w_, b = face.w[0], c = face.w[1], d = face.w[2];
    const Vec3 cd = c.cross(d);
    // The weights of the corners, up to a common factor: the weighted sum of the corners is the
    // origin.
    double inA = b.dot(cd), inB = -a.dot(cd), inC = -a.dot(d.cross(b)), inD = -a.dot(b.cross(c));
    const double sum = inA + inB + inC + inD, inside = 512 * kUnit * size_ * size_ * size_;
    if (sum < 0) inA = -inA, inB = -inB, inC = -inC, inD = -inD;
    if (inA > inside && inB > inside && inC > inside && inD > inside) return Inside::yes;
    Face best;
    double least = HUGE_VAL;
    const auto offer = [&](double in, const Vec3& p, const Vec3& q) {
      if (!(in < 0)) return;
      const Face found = triangle(a, p, q);
      const double square = found.v.squaredNorm();
      if (square < least) least = square, best = found;
    };
    offer(inD, b, c);
    offer(inB, c, d);
    offer(inC, d, b);
    if (best.count == 0) return Inside::unknown;
    face = best;
    return Inside::no;
  }

  QuickSet a_, b_;
  double radii_, size_, slack_;
  Vec3 w_ = Vec3::Zero();
};

}  // namespace

std::optional<bool> quickContact(const PosedSet& a, const PosedSet& b) {
  if (a.set().polytope || b.set().polytope) return std::nullopt;
  return Query(a, b).decide();
}

}  // namespace corridor
